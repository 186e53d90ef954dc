// What the test runtime is and was told: one object behind one lock.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "headset/test_runtime.h"
// Xlib defines None, Bool and Status: last of all.
#include <GL/gl.h>
#include <GL/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace trephine::xr_test {

// OpenXR's handles are 64 bits that mean nothing to the program.
using Handle = std::uint64_t;
template <class T>
Handle handleOf(T* of) {
  return reinterpret_cast<Handle>(of);
}

struct Swapchain {
  std::uint32_t width = 0, height = 0;
  std::vector<GLuint> images;
  std::size_t next = 0;
  int acquired = -1, released = -1;
  bool waited = false;
};

class RuntimeState : public TestRuntime {
 public:
  // ---- TestRuntime
  void reset() override;
  void setHead(const Pose& room_m) override;
  void setEyes(double separation_m, const FieldOfView& left, const FieldOfView& right) override;
  void setPeriod(double ms) override;
  void setSize(std::uint32_t width, std::uint32_t height) override;
  void setPluggedIn(bool plugged_in) override;
  void setReadBack(bool on) override;
  void setStage(bool known) override;
  void moveRoom(bool of_stage) override;
  void fail(const std::string& function, int result, int after, int times) override;
  void hang(double seconds) override;
  void lose(Loss loss) override;
  void setWorn(bool worn) override;
  Shown shown(int eye) override;
  std::optional<Screen> screen() override;
  int frames() override;
  int framesWithEyes() override;
  int mostRepeats() override;
  int framesHeld() override;
  int calls(const std::string& function) override;
  std::vector<std::string> functions() override;
  Alive alive() override;
  std::vector<std::string> violations() override;

  // ---- For the functions; `lock()` is held throughout.
  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  // Counts the call, and says what it is to give by the script: XR_SUCCESS where it may go on.
  XrResult enter(const char* function, bool of_session);
  // False, and a violation, where the session's context is not current in this thread.
  bool hasContext(const char* function);
  void violated(const std::string& what) { violations_.push_back(what); }
  void push(XrSessionState state);
  // Waits for the next frame, or until all is lost.
  XrResult waitFrame(std::unique_lock<std::mutex>& held, XrFrameState& frame);
  XrPosef eyePose(int eye) const;
  XrFovf eyeFov(int eye) const;
  void take(const XrFrameEndInfo& frame);
  void dropSwapchain(Swapchain& chain);
  void dropSession();

  // What exists.
  Handle last_handle = 100;
  std::set<Handle> instances, sessions;
  std::map<Handle, XrReferenceSpaceType> spaces;
  std::map<Handle, Swapchain> swapchains;
  std::deque<XrEventDataBuffer> events;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  bool asked_for_requirements = false;
  bool running = false, frame_begun = false, seen = false;
  int frames_waited_for = 0;
  GLXContext context = nullptr;
  bool plugged_in = true, stage = true;
  std::uint32_t width = 512, height = 512;

 private:
  struct Failure {
    std::string function;
    XrResult result;
    int after, times;
  };
  void losePending();
  std::vector<std::uint8_t> pixelsOf(const XrSwapchainSubImage& of);

  std::mutex mutex_;
  std::condition_variable changed_;
  Pose head_m_;
  double separation_m_ = 0.063;
  FieldOfView sees_[2] = {{-1.0, 0.75, -1.0, 0.9}, {-0.75, 1.0, -1.0, 0.9}};
  double period_ms_ = 11.1, hang_s_ = 0.0;
  bool read_back_ = true, worn_ = true;
  bool instance_lost_ = false, session_lost_ = false, loss_pending_ = false;
  int loss_events_ = 0;
  std::vector<Failure> failures_;
  std::map<std::string, int> calls_;
  std::vector<std::string> violations_;
  int frames_ = 0, frames_with_eyes_ = 0, frames_held_ = 0, repeats_ = 0, most_repeats_ = 0;
  Shown shown_[2];
  std::optional<Screen> screen_;
  std::int64_t last_frame_ns_ = 0;
  int textures_ = 0;
  friend XrResult makeImages(RuntimeState&, Swapchain&, std::int64_t format);
};

RuntimeState& theRuntime();
// The names that `functions` answers.
const std::vector<std::string>& functionNames();

}  // namespace trephine::xr_test
