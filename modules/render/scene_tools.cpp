// Outline and tools over the last picture of the volume, and the way from a tool to the surface.
//
// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <vtkCamera.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "render/scene_parts.h"
#include "render/tool_guide.h"

namespace trephine {

namespace {

// A cut is to be seen under the line along which it is made.
constexpr double kOutlineOpacity = 0.65;

}  // namespace

std::vector<PixelRect> SceneRenderer::View::partsOfTools() const {
  std::vector<PixelRect> parts;
  for (const auto& box : of.tools.boxes()) {
    const PixelRect part = around(box.data(), box.size(), 2);
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

PixelRect SceneRenderer::View::partOfOutline() const {
  const auto box = of.outline.box();
  return box ? around(box->data(), box->size(), 2) : PixelRect{};
}

void SceneRenderer::View::drawTools(unsigned int framebuffer, const Canvas* shown,
                                    const Span& span) {
  drawSolids(*of.tool_renderer, 1.0, partsOfTools(), framebuffer, shown, span);
}

void SceneRenderer::View::drawOutline(const Canvas* shown, const Span& span) {
  if (!of.outline.box()) return;
  of.outline.lift(camera);
  drawSolids(*of.outline_renderer, kOutlineOpacity, {partOfOutline()}, scene.framebuffer(), shown,
             span);
}

void SceneRenderer::View::drawSolids(vtkRenderer& solids, double opacity,
                                     const std::vector<PixelRect>& parts, unsigned int framebuffer,
                                     const Canvas* shown, const Span& span) {
  if (std::ranges::all_of(parts, &PixelRect::empty)) return;
  tool_layer.bind(width, height, {Canvas::Image::colour, Canvas::Image::hidden_part});
  glEnable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  for (const PixelRect& part : parts) {
    glScissor(part.low_x, part.low_y, part.width(), part.height());
    constexpr float kNothing[4] = {0.0F, 0.0F, 0.0F, 0.0F}, kFar = 1.0F;
    glClearBufferfv(GL_COLOR, 0, kNothing);
    glClearBufferfv(GL_DEPTH, 0, &kFar);
  }
  of.handToVtk(width, height);
  place(solids, glm::dvec2(1.0));
  solids.Render();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  DepthRange range;
  solids.GetActiveCamera()->GetClippingRange(range.near_mm, range.far_mm);
  range.parallel = camera.parallel();
  // A part that lies in another would be drawn twice, which changes nothing: what is read is not
  // what is written.
  for (const PixelRect& part : parts) {
    of.composer.drawTools(tool_layer, opacity, range, shown, span, part);
  }
}

void SceneRenderer::View::addGuides(const Canvas& shown, const Span& span, ScreenLines& to) const {
  std::vector<WordsBox> words;
  for (const ToolView& tool : of.tool_views) {
    const PixelRect reach = guideReach(tool, camera, width, height);
    std::optional<double> ahead_mm;
    if (!tool.contact && !reach.empty()) {
      DepthPatch patch;
      patch.step = span.pixels / glm::dvec2(shown.width(), shown.height());
      patch.beyond = span.beyond;
      const glm::ivec2 low = rayAt({reach.low_x, reach.low_y}, shown, span),
                       high = rayAt({reach.high_x, reach.high_y}, shown, span);
      patch.rays = {std::max(low.x, 0), std::max(low.y, 0), std::min(high.x + 1, shown.width()),
                    std::min(high.y + 1, shown.height())};
      patch.depth_mm = shown.readDepth_mm(patch.rays);
      if (!patch.depth_mm.empty()) {
        ahead_mm = surfaceAhead_mm(tool, patch, camera, width, height);
      }
    }
    const bool first_of_more = of.tool_views.size() > 1 && &tool == &of.tool_views.front();
    addGuide(tool, ahead_mm, camera, width, height, first_of_more, words, to);
  }
}

}  // namespace trephine
