// How far a tool still is from what can be seen: from its tip along its axis to the surface in the
// picture, by the picture's depth. Pure.
#pragma once

#include <optional>
#include <vector>

#include "render/cast_plan.h"
#include "render/scene_renderer.h"
#include "render/screen_lines.h"

namespace trephine {

// A part of a picture's depth: distance from the eye's plane in mm, 1e9 where nothing is opaque.
// Rows go up. `step` and `beyond`: see Span; pixels of the window are (ray + 0.5) * step - beyond.
struct DepthPatch {
  PixelRect rays;
  std::vector<float> depth_mm;
  glm::dvec2 step{1.0};
  glm::dvec2 beyond{0.0};

  // At a pixel of the window; 1e9 outside of the patch.
  double at(const glm::dvec2& pixel) const;
};

// The window's pixels that a guide may look at.
PixelRect guideReach(const ToolView& tool, const ViewCamera& camera, int width, int height);

// From the tip along the way that the tool points, up to kGuideReach_mm. None where nothing is met,
// or where the tip itself is hidden.
constexpr double kGuideReach_mm = 60.0;
std::optional<double> surfaceAhead_mm(const ToolView& tool, const DepthPatch& depth,
                                      const ViewCamera& camera, int width, int height);

// In contact: a ring at the tip, in the arm's colour. Else a line to the surface with its length in
// mm at its right, or at its left, and below the words that are there (`taken`, which gets these).
void addGuide(const ToolView& tool, std::optional<double> ahead_mm, const ViewCamera& camera,
              int width, int height, bool at_left, std::vector<WordsBox>& taken, ScreenLines& to);

}  // namespace trephine
