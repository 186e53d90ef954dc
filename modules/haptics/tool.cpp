#include "haptics/tool.h"

namespace trephine {

Tool makeNeedle(double length_m) { return {ToolKind::needle, length_m, {Vec3(0.0)}}; }

Tool makeBlade(double length_m, int count) {
  Tool tool{ToolKind::blade, length_m, {}};
  tool.points_m.reserve(std::size_t(count));
  const Vec3 along(0.0, 0.0, 1.0);  // from the tip towards the handle
  for (int k = 0; k < count; ++k) {
    const double fraction = count > 1 ? double(k) / double(count - 1) : 0.0;
    tool.points_m.push_back(fraction * length_m * along);
  }
  return tool;
}

Result<Tool> makeTool(ToolKind kind, double length_m, int count) {
  if (!isFinite(length_m) || length_m < 0.0 || length_m > 1.0) {
    return Error{"BAD_TOOL", "A tool's length must lie between 0 and 1000 mm", "length_mm", ""};
  }
  if (count < 1 || count > 10000) {
    return Error{"BAD_TOOL", "A blade has 1 to 10,000 points, not " + std::to_string(count), "points",
                 ""};
  }
  return kind == ToolKind::needle ? makeNeedle(length_m) : makeBlade(length_m, count);
}

}  // namespace trephine
