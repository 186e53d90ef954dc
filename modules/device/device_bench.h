// What emulates devices for a measurement: it plugs them in, into hands that move them, takes them
// out again, and knows what arrived at them. A library of its own, outside of the product.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/result.h"

namespace trephine {

class DeviceBench {
 public:
  virtual ~DeviceBench() = default;
  virtual const char* plugin() const = 0;
  // Two arms, anew, in hands that swing them. False where that did not work.
  virtual bool plugIn() = 0;
  virtual void unplug(std::uint32_t arm) = 0;
  // For so long the devices answer no call that gives them something.
  virtual void block(double seconds) = 0;
  // The size of the force that an arm has now [N].
  virtual double force_N(std::uint32_t arm) = 0;
  // From each sample at the arms to the force that answered it there, since they were plugged in
  // [ms]; empty where it does not tell.
  virtual std::vector<double> answers_ms() { return {}; }
  // The size of the force that an arm got, sample by sample since it was plugged in; empty where it
  // does not tell.
  virtual std::vector<double> received_N(std::uint32_t) { return {}; }
  // Samples that found no room on their way, since they were plugged in.
  virtual std::optional<std::uint64_t> lost() { return {}; }
};

// Of a library that exports `DeviceBench* trephine_device_bench()`; it stays loaded. Error:
// NO_BENCH.
Result<DeviceBench*> loadDeviceBench(const std::filesystem::path& library);

}  // namespace trephine
