#include "scene/arm_limits.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trephine {

namespace {

bool isForce(const TissueNumber& number) {
  return std::string_view(number.unit) == "N";
}

bool within(const Impedance& demanded, const Renderable& most) {
  return demanded.damping <= most.b_max && demanded.stiffness <= most.k_max;
}

}  // namespace

std::optional<ArmsLimit> armsLimit(const Scene& scene) {
  std::optional<ArmsLimit> limit;
  for (const SceneArm& arm : scene.arms) {
    if (!arm.dynamics) continue;
    const Renderable most = renderableOn(arm, scene.rate_hz);
    const double scale = arm.map.fixed ? arm.map.fixed->force_scale : arm.map.force_scale;
    const double force_N = arm.max_force_N / scale;
    if (!limit) {
      limit = ArmsLimit{most, force_N};
      continue;
    }
    limit->most = {std::min(limit->most.b_max, most.b_max), std::min(limit->most.k_max, most.k_max)};
    limit->force_N = std::min(limit->force_N, force_N);
  }
  return limit;
}

bool isFelt(const TissueNumber& number, const std::vector<LawKind>& laws) {
  const std::string_view meaning = number.meaning;
  const std::string_view of = meaning.substr(0, meaning.find(':'));  // "elastic and rupture laws"
  bool any = false;
  for (const auto& [name, law] : kLawNames) {
    if (of.find(name) == std::string_view::npos) continue;
    if (names(laws, law)) return true;
    any = true;
  }
  return !any;
}

std::optional<double> mostShown(const TissueNumber& number, const Tissue& tissue,
                                const ArmsLimit& arms, const DemandedOf& demanded) {
  const auto at = [&](double value) {
    Tissue other = tissue;
    number.set(other, {value, "asked"});
    return demanded(other);
  };
  const auto shows = [&](double value) { return within(at(value), arms.most); };
  const double highest = kMechanicsRange.high;
  const Impedance least = at(0.0), most = at(highest);
  const bool counts = least.damping != most.damping || least.stiffness != most.stiffness;
  std::optional<double> limit;
  if (isForce(number)) limit = arms.force_N;
  if (!counts) return limit;
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
  return limit ? std::min(*limit, low) : low;
}

}  // namespace trephine
