#include "render/opengl.h"
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

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2);

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr double kViewAngle_deg = 30.0;

// Of the context that is current; 0 where there is none.
int openGlVersion() {
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  return major * 10 + minor;
}

Vec3 toVec3(const double* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

struct SceneRenderer::Parts {
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkOpenGLRenderWindow> window;  // null while detached
  vtkNew<vtkCallbackCommand> context_asked;
  RenderHost host;
  bool hosted = false;

  Volume copy;
  CarveVolume volume;
  ToolDrawing tools;
  OrientationCue cue{*renderer};
  std::vector<VoxelBox> pulled;

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
    camera().SetViewAngle(kViewAngle_deg);
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

  vtkCamera& camera() const { return *renderer->GetActiveCamera(); }
  Vec3 eye() const { return toVec3(camera().GetPosition()); }
  Vec3 focus() const { return toVec3(camera().GetFocalPoint()); }
  Vec3 forward() const { return glm::normalize(focus() - eye()); }
  Vec3 right() const { return glm::normalize(glm::cross(forward(), toVec3(camera().GetViewUp()))); }
  Vec3 up() const { return glm::cross(right(), forward()); }

  void setCamera(const Vec3& at, const Vec3& direction, const Vec3& view_up, double distance_mm) {
    if (!isFinite(at) || !isFinite(direction) || !isFinite(view_up) || !isFinite(distance_mm)) {
      return;
    }
    if (glm::length(direction) == 0.0 || distance_mm <= 0.0) return;
    const Vec3 ahead = glm::normalize(direction);
    Vec3 side = glm::cross(ahead, view_up);
    if (glm::length(side) < 1e-6 * std::max(1.0, glm::length(view_up))) {
      side = glm::cross(ahead, std::abs(ahead.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, -1, 0));
    }
    const Vec3 up_axis = glm::normalize(glm::cross(side, ahead));
    const Vec3 from = at - ahead * distance_mm;
    camera().SetFocalPoint(at.x, at.y, at.z);
    camera().SetPosition(from.x, from.y, from.z);
    camera().SetViewUp(up_axis.x, up_axis.y, up_axis.z);
    stale = true;
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
    volume.sendChanges(*renderer);
    volume.setQuality(pixel_step, ray_step);
    cue.update(right(), up(), forward(), width, height);
    renderer->ResetCameraClippingRange();
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
  if (openGlVersion() < 32) return no_opengl;
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
  if (openGlVersion() < 32) {
    const std::string description = openGlDescription();
    p.window = nullptr;
    return Error{"NO_OPENGL", "OpenGL 3.2 is needed, the driver offers " + description,
                 "graphics driver", "Update the driver, or start with LIBGL_ALWAYS_SOFTWARE=1"};
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

void SceneRenderer::setVolume(const Grid& grid) {
  Parts& p = *parts_;
  p.stale = true;
  const bool same_place = grid.geometry() == p.copy.geometry;
  p.volume.remove(*p.renderer);
  p.copy = Volume{};  // its memory goes back before the new copy takes as much
  if (grid.geometry().voxelCount() == 0) return;
  p.copy = grid.snapshot();
  p.volume.show(p.copy, *p.renderer);
  if (!same_place) resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
}

bool SceneRenderer::hasVolume() const {
  return !parts_->copy.hu.empty();
}

void SceneRenderer::setTissues(const TissueSet& tissues) {
  parts_->stale = true;
  parts_->volume.setTransferFunction(transferFunction(tissues));
}

bool SceneRenderer::pullChanges(Grid& grid) {
  Parts& p = *parts_;
  if (!hasVolume() || !(grid.geometry() == p.copy.geometry)) return false;
  p.pulled.clear();
  grid.copyChanges(p.copy, p.pulled);
  for (const VoxelBox& box : p.pulled) p.volume.changed(box);
  if (p.pulled.empty()) return false;
  p.stale = true;
  return true;
}

void SceneRenderer::setTools(const std::vector<ToolView>& tools) {
  parts_->stale = true;
  parts_->tools.show(tools, *parts_->renderer);
}

const Volume& SceneRenderer::copy() const {
  return parts_->copy;
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
  Parts& p = *parts_;
  Picture picture;
  if (!p.window) return picture;
  p.draw(1.0, 1.0);
  vtkNew<vtkUnsignedCharArray> pixels;
  p.window->GetPixelData(0, 0, p.width - 1, p.height - 1, 0, pixels, 0);
  const std::size_t row = std::size_t(p.width) * 3;
  if (std::size_t(pixels->GetNumberOfValues()) != row * std::size_t(p.height)) return picture;
  picture.width = p.width;
  picture.height = p.height;
  picture.rgb.resize(row * std::size_t(p.height));
  for (int y = 0; y < p.height; ++y) {  // OpenGL's rows go up
    std::copy_n(pixels->GetPointer(0) + std::size_t(p.height - 1 - y) * row, row,
                picture.rgb.data() + std::size_t(y) * row);
  }
  return picture;
}

void SceneRenderer::resetCamera(const Vec3& direction, const Vec3& up) {
  Parts& p = *parts_;
  if (!hasVolume()) return;
  const GridGeometry& g = p.copy.geometry;
  p.setCamera(g.centre_mm(), direction, up, g.diagonal_mm());
  // As near as every corner allows.
  const double tan_y = std::tan(glm::radians(kViewAngle_deg / 2.0));
  const double tan_x = tan_y * double(p.width) / double(p.height);
  double distance = 1.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 voxel(corner & 1 ? g.size[0] - 1 : 0, corner & 2 ? g.size[1] - 1 : 0,
                     corner & 4 ? g.size[2] - 1 : 0);
    const Vec3 c = g.toPatient_mm(voxel) - g.centre_mm();
    const double needed =
        std::max(std::abs(glm::dot(c, p.right())) / tan_x, std::abs(glm::dot(c, p.up())) / tan_y) -
        glm::dot(c, p.forward());
    distance = std::max(distance, needed);
  }
  p.setCamera(g.centre_mm(), direction, up, distance * 1.02);
}

void SceneRenderer::lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up,
                           double distance_mm) {
  parts_->setCamera(focus_mm, direction, up, distance_mm);
}

void SceneRenderer::orbit(double azimuth_deg, double elevation_deg) {
  if (!isFinite(azimuth_deg) || !isFinite(elevation_deg)) return;
  Parts& p = *parts_;
  const Vec3 side = p.right(), up = p.up();
  const Quat turn = glm::angleAxis(glm::radians(azimuth_deg), up) *
                    glm::angleAxis(glm::radians(-elevation_deg), side);
  p.setCamera(p.focus(), turn * p.forward(), turn * up, glm::distance(p.eye(), p.focus()));
}

void SceneRenderer::zoom(double factor) {
  if (!isFinite(factor) || factor <= 0.0) return;
  Parts& p = *parts_;
  const double farthest = hasVolume() ? 20.0 * p.copy.geometry.diagonal_mm() : 1e5;
  const double distance = std::clamp(glm::distance(p.eye(), p.focus()) / factor, 1.0, farthest);
  p.setCamera(p.focus(), p.forward(), p.up(), distance);
}

void SceneRenderer::pan(double dx_pixels, double dy_pixels) {
  Parts& p = *parts_;
  const double mm = mmPerPixelAt(p.focus());
  const Vec3 shift = (p.up() * dy_pixels - p.right() * dx_pixels) * mm;
  p.setCamera(p.focus() + shift, p.forward(), p.up(), glm::distance(p.eye(), p.focus()));
}

Vec3 SceneRenderer::viewRight() const {
  return parts_->right();
}
Vec3 SceneRenderer::viewUp() const {
  return parts_->up();
}
Vec3 SceneRenderer::viewForward() const {
  return parts_->forward();
}

double SceneRenderer::mmPerPixelAt(const Vec3& patient_mm) const {
  const Parts& p = *parts_;
  const double depth_mm = std::max(1e-3, glm::dot(patient_mm - p.eye(), p.forward()));
  return 2.0 * depth_mm * std::tan(glm::radians(kViewAngle_deg / 2.0)) / double(p.height);
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
  return renderer.parts_->copy;
}

void UploadProbe::setLeaping(SceneRenderer& renderer, bool on) {
  renderer.parts_->stale = true;
  renderer.parts_->volume.setLeaping(on);
}

}  // namespace trephine
