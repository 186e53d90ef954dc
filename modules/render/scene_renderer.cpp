// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "render/canvas.h"
#include "render/carve_volume_mapper.h"
#include "render/display_probe.h"
#include "render/level_of_detail.h"
#include "render/orientation_cue.h"
#include "render/scene_renderer.h"
#include "render/tool_drawing.h"
#include "render/view_camera.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2);

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

struct SceneRenderer::Parts {
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkOpenGLRenderWindow> window;  // null while detached
  vtkNew<vtkCallbackCommand> context_asked;
  RenderHost host;
  bool hosted = false;

  std::shared_ptr<VolumeMirror> mirror = std::make_shared<VolumeMirror>();
  std::unique_ptr<VolumeMirror::Reader> news = std::make_unique<VolumeMirror::Reader>(mirror);
  GridGeometry shown;  // of what VTK draws
  CarveVolume volume;
  ToolDrawing tools;
  OrientationCue cue{*renderer};

  ViewCamera camera;
  LevelOfDetail level;
  bool moving = false;
  int width = 1;
  int height = 1;

  // The still picture as it grows from the top; `row` is the lowest that is at full quality.
  Canvas canvas;
  bool stale = true;
  int row = 0;
  int strip_rows = 0;
  double strip_ms = 0.0;
  double picture_ms = 0.0;

