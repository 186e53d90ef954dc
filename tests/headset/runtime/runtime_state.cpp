#include "runtime_state.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

namespace trephine::xr_test {

namespace {

std::int64_t now_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

XrPosef poseOf(const Pose& of) {
  const Quat& q = of.orientation;
  const Vec3& p = of.position;
  return {{float(q.x), float(q.y), float(q.z), float(q.w)}, {float(p.x), float(p.y), float(p.z)}};
}

Pose poseOf(const XrPosef& of) {
  const XrQuaternionf& q = of.orientation;
  return {{of.position.x, of.position.y, of.position.z}, Quat(q.w, q.x, q.y, q.z)};
}

}  // namespace

RuntimeState& theRuntime() {
  static RuntimeState runtime;
  return runtime;
}

void RuntimeState::reset() {
  const auto held = lock();
  head_m_ = Pose{};
  separation_m_ = 0.063;
  sees_[0] = {-1.0, 0.75, -1.0, 0.9};
  sees_[1] = {-0.75, 1.0, -1.0, 0.9};
  period_ms_ = 11.1;
  hang_s_ = 0.0;
  width = height = 512;
  plugged_in = stage = read_back_ = worn_ = true;
  failures_.clear();
  calls_.clear();
  violations_.clear();
  frames_ = frames_with_eyes_ = frames_held_ = repeats_ = most_repeats_ = 0;
  for (Shown& each : shown_) each = {};
  screen_.reset();
}

void RuntimeState::setHead(const Pose& room_m) {
  const auto held = lock();
  head_m_ = room_m;
}
void RuntimeState::setEyes(double separation_m, const FieldOfView& left, const FieldOfView& right) {
  const auto held = lock();
  separation_m_ = separation_m;
  sees_[0] = left;
  sees_[1] = right;
}
void RuntimeState::setPeriod(double ms) {
  const auto held = lock();
  period_ms_ = ms;
}
void RuntimeState::setSize(std::uint32_t wide, std::uint32_t high) {
  const auto held = lock();
  width = wide;
  height = high;
}
void RuntimeState::setPluggedIn(bool yes) {
  const auto held = lock();
  plugged_in = yes;
}
void RuntimeState::setReadBack(bool on) {
  const auto held = lock();
  read_back_ = on;
}
void RuntimeState::setStage(bool known) {
  const auto held = lock();
  stage = known;
}
void RuntimeState::moveRoom(bool of_stage) {
  const auto held = lock();
  XrEventDataBuffer buffer{};
  auto& event = reinterpret_cast<XrEventDataReferenceSpaceChangePending&>(buffer);
  event.type = XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING;
  event.referenceSpaceType =
      of_stage ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
  event.changeTime = now_ns();
  events.push_back(buffer);
}
void RuntimeState::fail(const std::string& function, int result, int after, int times) {
  const auto held = lock();
  failures_.push_back({function, XrResult(result), after, times});
}
void RuntimeState::hang(double seconds) {
  const auto held = lock();
  hang_s_ = seconds;
}

void RuntimeState::setWorn(bool worn) {
  const auto held = lock();
  if (worn == worn_) return;
  worn_ = worn;
  if (!running || !seen) return;
  if (worn) {
    push(XR_SESSION_STATE_VISIBLE);
    push(XR_SESSION_STATE_FOCUSED);
  } else {
    if (state == XR_SESSION_STATE_FOCUSED) push(XR_SESSION_STATE_VISIBLE);
    push(XR_SESSION_STATE_SYNCHRONIZED);
  }
}

void RuntimeState::lose(Loss loss) {
  const auto held = lock();
  switch (loss) {
    case Loss::instance:
      instance_lost_ = true;
      break;
    case Loss::session:
      session_lost_ = true;
      break;
    case Loss::pending:
      loss_pending_ = true;
      break;
    case Loss::event:
      losePending();
      break;
  }
  changed_.notify_all();
}

void RuntimeState::losePending() {
  switch (loss_events_++ % 3) {
    case 0:
      push(XR_SESSION_STATE_LOSS_PENDING);
      break;
    case 1:
      push(XR_SESSION_STATE_EXITING);
      break;
    default:
      XrEventDataBuffer event{};
      event.type = XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING;
      events.push_back(event);
  }
}

TestRuntime::Shown RuntimeState::shown(int eye) {
  const auto held = lock();
  return shown_[eye == 0 ? 0 : 1];
}
std::optional<TestRuntime::Screen> RuntimeState::screen() {
  const auto held = lock();
  return screen_;
}
int RuntimeState::frames() {
  const auto held = lock();
  return frames_;
}
int RuntimeState::framesWithEyes() {
  const auto held = lock();
  return frames_with_eyes_;
}
int RuntimeState::mostRepeats() {
  const auto held = lock();
  return most_repeats_;
}
int RuntimeState::framesHeld() {
  const auto held = lock();
  return frames_held_;
}
int RuntimeState::calls(const std::string& function) {
  const auto held = lock();
  return calls_[function];
}
std::vector<std::string> RuntimeState::functions() {
  return functionNames();
}
TestRuntime::Alive RuntimeState::alive() {
  const auto held = lock();
  return {int(instances.size()), int(sessions.size()), int(swapchains.size()), int(spaces.size()),
          textures_};
}
std::vector<std::string> RuntimeState::violations() {
  const auto held = lock();
  return violations_;
}

XrResult RuntimeState::enter(const char* function, bool of_session) {
  ++calls_[function];
  for (Failure& failure : failures_) {
    if (failure.times == 0 || (failure.function != "*" && failure.function != function)) continue;
    if (failure.after > 0) {
      --failure.after;
      continue;
    }
    if (failure.times > 0) --failure.times;
    if (failure.result == XR_ERROR_SESSION_LOST) session_lost_ = true;
    if (failure.result == XR_ERROR_INSTANCE_LOST) instance_lost_ = true;
    return failure.result;
  }
  if (instance_lost_ && !instances.empty()) return XR_ERROR_INSTANCE_LOST;
  if (of_session && session_lost_) return XR_ERROR_SESSION_LOST;
  return XR_SUCCESS;
}

bool RuntimeState::hasContext(const char* function) {
  if (context && ::glXGetCurrentContext() == context) return true;
  violated(std::string(function) + ": the session's OpenGL context is not current in this thread");
  return false;
}

void RuntimeState::push(XrSessionState next) {
  XrEventDataBuffer buffer{};
  auto& event = reinterpret_cast<XrEventDataSessionStateChanged&>(buffer);
  event.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  event.session = sessions.empty() ? XR_NULL_HANDLE : XrSession(*sessions.rbegin());
  event.state = next;
  events.push_back(buffer);
  state = next;
}

XrResult RuntimeState::waitFrame(std::unique_lock<std::mutex>& held, XrFrameState& frame) {
  if (hang_s_ > 0.0) {
    const auto until = std::chrono::duration<double>(std::exchange(hang_s_, 0.0));
    held.unlock();
    const timespec time{time_t(until.count()),
                        long(1e9 * (until.count() - std::floor(until.count())))};
    ::nanosleep(&time, nullptr);  // the runtime's own clock
    held.lock();
    return XR_ERROR_RUNTIME_FAILURE;
  }
  const auto lost = [this] { return instance_lost_ || session_lost_ || !running; };
  const std::int64_t due_ns = last_frame_ns_ + std::int64_t(1e6 * period_ms_);
  if (const std::int64_t left_ns = due_ns - now_ns(); left_ns > 0) {
    changed_.wait_for(held, std::chrono::nanoseconds(left_ns), lost);
  }
  if (instance_lost_) return XR_ERROR_INSTANCE_LOST;
  if (session_lost_) return XR_ERROR_SESSION_LOST;
  if (!running) return XR_ERROR_SESSION_NOT_RUNNING;
  const std::int64_t now = now_ns(), period_ns = std::int64_t(1e6 * period_ms_);
  last_frame_ns_ = due_ns > now - period_ns ? due_ns : now;
  ++frames_waited_for;
  frame.predictedDisplayTime = now + 2 * period_ns;
  frame.predictedDisplayPeriod = period_ns;
  frame.shouldRender = state == XR_SESSION_STATE_VISIBLE || state == XR_SESSION_STATE_FOCUSED;
  return loss_pending_ ? XR_SESSION_LOSS_PENDING : XR_SUCCESS;
}

XrPosef RuntimeState::eyePose(int eye) const {
  Pose pose = head_m_;
  const double aside_m = (eye == 0 ? -0.5 : 0.5) * separation_m_;
  pose.position += pose.orientation * Vec3(aside_m, 0.0, 0.0);
  return poseOf(pose);
}

XrFovf RuntimeState::eyeFov(int eye) const {
  const FieldOfView& of = sees_[eye];
  return {float(std::atan(of.left)), float(std::atan(of.right)), float(std::atan(of.up)),
          float(std::atan(of.down))};
}

std::vector<std::uint8_t> RuntimeState::pixelsOf(const XrSwapchainSubImage& of) {
  const Swapchain& chain = swapchains.at(handleOf(of.swapchain));
  std::vector<std::uint8_t> all(std::size_t(chain.width) * chain.height * 4);
  GLint bound = 0;
  ::glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  ::glBindTexture(GL_TEXTURE_2D, chain.images[std::size_t(chain.released)]);
  ::glPixelStorei(GL_PACK_ALIGNMENT, 1);
  ::glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, all.data());
  ::glBindTexture(GL_TEXTURE_2D, GLuint(bound));
  const std::size_t wide = std::size_t(of.imageRect.extent.width) * 4;
  std::vector<std::uint8_t> part(wide * std::size_t(of.imageRect.extent.height));
  for (std::size_t row = 0; row * wide < part.size(); ++row) {
    const std::size_t from = ((row + std::size_t(of.imageRect.offset.y)) * chain.width +
                              std::size_t(of.imageRect.offset.x)) *
                             4;
    std::memcpy(part.data() + row * wide, all.data() + from, wide);
  }
  return part;
}

