// A libHD.so of our own: the maker's functions, two arms that stand still, and a scheduler thread
// of 1 kHz. The plugin opens it as it would the maker's.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "hd_test.h"

#define HD_EXPORT extern "C" __attribute__((visibility("default")))

namespace {

using trephine::test::HdTest;

struct ErrorInfo {
  std::uint32_t code;
  int internal;
  std::uint32_t device;
};

HdTest test;
thread_local std::uint32_t current = 0xFFFFFFFF;
std::array<bool, 2> initialised{}, in_frame{};
std::array<std::array<double, 3>, 2> pending_N{};
std::vector<ErrorInfo> errors;  // of the thread that has the frame
std::uint32_t (*callback)(void*) = nullptr;
void* user = nullptr;
std::atomic<bool> running{false};
// A program may end with it at work.
struct Scheduler {
  std::thread thread;
  ~Scheduler() {
    running = false;
    if (thread.joinable()) thread.detach();
  }
} scheduler;

bool known(std::uint32_t device) {
  const bool is = device < 2 && initialised[device];
  if (!is) ++test.misuses;
  return is;
}

void schedule() {
  auto due = std::chrono::steady_clock::now();
  while (running) {
    due += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(due);  // the device's own clock
    if (std::chrono::steady_clock::now() - due > std::chrono::milliseconds(20)) {
      due = std::chrono::steady_clock::now();
    }
    if (!test.silent && callback) callback(user);
  }
}

}  // namespace

HD_EXPORT HdTest* trephine_hd_test() {
  return &test;
}

HD_EXPORT std::uint32_t hdInitDevice(const char* name) {
  const std::string asked = name ? name : "Left Device";
  for (std::uint32_t i = 0; i < 2; ++i) {
    if (asked != (i == 0 ? "Left Device" : "Right Device")) continue;
    if (!test.arms[i].there) {
      errors.push_back({0x0302, 0, i});
      return 0xFFFFFFFF;
    }
    initialised[i] = true;
    current = i;
    return i;
  }
  errors.push_back({0x0303, 0, 0xFFFFFFFF});
  return 0xFFFFFFFF;
}
HD_EXPORT void hdDisableDevice(std::uint32_t device) {
  if (known(device)) initialised[device] = false;
}
HD_EXPORT void hdMakeCurrentDevice(std::uint32_t device) {
  if (known(device)) current = device;
}
HD_EXPORT std::uint32_t hdGetCurrentDevice() {
  return current;
}
HD_EXPORT void hdBeginFrame(std::uint32_t device) {
  if (!known(device)) return;
  current = device;
  in_frame[device] = true;
  pending_N[device] = {};
  auto& arm = test.arms[device];
  if (arm.errors > 0) {
    --arm.errors;
    arm.error_frame = test.frames.load();
    errors.push_back({arm.error, 0, device});
  }
}
HD_EXPORT void hdEndFrame(std::uint32_t device) {
  if (!known(device)) return;
  if (const double block_s = test.block_s.exchange(0.0); block_s > 0.0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(block_s));  // the device's own clock
  }
  in_frame[device] = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    test.arms[device].force_N[axis] = test.arms[device].enabled ? pending_N[device][axis] : 0.0;
  }
  const auto& f = test.arms[device].force_N;
  const std::size_t frame = test.frames % trephine::test::HdArm::kFrames;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    test.arms[device].vector_N[frame][axis] = f[axis].load();
  }
  test.arms[device].sent_ns[frame] = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                         std::chrono::steady_clock::now().time_since_epoch())
                                         .count();
  test.arms[device].sent_N[test.frames % trephine::test::HdArm::kFrames] =
      std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  if (device == 0) ++test.frames;
}
HD_EXPORT void hdEnable(std::uint32_t what) {
  if (what == 0x4000 && known(current)) test.arms[current].enabled = true;
}
// What the motors have stays until the next frame.
HD_EXPORT void hdDisable(std::uint32_t what) {
  if (what == 0x4000 && known(current)) test.arms[current].enabled = false;
}
HD_EXPORT void hdGetIntegerv(std::uint32_t what, int* out) {
  *out = what == 0x2000 && current < 2 ? test.arms[current].buttons.load()
         : what == 0x2553              ? 6
         : what == 0x2555              ? test.styles.load()
                                       : 0;
}
HD_EXPORT void hdGetBooleanv(std::uint32_t what, std::uint8_t* out) {
  *out = what == 0x2002 && current < 2 && test.arms[current].in_holder;
}
HD_EXPORT void hdGetDoublev(std::uint32_t what, double* out) {
  const double turn = 0.3;
  const double transform[16] = {std::cos(turn), 0.0, -std::sin(turn), 0.0, 0.0, 1.0,  0.0,  0.0,
                                std::sin(turn), 0.0, std::cos(turn),  0.0, 5.0, 10.0, -3.0, 1.0};
  const double box[6] = {-80.0, -60.0, -35.0, 80.0, 60.0, 35.0};
  switch (what) {
    case 0x2052:
      if (!known(current) || !in_frame[current]) ++test.misuses;
      std::memcpy(out, transform, sizeof(transform));
      out[14] += (test.swing_mm + (current < 2 ? test.arms[current].swing_mm.load() : 0.0)) *
                 std::sin(2.0 * 3.14159265358979 * double(test.frames % 1000) / 1000.0);
      if (test.no_numbers) out[12] = std::nan("");
      break;
    case 0x2551:
      std::memcpy(out, box, sizeof(box));
      break;
    case 0x2603:
      *out = 3.3;
      break;
    case 0x2604:
      *out = 0.88;
      break;
    default:
      *out = 0.0;
  }
}
HD_EXPORT void hdSetDoublev(std::uint32_t what, const double* in) {
  if (what != 0x2700 || !known(current) || !in_frame[current]) {
    ++test.misuses;
    return;
  }
  std::memcpy(pending_N[current].data(), in, sizeof(pending_N[current]));
}
HD_EXPORT ErrorInfo hdGetError() {
  if (errors.empty()) return {0, 0, 0xFFFFFFFF};
  const ErrorInfo first = errors.front();
  errors.erase(errors.begin());
  return first;
}
HD_EXPORT const char* hdGetErrorString(std::uint32_t code) {
  return code == 0x0302 ? "communication error" : code == 0x0303 ? "no such device" : "an error";
}
HD_EXPORT std::uint32_t hdCheckCalibration() {
  return known(current) ? test.arms[current].calibration.load() : 0x5002;
}
HD_EXPORT void hdUpdateCalibration(std::uint32_t style) {
  test.style_used = int(style);
  if (known(current) && test.arms[current].calibration == 0x5001) {
    test.arms[current].calibration = 0x5000;
  }
}
HD_EXPORT void hdSetSchedulerRate(unsigned long) {}
HD_EXPORT void hdStartScheduler() {
  running = true;
  scheduler.thread = std::thread(schedule);
}
HD_EXPORT void hdStopScheduler() {
  running = false;
  if (scheduler.thread.joinable()) scheduler.thread.join();
}
#ifndef HD_LACKS_SCHEDULE
HD_EXPORT unsigned long hdScheduleAsynchronous(std::uint32_t (*called)(void*), void* with,
                                               std::uint16_t) {
  user = with;
  callback = called;
  return 1;
}
#endif
HD_EXPORT void hdUnschedule(unsigned long) {
  callback = nullptr;
}
