// The methods by which others set what is shown: each is a line or two.
//
// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <vtkAutoInit.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkRenderWindow.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "render/display_probe.h"
#include "render/scene_parts.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2);

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

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
  const Error no_opengl{code::kNoOpengl, tr("OpenGL 3.2 could not be started"), tr("hidden window"),
                        tr("Update the graphics driver, or install libgl1-mesa-dri")};
  if (!p.window) return no_opengl;
  p.window->SetOffScreenRendering(1);
  p.window->SetMultiSamples(0);
  p.window->SetSize(p.panel.width, p.panel.height);
  for (vtkRenderer* each : p.renderers()) p.window->AddRenderer(each);
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
  window->SetSize(p.panel.width, p.panel.height);
  window->OpenGLInit();
  p.window = window;
  if (openGlVersion() < kOpenGlNeeded) {
    const std::string description = openGlDescription();
    p.window = nullptr;
    return openGlTooOld(description);
  }
  for (vtkRenderer* each : p.renderers()) p.window->AddRenderer(each);
  return {};
}

void SceneRenderer::detach() {
  parts_->release();
}

std::array<int, 2> SceneRenderer::screenSize() const {
  if (!parts_->window) return {0, 0};
  const int* size = parts_->window->GetScreenSize();
  return {size[0], size[1]};
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

void SceneRenderer::setVolume(Grid& grid, const std::shared_ptr<const Volume>& whole) {
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(copyOf(*whole), grid.labels(), whole);
  mirror->pull(grid);
  setMirror(std::move(mirror));
}

bool SceneRenderer::takeChanges() {
  Parts& p = *parts_;
  const VolumeMirror::News news = p.news->take();
  if (!news.any()) return false;
  for (const VoxelBox& box : news.boxes) p.changed(box);
  if (news.other_labels) p.otherLabels();
  for (const VoxelBox& box : news.label_boxes) p.labelsChanged(box);
  if (!news.all) return true;
  p.spoil();
  p.volume.remove(*p.renderer);
  if (!hasVolume()) return true;
  p.seen_box.reset();
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
  Parts& p = *parts_;
  p.spoilLooks();
  // What is seen through and what is not says how long a picture takes.
  TissueSet seen = asSeen(tissues, looks);
  if (!(std::exchange(p.seen_tissues, seen) == seen)) p.seen_box.reset();
  std::vector<std::string> visible;
  for (const Tissue& tissue : seen.tissues) {
    if (tissue.opacity > 0.0) visible.push_back(tissue.id);
  }
  const bool others = std::exchange(p.visible, visible) != visible;
  if (std::exchange(p.looks, looks) != looks || others) p.panel.pictures.startAnew();
  p.volume.setTissues(seen, looks);
  p.labels_held |= !p.volume.labelsSent();
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

void SceneRenderer::setShading(const ShadingOptions& options) {
  parts_->spoil();
  parts_->volume.setShading(options);
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

void SceneRenderer::setOutline(const std::vector<Vec3>& points_mm, bool closed, double width_mm) {
  parts_->outline.show(points_mm, closed, width_mm, *parts_->outline_renderer);
  parts_->panel.scene_stale = true;
}

void SceneRenderer::resize(int width, int height) {
  parts_->panel.resize(width, height);
}

void SceneRenderer::setMoving(bool moving) {
  parts_->panel.moving = moving;
}

bool SceneRenderer::paint(unsigned int framebuffer, double budget_ms) {
  Parts& p = *parts_;
  if (!p.window) return true;
  takeChanges();
  p.window->MakeCurrent();
  p.panel.work(budget_ms);
  // Who has no frames to wait for waits here.
  const bool limited = budget_ms < std::numeric_limits<double>::infinity();
  while ((!p.hosted || !limited) && p.warmUp()) {
  }
  if (p.hosted) {
    p.panel.compose(framebuffer, true);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  } else if (p.frame.bind(p.panel.width, p.panel.height, {Canvas::Image::colour})) {
    p.panel.compose(p.frame.framebuffer(), true);
    glFinish();
  }
  return p.panel.moving || complete();
}

void SceneRenderer::paintEye(const EyeView& eye_mm, unsigned int framebuffer, int width,
                             int height) {
  Parts& p = *parts_;
  if (!p.window) return;
  takeChanges();
  p.window->MakeCurrent();
  View& eye = p.eye;
  eye.resize(width, height);
  eye.camera.lookThrough(eye_mm);
  const Clock::time_point begun = Clock::now();
  eye.drawAt(p.eye_level.pixelStep());
  if (p.drawsVolume()) p.eye_level.movingFrameTook(msSince(begun));
  eye.compose(framebuffer, false);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

Picture SceneRenderer::eyePicture(const EyeView& eye_mm, int width, int height) {
  Parts& p = *parts_;
  if (!p.window) return {};
  takeChanges();
  p.window->MakeCurrent();
  p.eye.resize(width, height);
  p.eye.camera.lookThrough(eye_mm);
  p.eye.drawAt(1.0);
  return p.eye.read(false);
}

void SceneRenderer::releaseEyes() {
  if (!parts_->window) return;
  parts_->window->MakeCurrent();
  parts_->cards.show({});
  parts_->cards.release();
  parts_->eye.release();
}

void SceneRenderer::setCards(std::vector<Card> cards) {
  parts_->cards.show(std::move(cards));
}

bool SceneRenderer::refine(double budget_ms) {
  Parts& p = *parts_;
  if (!p.window) return false;
  p.window->MakeCurrent();
  return p.panel.work(budget_ms);
}

bool SceneRenderer::cold() const {
  return parts_->window && parts_->cold();
}

bool SceneRenderer::warmUp() {
  Parts& p = *parts_;
  if (!p.window) return false;
  p.window->MakeCurrent();
  return p.warmUp();
}

bool SceneRenderer::complete() const {
  const Parts& p = *parts_;
  return !p.drawsVolume() || (p.panel.pictures.complete() && p.volume.labelsSent());
}

bool SceneRenderer::stale() const {
  return parts_->drawsVolume() && parts_->panel.pictures.stale();
}

Index3 SceneRenderer::reduction() const {
  return parts_->reduction;
}

Status SceneRenderer::refusal() const {
  return parts_->refusal;
}

double SceneRenderer::shareOfRays() const {
  const double step = parts_->panel.pictures.pixelStep();
  return parts_->drawsVolume() && step > 0.0 ? 1.0 / (step * step) : 0.0;
}

Picture SceneRenderer::picture() {
  Parts& p = *parts_;
  if (!p.window) return {};
  takeChanges();
  p.window->MakeCurrent();
  const bool moving = std::exchange(p.panel.moving, false);
  p.panel.work(std::numeric_limits<double>::infinity());
  p.panel.moving = moving;
  return p.panel.read(true);
}

void SceneRenderer::resetCamera(const Vec3& direction, const Vec3& up) {
  Parts& p = *parts_;
  if (!hasVolume()) return;
  const GridGeometry& g = p.voxels().geometry;
  p.panel.camera.fit(g, {{0, 0, 0}, g.size}, direction, up, p.panel.width, p.panel.height);
  p.spoil();
}

void SceneRenderer::showAll(const Vec3& direction, const Vec3& up, int covered) {
  Parts& p = *parts_;
  if (!hasVolume()) return;
  const int free = std::max(p.panel.width - 2 * covered, p.panel.width / 2);
  p.panel.camera.fit(p.voxels().geometry, p.seenBox(), direction, up, free, p.panel.height);
  p.spoil();
}

void SceneRenderer::lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up,
                           double distance_mm) {
  parts_->panel.camera.lookAt(focus_mm, direction, up, distance_mm);
  parts_->spoil();
}

void SceneRenderer::orbit(double azimuth_deg, double elevation_deg) {
  orbit(azimuth_deg, elevation_deg, parts_->panel.camera.focus());
}

void SceneRenderer::orbit(double azimuth_deg, double elevation_deg, const Vec3& about_mm) {
  parts_->panel.camera.orbit(azimuth_deg, elevation_deg, about_mm);
  parts_->spoil();
}

void SceneRenderer::zoom(double factor) {
  Parts& p = *parts_;
  p.panel.camera.zoom(factor, hasVolume() ? 20.0 * p.voxels().geometry.diagonal_mm() : 1e5);
  p.spoil();
}

void SceneRenderer::pan(double dx_pixels, double dy_pixels) {
  Parts& p = *parts_;
  p.panel.camera.pan(dx_pixels, dy_pixels, p.panel.height);
  p.spoil();
}

SceneRenderer::Seen SceneRenderer::seen() const {
  Parts& p = *parts_;
  if (!hasVolume()) return {};
  const GridGeometry& g = p.voxels().geometry;
  const VoxelBox box = p.seenBox();
  const Vec3 low(box.low[0], box.low[1], box.low[2]);
  const Vec3 high(box.high[0] - 1, box.high[1] - 1, box.high[2] - 1);
  return {g.toPatient_mm(0.5 * (low + high)),
          0.5 * glm::distance(g.toPatient_mm(low), g.toPatient_mm(high))};
}

void SceneRenderer::setParallel(bool parallel) {
  if (parallel == parts_->panel.camera.parallel()) return;
  parts_->panel.camera.setParallel(parallel);
  parts_->spoil();
}

const ViewCamera& SceneRenderer::camera() const {
  return parts_->panel.camera;
}

void SceneRenderer::setLines(const ScreenLines& lines) {
  parts_->lines = lines;
}

Vec3 SceneRenderer::viewRight() const {
  return parts_->panel.camera.right();
}
Vec3 SceneRenderer::viewUp() const {
  return parts_->panel.camera.up();
}
Vec3 SceneRenderer::viewForward() const {
  return parts_->panel.camera.forward();
}

double SceneRenderer::mmPerPixelAt(const Vec3& patient_mm) const {
  return parts_->panel.camera.mmPerPixelAt(patient_mm, parts_->panel.height);
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
  return renderer.parts_->mirror->mutableVolume();
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
  return renderer.parts_->panel.pictures.pixelStep();
}

Picture UploadProbe::pictureAt(SceneRenderer& renderer, double level) {
  SceneRenderer::Parts& p = *renderer.parts_;
  if (!p.window) return {};
  renderer.takeChanges();
  p.window->MakeCurrent();
  p.panel.drawAt(level);
  return p.panel.read(true);
}

Picture UploadProbe::painted(SceneRenderer& renderer) {
  if (!renderer.parts_->window) return {};
  renderer.parts_->window->MakeCurrent();
  return renderer.parts_->panel.read(true);
}

}  // namespace trephine