// Checked by xrEndFrame.
void RuntimeState::take(const XrFrameEndInfo& frame) {
  ++frames_;
  screen_.reset();
  for (std::uint32_t i = 0; i < frame.layerCount; ++i) {
    const XrCompositionLayerBaseHeader& layer = *frame.layers[i];
    if (layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
      const auto& quad = reinterpret_cast<const XrCompositionLayerQuad&>(layer);
      if (quad.eyeVisibility == XR_EYE_VISIBILITY_LEFT) ++frames_held_;
      if (quad.eyeVisibility != XR_EYE_VISIBILITY_BOTH) continue;
      screen_ = Screen{poseOf(quad.pose),
                       quad.size.width,
                       quad.size.height,
                       std::uint32_t(quad.subImage.imageRect.extent.width),
                       std::uint32_t(quad.subImage.imageRect.extent.height),
                       {}};
      if (read_back_) screen_->rgba = pixelsOf(quad.subImage);
    }
    if (layer.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) continue;
    ++frames_with_eyes_;
    const auto& eyes = reinterpret_cast<const XrCompositionLayerProjection&>(layer);
    const auto same = [](const Pose& a, const Pose& b) {
      return a.position == b.position && a.orientation == b.orientation;
    };
    const Pose at = poseOf(eyes.views[0].pose);
    const bool stale = same(at, shown_[0].view.pose) && !same(at, poseOf(eyePose(0)));
    repeats_ = stale ? repeats_ + 1 : 0;
    most_repeats_ = std::max(most_repeats_, repeats_);
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
      const XrCompositionLayerProjectionView& view = eyes.views[eye];
      Shown& of = shown_[eye];
      of.width = std::uint32_t(view.subImage.imageRect.extent.width);
      of.height = std::uint32_t(view.subImage.imageRect.extent.height);
      of.view.pose = poseOf(view.pose);
      of.view.sees = {std::tan(view.fov.angleLeft), std::tan(view.fov.angleRight),
                      std::tan(view.fov.angleDown), std::tan(view.fov.angleUp)};
      of.rgba = read_back_ ? pixelsOf(view.subImage) : std::vector<std::uint8_t>();
    }
  }
}

