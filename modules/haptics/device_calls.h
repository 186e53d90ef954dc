// The calls of a thread to its devices. One may never return; the thread can then be left behind in
// it, by another one that takes over what the two share.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

namespace trephine {

class DeviceCalls {
 public:
  // ---- The thread that calls.
  // False when it was left behind in the call: nothing more may be done.
  template <class Call>
  bool make(std::size_t device, Call&& call) {
    at_ = int(device);
    call();
    int expected = int(device);
    return at_.compare_exchange_strong(expected, kNone);
  }

  // ---- Any thread.
  std::optional<std::size_t> at() const {
    const int device = at_;
    return device < 0 ? std::nullopt : std::optional<std::size_t>(device);
  }
  // Visits each of so many devices, the one that is being called last: what is done there may wait
  // for that call.
  template <class Visit>
  void calledLast(std::size_t count, Visit&& visit) const {
    const std::optional<std::size_t> called = at();
    for (std::size_t i = 0; i < count; ++i) {
      if (i != called) visit(i);
    }
    if (called) visit(*called);
  }
  // Leaves the other thread behind if it is in a call: of which device. Nothing where it is
  // elsewhere, and will come to its end.
  std::optional<std::size_t> leaveBehind() {
    int device = at_;
    if (device < 0 || !at_.compare_exchange_strong(device, kLeftBehind)) return {};
    return std::size_t(device);
  }

 private:
  static constexpr int kNone = -1, kLeftBehind = -2;
  std::atomic<int> at_{kNone};
};

}  // namespace trephine
