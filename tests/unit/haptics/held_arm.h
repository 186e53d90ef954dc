// A burr on a slab of bone, and an arm in a hand that pulls it.
#pragma once

#include <algorithm>

#include "haptics_support.h"

namespace trephine::test {

constexpr double kOmniStep_m = 5.5e-5;

inline HapticParameters burrOnBone() {
  HapticParameters p = oneArm();
  p.arms[0].tool = makeBurr(0.003, 32, 8, 0.03);
  p.arms[0].dynamics = {0.045, kOmniStep_m, 3.3, 0};
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.force_at = ForceAt::distributed;
  p.removal = RemovalKind::work;
  p.controller = ControllerKind::bounded;
  p.tissues = boneTable(12.0, 900.0, 2.0);
  p.tissues.classes[0].solid = 1;
  p.tissues.classes[0].cuttable = 0;
  return p;
}

// An arm in a hand that pulls it to `rest_mm`, device.
struct Held {
  explicit Held(const HapticParameters& p = burrOnBone()) : bench(p) {}

  const ArmRecord& tick(std::vector<Command> commands = {}) {
    constexpr double kT = 1e-3;
    constexpr int kSteps = 20;
    for (int n = 0; n < kSteps; ++n) {
      const Vec3 hand_N = 1000.0 * (0.001 * rest_mm - at_m) - 10.0 * speed_m_s;
      speed_m_s += kT / kSteps / 0.045 * (hand_N + sent_N - 0.05 * speed_m_s);
      at_m += kT / kSteps * speed_m_s;
    }
    const ArmRecord& now =
        bench.at(1000.0 * (kOmniStep_m * glm::round(at_m / kOmniStep_m)), std::move(commands));
    sent_N = now.sent_N;
    most_J = std::max(most_J, energy_J());
    return now;
  }
  const ArmRecord& go(const Vec3& to_mm, int ticks) {
    const Vec3 from_mm = rest_mm;
    for (int n = 1; n <= ticks; ++n) {
      rest_mm = from_mm + (to_mm - from_mm) * (double(n) / ticks);
      tick();
    }
    return now();
  }
  const ArmRecord& now() const { return bench.record.arms[0]; }
  double energy_J() const {
    const Vec3& axes_J = bench.record.arms[0].energy_out_J;
    return axes_J.x + axes_J.y + axes_J.z;
  }

  Bench bench;
  Vec3 rest_mm{0.0, 0.0, 5.0}, at_m{0.0, 0.0, 0.005}, speed_m_s{0.0}, sent_N{0.0};
  double most_J = -1e9;
};

}  // namespace trephine::test
