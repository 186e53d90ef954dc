// Everything that one frame passes through in order, from boxes to pixels, and the methods that set
// what it shows: each is a line or two, so it stands in one file, of over 500 lines.
//
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
#include <vtkOpenGLShaderCache.h>
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

#include "base/log.h"
#include "render/canvas.h"
#include "render/carve_volume_mapper.h"
#include "render/composer.h"
#include "render/display_probe.h"
#include "render/display_volume.h"
#include "render/orientation_cue.h"
#include "render/scene_renderer.h"
#include "render/tool_drawing.h"
#include "render/tool_guide.h"
#include "render/view_camera.h"
#include "render/volume_pictures.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2);

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

// VTK only fills framebuffers of our own: one renderer the volume's, as many rays as asked for, the
// other the tools'. The picture is put together from both.
struct SceneRenderer::Parts {
  vtkNew<vtkRenderer> renderer;  // of the volume
  vtkNew<vtkRenderer> tool_renderer;
  vtkSmartPointer<vtkOpenGLRenderWindow> window;  // null while detached
  vtkNew<vtkCallbackCommand> context_asked;
  RenderHost host;
  bool hosted = false;

  std::shared_ptr<VolumeMirror> mirror = std::make_shared<VolumeMirror>();
  std::unique_ptr<VolumeMirror::Reader> news = std::make_unique<VolumeMirror::Reader>(mirror);
  GridGeometry place_shown;
  CarveVolume volume;
  std::optional<DisplayVolume> reduced;  // stands in for the mirror's on the graphics card
  Index3 reduction{1, 1, 1};
  bool fitted = false;   // what is shown has been sent, or refused
  bool refused = false;  // and nothing is drawn of it
  Status refusal;
  ToolDrawing tools;
  std::vector<ToolView> tool_views;
  ScreenLines lines;

  ViewCamera camera;
  VolumePictures pictures;
  Composer composer;
  Canvas scene;       // the volume over the background, in the window's size
  Canvas tool_layer;  // tools alone, colour and depth
  Canvas frame;       // pictures that are read back
  bool scene_stale = true;
  bool moving = false;
  int width = 1;
  int height = 1;

  Parts() {
    for (vtkRenderer* each : {renderer.Get(), tool_renderer.Get()}) {
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

  void spoil() {
    pictures.spoil();
    scene_stale = true;
  }

  const Volume& voxels() const { return mirror->volume(); }
  bool drawsVolume() const { return !mirror->empty() && !refused; }

  // All voxels, as many as the card takes; sent with the next picture.
  void show() {
    reduced.reset();
    reduction = {1, 1, 1};
    fitted = refused = false;
    refusal = {};
    pictures.startAnew();
    volume.show(mirror->lent(), mirror->labels(), *renderer);
  }

  void showReduced() {
    volume.remove(*renderer);
    reduced.emplace(voxels(), reduction);
    const LabelMap* labels = mirror->labels().get();
    volume.show(reduced->volume(), labels ? reduced->labels(*labels) : nullptr, *renderer);
  }

  void changed(const VoxelBox& box) {
    volume.changed(reduced ? reduced->update(voxels(), box) : box);
    cut(box);
  }

  // Halves it until the card takes it.
  void fit() {
    fitted = true;
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    if (most_edge > 0) most = std::min(most, most_edge);
    const Index3 needed = reductionFor(voxels().geometry.size, most, mirror->labels() != nullptr);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      reduction[axis] = std::max(reduction[axis], needed[axis]);
    }
    constexpr int kMost = 16;  // beyond it there is too little left to see
    for (;;) {
      if (reduction != Index3{1, 1, 1}) showReduced();
      handToVtk();
      volume.sendChanges(*renderer);  // takes the first texture unit before VTK does
      if (volume.sendAll(*renderer) && most_edge >= 0) return;
      if (*std::max_element(reduction.begin(), reduction.end()) >= kMost) break;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (voxels().geometry.size[axis] > 2 * reduction[axis]) reduction[axis] *= 2;
      }
    }
    refused = true;
    refusal = Error{"VOLUME_REFUSED", "The graphics card cannot show this volume", "3-D view",
                    "Close other programs, or import the case with a part or fewer voxels"};
    spdlog::warn("The graphics card refused a volume: {}", volume.complaint());
  }
  int most_edge = 0;  // for tests: as if textures had no longer edges; negative: all are refused

