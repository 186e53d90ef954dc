// Strokes of any tool, by any arm, through a block of tissue of any grid: what they took and what
// was paid for it.
#pragma once

#include <deque>
#include <initializer_list>
#include <random>
#include <utility>
#include <vector>

#include "haptics/unseen_energy.h"
#include "haptics_support.h"

namespace trephine::test {

// A block of one tissue in air: all within `half_mm` of the origin and below a slanted plane.
struct Block {
  Vec3 spacing_mm{0.5};
  Vec3 half_mm{8.0, 8.0, 6.0};
  Vec3 up = Vec3(0, 0, 1);  // of the plane through the origin
  std::int16_t hu = kBoneHu;
};

inline Volume blockOf(const Block& block) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  const Vec3 box_mm = 2.0 * (block.half_mm + 4.0);
  for (int axis = 0; axis < 3; ++axis) {
    g.size[std::size_t(axis)] = int(box_mm[axis] / block.spacing_mm[axis]);
  }
  g.spacing_mm = block.spacing_mm;
  g.origin_mm = -0.5 * block.spacing_mm * Vec3(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1);
  volume.hu.assign(g.voxelCount(), kAirHu);
  const Vec3 up = glm::normalize(block.up);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 v = g.indicesOf(n);
    const Vec3 p = g.origin_mm + g.spacing_mm * Vec3(v[0], v[1], v[2]);
    const bool within = glm::all(glm::lessThanEqual(glm::abs(p), block.half_mm));
    if (within && glm::dot(p, up) < 0.0) volume.hu[n] = block.hu;
  }
  return volume;
}

struct Place {
  double t_s = 0.0;
  Vec3 at_mm{0.0};     // of the arm's tip, patient
  Vec3 turn_rad{0.0};  // about the patient's axes
};

inline Quat turned(const Vec3& rad) {
  const double angle = glm::length(rad);
  if (angle < 1e-12) return {1, 0, 0, 0};
  const Vec3 s = std::sin(0.5 * angle) / angle * rad;
  return {std::cos(0.5 * angle), s.x, s.y, s.z};
}

