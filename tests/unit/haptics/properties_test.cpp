// What holds of touch whatever the numbers: energy, symmetry, frames, time steps, builds.
#include <cmath>
#include <functional>
#include <random>

#include "base/sha256.h"
#include "haptics_support.h"

namespace trephine {
namespace {

const std::vector<LawKind> kAllLaws{LawKind::viscous, LawKind::coulomb, LawKind::elastic,
                                    LawKind::rupture};

// A ball of bone with a soft shell around it, in a grid that lies turned in the patient. Nothing is
// cut.
Volume ball(const Mat3& direction = Mat3(1.0)) {
  Volume volume;
  volume.geometry.size = {64, 64, 64};
  volume.geometry.spacing_mm = Vec3(0.5);
  volume.geometry.direction = direction;
  volume.geometry.origin_mm = direction * Vec3(-15.75);
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 v = volume.geometry.indicesOf(n);
    const double r = 0.5 * glm::length(Vec3(v[0], v[1], v[2]) - 31.5);
    volume.hu[n] = r < 8.0 ? test::kBoneHu : r < 10.0 ? 40 : kAirHu;
  }
  return volume;
}

TissueTable twoTissues() {
  TissueTable t;
  t.count = 2;
  t.classes[0] = {{8.0, 900.0, 1.0, 0.0, 0.05}, 226, 3071, 0, 0};
  t.classes[1] = {{3.0, 200.0, 0.3, 0.5, 0.05}, 0, 100, 0, 0};
  return t;
}

HapticParameters parameters(const std::vector<LawKind>& laws = kAllLaws) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = makeBurr(0.002, 32, 4, 0.02);
  p.laws = laws;
  p.tissues = twoTissues();
  p.force_at = ForceAt::distributed;
  return p;
}

// A way around the ball and through its shell, at `t` seconds; it comes back after 4 s.
Vec3 way_mm(double t) {
  const double a = 2.0 * M_PI * t / 4.0;
  return {9.0 * std::cos(a), 6.0 * std::sin(2.0 * a), 7.0 + 3.0 * std::sin(3.0 * a)};
}
Quat lean(double t) {
  const double half = 0.2 * std::sin(2.0 * M_PI * t / 4.0);
  return {std::cos(half), 0.0, std::sin(half), 0.0};
}

struct Trace {
  std::vector<Vec3> force_N, torque_Nm;
  double absorbed_J = 0.0;
};