  Parts() {
    renderer->GradientBackgroundOn();
    renderer->SetBackground(0.07, 0.075, 0.08);
    renderer->SetBackground2(0.22, 0.225, 0.235);
    renderer->GetActiveCamera()->SetViewAngle(ViewCamera::kViewAngle_deg);
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

  void placeCamera() {
    const Vec3 eye = camera.eye(), focus = camera.focus(), up = camera.up();
    vtkCamera* vtk = renderer->GetActiveCamera();
    vtk->SetPosition(eye.x, eye.y, eye.z);
    vtk->SetFocalPoint(focus.x, focus.y, focus.z);
    vtk->SetViewUp(up.x, up.y, up.z);
    cue.update(camera.right(), camera.up(), camera.forward(), width, height);
    renderer->ResetCameraClippingRange();
  }

  // Draws into VTK's own framebuffer; the context is current afterwards.
  void draw(double pixel_step, double ray_step) {
    window->MakeCurrent();
    // The window's toolkit has changed OpenGL's state behind VTK's back.
    if (hosted) {
      window->GetState()->Reset();
      window->GetState()->vtkglDepthFunc(GL_LEQUAL);
    }
    window->SetSize(width, height);
    volume.lookFrom(camera.right(), camera.up(), camera.forward());
    volume.sendChanges(*renderer);
    volume.setQuality(pixel_step, ray_step);
    placeCamera();
    window->Render();
  }

  // Copies rows of what VTK drew.
  void keep(int low, int high) {
    canvas.bind(width, height);
    window->BlitDisplayFramebuffer(0, 0, low, width, high - low, 0, low, width, high - low,
                                   GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }

  void drawStrip(double left_ms) {
    const Clock::time_point start = Clock::now();
    const int rows = std::min(row, nextStripRows(strip_rows, strip_ms, left_ms));
    volume.setRows(std::pair(row - rows, row));
    draw(1.0, 1.0);
    volume.setRows(std::nullopt);
    keep(row - rows, row);
    glFinish();
    row -= rows;
    strip_rows = rows;
    strip_ms = msSince(start);
    picture_ms += strip_ms;
  }

  void drawStill(double budget_ms) {
    const Clock::time_point start = Clock::now();
    if (stale) {
      draw(level.pixelStep(), level.rayStep());
      keep(0, height);
      stale = false;
      row = height;
      strip_rows = height / 16;
      strip_ms = budget_ms;
      picture_ms = 0.0;
    }
    do {
      drawStrip(budget_ms - msSince(start));
    } while (row > 0 && msSince(start) + 0.5 * strip_ms < budget_ms);
    if (row == 0) level.stillFrameTook(picture_ms);
  }

  // What was drawn last.
  Picture read() {
    Picture picture;
    vtkNew<vtkUnsignedCharArray> pixels;
    window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0);
    const std::size_t row_bytes = std::size_t(width) * 3;
    const std::size_t bytes = row_bytes * std::size_t(height);
    if (std::size_t(pixels->GetNumberOfValues()) != bytes) return picture;
    picture.width = width;
    picture.height = height;
    picture.rgb.resize(bytes);
    for (int y = 0; y < height; ++y) {  // OpenGL's rows go up
      std::copy_n(pixels->GetPointer(0) + std::size_t(height - 1 - y) * row_bytes, row_bytes,
                  picture.rgb.data() + std::size_t(y) * row_bytes);
    }
    return picture;
  }

  void release() {
    if (!window) return;
    window->MakeCurrent();
    canvas.release();
    stale = true;
    volume.releaseGraphics(*renderer);
    window->Finalize();
    window->RemoveRenderer(renderer);
    window->RemoveObserver(context_asked);
    window = nullptr;
  }
};

SceneRenderer::SceneRenderer() : parts_(std::make_unique<Parts>()) {}

SceneRenderer::~SceneRenderer() {
  detach();
}

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::offscreen(int width, int height) {
  if (Status display = probeDisplay(); !display) return display.error();
  auto renderer = std::make_unique<SceneRenderer>();
  Parts& p = *renderer->parts_;
  p.width = std::max(1, width);
  p.height = std::max(1, height);
  vtkNew<vtkRenderWindow> window;
  p.window = vtkOpenGLRenderWindow::SafeDownCast(window);
  const Error no_opengl{"NO_OPENGL", "OpenGL 3.2 could not be started", "hidden window",
                        "Update the graphics driver, or install libgl1-mesa-dri"};
  if (!p.window) return no_opengl;
  p.window->SetOffScreenRendering(1);
  p.window->SetMultiSamples(0);
  p.window->SetSize(p.width, p.height);
  p.window->AddRenderer(p.renderer);
  p.window->Initialize();
  p.window->MakeCurrent();
  if (openGlVersion() < kOpenGlNeeded) return no_opengl;
  return renderer;
}

Status SceneRenderer::attach(RenderHost host) {
  detach();
  Parts& p = *parts_;
  p.host = std::move(host);
  p.hosted = true;
  if (!p.host.isCurrent()) p.host.makeCurrent();
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->AddObserver(vtkCommand::WindowIsCurrentEvent, p.context_asked);
  window->AddObserver(vtkCommand::WindowMakeCurrentEvent, p.context_asked);
  window->SetOwnContext(0);
  window->SetMultiSamples(0);
  window->SetFrameBlitModeToNoBlit();
  window->SetReadyForRendering(true);
  window->SetSize(p.width, p.height);
  window->OpenGLInit();
  p.window = window;
  if (openGlVersion() < kOpenGlNeeded) {
    const std::string description = openGlDescription();
    p.window = nullptr;
    return openGlTooOld(description);
  }
  p.window->AddRenderer(p.renderer);
  return {};
}

void SceneRenderer::detach() {
  parts_->release();
}

std::string SceneRenderer::openGlDescription() const {
  if (!parts_->window) return "none";
  parts_->window->MakeCurrent();
  std::string text;
  for (const GLenum part : {GL_VENDOR, GL_RENDERER, GL_VERSION}) {
    const auto* value = reinterpret_cast<const char*>(glGetString(part));
    if (!value) continue;
    if (!text.empty()) text += " | ";
    text += value;
  }
  return text.empty() ? "none" : text;
}

void SceneRenderer::setMirror(std::shared_ptr<VolumeMirror> mirror) {
  Parts& p = *parts_;
  p.news = std::make_unique<VolumeMirror::Reader>(mirror);
  p.volume.remove(*p.renderer);  // before the voxels that VTK reads go
  p.mirror = std::move(mirror);
  takeChanges();
}

void SceneRenderer::setVolume(const Grid& grid) {
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(grid.snapshot(), grid.labels());
  setMirror(std::move(mirror));
}

bool SceneRenderer::takeChanges() {
  Parts& p = *parts_;
  const VolumeMirror::News news = p.news->take();
  if (!news.any()) return false;
  p.stale = true;
  for (const VoxelBox& box : news.boxes) p.volume.changed(box);
  if (!news.all) return true;
  p.volume.remove(*p.renderer);
  if (!hasVolume()) return true;
  const bool same_place = p.mirror->volume().geometry == p.shown;
  p.shown = p.mirror->volume().geometry;
  p.volume.show(p.mirror->lent(), p.mirror->labels(), *p.renderer);
  if (!same_place) resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  return true;
}

bool SceneRenderer::hasVolume() const {
  return !parts_->mirror->empty();
}

void SceneRenderer::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  parts_->stale = true;
  parts_->volume.setTissues(tissues, looks);
}

void SceneRenderer::setClip(const std::vector<ClipPlane>& planes) {
  parts_->stale = true;
  parts_->volume.setClip(planes);
}

void SceneRenderer::setLight(const Vec3& from) {
  if (!isFinite(from) || glm::length(from) == 0.0) return;
  parts_->stale = true;
  parts_->volume.setLight(glm::normalize(from));
}

void SceneRenderer::setTruth(const RayTruth& truth) {
  parts_->stale = true;
  parts_->volume.setTruth(truth);
}

void SceneRenderer::setSampleDistance(double voxels) {
  if (!(voxels > 0.0)) return;
  parts_->stale = true;
  parts_->volume.setSampleDistance(voxels);
}

bool SceneRenderer::pullChanges(Grid& grid) {
  parts_->mirror->pull(grid);
  return takeChanges();
}

const Volume& SceneRenderer::copy() const {
  return parts_->mirror->volume();
}

void SceneRenderer::setTools(const std::vector<ToolView>& tools) {
  parts_->stale = true;
  parts_->tools.show(tools, *parts_->renderer);
}

