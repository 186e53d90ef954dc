// All that a picture passes through: rays, the canvas that the window shows, reading back.
//
// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkMatrix4x4.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/codes.h"
#include "base/log.h"
#include "base/tr.h"
#include "render/orientation_cue.h"
#include "render/scene_parts.h"

namespace trephine {

namespace {

constexpr double kNearestToAnEye_mm = 10.0;

}  // namespace

SceneRenderer::Parts::Parts() {
  for (vtkRenderer* each : renderers()) {
    each->EraseOff();
    each->GetActiveCamera();
  }
  context_asked->SetClientData(this);
  context_asked->SetCallback([](vtkObject*, unsigned long event, void* client, void* data) {
    const RenderHost& lender = static_cast<Parts*>(client)->host;
    if (event == vtkCommand::WindowIsCurrentEvent) {
      *static_cast<bool*>(data) = lender.isCurrent();
    } else if (!lender.isCurrent()) {
      // Qt's makeCurrent binds its own framebuffer, which VTK must not meet amid a frame.
      lender.makeCurrent();
    }
  });
}

void SceneRenderer::View::place(vtkRenderer& in, const glm::dvec2& spans) {
  const Vec3 eye = camera.eye(), focus = camera.focus(), up = camera.up();
  vtkCamera* vtk = in.GetActiveCamera();
  vtk->SetPosition(eye.x, eye.y, eye.z);
  vtk->SetFocalPoint(focus.x, focus.y, focus.z);
  vtk->SetViewUp(up.x, up.y, up.z);
  vtk->SetParallelProjection(camera.parallel());
  vtk->SetParallelScale(camera.halfHeight_mm() * spans.y);
  const FieldOfView sees = camera.sees(width, height);
  // Off the axis, VTK's culling takes this, and the picture the matrix below.
  const double half = std::max(sees.up, -sees.down) * spans.y;
  vtk->SetViewAngle(2.0 * glm::degrees(std::atan(half)));
  vtk->SetUseExplicitProjectionTransformMatrix(false);
  in.ResetCameraClippingRange();
  if (!camera.offAxis()) return;
  double range[2];
  vtk->GetClippingRange(range);
  const double near_mm = std::max(range[0], kNearestToAnEye_mm);
  const double far_mm = std::max(range[1], near_mm + 100.0);
  vtk->SetClippingRange(near_mm, far_mm);
  // About the middle of what is seen, so much wider and higher.
  const auto wider = [](double low, double high, double times) {
    const double middle = 0.5 * (low + high), reach = 0.5 * (high - low) * times;
    return std::pair(middle - reach, middle + reach);
  };
  const auto [left, right] = wider(sees.left, sees.right, spans.x);
  const auto [down, up_to] = wider(sees.down, sees.up, spans.y);
  vtkNew<vtkMatrix4x4> matrix;
  matrix->Zero();
  matrix->SetElement(0, 0, 2.0 / (right - left));
  matrix->SetElement(0, 2, (right + left) / (right - left));
  matrix->SetElement(1, 1, 2.0 / (up_to - down));
  matrix->SetElement(1, 2, (up_to + down) / (up_to - down));
  matrix->SetElement(2, 2, -(far_mm + near_mm) / (far_mm - near_mm));
  matrix->SetElement(2, 3, -2.0 * far_mm * near_mm / (far_mm - near_mm));
  matrix->SetElement(3, 2, -1.0);
  vtk->SetExplicitProjectionTransformMatrix(matrix);
  vtk->SetUseExplicitProjectionTransformMatrix(true);
}

void SceneRenderer::Parts::handToVtk(int width, int height) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);  // rows of a volume lie as close as they can
  window->SetSize(width, height);
  window->GetState()->Reset();
  window->GetState()->vtkglEnable(GL_DEPTH_TEST);
  window->GetState()->vtkglDepthMask(GL_TRUE);
  window->GetState()->vtkglDepthFunc(GL_LEQUAL);
  window->GetShaderCache()->ReleaseCurrentShader();
}

