// A force that was away comes back, in contact: after a pause, a change of the controller, other
// tissue under the tool.
#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "haptics_support.h"

namespace trephine {
namespace {

constexpr double kT = 1e-3;
constexpr double kOmniStep_m = 5.5e-5;

struct Tissue {
  const char* name;
  double stiffness, friction, depth_mm;
  bool solid;
};
const Tissue kBone{"bone", 900.0, 2.0, 3.0, true};
const Tissue kThick{"thick bone", 900.0, 2.0, 6.0, true};  // pressed with all that the arm has
const Tissue kLiver{"liver", 120.0, 0.35, 9.0, false};

TissueTable table(const Tissue& tissue) {
  TissueTable out = test::boneTable(tissue.solid ? 12.0 : 4.0, tissue.stiffness, tissue.friction);
  out.classes[0].solid = tissue.solid;
  out.classes[0].cuttable = 0;
  return out;
}

// A burr that a hand presses on a block of the tissue.
struct Pressed {
  Pressed(const Tissue& of, const ArmDynamics& dynamics, double hand_k, ControllerKind controller)
      : tissue(of),
        arm(dynamics),
        k(hand_k),
        bench(parameters(of, dynamics, controller)),
        on_the_way_N(std::size_t(delaySamples(dynamics, kT)) + 1, Vec3(0.0)) {}

  static HapticParameters parameters(const Tissue& of, const ArmDynamics& dynamics,
                                     ControllerKind controller) {
    HapticParameters p = test::oneArm();
    p.arms[0].tool = makeBurr(0.003, 32, 8, 0.03);
    p.arms[0].dynamics = dynamics;
    p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
    p.force_at = ForceAt::distributed;
    p.removal = RemovalKind::work;
    p.controller = controller;
    p.tissues = table(of);
    return p;
  }

  const ArmRecord& tick(std::vector<Command> commands = {}) {
    constexpr int kSteps = 20;
    for (int n = 0; n < kSteps; ++n) {
      const Vec3 hand_N = k * (0.001 * rest_mm - at_m) - 10.0 * speed_m_s;
      speed_m_s +=
          kT / kSteps / arm.apparent_mass_kg * (hand_N + on_the_way_N.front() - 0.05 * speed_m_s);
      at_m += kT / kSteps * speed_m_s;
    }
    const double q = arm.encoder_step_m;
    const ArmRecord& now = bench.at(1000.0 * (q > 0.0 ? q * glm::round(at_m / q) : at_m), commands);
    on_the_way_N.push_back(now.sent_N);
    on_the_way_N.pop_front();
    return now;
  }
  void press() {
    for (int n = 0; n < 1500; ++n) {
      rest_mm.z = 4.0 - (4.0 + tissue.depth_mm) * std::min(1.0, n / 1000.0);
      tick();
    }
  }

