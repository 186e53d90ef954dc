// A thread that a call of foreign code (an arm's plugin, the software of a headset) may hold for
// ever: it is waited for with patience, and then left behind with what it owns.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

namespace trephine::rt {

class AbandonableThread {
 public:
  AbandonableThread() = default;  // no thread: it has ended
  // Runs `work`, which shares the ownership of all that it uses: once it is left behind, its owner
  // may be gone before it. To be ended before it is destroyed. Errors: as std::thread's.
  template <class Work>
  requires(!std::is_same_v<Work, AbandonableThread>) explicit AbandonableThread(Work work)
      : thread_([ending = ending_, work = std::move(work)]() mutable {
          work();
          std::lock_guard lock(ending->mutex);
          ending->ended = true;
          ending->changed.notify_all();
        }) {}

  // Waits until the work has ended, which is a false or empty answer: nothing of it is left then.
  // From `patience` on it asks `held` every 5 ms whether a call holds the thread; with its first
  // answer that is true the thread is left behind, and that is the answer. The owner's thread.
  template <class Held>
  std::invoke_result_t<Held&> end(std::chrono::milliseconds patience, Held held) {
    if (!thread_.joinable()) return {};
    std::invoke_result_t<Held&> by{};
    bool ended = endsWithin(patience);
    while (!ended && !(by = held())) ended = endsWithin(std::chrono::milliseconds(5));
    if (ended) {
      thread_.join();
    } else {
      thread_.detach();
    }
    return by;
  }

 private:
  struct Ending {
    std::mutex mutex;
    std::condition_variable changed;
    bool ended = false;
  };
  bool endsWithin(std::chrono::milliseconds patience) {
    std::unique_lock lock(ending_->mutex);
    return ending_->changed.wait_for(lock, patience, [this] { return ending_->ended; });
  }

  std::shared_ptr<Ending> ending_ = std::make_shared<Ending>();  // the thread's too
  std::thread thread_;
};

}  // namespace trephine::rt