Trace follow(const HapticParameters& p, Volume volume, double rate_hz,
             const std::function<Pose(double)>& pose_m, double seconds = 4.0) {
  HapticParameters timed = p;
  timed.period_s = 1.0 / rate_hz;
  Grid grid(std::move(volume));
  HapticCore core(timed, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  Trace out;
  Vec3 last_N(0.0);
  for (int n = 0; n < int(seconds * rate_hz); ++n) {
    const Pose pose = pose_m(n / rate_hz);
    const Vec3 moved = pose.position - input.arms[0].position_m;
    input.arms[0].position_m = pose.position;
    input.arms[0].orientation = pose.orientation;
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    const ArmRecord& arm = record.arms[0];
    if (n > 0) out.absorbed_J -= 0.5 * glm::dot(arm.demanded_N + last_N, moved);
    last_N = arm.demanded_N;
    out.force_N.push_back(arm.demanded_N);
    out.torque_Nm.push_back(arm.demanded_torque_Nm);
  }
  return out;
}

Pose straight(double t) { return {0.001 * way_mm(t), {1, 0, 0, 0}}; }

TEST(Touch, TakesEnergyOnAClosedWayWhateverTheLaws) {
  for (LawKind law : {LawKind::viscous, LawKind::coulomb, LawKind::rupture}) {
    const Trace trace = follow(parameters({law}), ball(), 1000.0, straight);
    EXPECT_GT(trace.absorbed_J, 0.0) << int(law);
  }
  const Trace all = follow(parameters(), ball(), 1000.0, straight);
  EXPECT_GT(all.absorbed_J, 1e-3);
}

// The elastic law alone gives back what it took, up to what its smoothing costs.
TEST(Touch, AnElasticSurfaceIsNearlyWithoutLoss) {
  double taken_J = 0.0;
  const Trace trace = follow(parameters({LawKind::elastic}), ball(), 1000.0, [](double t) {
    return Pose{0.001 * Vec3(0.3, 0.2, 11.0 - 2.0 * std::sin(M_PI * t)), {1, 0, 0, 0}};
  }, 1.0);
  for (const Vec3& f : trace.force_N) taken_J = std::max(taken_J, f.z * 1e-3);
  EXPECT_GT(taken_J, 1e-5);
  EXPECT_LT(std::abs(trace.absorbed_J), 0.01 * taken_J);
}

TEST(Touch, AMirroredWayGivesTheMirroredForce) {
  const Trace one = follow(parameters({LawKind::viscous, LawKind::coulomb, LawKind::elastic}),
                           ball(), 1000.0, straight);
  const Trace other = follow(parameters({LawKind::viscous, LawKind::coulomb, LawKind::elastic}),
                             ball(), 1000.0, [](double t) {
                               Pose p = straight(t);
                               p.position.x = -p.position.x;
                               return p;
                             });
  double apart = 0.0, size = 0.0;
  for (std::size_t n = 0; n < one.force_N.size(); ++n) {
    const Vec3 mirrored(-other.force_N[n].x, other.force_N[n].y, other.force_N[n].z);
    apart += glm::dot(one.force_N[n] - mirrored, one.force_N[n] - mirrored);
    size += glm::dot(one.force_N[n], one.force_N[n]);
  }
  // The shell's points and the contact sphere's directions have no such symmetry themselves.
  EXPECT_LT(std::sqrt(apart / size), 0.08);
}

// The same patient in another frame: grid, and the arm's map, turned alike.
TEST(Touch, DoesNotDependOnThePatientsFrame) {
  const Quat turn = glm::normalize(Quat(0.8, 0.3, -0.4, 0.33));
  HapticParameters turned = parameters();
  turned.arms[0].map.rotation = turn;
  const auto leaning = [](double t) { return Pose{0.001 * way_mm(t), lean(t)}; };
  const Trace one = follow(parameters(), ball(), 1000.0, leaning);
  const Trace other = follow(turned, ball(glm::mat3_cast(turn)), 1000.0, leaning);
  double apart = 0.0, torque_apart = 0.0, size = 0.0, torque = 0.0;
  for (std::size_t n = 0; n < one.force_N.size(); ++n) {
    apart += std::pow(glm::length(one.force_N[n] - other.force_N[n]), 2);
    size += std::pow(glm::length(one.force_N[n]), 2);
    torque_apart += std::pow(glm::length(one.torque_Nm[n] - other.torque_Nm[n]), 2);
    torque += std::pow(glm::length(one.torque_Nm[n]), 2);
  }
  // Rounding moves a point into another voxel now and then.
  EXPECT_LT(std::sqrt(apart / size), 1e-3);
  EXPECT_LT(std::sqrt(torque_apart / torque), 1e-3);
}

TEST(Touch, DoesNotDependOnTheTimeStep) {
  const Trace slow = follow(parameters(), ball(), 500.0, straight);
  const Trace fast = follow(parameters(), ball(), 4000.0, straight);
  double apart = 0.0, size = 0.0;
  for (std::size_t n = 0; n < slow.force_N.size(); ++n) {
    apart += std::pow(glm::length(slow.force_N[n] - fast.force_N[8 * n]), 2);
    size += std::pow(glm::length(slow.force_N[n]), 2);
  }
  EXPECT_LT(std::sqrt(apart / size), 0.05);
}

// Places [mm] to and fro, without any library's sine.
struct RandomWalk {
  std::mt19937 random;
  double push = 0.0;
  Vec3 at{0.0}, speed{0.0};

  const Vec3& step() {
    for (int axis = 0; axis < 3; ++axis) {
      const double way = double(random() % 2001) / 1000.0 - 1.0;
      speed[axis] += push * way - 2e-6 * at[axis] * std::abs(at[axis]);
    }
    speed *= 0.98;
    return at += speed;
  }
};

// A recording made by one build replays in another: every number of a long run, in one hash.
std::string hashOfARun(int touch_version) {
  HapticParameters p = parameters();
  p.touch_version = touch_version;
  for (TissueClass& tissue : p.tissues.classes) tissue.cuttable = 1;
  p.tissues.classes[0].solid = 1;
  p.removal = RemovalKind::work;
  p.controller = ControllerKind::bounded;
  p.arms[0].tool.made_from.motor_W = 4.0;
  p.arms[0].dynamics = {0.045, 5.5e-5, 3.3, 0};
  Grid grid(ball());
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  std::vector<double> numbers;
  RandomWalk walk{std::mt19937(11), 0.002, Vec3(0.0, 0.0, 11.0)};
  for (int n = 0; n < 6000; ++n) {
    input.arms[0].position_m = 0.001 * walk.step();
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    const ArmRecord& arm = record.arms[0];
    for (const Vec3& v : {arm.demanded_N, arm.bounded_N, arm.sent_N, arm.energy_out_J}) {
      numbers.insert(numbers.end(), {v.x, v.y, v.z});
    }
    numbers.insert(numbers.end(),
                   {arm.cutting_credit_J, arm.learnt_scale, double(arm.removed_voxels)});
  }
  EXPECT_GT(core.journal().removed(0, 0) + core.journal().removed(0, 1), 100u);
  return sha256Hex(numbers.data(), numbers.size() * sizeof(double));
}
TEST(Touch, GivesTheSameBitsInEveryBuild) {
  EXPECT_EQ(hashOfARun(kTouchVersion),
            "401b88d624f714214275445bccd9a5f32661aa318415751bc5123c22fcbd7209");
}
TEST(Touch, OfRecordingsOfVersion10IsAsItWas) {
  EXPECT_EQ(hashOfARun(10), "169ecd196b4c7721314476182ef1a461946334921e3726f65406861508ab007d");
}

// Viscous alone, at the tip, instant removal, controller `seed`: the hash is of the build before
// there was a proxy.
TEST(Touch, OfTheSeedPaperIsTickForTickAsItWas) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = makeBlade(0.016, 16);
  p.arms[0].dynamics = {0.045, 5.5e-5, 3.3, 0};
  p.controller = ControllerKind::seed;
  p.laws = {LawKind::viscous};
  p.force_at = ForceAt::tip;
  p.tissues = test::boneTable(40.0);
  p.tissues.classes[0].solid = 1;
  Grid grid(test::boneSlab());
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  std::vector<double> numbers;
  RandomWalk walk{std::mt19937(5), 0.004, Vec3(0.0, 0.0, 3.0)};
  for (int n = 0; n < 4000; ++n) {
    input.arms[0].position_m = 0.001 * walk.step();
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    const ArmRecord& arm = record.arms[0];
    for (const Vec3& v :
         {arm.velocity_m_s, arm.demanded_N, arm.bounded_N, arm.sent_N, arm.energy_out_J}) {
      numbers.insert(numbers.end(), {v.x, v.y, v.z});
    }
    numbers.insert(numbers.end(), {arm.observer_J, arm.alpha, double(arm.removed_voxels)});
    ASSERT_EQ(arm.proxy_position_mm, arm.patient_position_mm);
  }
  EXPECT_EQ(core.journal().removed(0, 0), 63u);
  EXPECT_EQ(sha256Hex(numbers.data(), numbers.size() * sizeof(double)),
            "5bccb122e4f2834f8636fddade3c89527e806f576290cab42060f05013f71bc2");
}

}  // namespace
}  // namespace trephine
