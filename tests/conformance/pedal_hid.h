// A foot switch and SpaceMice, emulated: their descriptors and what they send.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hid_testbed.h"

namespace trephine::test {

// VEC Infinity: three switches and padding, no report id.
HidDescription footSwitch();
// The wired one sends three axes in each of two reports, the wireless one all six in one. Both have
// a second collection, which is none of axes.
HidDescription spaceMouse(bool wireless);

// A push along and a turn about the cap's own axes: right, towards the user, down.
using CapAxes = std::array<std::int16_t, 6>;

// What a cap's firmware does, on its end of a node: it repeats how the cap is held every 8 ms, and
// says once that it is at rest. Ends before that end is closed.
class CapFirmware {
 public:
  CapFirmware(int fd, bool wireless) : fd_(fd), wireless_(wireless), thread_([this] { run(); }) {}
  ~CapFirmware() { end(); }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void hold(const CapAxes& axes) {
    std::lock_guard lock(mutex_);
    axes_ = axes;
    said_ = false;
  }
  void release() { hold({}); }
  // No more reports, as if the cap were still held so.
  void fallSilent() { silent_ = true; }
  // Reports of random bytes without end, in place of those.
  void sendGarbage() { garbage_ = true; }
  void press(std::uint8_t buttons) { send({3, buttons, 0}); }
  // Bytes as they are.
  void send(const std::vector<std::uint8_t>& bytes);

 private:
  void run();

  int fd_;
  bool wireless_;
  std::mutex mutex_;
  CapAxes axes_{};
  bool said_ = true;  // that it is at rest
  std::atomic<bool> silent_{false}, garbage_{false}, ending_{false};
  std::thread thread_;
};

// The host's ticks beside such devices, which say in their own time how they are held: one in every
// millisecond.
class HostTicks {
 public:
  void begin() { next_ = std::chrono::steady_clock::now(); }
  void await();

 private:
  std::chrono::steady_clock::time_point next_;
};

// This thread runs with that priority, where the system allows it; 0: as any other.
void inRealTime(int priority);

}  // namespace trephine::test