void RuntimeState::dropSwapchain(Swapchain& chain) {
  if (!hasContext("xrDestroySwapchain")) return;
  ::glDeleteTextures(GLsizei(chain.images.size()), chain.images.data());
  textures_ -= int(chain.images.size());
  chain.images.clear();
}

void RuntimeState::dropSession() {
  for (auto& [handle, chain] : swapchains) dropSwapchain(chain);
  swapchains.clear();
  spaces.clear();
  sessions.clear();
  running = frame_begun = seen = session_lost_ = loss_pending_ = false;
  state = XR_SESSION_STATE_UNKNOWN;
  context = nullptr;
  if (instances.empty()) instance_lost_ = false;
}

XrResult makeImages(RuntimeState& runtime, Swapchain& chain, std::int64_t format) {
  constexpr std::size_t kImages = 3;
  chain.images.resize(kImages);
  GLint bound = 0;
  ::glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  ::glGenTextures(GLsizei(kImages), chain.images.data());
  for (GLuint image : chain.images) {
    ::glBindTexture(GL_TEXTURE_2D, image);
    ::glTexImage2D(GL_TEXTURE_2D, 0, GLint(format), GLsizei(chain.width), GLsizei(chain.height), 0,
                   GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  }
  ::glBindTexture(GL_TEXTURE_2D, GLuint(bound));
  runtime.textures_ += int(kImages);
  return XR_SUCCESS;
}

}  // namespace trephine::xr_test

extern "C" __attribute__((visibility("default"))) trephine::TestRuntime*
trephine_xr_test_runtime() {
  return &trephine::xr_test::theRuntime();
}