void SceneRenderer::View::cast(const Canvas& into, const Span& span, const PixelRect& part,
                               double ray_step) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.low_x, part.low_y, part.width(), part.height());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  constexpr float kNothing[4] = {0.0F, 0.0F, 0.0F, 0.0F}, kNever[4] = {1e9F, 1e9F, 0.0F, 0.0F};
  glClearBufferfv(GL_COLOR, 0, kNothing);
  glClearBufferfv(GL_COLOR, 1, kNever);
  glClearBufferfv(GL_COLOR, 2, kNothing);
  of.handToVtk(width, height);
  of.renderer->SetViewport(0.0, 0.0, double(into.width()) / width, double(into.height()) / height);
  of.volume.lookFrom(camera.right(), camera.up(), camera.forward());
  of.volume.setQuality(1.0, ray_step);
  of.volume.sendChanges(*of.renderer);
  of.volume.setPart(part);
  place(*of.renderer, span.pixels / glm::dvec2(width, height));
  of.renderer->Render();
  glFinish();
}

VolumePictures::Cast SceneRenderer::View::caster() {
  return [this](const Canvas& into, const Span& span, const PixelRect& part, double ray_step) {
    cast(into, span, part, ray_step);
  };
}

void SceneRenderer::View::drawAt(double level) {
  if ((!of.fitted || of.may_need_more) && !of.mirror->empty()) of.fit();
  if (of.drawsVolume() && !of.volume.labelsSent())
    sendLabels(std::numeric_limits<double>::infinity());
  if (of.drawsVolume()) pictures.castAt(level, LevelOfDetail::rayStepAt(level), caster());
  scene_stale = true;
}

bool SceneRenderer::View::work(double budget_ms) {
  const bool others = !of.fitted;
  if ((!of.fitted || of.may_need_more) && !of.mirror->empty()) {
    of.fit();
    // Sending a volume takes its time: its first picture is the next call's.
    const bool limited = budget_ms < std::numeric_limits<double>::infinity();
    if (others && of.drawsVolume() && limited) return false;
  }
  if (!of.drawsVolume()) return scene_stale;
  if (!of.volume.labelsSent()) {
    const auto begun = std::chrono::steady_clock::now();
    sendLabels(budget_ms);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begun;
    // The picture of them is the next call's, where they took this one's time.
    const bool spent = !moving && took.count() > 0.5 * budget_ms;
    const bool held = of.labels_held && !of.volume.labelsSent();
    if ((held || spent) && pictures.pixelStep() > 0.0) return false;
  }
  const bool changed = pictures.work(budget_ms, moving, caster());
  scene_stale |= changed;
  const std::string& shader = of.composer.failure();
  if (of.refusal && (!pictures.allocated() || !shader.empty())) {
    of.refusal = Error{code::kNoOpengl, tr("The graphics card refused to draw a picture"),
                       "3-D view", tr("Make the window smaller, or update the graphics driver")};
    spdlog::warn("No picture could be made: {}", shader.empty() ? "no memory" : shader);
  }
  return changed;
}

// Where labels have changed the picture is made again: of the part that they lie in, or, where that
// is much of it, coarse first.
void SceneRenderer::View::sendLabels(double budget_ms) {
  constexpr double kMuch = 0.15;  // of the view
  of.handToVtk(width, height);
  for (const VoxelBox& box : of.volume.sendLabels(*of.renderer, budget_ms)) {
    VoxelBox whole = box;  // of the mirror's voxels
    for (std::size_t axis = 0; axis < 3; ++axis) {
      whole.low[axis] *= of.reduction[axis];
      whole.high[axis] =
          std::min(whole.high[axis] * of.reduction[axis], of.voxels().geometry.size[axis]);
    }
    const PixelRect part = partOf(whole);
    if (part.pixels() > kMuch * width * height) {
      of.spoilLooks();
    } else {
      pictures.cut(part);
    }
  }
}