  Tissue tissue;
  ArmDynamics arm;
  double k;
  test::Bench bench;
  Vec3 rest_mm{0.0, 0.0, 4.0}, at_m{0.0, 0.0, 0.004}, speed_m_s{0.0};
  std::deque<Vec3> on_the_way_N;  // by the arm's delay; the first acts
};

struct Return {
  double steepest_N = 0.0;  // rise of the sent force in a tick, over half a second
  double back = 0.0;        // of what is demanded, over the last 50 ms of it
  int alternations = 0;     // ticks in which it turned round for the second time in a row
};

Return watch(Pressed& pressed, const std::vector<Command>& commands) {
  constexpr double kNoticed_N = 0.04;  // a count of the encoder in bone makes as much
  Return out;
  double before_N = glm::length(pressed.on_the_way_N.back()), change_N = 0.0, last_N = 0.0;
  double sent_N = 0.0, demanded_N = 0.0;
  for (int n = 0; n < 500; ++n) {
    const ArmRecord& now = pressed.tick(n == 0 ? commands : std::vector<Command>{});
    const double size_N = glm::length(now.sent_N), next_N = size_N - before_N;
    out.steepest_N = std::max(out.steepest_N, next_N);
    if (next_N * change_N < 0.0 && change_N * last_N < 0.0 &&
        std::min({std::abs(next_N), std::abs(change_N), std::abs(last_N)}) > kNoticed_N) {
      ++out.alternations;
    }
    last_N = std::exchange(change_N, next_N);
    before_N = size_N;
    if (n < 450) continue;
    sent_N += size_N;
    demanded_N += std::min(pressed.arm.peak_force_N, glm::length(now.demanded_N));
  }
  EXPECT_GT(demanded_N, 50 * 0.2) << "there is something to come back";
  out.back = sent_N / demanded_N;
  return out;
}

// What happens to the pressed tool; returns the command after which its force comes back.
using Happening = std::vector<Command> (*)(Pressed&);

void expectTheForceBack(ControllerKind before, Happening happen) {
  for (const ArmDynamics& arm :
       {ArmDynamics{0.045, kOmniStep_m, 3.3, 0}, ArmDynamics{0.045, kOmniStep_m, 3.3, kT},
        ArmDynamics{0.020, 0.0, 3.3, 0}}) {
    for (const Tissue& tissue : {kBone, kThick, kLiver}) {
      for (double hand : {300.0, 1000.0}) {
        Pressed pressed(tissue, arm, hand, before);
        pressed.press();
        const Return back = watch(pressed, happen(pressed));
        const auto where = [&] {
          return std::string(tissue.name) + ", " + std::to_string(arm.apparent_mass_kg) +
                 " kg, delay " + std::to_string(arm.delay_s) + ", hand " + std::to_string(hand);
        };
        EXPECT_LE(back.steepest_N, 0.05 + 1e-9) << where();
        EXPECT_GE(back.back, 0.8) << where();
        EXPECT_EQ(back.alternations, 0) << where();
      }
    }
  }
}

std::vector<Command> otherStiffness(const Pressed& pressed, double times) {
  static std::deque<TissueTable> tables;  // they stay
  TissueTable& other = tables.emplace_back(table(pressed.tissue));
  other.classes[0].stiffness_N_per_m *= times;
  return {{CommandKind::tissues, 0, &other}};
}

TEST(Force, IsBackSoonAndSteadilyAfterAPauseInContact) {
  expectTheForceBack(ControllerKind::bounded, [](Pressed& pressed) -> std::vector<Command> {
    pressed.tick({{CommandKind::pause, 0, {}}});
    for (int n = 0; n < 500; ++n) pressed.tick();
    return {{CommandKind::resume, 0, {}}};
  });
}

TEST(Force, IsBackSoonAndSteadilyAfterAChangeToBoundedInContact) {
  const Happening change = [](Pressed&) -> std::vector<Command> {
    return {{CommandKind::controller, std::int32_t(ControllerKind::bounded), {}}};
  };
  expectTheForceBack(ControllerKind::off, change);
  expectTheForceBack(ControllerKind::seed, change);
}

TEST(Force, IsBackSoonAndSteadilyWhereTheTissueTurnsStiffer) {
  expectTheForceBack(ControllerKind::bounded,
                     [](Pressed& pressed) { return otherStiffness(pressed, 2.0); });
}

TEST(Force, IsBackSoonAndSteadilyWhereTheTissueTurnsSofter) {
  expectTheForceBack(ControllerKind::bounded,
                     [](Pressed& pressed) { return otherStiffness(pressed, 0.5); });
}

// A burr in the hole that it cut, when the bone comes back.
TEST(Force, StaysAwayFromAToolInRestoredBoneUntilItIsOutThenComesOverTwoTenthsOfASecond) {
  HapticParameters p =
      Pressed::parameters(kBone, {0.045, kOmniStep_m, 3.3, 0}, ControllerKind::bounded);
  p.arms[0].tool = *makeTool({ToolKind::burr, 30.0, 32, 3.0, 8, BurrShape::sphere, 0.0, 20.0});
  p.tissues.classes[0].cuttable = 1;
  for (CommandKind kind : {CommandKind::undo, CommandKind::reset, CommandKind::rewind}) {
    test::Bench bench(p);
    bench.push({0, 0, 5}, {0, 0, -4}, 2500);
    const std::uint64_t removed = bench.core.journal().removed(0, 0);
    ASSERT_GT(removed, 50u);
    bench.at({0, 0, -4}, {{kind, 0, {}}});
    bench.settle();
    ASSERT_EQ(bench.core.journal().removed(0, 0), 0u);
    EXPECT_EQ(bench.push({0, 0, -4}, {0, 0, -1}, 1000), 0.0) << "in the bone";
    EXPECT_TRUE(bench.record.arms[0].tool_state & kToolWaits);
    EXPECT_EQ(bench.core.journal().removed(0, 0), 0u);
    bench.push({0, 0, -1}, {0, 0, 0.5}, 50);
    EXPECT_FALSE(bench.record.arms[0].tool_state & kToolWaits) << "out";
    // Straight back: after half of the ramp half of the force is there, after all of it all.
    double halfway = 0.0;
    for (int n = 0; n < 300; ++n) {
      const ArmRecord& arm = bench.at({0, 0, std::max(-2.0, 0.5 - 0.05 * n)});
      if (n == 75) halfway = glm::length(arm.sent_N) / glm::length(arm.clamped_N);
    }
    EXPECT_GT(halfway, 0.1);
    EXPECT_LT(halfway, 0.6);
    EXPECT_EQ(bench.record.arms[0].sent_N, bench.record.arms[0].clamped_N);
    EXPECT_GT(glm::length(bench.record.arms[0].sent_N), 0.1);
  }
}

}  // namespace
}  // namespace trephine
