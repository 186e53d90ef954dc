// The surface that a driven tool eats into is kept row by row: what it holds is what a search anew
// would find, however much went meanwhile.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "base/rt/alloc_guard.h"
#include "haptics/proxy.h"
#include "haptics_support.h"
#include "strokes_support.h"

namespace trephine {
namespace {

using VoxelSet = std::set<std::uint32_t>;

// A block of bone with a slab of dura on its far side, the origin in its middle.
Volume block(const Vec3& spacing_mm = {0.15, 0.3, 0.35}) {
  Volume volume;
  volume.geometry.size = {70, 70, 70};
  volume.geometry.spacing_mm = spacing_mm;
  volume.geometry.origin_mm = -0.5 * volume.geometry.spacing_mm * Vec3(69.0);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 45; ++k) {
    for (int j = 5; j < 65; ++j) {
      for (int i = 5; i < 65; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = k < 12 ? 150 : test::kBoneHu;
      }
    }
  }
  return volume;
}

TissueTable boneOverDura() {
  TissueTable table = test::boneTable(10.0, 900.0, 0.0);
  table.classes[0].solid = table.classes[0].cuttable = 1;
  table.classes[1] = table.classes[0];
  table.classes[1].hu_min = 100;
  table.classes[1].hu_max = 225;
  table.classes[1].cuttable = 0;
  table.classes[0].hu_min = 226;
  table.count = 2;
  return table;
}

struct Bone {
  explicit Bone(Volume volume = block())
      : grid(std::move(volume)), writer(grid.takeWriter()), tissue(grid, boneOverDura()) {}
  const GridGeometry& geometry() const { return grid.geometry(); }
  // All that may be cut within so far of a place goes.
  SolidSurface::Stale cut(SolidSurface& surface, const Vec3& at_mm, double radius_mm) {
    std::vector<std::uint32_t> went;
    VoxelBounds box;
    const GridGeometry& g = geometry();
    const Vec3 low = (at_mm - radius_mm - g.origin_mm) / g.spacing_mm,
               high = (at_mm + radius_mm - g.origin_mm) / g.spacing_mm;
    for (int k = std::max(0, int(low.z)); k <= std::min(g.size[2] - 1, int(high.z)); ++k) {
      for (int j = std::max(0, int(low.y)); j <= std::min(g.size[1] - 1, int(high.y)); ++j) {
        for (int i = std::max(0, int(low.x)); i <= std::min(g.size[0] - 1, int(high.x)); ++i) {
          const std::size_t v = g.indexOf(i, j, k);
          const int c = tissue.classAt(v);
          if (c < 0 || !tissue.ofClass(c).cuttable) continue;
          if (glm::distance(g.toPatient_mm(Vec3(i, j, k)), at_mm) > radius_mm) continue;
          writer->store(v, kAirHu);
          tissue.removed({i, j, k}, c);
          went.push_back(std::uint32_t(v));
          box.add({i, j, k});
        }
      }
    }
    rt::NoAllocation guard;
    return went.empty() ? SolidSurface::Stale{} : surface.removed(tissue, went, box);
  }
  Grid grid;
  std::optional<Grid::Writer> writer;
  TissueField tissue;
};

VoxelSet rowsOf(const SolidSurface& surface) {
  VoxelSet out;
  for (const SurfacePiece& piece : surface.pieces()) {
    if (piece.row_step != 0 && piece.voxel != SurfacePiece::kGone) out.insert(piece.voxel);
  }
  return out;
}

const Tool kBurr = test::tool(ToolKind::burr, 40.0, 2.0, 4.0);
const Tool kSaw = test::tool(ToolKind::blade, 6.0, 0.6, 4.0);

TEST(SurfaceRows, AreThoseOfASearchAnewHoweverMuchWent) {
  for (const Tool* tool : {&kBurr, &kSaw}) {
    Bone bone;
    std::mt19937 random(3);
    const auto in = [&](double from, double to) {
      return from + (to - from) * double(random()) / 4294967296.0;
    };
    SolidSurface surface(*tool, bone.geometry()), anew(*tool, bone.geometry());
    std::size_t most = 0;
    for (int place = 0; place < 12; ++place) {
      const Pose pose_mm{{in(-6, 6), in(-6, 6), in(1.0, 4.5)},
                         test::turned({in(-1, 1), in(-1, 1), in(-1, 1)})};
      const PlacedBody body = surface.place(pose_mm);
      bone.cut(surface, pose_mm.position, 1.5);
      surface.begin(bone.tissue, body, Cutting::driven);
      // Some of it goes while it is looked for.
      (void)surface.goOn(bone.tissue, 200);
      bone.cut(surface, pose_mm.position + Vec3(in(-2, 2), in(-2, 2), -1.0), 1.2);
      while (surface.underWay()) {
        (void)surface.goOn(bone.tissue, 100);
        bone.cut(surface, pose_mm.position + Vec3(in(-2, 2), in(-2, 2), -1.5), 0.6);
      }
      for (int n = 0; n < 6; ++n) {
        bone.cut(surface, pose_mm.position + Vec3(in(-3, 3), in(-3, 3), in(-3, 1)), 0.9);
      }
      anew.begin(bone.tissue, body, Cutting::driven);
      ASSERT_TRUE(anew.goOn(bone.tissue, SolidSurface::kAll));
      const VoxelSet kept = rowsOf(surface), found = rowsOf(anew);
      most = std::max(most, found.size());
      // What is kept may lie a little farther than a search looks.
      EXPECT_TRUE(std::ranges::includes(kept, found)) << place;
      EXPECT_LT(double(kept.size()), 1.3 * double(found.size()) + 4.0);
    }
    EXPECT_GT(most, 40u);
  }
}

// Stretches of a long part share voxels, and many cuts make the table of them anew: now and then in
// the middle of such a voxel.
TEST(SurfaceRows, HoldNoVoxelThatWentHoweverOftenTheirTableIsMadeAnew) {
  constexpr double kLength_mm = 16.0, kRadius_mm = 1.2;
  Tool saw;
  saw.body.push_back({Vec3(0.0), Vec3(0.0, 0.0, 0.001 * kLength_mm), 0.001 * kRadius_mm, true});
  for (unsigned seed = 30; seed < 40; ++seed) {
    Volume solid;
    solid.geometry.size = {60, 15, 60};
    solid.geometry.spacing_mm = {0.1, 0.4, 0.4};
    solid.geometry.origin_mm = -0.5 * solid.geometry.spacing_mm * Vec3(59, 14, 59);
    solid.hu.assign(solid.geometry.voxelCount(), test::kBoneHu);
    Bone bone(std::move(solid));
    SolidSurface surface(saw, bone.geometry());
    std::mt19937 random(seed);
    const auto in = [&](double from, double to) {
      return from + (to - from) * double(random()) / 4294967296.0;
    };
    const double x_mm = in(-0.5, 0.5), y_mm = in(-0.5, 0.5);
    const Pose pose_mm{{x_mm, y_mm, -0.5 * kLength_mm - 0.3}, Quat(1, 0, 0, 0)};
    // The tool displaced by `shift` takes what it is in, as many in a tick as removal does.
    const auto cutAlong = [&](const Vec3& shift, double radius_mm) {
      std::vector<std::uint32_t> went;
      VoxelBounds box;
      const auto tell = [&] {
        if (!went.empty()) (void)surface.removed(bone.tissue, went, box);
        went.clear();
        box = {};
      };
      for (std::size_t v = 0; v < bone.geometry().voxelCount(); ++v) {
        if (bone.grid.hu(v) < 226) continue;
        const Index3 at = bone.geometry().indicesOf(v);
        Vec3 off =
            bone.geometry().toPatient_mm(Vec3(at[0], at[1], at[2])) - (pose_mm.position + shift);
        off.z -= std::clamp(off.z, 0.0, kLength_mm);
        if (glm::length(off) > radius_mm) continue;
        bone.writer->store(v, kAirHu);
        bone.tissue.removed(at, 0);
        went.push_back(std::uint32_t(v));
        box.add(at);
        if (went.size() == 512) tell();
      }
      tell();
    };
    cutAlong(Vec3(0.0), 0.95 * kRadius_mm);
    surface.begin(bone.tissue, surface.place(pose_mm), Cutting::driven);
    ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
    for (int step = 0; step < 40; ++step) {
      const double angle = in(0, 6.283), by = in(0, 0.95 * surface.margin_mm());
      const double up = in(-0.3, 0.3);
      cutAlong({by * std::cos(angle), by * std::sin(angle), up}, kRadius_mm);
    }
    std::size_t gone = 0;
    for (const SurfacePiece& piece : surface.pieces()) {
      if (piece.voxel == SurfacePiece::kGone) continue;
      gone += !bone.tissue.isSolid(bone.tissue.classAt(piece.voxel));
    }
    EXPECT_GT(surface.pieces().size(), 300u);
    EXPECT_EQ(gone, 0u) << seed;
  }
}

TEST(SurfaceRows, AreFoundAndFollowedWithoutAllocating) {
  Bone bone;
  SolidSurface surface(kBurr, bone.geometry());
  const std::uint64_t before = rt::guardedAllocations();
  for (int n = 0; n < 10; ++n) {
    const Pose pose_mm{{0.5 * n - 2.0, 0.0, 3.0 - 0.2 * n}, test::turned({0.1 * n, 0.3, 0.0})};
    {
      rt::NoAllocation guard;
      surface.begin(bone.tissue, surface.place(pose_mm), Cutting::driven);
      ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
    }
    bone.cut(surface, pose_mm.position, 2.3);
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
}

TEST(SurfaceRows, WhatIsNotCutIsMetWhereARowEndsAtItAndIsSearchedAnew) {
  Bone bone;
  SolidSurface surface(kBurr, bone.geometry());
  // Bone alone about it, and a way for its shaft; dura begins 8 mm below the middle.
  const Vec3 at_mm(0.0, 0.0, -5.0), ball_mm(0.0, 0.0, 2.0);
  SolidSurface::Stale stale;
  for (double z = -3.0; z < 5.0; z += 0.5) bone.cut(surface, {0.0, 0.0, z}, 2.2);
  surface.begin(bone.tissue, surface.place({at_mm, Quat(1, 0, 0, 0)}), Cutting::driven);
  ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
  stale = bone.cut(surface, at_mm + ball_mm, 2.5);
  EXPECT_FALSE(stale.now) << "a driven tool's own rows go on";
  // Farther down some disks of dura are among them.
  const Vec3 low_mm(0.0, 0.0, -7.6);
  for (double z = -5.6; z < 0.0; z += 0.5) bone.cut(surface, {0.0, 0.0, z}, 2.2);
  surface.begin(bone.tissue, surface.place({low_mm, Quat(1, 0, 0, 0)}), Cutting::driven);
  ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
  const auto disks = std::ranges::count_if(
      surface.pieces(), [](const SurfacePiece& piece) { return !piece.cuttable; });
  EXPECT_GT(disks, 0);
  stale = bone.cut(surface, low_mm + ball_mm, 2.6);
  EXPECT_TRUE(stale.now) << "the place of a disk follows from what is around it";
  EXPECT_EQ(surface.removed(bone.tissue, std::vector<std::uint32_t>{0}, {{0, 0, 0}, {1, 1, 1}}).now,
            false)
      << "far away";
}

// Pressed 0.3 mm into flat bone and pitched slowly, its motor without power: where a long part lies
// along the rows, the place of a row that is nearest to it wanders all along it.
TEST(SurfaceRows, ALongDrivenPartAlongTheRowsEntersNoDeeperThanBefore) {
  const Tool saw = test::tool(ToolKind::blade, 8.0, 1.2, 4.0);
  Bone bone(block({0.2, 0.2, 0.2}));
  std::vector<double> deepest_mm;
  for (const int version : {10, kTouchVersion}) {
    Proxy proxy(saw, bone.geometry(), version);
    const double top_mm = -0.5 * 0.2 * 69.0 + 44.5 * 0.2;
    const Vec3 middle_mm = 500.0 * (saw.body[0].from_m + saw.body[0].to_m);
    double deepest = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const double t = 0.001 * n;
      const Quat turn = test::turned({0.0, -1.5707963267948966 + 0.12 * std::sin(6.0 * t), 0.0});
      const Vec3 axis_mm(0.0, 0.0, top_mm + 1.2 - (n < 100 ? 0.01 * n - 0.7 : 0.3));
      const Pose arm_mm{axis_mm - turn * middle_mm, turn};
      if (n == 0) proxy.place({arm_mm.position + Vec3(0, 0, 2), turn});
      proxy.follow(bone.tissue, arm_mm, Cutting::driven);
      if (n % 40 != 0) continue;
      const BodyPart& part = saw.body[0];
      const Pose& pose = proxy.pose_mm();
      const Vec3 from = pose.position + pose.orientation * (1000.0 * part.from_m);
      const Vec3 along = pose.orientation * (1000.0 * (part.to_m - part.from_m));
      const GridGeometry& g = bone.geometry();
      for (std::size_t v = 0; v < g.voxelCount(); ++v) {
        if (bone.grid.hu(v) < 226) continue;
        const Index3 at = g.indicesOf(v);
        const Vec3 mm = g.toPatient_mm(Vec3(at[0], at[1], at[2])) - from;
        const double on = std::clamp(glm::dot(mm, along) / glm::dot(along, along), 0.0, 1.0);
        deepest = std::max(deepest, 1.2 - glm::length(mm - on * along));
      }
    }
    deepest_mm.push_back(deepest);
  }
  std::printf("a long part along the rows: touch version 10 %.4f mm deep, now %.4f\n",
              deepest_mm[0], deepest_mm[1]);
  EXPECT_LT(deepest_mm[1], deepest_mm[0] + 0.01);
}

// Held where it cannot cut, its arm deep below: no voxel's centre comes into the burr, but by what
// it may be in a step.
TEST(SurfaceRows, ADrivenToolStaysOutOfWhatItHasNotCut) {
  for (const int version : {10, kTouchVersion}) {
    HapticParameters p = test::oneArm();
    p.touch_version = version;
    p.arms[0].tool = kBurr;
    p.tissues = boneOverDura();
    p.tissues.classes[0].cutting_J_per_mm3 = 0.06;
    p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
    p.removal = RemovalKind::work;
    test::Bench bench(p, block());
    const GridGeometry g = bench.grid.geometry();
    double deepest_mm = 0.0;
    std::uint64_t removed = 0;
    for (int n = 0; n < 1500; ++n) {
      const double t = 0.001 * n;
      const Vec3 arm_mm(3.0 * std::sin(4.0 * t), 2.0 * std::sin(5.0 * t),
                        9.0 - 8.0 * std::min(1.0, 2.0 * t));
      const ArmRecord& arm = bench.at(arm_mm);
      removed += std::uint64_t(arm.removed_voxels);
      if (n % 30 != 0) continue;
      for (std::size_t v = 0; v < g.voxelCount(); ++v) {
        if (bench.grid.hu(v) < 226) continue;
        const Index3 at = g.indicesOf(v);
        const Vec3 mm = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
        const Vec3 ball = arm.proxy_position_mm + 1000.0 * kBurr.body[0].from_m;
        deepest_mm = std::max(deepest_mm, 2.0 - glm::distance(mm, ball));
      }
    }
    EXPECT_GT(removed, 500u) << version;
    EXPECT_LT(deepest_mm, 0.45 * 0.15) << version;
    std::printf("touch version %d: %llu voxels, at most %.4f mm in uncut bone\n", version,
                static_cast<unsigned long long>(removed), deepest_mm);
  }
}

}  // namespace
}  // namespace trephine
