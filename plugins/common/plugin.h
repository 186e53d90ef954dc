// What every plugin in C++ shares: its side of trephine_device.h. A plugin defines TrephineDevice,
// derived from Opened, and answers the host with Plugin<TrephineDevice>::table(). Checked there,
// for all plugins alike: arguments, the order of the calls, forces that are no numbers, and the
// answer to safe_stop; and what a plugin throws becomes a code and a sentence.
//
// A TrephineDevice has
//   static constexpr const char* kName, *kArm;        the plugin, and what it calls one of its arms
//   static constexpr std::uint32_t kMostArms;         that are opened together
//   static std::vector<Found> find();                 the arms there now, of a type of its own
//   static void describe(const Found&, TrephineArmInfo&);
//   explicit TrephineDevice(const std::vector<Found>& arms);   opens them
//   std::size_t size() const;
//   void configure(const char* json);                 not while it runs; strong: all or nothing
//   void capabilities(std::size_t arm, TrephineCapabilities&);   configured; all of it is 0
//   void calibrate(std::size_t arm);                  configured
//   void start(); void stop();                        stop() also after a start() that threw
// and, on the haptic thread, where nothing may throw, allocate or block, which answer TREPHINE_OK
// or with fail():
//   int read(double dt_s, TrephineArmState* states);  see element()
//   int command(const Forces& forces_N);
// Where it has them also
//   bool waitForOther(double timeout_s);              a sample that read() has not given; it blocks
//   int setTarget(std::size_t arm, const double position_m[3], const double orientation[4],
//                 double hand_k, double hand_b);
//   void sendNow();                                   any thread: safe_stop was asked for
#pragma once

#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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

inline std::int64_t now_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