PixelRect SceneRenderer::View::around(const Vec3* points, std::size_t count, int margin) const {
  PixelRect rect;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<glm::dvec2> at = camera.pixelOf(points[i], width, height);
    if (!at) return {0, 0, width, height};
    const auto within = [](double value, int most) {
      return int(std::floor(std::clamp(value, -1.0, double(most))));
    };
    const int x = within(at->x, width), y = within(at->y, height);
    rect = bounding(rect, {x - margin, y - margin, x + margin + 1, y + margin + 1});
  }
  return {std::max(rect.low_x, 0), std::max(rect.low_y, 0), std::min(rect.high_x, width),
          std::min(rect.high_y, height)};
}

void SceneRenderer::View::cut(const VoxelBox& box) {
  of.labels_held = false;
  pictures.cut(partOf(box));
}

PixelRect SceneRenderer::View::partOf(const VoxelBox& box) const {
  // Shading and ambient light look this far from a sample.
  constexpr double kReach_voxels = 4.0;
  Vec3 corners[8];
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = std::size_t(axis);
      corners[corner][axis] =
          corner & (1 << axis) ? box.high[a] - 1 + kReach_voxels : box.low[a] - kReach_voxels;
    }
    corners[corner] = of.voxels().geometry.toPatient_mm(corners[corner]);
  }
  return around(corners, 8, 1);
}

// In the order in which they are needed. What is sent has to be fitted first.
bool SceneRenderer::Parts::Warm::*SceneRenderer::Parts::nextCold() const {
  if (!warm.background) return &Warm::background;
  if (!mirror->empty() && !fitted) return nullptr;
  if (drawsVolume() && (!warm.volume || panel.pictures.cold())) return &Warm::volume;
  if (!warm.outline && !panel.partOfOutline().empty()) return &Warm::outline;
  if (!warm.tools && !panel.partsOfTools().empty()) return &Warm::tools;
  if (!warm.cards && !cards.empty()) return &Warm::cards;
  return nullptr;
}

bool SceneRenderer::Parts::warmUp() {
  bool Warm::*const next = nextCold();
  if (!next) return false;
  const Canvas* shown = panel.shownCanvas();
  const Span span = shown ? panel.pictures.span() : Span{};
  panel.scene_stale = true;  // it is drawn into
  if (next == &Warm::volume && panel.pictures.cold()) {
    panel.pictures.warmUp(panel.caster());
    return true;
  }
  const int width = panel.width, height = panel.height;
  panel.scene.bind(width, height, {Canvas::Image::colour});
  if (next == &Warm::background) {
    composer.drawVolume(nullptr, {}, width, height);
    composer.drawLines({{{0.0, 0.0}, {1.0, 1.0}, Vec3(0.0), 1.0}}, width, height);
  } else if (next == &Warm::volume) {
    composer.drawVolume(shown ? shown : &panel.pictures.warmUpCanvas(), span, width, height);
  } else if (next == &Warm::outline) {
    panel.drawOutline(shown, span);
  } else if (next == &Warm::cards) {
    cards.draw(eye.camera, width, height, shown, span);
  } else {  // with the marks of contact
    std::vector<ToolView> touching = tool_views;
    for (ToolView& tool : touching) tool.contact = true;
    tools.show(touching, *tool_renderer);
    panel.drawTools(panel.scene.framebuffer(), shown, span);
    tools.show(tool_views, *tool_renderer);
  }
  glFinish();
  warm.*next = true;
  return true;
}

const Canvas* SceneRenderer::View::shownCanvas() const {
  return of.drawsVolume() && pictures.pixelStep() > 0.0 ? &pictures.canvas() : nullptr;
}

