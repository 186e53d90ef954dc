// All of a headset's time from the instance to the end of it, in its own thread, with its OpenGL
// context current. Whatever goes wrong, what was made is destroyed again, children first.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>

#include "headset/headset.h"

class QOpenGLExtraFunctions;

namespace trephine {

// What the two threads share beside pictures.
struct HeadsetShared {
  HeadsetOptions options;
  std::function<void()> wake;
  PictureExchange pictures;
  std::atomic<bool> stop{false}, abandoned{false};
  std::atomic<std::int64_t> in_call_since_ns{0};  // of OpenXR; 0: in none

  void tell(const HeadsetState& state) {
    std::lock_guard lock(mutex);
    now = state;
  }
  std::mutex mutex;
  HeadsetState now;                // guarded by it
  std::optional<HeadsetEnd> over;  // likewise
};

HeadsetEnd runOpenXr(HeadsetShared& shared, QOpenGLExtraFunctions& gl);

}  // namespace trephine
