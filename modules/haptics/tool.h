// Tools: the points with which they touch, the solid with which they cut, the contact sphere with
// which they press. A tool points along -z of its own frame; its tip is the origin.
#pragma once

#include <string>
#include <vector>

#include "base/math.h"
#include "base/range.h"
#include "base/result.h"

namespace trephine {

enum class ToolKind { needle, blade, burr };
enum class BurrShape { sphere, cylinder };

constexpr Range kToolLength_mm{0, 1000, "mm"};  // a burr's: at least its head
constexpr Range kToolRadius_mm{0.05, 20, "mm"};
constexpr Range kToolMotor_W{0, 500, "W"};
constexpr Range kToolPoints{1, 10'000};
constexpr Range kToolShaftPoints{0, 1000};

// What an exercise or a tool file says of a tool, in the millimetres of files.
struct ToolDescription {
  ToolKind kind = ToolKind::needle;
  double length_mm = 0.0;  // needle: drawn; blade: its edge; burr: with its shaft
  int points = 1;          // along a needle or blade; on a burr's shell
  double radius_mm = 0.6;  // of the solid that cuts: half the width of a slot or hole
  int shaft_points = 0;    // burr only: they touch and do not cut
  BurrShape shape = BurrShape::sphere;
  double head_mm = 0.0;    // cylinder only: length of the burr's head
  double motor_W = 0.0;    // work that the motor does on tissue; 0: driven by hand

  friend bool operator==(const ToolDescription&, const ToolDescription&) = default;
};

// A part of a tool that has a body: all within a radius of a segment, tool frame.
struct BodyPart {
  Vec3 from_m{0.0}, to_m{0.0};
  double radius_m = 0.0;
  bool cuts = false;
};

struct Tool {
  ToolDescription made_from;
  std::vector<Vec3> points_m;   // tool frame
  std::vector<double> weights;  // of the points, their sum is 1
  std::size_t cutting_points = 0;  // the first so many are where it cuts; the others are a shaft's
  // What it cuts: all within radius_m of this segment, tool frame.
  Vec3 solid_from_m{0.0}, solid_to_m{0.0};
  double radius_m = 0.0;
  // What cannot enter solid tissue: the solid that cuts and, where there is one, the shaft.
  std::vector<BodyPart> body;
  // From a point to the surface of the solid: 0 for points on a shell.
  double point_inset_m = 0.0;
  // The contact sphere, with which it presses on elastic tissue, touches the tip from inside.
  double sphere_radius_m = 0.0;
  // Elastic tissue pushes a blunt tool out at any depth; a sharp one has cut it open, and the push
  // fades as it goes in.
  bool blunt = false;
};

// A needle of one point touches with its tip alone; more of them lie evenly along its length.
Tool makeNeedle(double length_m, int count = 1);

// Seed paper, eqs. 2-4: the blade is the line from the tip along (u, v, w), and point k of i lies
// at t_k = (k / i) L / |(u, v, w)|, k = 0..i. (The paper prints the square of the root; with the
// unit vector along the tool both readings agree.) `count` points: i = count - 1. The weights are
// those of the trapezoidal rule, so that the sum of point forces goes to the line integral.
Tool makeBlade(double length_m, int count);

// A sphere (or a rod with round ends) that cuts, its shell evenly covered with points, and a shaft.
Tool makeBurr(double radius_m, int shell_points, int shaft_points, double length_m);

// Errors: BAD_TOOL for a number out of its range above and a burr shorter than its head; `where`
// names the field of the tool file.
Result<Tool> makeTool(const ToolDescription& description);

}  // namespace trephine
