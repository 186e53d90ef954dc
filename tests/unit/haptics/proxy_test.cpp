// Where a tool can be: never in uncut solid tissue, whatever its arm does.
#include "haptics/proxy.h"

#include <algorithm>
#include <cmath>

#include "base/rt/alloc_guard.h"
#include "haptics/hand_work.h"
#include "haptics_support.h"

namespace trephine {
namespace {

using test::Bench;

TissueTable solidBone(bool cuttable = false) {
  TissueTable table = test::boneTable(10.0, 900.0, 0.0);
  table.classes[0].solid = 1;
  table.classes[0].cuttable = cuttable;
  return table;
}

// A cube of bone of 12 mm in air, voxels of 0.5 mm; the origin is in its middle.
Volume cube() {
  Volume volume;
  volume.geometry.size = {80, 80, 80};
  volume.geometry.spacing_mm = Vec3(0.5);
  volume.geometry.origin_mm = Vec3(-19.75);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 28; k < 52; ++k) {
    for (int j = 28; j < 52; ++j) {
      for (int i = 28; i < 52; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = test::kBoneHu;
      }
    }
  }
  return volume;
}

struct Surroundings {
  explicit Surroundings(Volume volume, const TissueTable& table = solidBone())
      : grid(std::move(volume)), tissue(grid, table) {}
  // How deep the centre of an uncut voxel lies in the tool's body, at most; below 0: nowhere.
  double deepest_mm(const Tool& tool, const Pose& pose_mm) const {
    double deepest = -1e9;
    const GridGeometry& g = grid.geometry();
    for (std::size_t n = 0; n < g.voxelCount(); ++n) {
      if (grid.hu(n) < 226) continue;
      const Index3 v = g.indicesOf(n);
      const Vec3 at = g.toPatient_mm(Vec3(v[0], v[1], v[2]));
      for (const BodyPart& part : tool.body) {
        const Vec3 from = pose_mm.position + pose_mm.orientation * (1000.0 * part.from_m);
        const Vec3 along = pose_mm.orientation * (1000.0 * (part.to_m - part.from_m));
        const double length2 = glm::dot(along, along);
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(at - from, along) / length2, 0.0, 1.0) : 0.0;
        deepest = std::max(deepest, 1000.0 * part.radius_m - glm::length(at - from - t * along));
      }
    }
    return deepest;
  }
  Grid grid;
  TissueField tissue;
};

Quat turnAbout(const Vec3& axis, double angle) {
  const Vec3 unit = glm::normalize(axis);
  return Quat(std::cos(angle / 2), std::sin(angle / 2) * unit.x, std::sin(angle / 2) * unit.y,
              std::sin(angle / 2) * unit.z);
}

const Tool kTools[] = {makeNeedle(0.06), makeBlade(0.016, 16), makeBurr(0.003, 32, 8, 0.03)};

// Amid bone wherever it lies, turned in every way: as much to find as there can be.
TEST(SolidSurface, FindsAllThatThereIsAroundAToolWithoutAllocating) {
  Volume block = cube();
  std::ranges::fill(block.hu, test::kBoneHu);
  Surroundings bone(std::move(block));
  for (const Tool& tool : kTools) {
    SolidSurface surface(tool, bone.grid.geometry());
    std::size_t most = 0;
    for (int n = 0; n < 24; ++n) {
      const Pose pose_mm{Vec3(0.13, -0.2, -8.0), turnAbout(Vec3(1, n % 5, n % 3), 0.26 * n)};
      const std::uint64_t before = rt::guardedAllocations();
      {
        rt::NoAllocation guard;
        surface.begin(bone.tissue, surface.place(pose_mm), Cutting::nothing);
        ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
      }
      ASSERT_EQ(rt::guardedAllocations(), before) << int(tool.made_from.kind) << " " << n;
      most = std::max(most, surface.pieces().size());
    }
    EXPECT_GT(most, 20u);
  }
}