struct Stroke {
  Tool tool;
  TissueTable tissues;
  Block block;
  std::vector<LawKind> laws{LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  ArmDynamics arm{0.045, 5.5e-5, 3.3, 0};
  double rate_hz = 1000.0;
  double force_scale = 1.0, motion_scale = 1.0;
  std::vector<Place> way;
  bool in_the_hand = false;  // the arm moves as its mass, a hand and the tissue let it
};

struct Account {
  double removed_mm3 = 0.0, removed_J = 0.0;  // at the price of each tissue
  double motor_J = 0.0;                       // while the tool touched or was held
  double hand_J = 0.0;  // from what was sent, where the arm was and the share that was rendered
  double stored_J = 0.0;
  double recorded_hand_J = 0.0;
  double unseen_J =
      0.0;  // what the arm's encoder cannot see, in the model's units at the least share
  double unpaid_J = 0.0;  // what was ever spent beyond the most that had been put in by then
  double least_share = 1.0;
};

inline Account cut(const Stroke& stroke) {
  HapticParameters p = oneArm();
  p.period_s = 1.0 / stroke.rate_hz;
  ArmParameters& arm = p.arms[0];
  arm.tool = stroke.tool;
  arm.dynamics = stroke.arm;
  arm.max_force_N = stroke.arm.peak_force_N;
  arm.map.force_scale = stroke.force_scale;
  arm.map.motion_scale = stroke.motion_scale;
  p.laws = stroke.laws;
  p.force_at = ForceAt::distributed;
  p.removal = RemovalKind::work;
  p.controller = ControllerKind::bounded;
  p.tissues = stroke.tissues;
  p.journal_voxels = 4'000'000;
  Grid grid(blockOf(stroke.block));
  HapticCore core(p, *grid.takeWriter());
  const double voxel_mm3 = grid.geometry().voxelVolume_mm3();
  const double T = p.period_s, units = stroke.force_scale / stroke.motion_scale;

  Account out;
  TickInput input;
  TickRecord record;
  Vec3 at_m = arm.map.toDevice_m(stroke.way[0].at_mm), speed_m_s(0.0), sampled_m(0.0);
  std::deque<Vec3> on_the_way_N(std::size_t(delaySamples(stroke.arm, T)) + 1, Vec3(0.0));
  std::size_t leg = 0;
  double most_in_J = 0.0;
  const double q = stroke.arm.encoder_step_m;
  for (; double(input.tick) * T < stroke.way.back().t_s; ++input.tick) {
    const double t = double(input.tick) * T;
    while (leg + 2 < stroke.way.size() && t >= stroke.way[leg + 1].t_s) ++leg;
    const Place &from = stroke.way[leg], &to = stroke.way[leg + 1];
    const double way = std::clamp((t - from.t_s) / (to.t_s - from.t_s), 0.0, 1.0);
    const double part = way * way * (3.0 - 2.0 * way);  // from rest to rest
    const Vec3 goal_m = arm.map.toDevice_m(from.at_mm + part * (to.at_mm - from.at_mm));
    if (!stroke.in_the_hand) at_m = goal_m;
    const Vec3 sent_before_N = record.arms[0].sent_N;
    if (stroke.in_the_hand && input.tick > 0) {
      constexpr int kSteps = 20;
      for (int n = 0; n < kSteps; ++n) {
        const Vec3 hand_N = 1000.0 * (goal_m - at_m) - 10.0 * speed_m_s;
        speed_m_s += T / kSteps / stroke.arm.apparent_mass_kg *
                     (hand_N + on_the_way_N.front() - 0.05 * speed_m_s);
        at_m += T / kSteps * speed_m_s;
      }
    }
    const Vec3 sample_m = q > 0.0 ? q * glm::round(at_m / q) : at_m;
    const double share = record.arms[0].rendered_share;
    if (input.tick > 0) out.hand_J -= glm::dot(sent_before_N, sample_m - sampled_m) / units / share;
    sampled_m = sample_m;
    input.arms[0].position_m = sample_m;
    input.arms[0].orientation = turned(from.turn_rad + part * (to.turn_rad - from.turn_rad));
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    const ArmRecord& now = record.arms[0];
    EXPECT_EQ(now.faults, 0u);
    on_the_way_N.push_back(now.sent_N);
    on_the_way_N.pop_front();
    for (const CarveRecord& carve : core.carves()) {
      out.removed_mm3 += voxel_mm3;
      out.removed_J +=
          voxel_mm3 * p.tissues.classes[std::size_t(carve.tissue_class)].cutting_J_per_mm3;
    }
    const bool works = now.points_in_tissue > 0 || (now.tool_state & kToolHeld);
    if (works) out.motor_J += T * stroke.tool.made_from.motor_W;
    out.stored_J = now.stored_J;
    out.recorded_hand_J = now.hand_work_J;
    most_in_J = std::max(most_in_J, out.motor_J + out.hand_J - out.stored_J);
    out.unpaid_J = std::max(out.unpaid_J, out.removed_J - most_in_J);
    out.least_share = std::min(out.least_share, now.rendered_share);
  }
  out.unseen_J = unseenEnergy_J(q) / units / out.least_share;
  return out;
}

inline TissueClass bone() {
  return {{12.0, 900.0, 2.0, 0.0, 0.06}, 226, 3071, 1, 0, 1};
}
inline TissueClass liver() {
  return {{4.0, 120.0, 0.35, 0.0, 5e-6}, 0, 225, 1, 0, 0};
}
constexpr std::int16_t kLiverHu = 100;

inline Tool tool(ToolKind kind, double length_mm, double radius_mm, double motor_W,
                 BurrShape shape = BurrShape::sphere) {
  const bool burr = kind == ToolKind::burr;
  const double head_mm = shape == BurrShape::cylinder ? 3.0 * radius_mm : 0.0;
  return *makeTool({kind, length_mm,
                    kind == ToolKind::needle ? 1
                    : burr                   ? 32
                                             : 16,
                    radius_mm, burr ? 8 : 0, shape, head_mm, motor_W});
}

// The same numbers with every library.
struct Random {
  explicit Random(unsigned seed) : engine(seed) { engine.discard(8); }
  int below(int count) { return int(engine() % std::uint32_t(count)); }
  double in(double low, double high) { return low + (high - low) * below(100001) / 100000.0; }
  double of(std::initializer_list<double> values) {
    return values.begin()[below(int(values.size()))];
  }
  std::mt19937 engine;
};

// In and out, slanted, turning: any tool, on any grid, at any rate, by any arm over any map.
inline Stroke randomStroke(unsigned seed) {
  Random random(seed);
  Stroke s;
  s.tissues.count = 2;
  s.tissues.classes[0] = liver();
  s.tissues.classes[1] = bone();
  switch (random.below(5)) {
    case 0:
      s.tool = tool(ToolKind::burr, 30.0, 3.0, random.of({0.6, 2, 4, 20}));
      break;
    case 1:
      s.tool = tool(ToolKind::burr, 20.0, 2.0, random.of({1, 4}), BurrShape::cylinder);
      break;
    case 2:
      s.tool = tool(ToolKind::blade, 16.0, 0.6, random.of({1, 6, 20}));
      break;
    case 3:
      s.tool = tool(ToolKind::blade, 16.0, 0.6, 0.0);
      break;
    default:
      s.tool = tool(ToolKind::needle, 40.0, 0.9, 0.0);
      break;
  }
  if (s.tool.made_from.motor_W == 0.0) {  // by hand, real bone hardly gives way
    if (random.below(2)) s.block.hu = kLiverHu;
    s.tissues.classes[1].cutting_J_per_mm3 = random.of({6e-2, 2e-3, 3e-4});
  }
  s.block.spacing_mm = Vec3(random.of({0.25, 0.4, 0.5, 0.8, 1.0}));
  if (random.below(2)) s.block.spacing_mm[random.below(3)] = random.of({0.5, 1.0});
  s.block.up = Vec3(random.in(-0.5, 0.5), random.in(-0.5, 0.5), 1.0);
  s.rate_hz = random.of({500, 1000, 2000, 4000, 8000});
  const int arm = random.below(3);  // the last renders about half as much as the first
  s.arm = {arm == 1 ? 0.045 : 0.020, random.of({0.0, 5.5e-5}), 3.3,
           arm == 2 ? 1.0 / s.rate_hz : 0.0};
  s.force_scale = random.of({0.5, 1, 2});
  s.motion_scale = random.of({0.5, 1, 1.5});
  s.in_the_hand = random.below(2);
  double t_s = 0.0;
  const auto to = [&](double after_s, const Vec3& at_mm, const Vec3& turn_rad) {
    s.way.push_back({t_s += after_s, at_mm, turn_rad});
  };
  to(0, {random.in(-3, 3), random.in(-3, 3), 8}, {random.in(-0.4, 0.4), random.in(-0.4, 0.4), 0});
  const int legs = 3 + random.below(3);
  for (int leg = 0; leg < legs; ++leg) {
    const double z = leg % 2 == 1 && random.below(2) ? random.in(4, 8) : random.in(-5, 1);
    to(random.in(0.2, 0.7), {random.in(-5, 5), random.in(-5, 5), z},
       {random.in(-0.6, 0.6), random.in(-0.6, 0.6), random.in(-1, 1)});
  }
  to(0.5, {random.in(-3, 3), random.in(-3, 3), 9}, Vec3(0));
  return s;
}

// What is taken is never more than what had been put in by then. Returns whether that holds in the
// end too, within 2 % and what the encoder cannot see: an arm may give out afterwards what it had
// taken before.
inline bool expectPaid(unsigned seed) {
  const Account a = cut(randomStroke(seed));
  EXPECT_LE(a.unpaid_J, 1e-9 + 1e-6 * a.removed_J) << "stroke " << seed;
  EXPECT_NEAR(a.recorded_hand_J, a.hand_J, 1e-9 + 1e-6 * std::abs(a.hand_J)) << "stroke " << seed;
  EXPECT_GT(a.least_share, 0.01) << "stroke " << seed
                                 << ": a hundredfold of the work at the device";
  const bool over = a.stored_J == 0.0 && a.removed_J > 0.0;
  return !over || a.removed_J <= 1.02 * (a.motor_J + a.hand_J) + a.unseen_J;
}

// One way into a block, along it and out, turning a little.
inline Stroke sameStroke(const Tool& tool, bool liver_block, double spacing_mm) {
  Stroke s;
  s.tool = tool;
  s.tissues.count = 2;
  s.tissues.classes[0] = liver();
  s.tissues.classes[1] = bone();
  if (liver_block) s.block.hu = kLiverHu;
  s.block.spacing_mm = Vec3(spacing_mm);
  s.block.half_mm = {9, 9, 7};
  s.block.up = {0.12, -0.07, 1.0};
  s.way = {{0, {-5, -4, 6}, {0, 0, 0}},
           {0.6, {-5, -4, -2}, {0.1, 0.2, 0}},
           {1.8, {5, -2.5, -2.4}, {0.2, -0.2, 0}},
           {2.6, {4, 4.5, -2}, {0, 0, 0.3}},
           {3.2, {4, 4.5, 6}, {0, 0, 0}}};
  return s;
}

struct Tried {
  const char* name;
  Tool tool;
  bool liver;
};
inline std::vector<Tried> triedTools() {
  return {{"burr of 4 W", tool(ToolKind::burr, 30.0, 3.0, 4.0), false},
          {"burr of 40 W", tool(ToolKind::burr, 30.0, 3.0, 40.0), false},
          {"blade of 6 W", tool(ToolKind::blade, 16.0, 0.6, 6.0), false},
          {"blade in liver", tool(ToolKind::blade, 16.0, 0.6, 0.0), true},
          {"needle in liver", tool(ToolKind::needle, 40.0, 0.9, 0.0), true}};
}

// An arm of 20 g, one of 45 g, and one that renders half as much of a stiff tissue, the delay of
// which is the reason.
inline void expectSameByAnyArm(const Tried& tried, double spacing_mm) {
  Stroke s = sameStroke(tried.tool, tried.liver, spacing_mm);
  for (TissueClass& tissue : s.tissues.classes) {
    if (tissue.solid) tissue.stiffness_N_per_m = 2500.0;
  }
  const double reference = cut(s).removed_mm3;
  ASSERT_GT(reference, 10.0) << tried.name;
  Stroke light = s, weak = s, scaled = s;
  light.arm.apparent_mass_kg = 0.020;
  weak.arm.apparent_mass_kg = 0.020;
  weak.arm.delay_s = 0.001;
  ASSERT_LT(renderable(weak.arm, 1000.0, 1, {}).k_max, 0.7 * 2500.0);
  scaled.force_scale = 0.5;
  scaled.motion_scale = 1.5;
  for (const auto& [name, stroke] :
       {std::pair{"20 g", &light}, {"weak", &weak}, {"scaled", &scaled}}) {
    const double mm3 = cut(*stroke).removed_mm3;
    EXPECT_NEAR(mm3, reference, 0.05 * reference)
        << tried.name << ", " << spacing_mm << " mm, " << name;
  }
}

inline void expectSameAtAnyRate(const Tried& tried, double spacing_mm,
                                std::initializer_list<double> rates_hz) {
  Stroke s = sameStroke(tried.tool, tried.liver, spacing_mm);
  s.rate_hz = 8000.0;
  const double reference = cut(s).removed_mm3;
  ASSERT_GT(reference, 10.0) << tried.name;
  for (double rate_hz : rates_hz) {
    s.rate_hz = rate_hz;
    EXPECT_NEAR(cut(s).removed_mm3, reference, 0.05 * reference)
        << tried.name << ", " << spacing_mm << " mm, " << rate_hz << " Hz";
  }
}

}  // namespace trephine::test