// At most as long as the field is.
template <std::size_t kRoom>
void copyText(char (&to)[kRoom], const std::string& text) {
  std::snprintf(to, kRoom, "%s", text.c_str());
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

// Thrown where a call beside the haptic thread is refused.
struct Refused {
  int code;  // TREPHINE_ERROR_*
  std::string sentence;
};

// Of each arm: none (null) where what the host commands is no number.
constexpr std::size_t kMostArmsOfAll = 8;
using Forces = std::array<const double*, kMostArmsOfAll>;

template <class Device>
class Plugin {
 public:
  // The answer to a host of that version: null where it is not ours.
  static const TrephineDeviceApi* table(std::uint32_t host_abi) {
    static_assert(Device::kMostArms <= kMostArmsOfAll);
    static constexpr TrephineDeviceApi kApi = {sizeof(TrephineDeviceApi),
                                               TREPHINE_DEVICE_ABI,
                                               Device::kName,
                                               enumerate,
                                               open,
                                               configure,
                                               capabilities,
                                               calibrate,
                                               start,
                                               read,
                                               write,
                                               kWait,
                                               kSetTarget,
                                               stop,
                                               safeStop,
                                               lastError,
                                               close};
    return host_abi == TREPHINE_DEVICE_ABI ? &kApi : nullptr;
  }

 private:
  inline static thread_local Opened nobody;  // says what calls without a device have to say

  // What `call` throws is said by `by`.
  template <class Call>
  static int guarded(Opened* by, Call call) {
    try {
      call();
      return TREPHINE_OK;
    } catch (Refused& refused) {
      by->said = std::move(refused.sentence);
      return fail(by, refused.code, by->said.c_str());
    } catch (const std::bad_alloc&) {
      return fail(by, TREPHINE_ERROR_DEVICE, "There is no memory for the arms.");
    } catch (const std::exception&) {
      return fail(by, TREPHINE_ERROR_DEVICE, "The device's plugin has failed: start it anew.");
    }
  }

  static std::uint32_t enumerate(TrephineArmInfo* infos, std::uint32_t capacity) {
    std::uint32_t count = 0;
    nobody.error = "";
    guarded(&nobody, [&] {
      const auto found = Device::find();
      if (infos && infos->size >= sizeof(TrephineArmInfo)) {
        for (std::uint32_t i = 0; i < capacity && i < found.size(); ++i) {
          Device::describe(found[i], *element(infos, i));
        }
      }
      count = std::uint32_t(found.size());
    });
    return count;
  }

  static int open(const std::uint32_t* places, std::uint32_t n_arms, Device** device) {
    if (!device) return TREPHINE_ERROR_ARGUMENT;
    *device = nullptr;
    nobody.error = "";
    return guarded(&nobody, [&] {
      const std::string arm = Device::kArm;
      if (!places || n_arms == 0 || n_arms > Device::kMostArms) {
        throw Refused{TREPHINE_ERROR_ARGUMENT,
                      "'" + std::string(Device::kName) + "' opens one to " +
                          std::to_string(Device::kMostArms) + " arms together."};
      }
      const auto found = Device::find();
      auto chosen = found;
      chosen.clear();
      for (std::uint32_t i = 0; i < n_arms; ++i) {
        const std::string number = std::to_string(places[i]);
        if (places[i] >= found.size()) {
          throw Refused{TREPHINE_ERROR_NO_DEVICE, "There is no " + arm + " " + number + " of " +
                                                      std::to_string(found.size()) +
                                                      ", counted from 0."};
        }
        if (std::count(places, places + i, places[i]) > 0) {
          throw Refused{TREPHINE_ERROR_ARGUMENT,
                        "The " + arm + " " + number + " is asked for twice."};
        }
        chosen.push_back(found[places[i]]);
      }
      *device = new Device(chosen);
    });
  }

  static int configure(Device* device, const char* json) {
    if (!device || !json) return TREPHINE_ERROR_ARGUMENT;
    if (device->running) {
      return fail(device, TREPHINE_ERROR_STATE,
                  "The arms are running: stop them to configure them.");
    }
    return guarded(device, [&] {
      device->configure(json);
      device->configured = true;
    });
  }

  static int checkArm(Device* device, std::uint32_t arm) {
    if (arm >= device->size()) {
      return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
    }
    if (device->configured) return TREPHINE_OK;
    return fail(device, TREPHINE_ERROR_STATE, "The arms have no configuration yet.");
  }

  static int capabilities(Device* device, std::uint32_t arm, TrephineCapabilities* out) {
    if (!device || !out || out->size < sizeof(TrephineCapabilities)) return TREPHINE_ERROR_ARGUMENT;
    if (const int refused = checkArm(device, arm)) return refused;
    return guarded(device, [&] {
      TrephineCapabilities able{};
      device->capabilities(arm, able);
      able.size = out->size;
      able.version = out->version;
      *out = able;
    });
  }

  static int calibrate(Device* device, std::uint32_t arm) {
    if (!device) return TREPHINE_ERROR_ARGUMENT;
    if (const int refused = checkArm(device, arm)) return refused;
    return guarded(device, [&] { device->calibrate(arm); });
  }

  static int start(Device* device) {
    if (!device) return TREPHINE_ERROR_ARGUMENT;
    if (!device->configured || device->running) {
      return fail(device, TREPHINE_ERROR_STATE,
                  device->running ? "The arms are already running."
                                  : "The arms have no configuration yet.");
    }
    device->silence.answer(device->silence.asked());
    const int started = guarded(device, [&] { device->start(); });
    device->running = started == TREPHINE_OK;
    if (!device->running) device->stop();
    return started;
  }

  // What an exchange with this array begins with: TREPHINE_OK, or why it is refused.
  template <class T>
  static int beginExchange(Device* device, const T* first) {
    if (!device) return TREPHINE_ERROR_ARGUMENT;
    if (!first || first->size < sizeof(T)) {
      return fail(device, TREPHINE_ERROR_ARGUMENT, "The states or commands have no valid size.");
    }
    if (device->running) return TREPHINE_OK;
    return fail(device, TREPHINE_ERROR_STATE, "The arms are not running: start them.");
  }

  static int read(Device* device, double dt_s, TrephineArmState* states) {
    if (const int refused = beginExchange(device, states)) return refused;
    return device->read(dt_s, states);
  }

  static int write(Device* device, const TrephineArmCommand* commands) {
    // What was commanded before a silence was asked for is no answer to it.
    const std::uint32_t silences = device ? device->silence.asked() : 0;
    if (const int refused = beginExchange(device, commands)) return refused;
    Forces forces_N{};
    bool whole = true, none = true;
    for (std::size_t i = 0; i < device->size(); ++i) {
      const double* force_N = element(commands, i)->force_N;
      if (finite(force_N, 3)) forces_N[i] = force_N;
      whole = whole && forces_N[i];
      none = none && std::all_of(force_N, force_N + 3, [](double along) { return along == 0.0; });
    }
    if (const int code = device->command(forces_N)) return code;
    if (none) device->silence.answer(silences);
    if (whole) return TREPHINE_OK;
    return fail(device, TREPHINE_ERROR_ARGUMENT,
                "A commanded force was not finite: that arm got none.");
  }

  static int wait(Device* device, double timeout_s) {
    if (!device || !device->running || !(timeout_s >= 0.0)) return TREPHINE_ERROR_ARGUMENT;
    return device->waitForOther(std::min(timeout_s, 1.0)) ? TREPHINE_OK : TREPHINE_ERROR_TIMEOUT;
  }
  static constexpr auto kWait = [] {
    if constexpr (requires(Device device) { device.waitForOther(0.0); }) {
      return &wait;
    } else {
      return nullptr;  // the host paces them
    }
  }();

  static int setTarget(Device* device, std::uint32_t arm, const double position_m[3],
                       const double orientation[4], double hand_k, double hand_b) {
    if (!device || !position_m || !orientation) return TREPHINE_ERROR_ARGUMENT;
    if (arm >= device->size()) {
      return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
    }
    return device->setTarget(arm, position_m, orientation, hand_k, hand_b);
  }
  static constexpr auto kSetTarget = [] {
    if constexpr (requires { &Device::setTarget; }) {
      return &setTarget;
    } else {
      return nullptr;  // no simulated hand
    }
  }();

  static int stop(Device* device) {
    if (!device) return TREPHINE_ERROR_ARGUMENT;
    device->running = false;
    device->stop();
    return TREPHINE_OK;
  }

  static void safeStop(Device* device) {
    if (!device) return;
    device->silence.ask();
    if constexpr (requires { &Device::sendNow; }) device->sendNow();
  }

  static const char* lastError(Device* device) {
    return device ? device->error : nobody.error;
  }

  static void close(Device* device) {
    if (device) stop(device);
    delete device;
  }
};

}  // namespace trephine::plugin
