// Takes the force away when the haptic thread stands still: in a call of a device that does not
// return, or off the processor. Real time only.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "haptics/haptic_loop.h"

namespace trephine {

// When a count stands still. Pure: counts and times [ns] in, one answer a standstill.
class Standstill {
 public:
  static constexpr std::int64_t kAllowed_ns = 20'000'000;
  // True once for a `count` that has been the same for 20 ms. `counting` false: nothing is due.
  bool begins(std::uint64_t count, bool counting, std::int64_t now_ns);
  // Since when it stands still, 20 ms or more ago; 0 while it goes on.
  std::int64_t since_ns() const { return said_ ? since_ns_ : 0; }

 private:
  std::uint64_t count_ = 0;
  std::int64_t since_ns_ = 0;
  bool counting_ = false;
  bool said_ = false;
};

class Watchdog {
 public:
  explicit Watchdog(HapticLoop& loop) : loop_(loop) {}

  // The watchdog's thread, until end(): looks every 2 ms.
  void run();
  void end();
  // Any thread: zero force at once, by way of the watchdog's thread, so that a plugin whose
  // safe_stop blocks holds nobody else up. False when that took longer than `patience`.
  bool silence(std::chrono::milliseconds patience);
  // How long the ticks have stood still [s]; 0 while they go on. Any thread.
  double stillFor_s() const;

 private:
  HapticLoop& loop_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false, asked_ = false, silenced_ = false;
  std::atomic<std::int64_t> still_since_ns_{0};  // 0: the ticks go on
};

}  // namespace trephine