void SceneRenderer::resize(int width, int height) {
  Parts& p = *parts_;
  if (width == p.width && height == p.height) return;
  p.width = std::max(1, width);
  p.height = std::max(1, height);
  p.stale = true;
}

void SceneRenderer::setMoving(bool moving) {
  parts_->moving = moving;
}

bool SceneRenderer::paint(unsigned int framebuffer, double budget_ms) {
  Parts& p = *parts_;
  if (!p.window) return true;
  takeChanges();
  const Clock::time_point start = Clock::now();
  if (!p.moving && p.level.stillFrame_ms() > budget_ms) {
    if (p.stale || p.row > 0) p.drawStill(budget_ms);
    if (p.hosted) p.canvas.copyTo(framebuffer);
    return p.row == 0;
  }
  p.stale = true;
  p.draw(p.moving ? p.level.pixelStep() : 1.0, p.moving ? p.level.rayStep() : 1.0);
  if (p.hosted) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    p.window->BlitDisplayFramebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  }
  glFinish();  // the level follows the time that a frame really takes
  if (p.moving) {
    p.level.movingFrameTook(msSince(start));
  } else {
    p.level.stillFrameTook(msSince(start));
  }
  return true;
}

Picture SceneRenderer::picture() {
  if (!parts_->window) return {};
  takeChanges();
  parts_->draw(1.0, 1.0);
  return parts_->read();
}

void SceneRenderer::resetCamera(const Vec3& direction, const Vec3& up) {
  Parts& p = *parts_;
  if (!hasVolume()) return;
  p.camera.fit(p.mirror->volume().geometry, direction, up, p.width, p.height);
  p.stale = true;
}

void SceneRenderer::lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up,
                           double distance_mm) {
  parts_->camera.lookAt(focus_mm, direction, up, distance_mm);
  parts_->stale = true;
}

void SceneRenderer::orbit(double azimuth_deg, double elevation_deg) {
  parts_->camera.orbit(azimuth_deg, elevation_deg);
  parts_->stale = true;
}

void SceneRenderer::zoom(double factor) {
  Parts& p = *parts_;
  p.camera.zoom(factor, hasVolume() ? 20.0 * p.mirror->volume().geometry.diagonal_mm() : 1e5);
  p.stale = true;
}

void SceneRenderer::pan(double dx_pixels, double dy_pixels) {
  Parts& p = *parts_;
  p.camera.pan(dx_pixels, dy_pixels, p.height);
  p.stale = true;
}

Vec3 SceneRenderer::viewRight() const {
  return parts_->camera.right();
}
Vec3 SceneRenderer::viewUp() const {
  return parts_->camera.up();
}
Vec3 SceneRenderer::viewForward() const {
  return parts_->camera.forward();
}

double SceneRenderer::mmPerPixelAt(const Vec3& patient_mm) const {
  return parts_->camera.mmPerPixelAt(patient_mm, parts_->height);
}

double UploadProbe::fullUpload_ms(SceneRenderer& renderer) {
  SceneRenderer::Parts& p = *renderer.parts_;
  p.window->MakeCurrent();
  p.volume.scan(*p.renderer);  // outside the time: only what crosses to the GPU counts
  glFinish();
  const Clock::time_point start = Clock::now();
  p.volume.sendAll(*p.renderer);
  glFinish();
  return msSince(start);
}

double UploadProbe::boxUpload_ms(SceneRenderer& renderer, const VoxelBox& box) {
  SceneRenderer::Parts& p = *renderer.parts_;
  p.window->MakeCurrent();
  glFinish();
  const Clock::time_point start = Clock::now();
  p.volume.changed(box);
  p.volume.sendChanges(*p.renderer);
  glFinish();
  return msSince(start);
}

Volume& UploadProbe::copy(SceneRenderer& renderer) {
  return renderer.parts_->mirror->lent();
}

void UploadProbe::setLeaping(SceneRenderer& renderer, bool on) {
  renderer.parts_->stale = true;
  renderer.parts_->volume.setLeaping(on);
}
void UploadProbe::setFirstTissue(SceneRenderer& renderer, bool on) {
  renderer.parts_->stale = true;
  renderer.parts_->volume.setFirstTissue(on);
}
void UploadProbe::setNormalsAsColour(SceneRenderer& renderer, bool on) {
  renderer.parts_->stale = true;
  renderer.parts_->volume.setNormalsAsColour(on);
}

double UploadProbe::level(const SceneRenderer& renderer) {
  return renderer.parts_->level.pixelStep();
}

Picture UploadProbe::pictureAt(SceneRenderer& renderer, double level) {
  if (!renderer.parts_->window) return {};
  renderer.parts_->stale = true;
  renderer.parts_->draw(level, LevelOfDetail::rayStepAt(level));
  return renderer.parts_->read();
}

Picture UploadProbe::painted(SceneRenderer& renderer) {
  if (!renderer.parts_->window) return {};
  return renderer.parts_->read();
}

}  // namespace trephine
