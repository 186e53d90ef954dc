#include "haptics/tool.h"

#include <algorithm>
#include <cmath>

#include "base/tr.h"
#include "haptics/codes.h"
#include "haptics/spiral.h"

namespace trephine {

namespace {

const Vec3 kAlong(0.0, 0.0, 1.0);  // from the tip towards the handle
// The least radius of a sharp tip's contact sphere: a normal needs more than a voxel.
constexpr double kLeastSphere_m = 1.5e-3;
// Share of the shaft's points in a burr's contact, however many there are; tuned here, uncited.
constexpr double kShaftShare = 0.1;
// A shaft is thinner than the hole that its head cuts: by this share, and never thicker than that
// of the shipped burr.
constexpr double kShaftOfHead = 0.5;
constexpr double kThickestShaft_m = 1.2e-3;

void addBody(Tool& tool, double length_m) {
  tool.body.push_back({tool.solid_from_m, tool.solid_to_m, tool.radius_m, true});
  if (length_m > tool.solid_to_m.z + tool.radius_m) {
    tool.body.push_back({tool.solid_to_m, length_m * kAlong,
                         std::min(kShaftOfHead * tool.radius_m, kThickestShaft_m), false});
  }
}

// `count` points from `from` to `to`, ends included, with trapezoidal weights that sum to `share`.
void addLine(Tool& tool, const Vec3& from, const Vec3& to, int count, double share) {
  for (int k = 0; k < count; ++k) {
    const double fraction = count > 1 ? double(k) / double(count - 1) : 0.0;
    tool.points_m.push_back(from + fraction * (to - from));
    const bool end = k == 0 || k == count - 1;
    tool.weights.push_back(count > 1 ? share * (end ? 0.5 : 1.0) / double(count - 1) : share);
  }
}

Tool sharpTool(const ToolDescription& d) {
  Tool tool;
  tool.made_from = d;
  addLine(tool, Vec3(0.0), 0.001 * d.length_mm * kAlong, d.points, 1.0);
  tool.cutting_points = tool.points_m.size();
  tool.radius_m = tool.point_inset_m = 0.001 * d.radius_mm;
  tool.sphere_radius_m = std::max(kLeastSphere_m, tool.radius_m);
  // A needle opens tissue with its point, a blade along its edge; a blade of one point is its tip.
  const bool edge = d.kind == ToolKind::blade && d.points > 1;
  tool.solid_to_m = (edge ? 0.001 * d.length_mm : 0.0) * kAlong;
  addBody(tool, 0.001 * d.length_mm);
  return tool;
}

// An equal-area spiral (Fibonacci lattice) over the surface of a rod with round ends: each turn of
// latitude holds as much surface as the next.
void addShell(Tool& tool, double radius, double straight, int count, double share) {
  GoldenTurn turn;
  for (int i = 0; i < count; ++i, turn.next()) {
    // Archimedes: a band of a sphere has the area of that of its cylinder, so height measures area.
    const double height = (i + 0.5) / count * (2.0 * radius + straight);
    const double level = height < radius              ? height - radius
                         : height > radius + straight ? height - radius - straight
                                                      : 0.0;
    const double flat = std::sqrt(std::max(0.0, radius * radius - level * level));
    tool.points_m.push_back({flat * turn.cosine, flat * turn.sine, height});
    tool.weights.push_back(share / count);
  }
}

Tool burr(const ToolDescription& d) {
  Tool tool;
  tool.made_from = d;
  const double radius = 0.001 * d.radius_mm, length = 0.001 * d.length_mm;
  const bool cylinder = d.shape == BurrShape::cylinder;
  const double straight = cylinder ? std::max(0.0, 0.001 * d.head_mm - 2.0 * radius) : 0.0;
  const double head = 2.0 * radius + straight;
  addShell(tool, radius, straight, d.points, d.shaft_points > 0 ? 1.0 - kShaftShare : 1.0);
  tool.cutting_points = tool.points_m.size();
  if (d.shaft_points > 0) {
    const double gap = std::max(0.0, length - head) / d.shaft_points;
    addLine(tool, (head + gap) * kAlong, (head + gap * d.shaft_points) * kAlong, d.shaft_points,
            kShaftShare);
  }
  tool.solid_from_m = radius * kAlong;
  tool.solid_to_m = (radius + straight) * kAlong;
  tool.radius_m = tool.sphere_radius_m = radius;
  tool.blunt = true;
  addBody(tool, length);
  return tool;
}

}  // namespace

Tool makeNeedle(double length_m, int count) {
  ToolDescription d;
  d.length_mm = 1000.0 * length_m;
  d.points = count;
  return sharpTool(d);
}

Tool makeBlade(double length_m, int count) {
  ToolDescription d;
  d.kind = ToolKind::blade;
  d.length_mm = 1000.0 * length_m;
  d.points = count;
  return sharpTool(d);
}

Tool makeBurr(double radius_m, int shell_points, int shaft_points, double length_m) {
  ToolDescription d;
  d.kind = ToolKind::burr;
  d.radius_mm = 1000.0 * radius_m;
  d.points = shell_points;
  d.shaft_points = shaft_points;
  d.length_mm = 1000.0 * length_m;
  return burr(d);
}

Result<Tool> makeTool(const ToolDescription& d) {
  const auto bad = [](const char* field, double value, const std::string& must) {
    return Error{code::kBadTool, tr("The value {} must {}", plainNumber(value), must), field, ""};
  };
  const bool is_burr = d.kind == ToolKind::burr;
  const struct {
    const char* field;
    double value;
    Range range;
  } rows[] = {{"length_mm", d.length_mm, kToolLength_mm},
              {"points", double(d.points), kToolPoints},
              {"radius_mm", d.radius_mm, kToolRadius_mm},
              {"motor_W", d.motor_W, kToolMotor_W},
              {"shaft_points", is_burr ? d.shaft_points : 0.0, kToolShaftPoints}};
  for (const auto& [field, value, range] : rows) {
    if (!range.holds(value)) return bad(field, value, tr("lie {}", range.words()));
  }
  if (!is_burr) return sharpTool(d);
  const bool cylinder = d.shape == BurrShape::cylinder;
  if (cylinder && !(d.head_mm >= 2.0 * d.radius_mm && d.head_mm <= kToolLength_mm.high)) {
    return bad("head_mm", d.head_mm,
               tr("be at least twice the radius: a head is as long as it is thick"));
  }
  if (d.length_mm < (cylinder ? d.head_mm : 2.0 * d.radius_mm)) {
    return bad("length_mm", d.length_mm, tr("be at least the length of the burr's head"));
  }
  return burr(d);
}

}  // namespace trephine
