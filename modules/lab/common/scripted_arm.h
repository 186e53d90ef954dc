// An arm that answers from a script, through the real host of devices: for measurements that
// prescribe where it is.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/math.h"
#include "device/device.h"

namespace trephine {

class ScriptedArm {
 public:
  // What it answers in one exchange.
  struct Sample {
    Vec3 position_m{0.0};
    Quat orientation{1, 0, 0, 0};
    std::int64_t time_ns = 0;
    std::uint32_t flags = TREPHINE_ARM_CALIBRATED;
    std::uint32_t buttons = 0;
    int answer = TREPHINE_OK;
  };
  // Of an exchange, counted from 0. Haptic thread: no allocation.
  using Script = std::function<Sample(int exchange)>;

  // `exchanges`: room for what it is commanded in so many.
  ScriptedArm(Script script, const TrephineCapabilities& capabilities, std::size_t exchanges);
  // It outlives the device.
  Result<std::unique_ptr<Device>> open();

  const std::vector<Vec3>& commanded_N() const { return commanded_N_; }

 private:
  friend struct ScriptedArmApi;
  Script script_;
  TrephineCapabilities capabilities_;
  std::vector<Vec3> commanded_N_;
};

// An Omni's.
TrephineCapabilities omniCapabilities();

}  // namespace trephine
