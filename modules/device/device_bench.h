// What emulates devices for a measurement: it plugs them in, into hands that move them, takes them
// out again, and knows what arrived at them. A library of its own, outside of the product.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

// An `arm` is its place in the plugin's enumeration.
class DeviceBench {
 public:
  virtual ~DeviceBench() = default;
  virtual const char* plugin() const = 0;
  // Two arms, anew, in hands that swing them. False where that did not work.
  virtual bool plugIn() = 0;
  virtual void unplug(std::uint32_t arm) = 0;
  // For so long the devices answer no call that gives them something; it returns at once.
  virtual void block(double seconds) = 0;
  // The size of the force that an arm has now [N].
  virtual double force_N(std::uint32_t arm) = 0;
  // What an arm was given and gave since it was plugged in, by the monotonic clock, in order; empty
  // where the bench does not tell. Forces in the host's frame, as the motors gave them.
  struct Given {
    std::int64_t at_ns = 0;
    Vec3 force_N{0.0};
  };
  virtual std::vector<Given> given(std::uint32_t) { return {}; }
  virtual std::vector<std::int64_t> samples_ns(std::uint32_t) { return {}; }
  // How far a force of given() may be from what was sent: rounding, and the arm's way meanwhile.
  virtual double tolerance_N() const { return 1e-9; }
  // Samples that found no room on their way, since they were plugged in.
  virtual std::optional<std::uint64_t> lost() { return {}; }
};

// Of a library that exports `extern "C" DeviceBench* trephine_device_bench()`; it stays loaded, and
// the bench is its own: nobody deletes it. Error: NO_BENCH.
Result<DeviceBench*> loadDeviceBench(const std::filesystem::path& library);

}  // namespace trephine
