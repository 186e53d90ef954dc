#include "exercise/arm_limits.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trephine {

double mostForce_N(const ExerciseArm& arm, const std::optional<ArmDynamics>& dynamics) {
  return dynamics ? std::min(arm.max_force_N, dynamics->peak_force_N) : arm.max_force_N;
}

std::optional<ArmsLimit> armsLimit(const Exercise& exercise, const Rig& rig) {
  std::optional<ArmsLimit> limit;
  for (std::size_t i = 0; i < exercise.arms.size() && i < rig.arms.size(); ++i) {
    const ExerciseArm& arm = exercise.arms[i];
    const std::optional<ArmDynamics>& dynamics = rig.arms[i].dynamics;
    if (!dynamics) continue;
    const Renderable most = renderableOn(arm, dynamics, exercise.rate_hz);
    const double scale = arm.map.fixed ? arm.map.fixed->force_scale : arm.map.force_scale;
    const double force_N = mostForce_N(arm, dynamics) / scale;
    if (!limit) {
      limit = ArmsLimit{most, force_N};
      continue;
    }
    limit->most = {std::min(limit->most.b_max, most.b_max), std::min(limit->most.k_max, most.k_max)};
    limit->force_N = std::min(limit->force_N, force_N);
  }
  return limit;
}

bool isForce(const TissueNumber& number) {
  return std::string_view(number.unit) == "N";
}

bool isFelt(const TissueNumber& number, const Tissue& tissue, const std::vector<LawKind>& laws,
            RemovalKind removal) {
  const bool cuts = number.isCutting() && number.of(tissue);  // it is paid by the one that is given
  if (cuts && removal == RemovalKind::work && tissue.cuttable) return true;
  TickNumbers numbers;
  for (const TissueNumber& one : kTissueNumbers) numbers.*one.in_tick = one.valueOf(tissue);
  return std::any_of(laws.begin(), laws.end(),
                     [&](LawKind law) { return feels(law, number.in_tick, numbers); });
}

bool isWeaker(const TissueNumber& number, const Tissue& tissue, const ArmsLimit& arms,
              const DemandedOf& demanded) {
  return std::string_view(number.key) == "rupture_N" && number.valueOf(tissue) > 0.0 &&
         demanded(tissue).stiffness > arms.most.k_max;
}

std::optional<double> mostShown(const TissueNumber& number, const Tissue& tissue,
                                const ArmsLimit& arms, const DemandedOf& demanded) {
  const auto at = [&](double value) {
    Tissue other = tissue;
    number.set(other, {value, "asked"});
    return demanded(other);
  };
  if (isForce(number)) return arms.force_N;
  const double highest = number.greatest;
  const Impedance least = at(0.0), most = at(highest);
  const bool damps = least.damping != most.damping, pulls = least.stiffness != most.stiffness;
  if (!damps && !pulls) return {};
  const auto shows = [&](double value) {
    const Impedance with = at(value);
    return (!damps || with.damping <= arms.most.b_max) &&
           (!pulls || with.stiffness <= arms.most.k_max);
  };
  double low = 0.0, high = highest;
  if (shows(high)) {
    low = high;
  } else {
    // What is demanded rises with the number; 60 halvings leave less than a digit can show.
    for (int n = 0; n < 60 && high - low > 1e-9 * high; ++n) {
      const double middle = low > 0.0 && high / low > 4.0 ? std::sqrt(low * high)
                            : low == 0.0 && high > 1e-6   ? high * 1e-2
                                                          : 0.5 * (low + high);
      (shows(middle) ? low : high) = middle;
    }
  }
  return low;
}

}  // namespace trephine