  // `upwards`: what the picture spans upwards, in the window's height.
  void place(vtkRenderer& in, double upwards) {
    const Vec3 eye = camera.eye(), focus = camera.focus(), up = camera.up();
    vtkCamera* vtk = in.GetActiveCamera();
    vtk->SetPosition(eye.x, eye.y, eye.z);
    vtk->SetFocalPoint(focus.x, focus.y, focus.z);
    vtk->SetViewUp(up.x, up.y, up.z);
    vtk->SetParallelProjection(camera.parallel());
    vtk->SetParallelScale(camera.halfHeight_mm() * upwards);
    const double half = std::tan(glm::radians(ViewCamera::kViewAngle_deg / 2.0)) * upwards;
    vtk->SetViewAngle(2.0 * glm::degrees(std::atan(half)));
    in.ResetCameraClippingRange();
  }

  // OpenGL's state was changed behind VTK's back, by us and by the window's toolkit.
  void handToVtk() {
    window->SetSize(width, height);
    window->GetState()->Reset();
    window->GetState()->vtkglEnable(GL_DEPTH_TEST);
    window->GetState()->vtkglDepthMask(GL_TRUE);
    window->GetState()->vtkglDepthFunc(GL_LEQUAL);
    window->GetShaderCache()->ReleaseCurrentShader();
  }

