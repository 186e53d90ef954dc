// The firmware of a WoodenHaptics board, emulated: a report in every millisecond, motors that begin
// with the first report out and stop after half a second without one, currents clamped at 3 A.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hid_testbed.h"

namespace trephine::test {

inline HidDescription woodenBoard() {
  return {0x1234, 0x0006, "WoodenHaptics", "1", plainDescriptor(0xFFAB, 0x0200, 8, 8)};
}

class WoodenFirmware {
 public:
  using Clock = std::chrono::steady_clock;
  enum class State { runs, silent, garbage };

  // On the firmware's end of a node; ends before that is closed.
  explicit WoodenFirmware(int fd) : fd_(neverWaits(fd)), thread_([this] { run(); }) {}
  ~WoodenFirmware() { end(); }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }

  void setCounts(const std::array<std::int16_t, 3>& counts) {
    std::lock_guard lock(mutex_);
    counts_ = counts;
  }
  void setState(State state) { state_ = state; }
  // What the motors have now [mA].
  std::array<std::int16_t, 3> milliamps() const {
    std::lock_guard lock(mutex_);
    return milliamps_;
  }
  // Since the first report out [s]; negative before it.
  double since_s() const {
    std::lock_guard lock(mutex_);
    return first_out_ ? std::chrono::duration<double>(Clock::now() - *first_out_).count() : -1.0;
  }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t lost() const { return lost_; }  // found no room in a node that is open
  // What the motors were told, and when each report in was sent.
  struct Told {
    Clock::time_point at;
    std::array<std::int16_t, 3> milliamps;
  };
  std::vector<Told> told() const {
    std::lock_guard lock(mutex_);
    return told_;
  }
  std::vector<Clock::time_point> reportsSent() const {
    std::lock_guard lock(mutex_);
    return reports_;
  }
  // From each report in to the first report out that came after it [us].
  std::vector<double> answers_us() const {
    std::lock_guard lock(mutex_);
    return answers_us_;
  }

 private:
  static int neverWaits(int fd);
  void run();
  void take(const std::uint8_t* report);
  bool hasRoom(Clock::time_point now) const;

  int fd_;
  mutable std::mutex mutex_;
  std::array<std::int16_t, 3> counts_{}, milliamps_{};
  std::optional<Clock::time_point> first_out_, last_out_, unanswered_;
  std::vector<double> answers_us_;
  std::vector<Told> told_;
  std::vector<Clock::time_point> reports_;
  std::vector<std::uint8_t> rest_;  // of a report in
  std::vector<std::uint8_t> out_;   // bytes of reports out: the node does not keep them apart
  std::atomic<State> state_{State::runs};
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> sent_{0}, lost_{0};
  std::thread thread_;
};

}  // namespace trephine::test
