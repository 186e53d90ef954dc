#include "session/arm_devices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/json.h"
#include "base/range.h"
#include "base/system.h"

namespace trephine {

namespace {

// Held to the rules of every JSON file before the plugin sees it.
Result<std::string> readDeviceFile(const std::string& file) {
  if (file.empty()) return std::string("{}");
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  return json->dump();
}

// The first whose samples come at the scene's rate is the clock: a sample of it is never old. Where
// there is none, the host's is.
void choosePace(const Scene& scene, std::vector<LoopDevice>& devices) {
  constexpr double kSameRate = 1e-3;
  for (LoopDevice& of : devices) {
    const double rate_hz = of.device->capabilities(0).rate_hz;
    if (!of.device->hasClock() || std::abs(rate_hz / scene.rate_hz - 1.0) > kSameRate) continue;
    of.paces = true;
    return;
  }
}

// From a sample to the force that answers it. One by another clock than the loop's may be a period
// of its own old before it is looked at.
double delayOf(const LoopDevice& of, const TrephineCapabilities& able) {
  const bool waits_for_loop = of.device->hasClock() && !of.paces;
  return able.latency_s + (waits_for_loop ? 1.0 / able.rate_hz : 0.0);
}

}  // namespace

Status openDevices(Scene& scene, std::vector<LoopDevice>& devices,
                   std::vector<TrephineCapabilities>& capabilities) {
  std::map<std::string, std::vector<std::size_t>> arms_by_plugin;
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    arms_by_plugin[scene.arms[i].plugin].push_back(i);
  }
  capabilities.resize(scene.arms.size());
  for (const auto& [name, arms] : arms_by_plugin) {
    Result<std::shared_ptr<const DevicePlugin>> plugin = DevicePlugin::load(name, pluginFolder());
    if (!plugin) return plugin.error();
    std::vector<std::uint32_t> device_arms;
    const std::string& config = scene.arms[arms.front()].device_config;
    for (std::size_t arm : arms) {
      device_arms.push_back(scene.arms[arm].device_arm);
      if (scene.arms[arm].device_config != config) {
        return Error{"BAD_SCENE", "The arms of the plugin '" + name + "' name different files",
                     "arms: device.config", "One file configures all arms of a plugin"};
      }
    }
    Result<std::string> text = readDeviceFile(config);
    if (!text) return text.error();
    Result<std::unique_ptr<Device>> device = Device::open(*plugin, device_arms, *text);
    if (!device) {
      Error error = device.error();
      if (error.code == "BAD_DEVICE_CONFIG" && !config.empty()) error.where = config;
      return error;
    }
    for (std::size_t i = 0; i < arms.size(); ++i) {
      capabilities[arms[i]] = (*device)->capabilities(i);
      if (scene.rate_hz > capabilities[arms[i]].rate_hz) {
        return Error{"BAD_SCENE",
                     "The scene asks for " + plainNumber(scene.rate_hz) + " Hz, and the " +
                         scene.arms[arms[i]].name + " arm's device '" + name + "' keeps at most " +
                         plainNumber(capabilities[arms[i]].rate_hz) + " Hz",
                     "rate_hz", "Lower the scene's rate_hz, or use another device"};
      }
    }
    devices.push_back({*std::move(device), arms});
  }
  choosePace(scene, devices);
  for (const LoopDevice& of : devices) {
    for (std::size_t i = 0; i < of.arms.size(); ++i) {
      SceneArm& arm = scene.arms[of.arms[i]];
      const TrephineCapabilities& able = capabilities[of.arms[i]];
      const double delay_s = delayOf(of, able);
      if (delay_s * scene.rate_hz > kMaxDelayTicks) {
        return Error{"BAD_SCENE",
                     "The " + arm.name + " arm's device '" + arm.plugin + "' answers " +
                         plainNumber(1e3 * delay_s) + " ms late, more than " +
                         std::to_string(kMaxDelayTicks) + " periods of the scene's " +
                         plainNumber(scene.rate_hz) + " Hz",
                     "rate_hz", "Lower the scene's rate_hz, or use another device"};
      }
      arm.max_force_N = std::min(arm.max_force_N, able.peak_force_N);
      arm.dynamics =
          ArmDynamics{able.apparent_mass_kg,   able.encoder_step_m, arm.max_force_N, delay_s,
                      able.continuous_force_N, able.thermal_s};
    }
  }
  return {};
}

Result<std::vector<Vec3>> readWorkspaces(Scene scene) {
  std::vector<LoopDevice> devices;
  std::vector<TrephineCapabilities> capabilities;
  if (Status opened = openDevices(scene, devices, capabilities); !opened) return opened.error();
  std::vector<Vec3> sizes;
  for (const TrephineCapabilities& of : capabilities) {
    sizes.push_back(1000.0 * Vec3(of.workspace_m[0], of.workspace_m[1], of.workspace_m[2]));
  }
  return sizes;
}

Status readArmDynamics(Scene& scene) {
  std::vector<LoopDevice> devices;
  std::vector<TrephineCapabilities> capabilities;
  Scene asked = scene;
  for (SceneArm& arm : asked.arms) arm.max_force_N = kPeakForce_N.high;
  if (Status opened = openDevices(asked, devices, capabilities); !opened) return opened;
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    scene.arms[i].dynamics = asked.arms[i].dynamics;
  }
  return {};
}

}  // namespace trephine
