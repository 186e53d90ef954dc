// What the device tests share: the shipped device file and opened simulated arms.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/json.h"
#include "device/device.h"

namespace trephine::test {

constexpr double kTick_s = 0.001;

inline Json omni() {
  Result<Json> json = readJsonFile(TREPHINE_TEST_OMNI);
  return json ? *json : Json();
}

// The Omni with encoders that read exactly and without friction, for comparison with formulas.
inline Json exactOmni() {
  Json json = omni();
  json["arm"]["encoder_step_m"]["value"] = 0.0;
  json["arm"].erase("friction_N");
  return json;
}

inline std::shared_ptr<const DevicePlugin> simulatedPlugin() {
  auto plugin = DevicePlugin::load("simulated", TREPHINE_TEST_PLUGIN_DIR);
  if (!plugin) {
    ADD_FAILURE() << plugin.error().sentence();
    return nullptr;
  }
  return *plugin;
}

// Simulated arms with what a tick needs; `arms` of them, opened but not started.
struct Bench {
  std::unique_ptr<Device> device;
  std::vector<TrephineArmState> states;
  std::vector<TrephineArmCommand> commands;

  explicit Bench(const Json& config, std::uint32_t arms = 1) : states(arms), commands(arms) {
    auto plugin = simulatedPlugin();
    if (!plugin) return;
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < arms; ++i) places.push_back(i);
    auto opened = Device::open(plugin, places, config.dump());
    if (!opened) {
      ADD_FAILURE() << opened.error().sentence();
      return;
    }
    device = std::move(*opened);
  }

  void hold(const Vec3& rest_m, double k, double b, std::size_t arm = 0) {
    Pose pose;
    pose.position = rest_m;
    device->setTarget(arm, pose, k, b);
  }
  void push(const Vec3& force_N, std::size_t arm = 0) {
    for (int axis = 0; axis < 3; ++axis) commands[arm].force_N[axis] = force_N[axis];
  }
  bool start() {
    Status started = device->start();
    if (!started) ADD_FAILURE() << started.error().sentence();
    return started.ok();
  }
  bool tick(double dt_s = kTick_s) {
    device->write(commands.data());
    return device->read(dt_s, states.data());
  }
  Vec3 position(std::size_t arm = 0) const {
    const double* p = states[arm].position_m;
    return {p[0], p[1], p[2]};
  }
};

}  // namespace trephine::test
