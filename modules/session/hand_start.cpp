#include "session/hand_start.h"

#include <algorithm>

namespace trephine {

namespace {
constexpr double kStep_mm = 0.5;
constexpr double kSpare_mm = 5.0;
}  // namespace

std::vector<double> drawnBack_mm(const HapticParameters& parameters, const Grid& grid,
                                 const std::vector<double>& reach_mm) {
  const TissueField tissue(grid, parameters.tissues);
  std::vector<double> out;
  for (std::size_t i = 0; i < parameters.arms.size(); ++i) {
    const ArmParameters& arm = parameters.arms[i];
    const ToolContact contact(arm.tool, grid.geometry());
    const Pose origin = arm.map.toPatient_mm(Pose{});
    double radius_mm = 0.0;
    for (const BodyPart& part : arm.tool.body) {
      radius_mm = std::max(radius_mm, 1000.0 * part.radius_m);
    }
    const Vec3 back = origin.orientation * Vec3(0.0, 0.0, 1.0);
    const auto inTissue = [&](double by_mm) {
      const auto touches = [&](double at_mm) {
        return contact.wouldTouch(tissue, {origin.position + at_mm * back, origin.orientation});
      };
      return touches(by_mm) || touches(by_mm - radius_mm);  // its points lie on the axis
    };
    double by_mm = 0.0;
    if (inTissue(0.0)) {
      double farthest_mm = reach_mm[i];
      while (farthest_mm > 0.0 && inTissue(farthest_mm)) farthest_mm -= kStep_mm;
      double nearest_mm = farthest_mm;
      while (nearest_mm > 0.0 && !inTissue(nearest_mm)) nearest_mm -= kStep_mm;
      by_mm = std::max(0.0, std::min(nearest_mm + kStep_mm + kSpare_mm, farthest_mm));
    }
    out.push_back(by_mm);
  }
  return out;
}

}  // namespace trephine
