#include "lab/headset/headset_rig.h"

#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <algorithm>
#include <cstdlib>
#include <thread>

#include "base/codes.h"
#include "machine/common/exercise_view.h"
#include "render/display_probe.h"
#include "training/replay.h"

namespace trephine {

namespace {

constexpr int kPanelWidth = 960, kPanelHeight = 600;
constexpr std::int64_t kPanelEvery_ns = 16'666'667;
constexpr double kFrame_ms = 20.0, kBetween_ms = 10.0;  // as the window in an exercise
constexpr double kAhead_m = 0.4, kAbove_m = -0.2;

QGuiApplication* application() {
  static int count = 1;
  static char name[] = "trephine-measure";
  static char* arguments[] = {name, nullptr};
  // GLX: what the window uses.
  ::setenv("QT_QPA_PLATFORM", "xcb", 1);
  ::setenv("QT_XCB_GL_INTEGRATION", "xcb_glx", 1);
  return new QGuiApplication(count, arguments);
}

}  // namespace

HeadsetRig::HeadsetRig() = default;

Result<std::unique_ptr<HeadsetRig>> HeadsetRig::create() {
  if (Status display = probeDisplay(); !display) return display.error();
  std::unique_ptr<HeadsetRig> rig(new HeadsetRig);
  rig->application_.reset(application());
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  rig->context_ = std::make_unique<QOpenGLContext>();
  rig->context_->setFormat(format);
  rig->surface_ = std::make_unique<QOffscreenSurface>();
  const bool made = rig->context_->create();
  rig->surface_->setFormat(rig->context_->format());
  rig->surface_->create();
  if (!made || !rig->context_->makeCurrent(rig->surface_.get())) {
    return Error{code::kNoOpengl, "The graphics driver gives no OpenGL 3.2", "",
                 "Update the graphics driver"};
  }
  rig->renderer_ = std::make_unique<SceneRenderer>();
  HeadsetRig* const of = rig.get();
  Status attached = rig->renderer_->attach(
      {[of] { return QOpenGLContext::currentContext() == of->context_.get(); },
       [of] { of->context_->makeCurrent(of->surface_.get()); }});
  if (!attached) return attached.error();
  QOpenGLExtraFunctions& f = rig->gl();
  f.glGenTextures(1, &rig->panel_texture_);
  f.glBindTexture(GL_TEXTURE_2D, rig->panel_texture_);
  f.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kPanelWidth, kPanelHeight, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
  f.glGenFramebuffers(1, &rig->panel_.framebuffer);
  f.glBindFramebuffer(GL_FRAMEBUFFER, rig->panel_.framebuffer);
  f.glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, rig->panel_texture_,
                           0);
  rig->panel_.width = kPanelWidth;
  rig->panel_.height = kPanelHeight;
  rig->renderer_->resize(kPanelWidth, kPanelHeight);
  return rig;
}

HeadsetRig::~HeadsetRig() {
  headset_.reset();
  session_.reset();
  if (!context_ || !context_->makeCurrent(surface_.get())) return;
  if (renderer_) renderer_->detach();
  renderer_.reset();
  gl().glDeleteFramebuffers(1, &panel_.framebuffer);
  gl().glDeleteTextures(1, &panel_texture_);
}

QOpenGLExtraFunctions& HeadsetRig::gl() {
  return *context_->extraFunctions();
}