  // Into the framebuffer that is bound.
  void cast(const Canvas& into, const Span& span, const PixelRect& part, double ray_step) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(part.low_x, part.low_y, part.width(), part.height());
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    constexpr float kNothing[4] = {0.0F, 0.0F, 0.0F, 0.0F}, kNever[4] = {1e9F, 1e9F, 0.0F, 0.0F};
    glClearBufferfv(GL_COLOR, 0, kNothing);
    glClearBufferfv(GL_COLOR, 1, kNever);
    glClearBufferfv(GL_COLOR, 2, kNothing);
    handToVtk();
    renderer->SetViewport(0.0, 0.0, double(into.width()) / width, double(into.height()) / height);
    volume.lookFrom(camera.right(), camera.up(), camera.forward());
    volume.sendChanges(*renderer);
    volume.setQuality(1.0, ray_step);
    volume.setPart(part);
    place(*renderer, span.pixels.y / height);
    renderer->Render();
    glFinish();
  }

  VolumePictures::Cast caster() {
    return [this](const Canvas& into, const Span& span, const PixelRect& part, double ray_step) {
      cast(into, span, part, ray_step);
    };
  }

  void drawAt(double level) {
    if (!fitted && !mirror->empty()) fit();
    if (drawsVolume()) pictures.castAt(level, LevelOfDetail::rayStepAt(level), caster());
    scene_stale = true;
  }

  bool work(double budget_ms) {
    if (!fitted && !mirror->empty()) fit();
    if (!drawsVolume()) return std::exchange(scene_stale, false);
    const bool changed = pictures.work(budget_ms, moving, caster());
    scene_stale |= changed;
    const std::string& shader = composer.failure();
    if (refusal && (!pictures.allocated() || !shader.empty())) {
      refusal = Error{"NO_OPENGL", "The graphics card refused to draw a picture", "3-D view",
                      "Make the window smaller, or update the graphics driver"};
      spdlog::warn("No picture could be made: {}", shader.empty() ? "no memory" : shader);
    }
    return changed;
  }

  // Around the points, in the window's pixels.
  PixelRect around(const Vec3* points, std::size_t count, int margin) const {
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

  void cut(const VoxelBox& box) {
    // Shading and ambient light look this far from a sample.
    constexpr double kReach_voxels = 4.0;
    Vec3 corners[8];
    for (int corner = 0; corner < 8; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        corners[corner][axis] =
            corner & (1 << axis) ? box.high[a] - 1 + kReach_voxels : box.low[a] - kReach_voxels;
      }
      corners[corner] = voxels().geometry.toPatient_mm(corners[corner]);
    }
    pictures.cut(around(corners, 8, 1));
  }

  void drawTools(unsigned int framebuffer, const Canvas* shown, const Span& span) {
    std::vector<PixelRect> parts;
    for (const auto& box : tools.boxes()) {
      const PixelRect part = around(box.data(), box.size(), 2);
      if (!part.empty()) parts.push_back(part);
    }
    if (parts.empty()) return;
    tool_layer.bind(width, height, {Canvas::Image::colour, Canvas::Image::hidden_part});
    glEnable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    for (const PixelRect& part : parts) {
      glScissor(part.low_x, part.low_y, part.width(), part.height());
      constexpr float kNothing[4] = {0.0F, 0.0F, 0.0F, 0.0F}, kFar = 1.0F;
      glClearBufferfv(GL_COLOR, 0, kNothing);
      glClearBufferfv(GL_DEPTH, 0, &kFar);
    }
    handToVtk();
    place(*tool_renderer, 1.0);
    tool_renderer->Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    DepthRange range;
    tool_renderer->GetActiveCamera()->GetClippingRange(range.near_mm, range.far_mm);
    range.parallel = camera.parallel();
    // A part that lies in another would be drawn twice, which changes nothing: what is read is not
    // what is written.
    for (const PixelRect& part : parts) {
      composer.drawTools(tool_layer, range, shown, span, part);
    }
  }

  void addGuides(const Canvas& shown, const Span& span, ScreenLines& to) const {
    for (const ToolView& tool : tool_views) {
      const PixelRect reach = guideReach(tool, camera, width, height);
      std::optional<double> ahead_mm;
      if (!tool.contact && !reach.empty()) {
        DepthPatch patch;
        patch.step = span.pixels / glm::dvec2(shown.width(), shown.height());
        patch.beyond = span.beyond;
        const auto ray = [&](int x, int y) {
          return glm::ivec2(glm::floor((glm::dvec2(x, y) + span.beyond) / patch.step));
        };
        const glm::ivec2 low = ray(reach.low_x, reach.low_y),
                         high = ray(reach.high_x, reach.high_y);
        patch.rays = {std::max(low.x, 0), std::max(low.y, 0), std::min(high.x + 1, shown.width()),
                      std::min(high.y + 1, shown.height())};
        patch.depth_mm = shown.readDepth_mm(patch.rays);
        if (!patch.depth_mm.empty()) {
          ahead_mm = surfaceAhead_mm(tool, patch, camera, width, height);
        }
      }
      addGuide(tool, ahead_mm, camera, width, height, to);
    }
  }

  void compose(unsigned int framebuffer) {
    const Canvas* shown = drawsVolume() ? &pictures.canvas() : nullptr;
    const Span span = shown ? pictures.span() : Span{};
    if (scene_stale || scene.width() != width || scene.height() != height) {
      scene.bind(width, height, {Canvas::Image::colour});
      composer.drawVolume(shown, span, width, height);
      scene_stale = false;
    }
    scene.copyTo(framebuffer);
    drawTools(framebuffer, shown, span);
    ScreenLines all;
    if (shown) {
      addOrientationCue(camera, width, height, all);
      addScaleBar(camera, width, height, all);
      if (std::min(width, height) >= kRoomForCues) addGuides(*shown, span, all);
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    }
    all.insert(all.end(), lines.begin(), lines.end());
    composer.drawLines(all, width, height);
  }

  // What is shown now.
  Picture read() {
    Picture picture;
    if (!frame.bind(width, height, {Canvas::Image::colour})) return picture;
    compose(frame.framebuffer());
    frame.bind();
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

  void release() {
    if (!window) return;
    window->MakeCurrent();
    pictures.release();
    composer.release();
    scene.release();
    tool_layer.release();
    frame.release();
    scene_stale = true;
    fitted = refused = false;
    volume.releaseGraphics(*renderer);
    window->Finalize();
    for (vtkRenderer* each : {renderer.Get(), tool_renderer.Get()}) window->RemoveRenderer(each);
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
  renderer->resize(width, height);
  vtkNew<vtkRenderWindow> window;
  p.window = vtkOpenGLRenderWindow::SafeDownCast(window);
  const Error no_opengl{"NO_OPENGL", "OpenGL 3.2 could not be started", "hidden window",
                        "Update the graphics driver, or install libgl1-mesa-dri"};
  if (!p.window) return no_opengl;
  p.window->SetOffScreenRendering(1);
  p.window->SetMultiSamples(0);
  p.window->SetSize(p.width, p.height);
  for (vtkRenderer* each : {p.renderer.Get(), p.tool_renderer.Get()}) p.window->AddRenderer(each);
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
  for (vtkRenderer* each : {p.renderer.Get(), p.tool_renderer.Get()}) p.window->AddRenderer(each);
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
  for (const VoxelBox& box : news.boxes) p.changed(box);
  if (!news.all) return true;
  p.spoil();
  p.volume.remove(*p.renderer);
  if (!hasVolume()) return true;
  const bool same_place = p.voxels().geometry == p.place_shown;
  p.place_shown = p.voxels().geometry;
  p.show();
  if (!same_place) resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  return true;
}

bool SceneRenderer::hasVolume() const {
  return !parts_->mirror->empty();
}

void SceneRenderer::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  parts_->spoil();
  parts_->volume.setTissues(asSeen(tissues, looks), looks);
}