TEST(Proxy, HeldBackByAPauseOnItsWayThroughAirIsPulledByNothing) {
  Surroundings bone(cube());
  Proxy proxy(kTools[2], bone.grid.geometry());
  const Quat upright(1, 0, 0, 0);
  proxy.place({{0, 0, 8}, upright});
  for (int i = 0; i < 60; ++i) {
    proxy.follow(bone.tissue, {{0, 0, 8 - 0.05 * i}, upright}, Cutting::nothing);
  }
  const Pose on_bone = proxy.pose_mm();
  proxy.hold(on_bone);
  EXPECT_EQ(proxy.pull().stiffness, 900.0) << "bone held it";
  proxy.follow(bone.tissue, {{0, 0, 5}, upright}, Cutting::nothing);
  ASSERT_GT(proxy.pull().stiffness, 0.0);
  // Away from the bone: on the way nothing holds it but the pause.
  proxy.follow(bone.tissue, {{0, 0, 16}, upright}, Cutting::nothing);
  proxy.hold(on_bone);
  EXPECT_EQ(proxy.pull().stiffness, 0.0);
  EXPECT_FALSE(proxy.held());
}

TEST(Proxy, IsAtTheArmWhereNothingIsSolid) {
  Surroundings air(test::boneSlab(), test::boneTable());
  Proxy proxy(kTools[0], air.grid.geometry());
  proxy.place({{0, 0, 8}, Quat(1, 0, 0, 0)});
  for (int n = 0; n < 100; ++n) {
    const Pose arm{{0.05 * n, 0, 8 - 0.15 * n}, turnAbout({1, 2, 3}, 0.005 * n)};
    proxy.follow(air.tissue, arm, Cutting::by_hand);
    ASSERT_EQ(proxy.pose_mm().position, arm.position) << "soft tissue lets it through";
    ASSERT_FALSE(proxy.held());
  }
}

TEST(Proxy, NeverEntersSolidTissueFromAnySideOverEdgesAndTurning) {
  const Surroundings bone(cube());
  for (const Tool& tool : kTools) {
    for (int side = 0; side < 26; ++side) {
      const int number = side < 13 ? side : side + 1;
      const Vec3 out = glm::normalize(Vec3(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1));
      // The handle away from the cube.
      const Vec3 z(0, 0, 1), axis = glm::cross(z, out);
      const Quat outwards = glm::length(axis) > 1e-9
                                ? turnAbout(axis, std::acos(glm::dot(z, out)))
                                : (out.z > 0 ? Quat(1, 0, 0, 0) : Quat(0, 1, 0, 0));
      const Vec3 aside = glm::normalize(glm::cross(out, Vec3(0.3, 0.5, 0.8)));
      Proxy proxy(tool, bone.grid.geometry());
      proxy.place({18.0 * out, outwards});
      for (int n = 0; n < 1200; ++n) {
        // 15 mm beyond the middle, 20 mm sideways over an edge, turning meanwhile.
        const double in = std::min(1.0, n / 500.0), over = std::clamp((n - 600) / 600.0, 0.0, 1.0);
        const Pose arm{(18.0 - 33.0 * in) * out + 20.0 * over * aside,
                       turnAbout(aside, 0.5 * std::sin(0.01 * n)) * outwards};
        proxy.follow(bone.tissue, arm, Cutting::nothing);
        if (n % 100 != 99) continue;
        ASSERT_LE(bone.deepest_mm(tool, proxy.pose_mm()), 0.25)
            << "tool " << &tool - kTools << ", side " << side << ", tick " << n;
      }
    }
  }
}

TEST(Proxy, PullsAlongTheSurfacesNormalAsFarAsTheArmIsIn) {
  const Surroundings bone(test::boneSlab());
  Proxy proxy(kTools[2], bone.grid.geometry());
  proxy.place({{0, 0, 5}, Quat(1, 0, 0, 0)});
  const auto shift = [&](double depth_mm) {
    for (int n = 0; n < 40; ++n) {
      proxy.follow(bone.tissue, {{0.3, 0.2, -depth_mm}, Quat(1, 0, 0, 0)}, Cutting::nothing);
    }
    return proxy.pull().shift_mm;
  };
  const Vec3 one = shift(1.0), three = shift(3.0);
  EXPECT_NEAR(three.z - one.z, 2.0, 0.02);
  EXPECT_LT(std::hypot(three.x, three.y), 0.02 * three.z);
  EXPECT_NEAR(proxy.pull().stiffness, 900.0, 1e-9);
}