Status HeadsetRig::open(const std::filesystem::path& file, const std::filesystem::path& recording,
                        const Progress& progress) {
  session_.reset();
  Result<Exercise> exercise = readExercise(file);
  if (!exercise) return exercise.error();
  Result<Placement> of = openCase(*exercise, progress);
  if (!of) return of.error();
  SessionOptions options;
  options.recording = recording_ = recording;
  if (!exercise->operator_file.empty()) {
    Result<OperatorScript> script = readOperatorScript(exercise->operator_file, *exercise);
    if (!script) return script.error();
    options.script = *std::move(script);
  }
  Result<std::unique_ptr<Session>> session = Session::create(*of, options);
  if (!session) return session.error();
  exercise_ = std::move(of->exercise);
  case_ = std::move(of->patient);
  session_ = *std::move(session);
  renderer_->setTissues(exercise_->tissues, exercise_->view.looks);
  renderer_->setVolume(session_->grid(), case_->volume);
  renderer_->setTools(toolsOf(*session_));
  lookAtExercise(*renderer_, *session_);
  showOutline(*renderer_, *session_, *case_->volume);
  // A head that looks straight ahead, where a runtime says nothing else.
  Eyes eyes;
  for (std::size_t eye = 0; eye < 2; ++eye)
    eyes[eye].pose.position = Vec3(eye == 0 ? -0.0315 : 0.0315, 0.0, 0.0);
  const ViewCamera& camera = renderer_->camera();
  place_ = before(eyes, {camera.focus(), camera.forward(), camera.up()}, kAhead_m, kAbove_m);
  while (renderer_->warmUp()) {
  }
  renderer_->paint(panel_.framebuffer);
  last_turn_ns_ = last_panel_ns_ = 0;
  return recording.empty() ? Status() : session_->start();
}

Status HeadsetRig::endExercise() {
  return session_->stop();
}

bool HeadsetRig::replays(const Progress& progress) const {
  const auto reader = SessionReader::open(recording_);
  if (!reader) return false;
  const Result<ReplayResult> again =
      replay(**reader, *case_->volume, session_->grid().labels().get(), progress, case_->sha256);
  return again && again->identical && !again->cut_short;
}

void HeadsetRig::turn() {
  const std::int64_t now_ns = monotonic_ns();
  if (last_turn_ns_ != 0) {
    longest_ms_ = std::max(longest_ms_, 1e-6 * double(now_ns - last_turn_ns_));
  }
  last_turn_ns_ = now_ns;
  bool idle = true;
  if (now_ns >= next_panel_ns_) {  // first: eyes are wanted all the time
    idle = false;
    if (last_panel_ns_ != 0) {
      longest_panel_ms_ = std::max(longest_panel_ms_, 1e-6 * double(now_ns - last_panel_ns_));
    }
    last_panel_ns_ = now_ns;
    next_panel_ns_ = std::max(next_panel_ns_ + kPanelEvery_ns, now_ns);
    if (session_ && session_->running()) {
      renderer_->pullChanges(session_->grid());
      renderer_->setTools(toolsOf(*session_));
    }
    renderer_->paint(panel_.framebuffer, kFrame_ms);
  }
  if (headset_ && woken_->exchange(false)) {
    idle = false;
    if (std::optional<HeadsetEnd> how = headset_->end()) {
      end_ = std::move(how);
      painter_.release(headset_->pictures());
      renderer_->releaseEyes();
      headset_.reset();
    } else {
      const HeadsetState state = headset_->state();
      if (!placed_ && state.located) {
        const ViewCamera& camera = renderer_->camera();
        place_ = before(state.eyes_m, {camera.focus(), camera.forward(), camera.up()}, kAhead_m,
                        kAbove_m);
        placed_ = true;
      }
      while (renderer_->warmUp()) {
      }
      const bool drew = painter_.serve(
          headset_->pictures(),
          [this](const EyeView& eye_m, unsigned int framebuffer, int width, int height) {
            renderer_->paintEye(place_.toPatient_mm(eye_m), framebuffer, width, height);
          },
          panel_);
      pairs_ += drew ? 1 : 0;
    }
  } else if (idle && !renderer_->complete()) {
    idle = !renderer_->refine(kBetween_ms);
  }
  if (idle) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

double HeadsetRig::takeLongestTurn_ms() {
  last_panel_ns_ = 0;
  return std::max(std::exchange(longest_ms_, 0.0), std::exchange(longest_panel_ms_, 0.0));
}

Status HeadsetRig::startHeadset(const HeadsetOptions& options) {
  end_.reset();
  placed_ = false;
  *woken_ = false;
  auto started = Headset::start(*context_, options, [woken = woken_] { *woken = true; });
  if (!started) return started.error();
  headset_ = *std::move(started);
  return {};
}

int HeadsetRig::textures() {
  constexpr unsigned int kMost = 4000;
  int count = 0;
  for (unsigned int name = 1; name < kMost; ++name) count += gl().glIsTexture(name) ? 1 : 0;
  return count;
}

}  // namespace trephine
