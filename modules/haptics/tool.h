// Tools as sample points. A tool points along -z of its own frame; its tip is the origin.
#pragma once

#include <string>
#include <vector>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

enum class ToolKind { needle, blade };

struct Tool {
  ToolKind kind = ToolKind::needle;
  double length_m = 0.0;
  std::vector<Vec3> points_m;  // tool frame; the tip first
};

// A needle touches with its tip alone; its length is only drawn.
Tool makeNeedle(double length_m);

// Seed paper, eqs. 2-4: the blade is the line from the tip along (u, v, w), and point k of i lies at
// t_k = (k / i) L / |(u, v, w)|, k = 0..i. (The paper prints the square of the root; with the unit
// vector along the tool both readings agree.) `count` points: i = count - 1.
Tool makeBlade(double length_m, int count);

// Errors: BAD_TOOL for a length that is not finite or outside 0..1 m, or not 1..10,000 points.
Result<Tool> makeTool(ToolKind kind, double length_m, int count);

}  // namespace trephine