TEST(Proxy, StandsStillUnderAnArmThatShakesByACount) {
  const Surroundings bone(cube());
  Proxy proxy(kTools[0], bone.grid.geometry());
  proxy.place({{1, 1, 12}, Quat(1, 0, 0, 0)});
  Vec3 before(0.0);
  for (int n = 0; n < 600; ++n) {
    const double count = n % 2 ? 0.055 : 0.0;
    proxy.follow(bone.tissue, {{1 + count, 1, 3.0 + count}, Quat(1, 0, 0, 0)}, Cutting::nothing);
    const double moved = glm::length(proxy.pose_mm().position - before);
    ASSERT_TRUE(n <= 300 || moved < 0.06) << moved << " in tick " << n;
    before = proxy.pose_mm().position;
  }
}

HapticParameters burrWithoutMotor() {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = makeBurr(0.003, 32, 0, 0.006);
  p.arms[0].max_force_N = 100.0;
  p.laws = {LawKind::elastic};
  p.removal = RemovalKind::work;
  p.tissues = solidBone(true);
  return p;
}

// Of the slab: its last voxels at -1 mm are 1000 HU, the next -1000, bone begins at 226.
constexpr double kSurface_mm = -1.0 + (1000.0 - 225.5) / 2000.0;

TEST(Barrier, ABurrWithoutItsMotorIsHeldAndCutsNothing) {
  Bench bench(burrWithoutMotor());
  for (int n = 0; n <= 2000; ++n) bench.at({0, 0, 4 - 0.01 * n});
  const ArmRecord& arm = bench.record.arms[0];
  EXPECT_GT(arm.proxy_position_mm.z, kSurface_mm);
  EXPECT_NEAR(arm.demanded_N.z, 0.9 * (arm.proxy_position_mm.z + 16.0), 1e-6);
  EXPECT_EQ(bench.core.journal().removed(0, 0), 0u);
  EXPECT_TRUE(arm.tool_state & kToolHeld);
  for (int n = 0; n <= 2000; ++n) bench.at({0, 0, -16 + 0.01 * n});
  EXPECT_NEAR(bench.record.arms[0].proxy_position_mm.z, 4.0, 1e-9) << "and comes back";
}

TEST(Barrier, AToolThatStartsInTissueHasNoForceUntilItHasBeenOut) {
  Bench bench(burrWithoutMotor());
  bench.at({0, 0, -3});
  ASSERT_EQ(bench.core.events().size(), 1u);
  EXPECT_EQ(bench.core.events()[0].kind, EventKind::starts_in_tissue);
  EXPECT_EQ(bench.push({0, 0, -3}, {0, 0, 0.6}, 400), 0.0);
  bench.push({0, 0, 0.6}, {0, 0, 3}, 100);
  bench.push({0, 0, 3}, {0, 0, -2}, 300);
  EXPECT_GT(glm::length(bench.record.arms[0].sent_N), 0.5);
}

TEST(Barrier, InAPauseTheToolStaysOutsideToo) {
  Bench bench(burrWithoutMotor());
  bench.at({0, 0, 3}, {{CommandKind::pause, 0, {}}});
  for (int n = 0; n <= 1000; ++n) bench.at({0, 0, 3 - 0.013 * n});
  EXPECT_EQ(glm::length(bench.record.arms[0].sent_N), 0.0);
  EXPECT_GT(bench.record.arms[0].proxy_position_mm.z, kSurface_mm);
}