void SceneRenderer::setClip(const std::vector<ClipPlane>& planes) {
  parts_->spoil();
  parts_->volume.setClip(planes);
}

void SceneRenderer::setLight(const Vec3& from) {
  if (!isFinite(from) || glm::length(from) == 0.0) return;
  parts_->spoil();
  parts_->volume.setLight(glm::normalize(from));
}

void SceneRenderer::setTruth(const RayTruth& truth) {
  parts_->spoil();
  parts_->volume.setTruth(truth);
}

void SceneRenderer::setSampleDistance(double voxels) {
  if (!(voxels > 0.0)) return;
  parts_->spoil();
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
  parts_->tools.show(tools, *parts_->tool_renderer);
  parts_->tool_views = tools;
}

void SceneRenderer::resize(int width, int height) {
  Parts& p = *parts_;
  if (width == p.width && height == p.height) return;
  p.width = std::max(1, width);
  p.height = std::max(1, height);
  p.pictures.resize(p.width, p.height);
  p.scene_stale = true;
}

void SceneRenderer::setMoving(bool moving) {
  parts_->moving = moving;
}

bool SceneRenderer::paint(unsigned int framebuffer, double budget_ms) {
  Parts& p = *parts_;
  if (!p.window) return true;
  takeChanges();
  p.window->MakeCurrent();
  p.work(budget_ms);
  if (p.hosted) {
    p.compose(framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  } else if (p.frame.bind(p.width, p.height, {Canvas::Image::colour})) {
    p.compose(p.frame.framebuffer());
    glFinish();
  }
  return p.moving || complete();
}

bool SceneRenderer::refine(double budget_ms) {
  Parts& p = *parts_;
  if (!p.window) return false;
  p.window->MakeCurrent();
  return p.work(budget_ms);
}

bool SceneRenderer::complete() const {
  return !parts_->drawsVolume() || parts_->pictures.complete();
}

Index3 SceneRenderer::reduction() const {
  return parts_->reduction;
}

Status SceneRenderer::refusal() const {
  return parts_->refusal;
}

double SceneRenderer::shareOfRays() const {
  const double step = parts_->pictures.pixelStep();
  return parts_->drawsVolume() && step > 0.0 ? 1.0 / (step * step) : 0.0;
}

Picture SceneRenderer::picture() {
  Parts& p = *parts_;
  if (!p.window) return {};
  takeChanges();
  p.window->MakeCurrent();
  const bool moving = std::exchange(p.moving, false);
  p.work(std::numeric_limits<double>::infinity());
  p.moving = moving;
  return p.read();
}

void SceneRenderer::resetCamera(const Vec3& direction, const Vec3& up) {
  Parts& p = *parts_;
  if (!hasVolume()) return;
  p.camera.fit(p.voxels().geometry, direction, up, p.width, p.height);
  p.spoil();
}

void SceneRenderer::lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up,
                           double distance_mm) {
  parts_->camera.lookAt(focus_mm, direction, up, distance_mm);
  parts_->spoil();
}

