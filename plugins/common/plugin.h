// What every plugin in C++ needs of the interface: arrays of the host's sizes, forces that are
// numbers, the host's clock, whether safe_stop has been answered, and when an exchange is refused.
#pragma once

#include <time.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "trephine_device.h"

namespace trephine::plugin {

// Element i of an array whose elements have the size that the host wrote into the first.
template <class T>
T* element(T* first, std::size_t i) {
  using Byte = std::conditional_t<std::is_const_v<T>, const char, char>;
  return reinterpret_cast<T*>(reinterpret_cast<Byte*>(first) + i * first->size);
}

inline bool finite(const double* values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) return false;
  }
  return true;
}

// Zero force for every arm: what answers a safe_stop.
inline bool commandsNothing(const TrephineArmCommand* commands, std::size_t arms) {
  for (std::size_t i = 0; i < arms; ++i) {
    for (double along : element(commands, i)->force_N) {
      if (along != 0.0) return false;
    }
  }
  return true;
}

inline std::int64_t now_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

// Whether the host has asked for no force (safe_stop) and not yet answered that it knows.
class Silence {
 public:
  void ask() { asked_.fetch_add(1); }  // any thread
  bool holds() const { return asked_ != answered_; }
  std::uint32_t asked() const { return asked_; }
  // With what asked() was before the command that answers it.
  void answer(std::uint32_t asked) { answered_ = asked; }

 private:
  std::atomic<std::uint32_t> asked_{0}, answered_{0};
};

// What every open device has.
struct Opened {
  Silence silence;
  bool configured = false, running = false;
  std::string said;        // of calls beside the haptic thread
  const char* error = "";  // a literal or `said`: set without allocation
};

inline int fail(Opened* device, int code, const char* sentence) {
  device->error = sentence;
  return code;
}

inline int failWith(Opened* device, int code, std::string sentence) {
  device->said = std::move(sentence);
  return fail(device, code, device->said.c_str());
}

// What a read or a write with this array begins with: TREPHINE_OK, or why it is refused.
template <class T>
int beginExchange(Opened* device, const T* first) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (!first || first->size < sizeof(T)) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "The states or commands have no valid size.");
  }
  if (device->running) return TREPHINE_OK;
  return fail(device, TREPHINE_ERROR_STATE, "The arms are not running: start them.");
}

// What a write ends with: `silences` were asked for when it began, since what was commanded before
// one is no answer to it.
inline int endWrite(Opened* device, std::uint32_t silences, const TrephineArmCommand* commands,
                    std::size_t arms, bool refused) {
  if (commandsNothing(commands, arms)) device->silence.answer(silences);
  if (!refused) return TREPHINE_OK;
  return fail(device, TREPHINE_ERROR_ARGUMENT,
              "A commanded force was not finite: that arm got none.");
}

}  // namespace trephine::plugin