// A tool in a box of bone, its arm outside: as after a dive through a hole.
TEST(Barrier, AHookedToolIsLetGoOnceItsArmHasLongBeenFree) {
  HapticParameters p = burrWithoutMotor();
  Volume hollow = cube();
  const GridGeometry& g = hollow.geometry;
  for (int k = 30; k < 50; ++k) {
    for (int j = 30; j < 50; ++j) {
      for (int i = 30; i < 50; ++i) hollow.hu[g.indexOf(i, j, k)] = kAirHu;
    }
  }
  Bench bench(p, std::move(hollow));
  for (int n = 0; n < 10; ++n) bench.at({0, 0, -3});
  for (int n = 0; n < 300; ++n) bench.at({0, 0, -3 + 0.075 * n});
  EXPECT_LT(bench.record.arms[0].proxy_position_mm.z, 1.0);
  EXPECT_GT(glm::length(bench.record.arms[0].sent_N), 1.0);
  int let_go = 0;
  double longest_step = 0.0, before = glm::length(bench.record.arms[0].demanded_N);
  for (int n = 0; n < 900; ++n) {
    bench.at({0, 0, 19.4});
    for (const Event& event : bench.core.events()) let_go += event.kind == EventKind::let_go;
    const double now = glm::length(bench.record.arms[0].demanded_N);
    longest_step = std::max(longest_step, std::abs(now - before));
    before = now;
  }
  EXPECT_EQ(let_go, 1);
  EXPECT_EQ(bench.record.arms[0].proxy_position_mm, bench.record.arms[0].patient_position_mm);
  EXPECT_EQ(glm::length(bench.record.arms[0].sent_N), 0.0);
  EXPECT_LT(longest_step, 0.2) << "it fades";
}

TEST(HandWork, WhatASpringGivesBackIsNotPaidTwice) {
  HandWork work;
  double paid = work.endTick(0.0, 1.0);
  const auto move = [&](double force_N, double by_m, double stored_J) {
    work.addDeviceWork(Vec3(0, 0, force_N), Vec3(0, 0, by_m), 1.0);
    work.addModelWork(-force_N * by_m);
    paid += work.endTick(stored_J, 1.0);
  };
  move(1.0, -0.002, 0.002);  // pressed: all of it is stored
  EXPECT_NEAR(paid, 0.0, 1e-15);
  move(1.0, 0.002, 0.0);  // and comes back
  EXPECT_NEAR(paid, 0.0, 1e-15);
  move(1.0, -0.003, 0.001);  // two thirds are lost
  EXPECT_NEAR(paid, 0.002, 1e-15);
  move(1.0, 0.001, 0.0);
  move(1.0, 0.001, 0.0);  // the arm gives out: a debt
  move(1.0, -0.001, 0.0);
  EXPECT_NEAR(paid, 0.002, 1e-15) << "the debt comes first";
}

TEST(HandWork, DoesNotDependOnTheArm) {
  // Half the impedance shown over a map of g / s = 2: half the force, doubled.
  HandWork work, weak;
  work.endTick(0.0, 1.0);
  weak.endTick(0.0, 0.5);
  work.addDeviceWork(Vec3(0, 0, 1.0), Vec3(0, 0, -0.001), 1.0);
  weak.addDeviceWork(Vec3(0, 0, 1.0), Vec3(0, 0, -0.001), 2.0);
  EXPECT_DOUBLE_EQ(work.done_J(), weak.done_J());
}

TEST(HandWork, WhatAControllerDampsAwayIsNoWorkOnTissue) {
  HandWork work;
  double paid = work.endTick(0.0, 0.1);
  for (int n = 0; n < 10; ++n) {
    work.addDeviceWork(Vec3(0, 0, 0.2), Vec3(0, 0, -0.001), 1.0);  // ten times what the model does
    work.addModelWork(0.0002);
    paid += work.endTick(0.0, 0.1);
  }
  EXPECT_NEAR(work.done_J(), 0.02, 1e-15);
  EXPECT_NEAR(paid, 0.002, 1e-15);
}

