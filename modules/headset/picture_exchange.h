// Pictures on their way from the window's thread, which draws them, to the headset's, which shows
// them. Neither waits for the other: a request that is not answered in time is replaced by the
// next, and a picture that was not shown by a newer one. OpenGL objects are passed by name, with
// fences.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "base/eye_view.h"

namespace trephine {

// Of the monotonic clock, as all times here are.
inline std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

struct PictureRequest {
  enum class Of { eyes, panel };
  std::uint64_t number = 0;
  Of of = Of::eyes;
  Eyes eyes_m{};              // in the room
  int width = 0, height = 0;  // of each eye's picture
  std::int64_t asked_ns = 0;  // monotonic clock
};

// Two textures of the window's share group, or one of the panel.
struct SharedPicture {
  PictureRequest request;
  std::array<unsigned int, 2> textures{};
  int width = 0, height = 0;     // of the textures
  std::int64_t finished_ns = 0;  // monotonic clock
  void* drawn = nullptr;         // GLsync of the window, for the headset to wait for and delete
  void* read = nullptr;          // GLsync of the headset, likewise for the window
};

class PictureExchange {
 public:
  // ---- The headset's thread.
  void ask(const PictureRequest& request);
  // The newest picture of this kind that is drawn; waits at most so long for that of this number.
  SharedPicture* take(PictureRequest::Of kind, std::uint64_t number,
                      std::chrono::microseconds patience);
  void giveBack(SharedPicture& picture);
  void cancelWaiting();  // any thread: take() returns at once from now on

  // ---- The window's thread.
  // The newest request, once.
  std::optional<PictureRequest> asked();
  // One to draw into, that has held such a picture before where there is one; null while the
  // headset holds all of them.
  SharedPicture* begin(PictureRequest::Of kind);
  void finish(SharedPicture& picture, const PictureRequest& request, void* drawn);
  void giveUp(SharedPicture& picture);  // not drawn after all
  // Once the headset's thread has ended.
  std::array<SharedPicture, 4>& all() { return pictures_; }

 private:
  enum class State { free, drawing, ready, shown };
  SharedPicture* newest(PictureRequest::Of kind);
  State& stateOf(const SharedPicture& picture) {
    return states_[std::size_t(&picture - pictures_.data())];
  }

  std::mutex mutex_;
  std::condition_variable drawn_;
  std::optional<PictureRequest> request_;
  // One of each kind is shown, one ready, one drawn into.
  std::array<SharedPicture, 4> pictures_{};
  std::array<State, 4> states_{};
  bool cancelled_ = false;
};

}  // namespace trephine