void SceneRenderer::View::compose(unsigned int framebuffer, bool with_cues) {
  const Canvas* shown = shownCanvas();
  const Span span = shown ? pictures.span() : Span{};
  if (!of.warm.background) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    constexpr float kDark[4] = {0.14F, 0.145F, 0.155F, 1.0F};
    glClearBufferfv(GL_COLOR, 0, kDark);
    return;
  }
  if (scene_stale || scene.width() != width || scene.height() != height) {
    scene.bind(width, height, {Canvas::Image::colour});
    of.composer.drawVolume(
        shown, span, width, height,
        camera.offAxis() ? Composer::Background::even : Composer::Background::shaded);
    if (of.warm.outline) drawOutline(shown, span);
    scene_stale = false;
  }
  scene.copyTo(framebuffer);
  if (of.warm.tools) drawTools(framebuffer, shown, span);
  if (!with_cues) {
    if (of.warm.cards) of.cards.draw(camera, width, height, shown, span);
    return;
  }
  ScreenLines all;
  if (shown) {
    addOrientationCue(camera, width, height, all);
    addScaleBar(camera, inTheMiddle(*shown, span), width, height, all);
    if (std::min(width, height) >= kRoomForCues) addGuides(*shown, span, all);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  }
  all.insert(all.end(), of.lines.begin(), of.lines.end());
  of.composer.drawLines(all, width, height);
}

glm::ivec2 SceneRenderer::View::rayAt(const glm::dvec2& pixel, const Canvas& shown,
                                      const Span& span) {
  const glm::dvec2 step = span.pixels / glm::dvec2(shown.width(), shown.height());
  return glm::floor((pixel + span.beyond) / step);
}

Vec3 SceneRenderer::View::inTheMiddle(const Canvas& shown, const Span& span) const {
  if (camera.parallel()) return camera.focus();
  const glm::ivec2 ray = rayAt(0.5 * glm::dvec2(width, height), shown, span);
  const std::vector<float> depth_mm = shown.readDepth_mm({ray.x, ray.y, ray.x + 1, ray.y + 1});
  constexpr float kSomewhere_mm = 1e8F;
  if (depth_mm.empty() || depth_mm[0] > kSomewhere_mm) return camera.focus();
  return camera.eye() + camera.forward() * double(depth_mm[0]);
}

Picture SceneRenderer::View::read(bool with_cues) {
  Picture picture;
  while (of.warmUp()) {
  }
  if (!of.frame.bind(width, height, {Canvas::Image::colour})) return picture;
  compose(of.frame.framebuffer(), with_cues);
  of.frame.bind();
  const std::size_t row = std::size_t(width) * 3;
  std::vector<std::uint8_t> up(row * std::size_t(height));
  while (glGetError() != GL_NO_ERROR) {  // of before
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, up.data());
  if (glGetError() != GL_NO_ERROR) return picture;
  picture.width = width;
  picture.height = height;
  picture.rgb.resize(up.size());
  for (int y = 0; y < height; ++y) {  // OpenGL's rows go up
    std::copy_n(up.data() + std::size_t(height - 1 - y) * row, row,
                picture.rgb.data() + std::size_t(y) * row);
  }
  return picture;
}

void SceneRenderer::View::resize(int wide, int high) {
  wide = std::max(1, wide);
  high = std::max(1, high);
  if (wide == width && high == height) return;
  width = wide;
  height = high;
  pictures.resize(width, height);
  scene_stale = true;
}

void SceneRenderer::View::release() {
  pictures.release();
  scene.release();
  tool_layer.release();
  scene_stale = true;
}

void SceneRenderer::Parts::release() {
  if (!window) return;
  window->MakeCurrent();
  panel.release();
  eye.release();
  composer.release();
  cards.release();
  frame.release();
  warm = {};
  fitted = refused = false;
  volume.releaseGraphics(*renderer);
  window->Finalize();
  for (vtkRenderer* each : renderers()) window->RemoveRenderer(each);
  window->RemoveObserver(context_asked);
  window = nullptr;
}

}  // namespace trephine