TEST(Barrier, AThickToolThatOverlapsBoneStartsInTissueThoughItsAxisDoesNot) {
  HapticParameters p = burrWithoutMotor();
  p.arms[0].tool = makeNeedle(0.06);
  for (BodyPart& part : p.arms[0].tool.body) part.radius_m = 0.005;
  Bench bench(p);
  bench.at({0, 0, kSurface_mm + 3.0});  // its tip is round: 5 mm around the axis
  ASSERT_EQ(bench.core.events().size(), 1u);
  EXPECT_EQ(bench.core.events()[0].kind, EventKind::starts_in_tissue);
  EXPECT_EQ(bench.push({0, 0, kSurface_mm + 3.0}, {0, 0, kSurface_mm + 3.0}, 200), 0.0);
  EXPECT_NEAR(bench.record.arms[0].proxy_position_mm.z, kSurface_mm + 3.0, 1e-9) << "not thrown";
  bench.push({0, 0, kSurface_mm + 3.0}, {0, 0, 10}, 200);
  bench.push({0, 0, 10}, {0, 0, kSurface_mm + 3.0}, 400);
  EXPECT_GT(glm::length(bench.record.arms[0].sent_N), 0.5);
}

TEST(Barrier, WithoutTheElasticLawAStartInTissueIsToldToo) {
  HapticParameters p = burrWithoutMotor();
  p.laws = {LawKind::viscous};
  Bench bench(p);
  bench.at({0, 0, -3});
  ASSERT_EQ(bench.core.events().size(), 1u);
  EXPECT_EQ(bench.core.events()[0].kind, EventKind::starts_in_tissue);
  bench.at({0, 0, -3.1});
  EXPECT_TRUE(bench.core.events().empty()) << "once";
}

TEST(Barrier, BoneWithoutStiffnessIsCutByAMotorAllTheSame) {
  const auto removed = [](double stiffness) {
    HapticParameters p = burrWithoutMotor();
    p.arms[0].tool.made_from.motor_W = 6.0;
    p.tissues = solidBone(true);
    p.tissues.classes[0].stiffness_N_per_m = stiffness;
    p.tissues.classes[0].cutting_J_per_mm3 = 0.06;
    Bench bench(p);
    bench.push({0, 0, 4}, {0, 0, -4}, 2000);
    return bench.core.journal().removed(0, 0);
  };
  EXPECT_GT(removed(0.0), 50u);
  EXPECT_EQ(removed(0.0), removed(1e-9));
}

TEST(Barrier, TheTissueThatHoldsTheToolIsTheOneItTouches) {
  HapticParameters p = burrWithoutMotor();
  p.tissues.count = 2;
  p.tissues.classes[1].hu_min = 0;
  p.tissues.classes[1].hu_max = 225;
  Volume volume = cube();
  for (int k = 52; k < 60; ++k) {  // a soft layer on the bone, where the tool's points lie
    for (int n = 0; n < 80 * 80; ++n) volume.hu[volume.geometry.indexOf(n % 80, n / 80, k)] = 100;
  }
  Bench bench(p, std::move(volume));
  bench.push({0, 0, 19}, {0, 0, 4}, 1500);
  EXPECT_TRUE(bench.record.arms[0].tool_state & kToolHeld);
  EXPECT_EQ(bench.record.arms[0].tissue_class, 0);
}

TEST(Barrier, InAPauseTheDemandIsStillTheWallsOwn) {
  Bench bench(burrWithoutMotor());
  bench.push({0, 0, 4}, {0, 0, -3}, 700);
  bench.push({0, 0, -3}, {0, 0, -3}, 100);
  const double before_N = bench.record.arms[0].demanded_N.z;
  ASSERT_GT(before_N, 1.0);
  bench.at({0, 0, -3}, {{CommandKind::pause, 0, {}}});
  EXPECT_NEAR(bench.record.arms[0].demanded_N.z, before_N, 0.02 * before_N);
  bench.push({0, 0, -3}, {0, 0, -3.5}, 100);
  EXPECT_NEAR(bench.record.arms[0].demanded_N.z, before_N + 0.45, 0.05);
  EXPECT_EQ(glm::length(bench.record.arms[0].sent_N), 0.0);
}

}  // namespace
}  // namespace trephine