void SceneRenderer::orbit(double azimuth_deg, double elevation_deg) {
  parts_->camera.orbit(azimuth_deg, elevation_deg);
  parts_->spoil();
}

void SceneRenderer::zoom(double factor) {
  Parts& p = *parts_;
  p.camera.zoom(factor, hasVolume() ? 20.0 * p.voxels().geometry.diagonal_mm() : 1e5);
  p.spoil();
}

void SceneRenderer::pan(double dx_pixels, double dy_pixels) {
  Parts& p = *parts_;
  p.camera.pan(dx_pixels, dy_pixels, p.height);
  p.spoil();
}

void SceneRenderer::lookFrom(StandardView side) {
  parts_->camera.lookFrom(side);
  parts_->spoil();
}

void SceneRenderer::setParallel(bool parallel) {
  if (parallel == parts_->camera.parallel()) return;
  parts_->camera.setParallel(parallel);
  parts_->spoil();
}

const ViewCamera& SceneRenderer::camera() const {
  return parts_->camera;
}

void SceneRenderer::setLines(const ScreenLines& lines) {
  parts_->lines = lines;
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
  p.spoil();
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
  p.spoil();
  glFinish();
  const Clock::time_point start = Clock::now();
  p.changed(box);
  p.volume.sendChanges(*p.renderer);
  glFinish();
  return msSince(start);
}

Volume& UploadProbe::copy(SceneRenderer& renderer) {
  return renderer.parts_->mirror->lent();
}

void UploadProbe::limitEdges(SceneRenderer& renderer, int most) {
  renderer.parts_->most_edge = most;
}

void UploadProbe::setLeaping(SceneRenderer& renderer, bool on) {
  renderer.parts_->spoil();
  renderer.parts_->volume.setLeaping(on);
}
void UploadProbe::setFirstTissue(SceneRenderer& renderer, bool on) {
  renderer.parts_->spoil();
  renderer.parts_->volume.setFirstTissue(on);
}

void UploadProbe::setNormalsAsColour(SceneRenderer& renderer, bool on) {
  renderer.parts_->spoil();
  renderer.parts_->volume.setNormalsAsColour(on);
}

double UploadProbe::level(const SceneRenderer& renderer) {
  return renderer.parts_->pictures.pixelStep();
}

Picture UploadProbe::pictureAt(SceneRenderer& renderer, double level) {
  SceneRenderer::Parts& p = *renderer.parts_;
  if (!p.window) return {};
  renderer.takeChanges();
  p.window->MakeCurrent();
  p.drawAt(level);
  return p.read();
}

Picture UploadProbe::painted(SceneRenderer& renderer) {
  if (!renderer.parts_->window) return {};
  renderer.parts_->window->MakeCurrent();
  return renderer.parts_->read();
}

}  // namespace trephine
