// An OpenXR runtime without a headset (libtrephine_openxr_test.so), as tests and measurements
// script it and look into it. The real loader finds it through its manifest (XR_RUNTIME_JSON).
// Whoever holds one loads it before OpenXR does: the loader unloads it with the last instance, and
// its state would go with it. Every method may be called from any thread.
//
// It is strict where real runtimes crash later: a call that needs the session's OpenGL context to
// be current in its thread is refused where it is not, and counts as a violation, like calls that
// come out of order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/eye_view.h"
#include "base/result.h"

namespace trephine {

class TestRuntime {
 public:
  virtual ~TestRuntime() = default;

  // ---- What it does from now on.
  // All as it was when it was loaded, and nothing counted.
  virtual void reset() = 0;
  virtual void setHead(const Pose& room_m) = 0;
  virtual void setEyes(double separation_m, const FieldOfView& left, const FieldOfView& right) = 0;
  virtual void setPeriod(double ms) = 0;                                // of frames
  virtual void setSize(std::uint32_t width, std::uint32_t height) = 0;  // of an eye, recommended
  virtual void setPluggedIn(bool plugged_in) = 0;
  virtual void setReadBack(bool on) = 0;  // of what frames show
  virtual void setStage(bool known) = 0;  // the room's own frame, or only where it was put on
  // Its frame, or that of where it was put on, lies elsewhere from now on.
  virtual void moveRoom(bool of_stage) = 0;
  // Each call of this function ("*": of any) gives this XrResult, `times` of them (negative: for
  // good), after `after` more that go well.
  virtual void fail(const std::string& function, int result, int after, int times) = 0;
  // The next xrWaitFrame lasts so long, and then fails.
  virtual void hang(double seconds) = 0;
  enum class Loss {
    instance,  // calls give XR_ERROR_INSTANCE_LOST
    session,   // calls give XR_ERROR_SESSION_LOST
    pending,   // calls give XR_SESSION_LOSS_PENDING, which is no error, and then go on
    event      // the state LOSS_PENDING, EXITING or a loss of the instance, in turns
  };
  virtual void lose(Loss loss) = 0;
  // The headset is taken off, or put on again.
  virtual void setWorn(bool worn) = 0;

  // ---- What it was given.
  struct Shown {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // rows go up; empty unless read back
    EyeView view;                    // with which it was shown, in the room, in metres
  };
  virtual Shown shown(int eye) = 0;  // of the last frame with a picture for each eye
  struct Screen {                    // a flat one in the room
    Pose pose_m;
    double width_m = 0.0, height_m = 0.0;
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  virtual std::optional<Screen> screen() = 0;  // of the last frame, where it has one
  virtual int frames() = 0;                    // all of them
  virtual int framesWithEyes() = 0;
  // Of these, the most in a row after the first that showed a pair with the poses of the one before
  // while the eyes were elsewhere.
  virtual int mostRepeats() = 0;
  virtual int framesHeld() = 0;  // with a flat picture in the room for each eye
  virtual int calls(const std::string& function) = 0;
  virtual std::vector<std::string> functions() = 0;  // which it has

  struct Alive {
    int instances = 0, sessions = 0, swapchains = 0, spaces = 0, textures = 0;
    bool any() const { return instances + sessions + swapchains + spaces + textures != 0; }
  };
  virtual Alive alive() = 0;
  virtual std::vector<std::string> violations() = 0;
};

// Of a library that exports `TestRuntime* trephine_xr_test_runtime()`; it stays loaded. Error:
// NO_RUNTIME.
Result<TestRuntime*> loadTestRuntime(const std::filesystem::path& library);

}  // namespace trephine
