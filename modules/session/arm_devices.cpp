#include "session/arm_devices.h"

#include <algorithm>
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
      if (capabilities[arms[i]].latency_s * scene.rate_hz > kMaxDelayTicks) {
        return Error{"BAD_SCENE",
                     "The " + scene.arms[arms[i]].name + " arm's device '" + name + "' answers " +
                         plainNumber(1e3 * capabilities[arms[i]].latency_s) +
                         " ms late, more than " + std::to_string(kMaxDelayTicks) +
                         " periods of the scene's " + plainNumber(scene.rate_hz) + " Hz",
                     "rate_hz", "Lower the scene's rate_hz, or use another device"};
      }
      double& limit_N = scene.arms[arms[i]].max_force_N;
      limit_N = std::min(limit_N, capabilities[arms[i]].peak_force_N);
      scene.arms[arms[i]].dynamics =
          ArmDynamics{capabilities[arms[i]].apparent_mass_kg, capabilities[arms[i]].encoder_step_m,
                      limit_N, capabilities[arms[i]].latency_s};
    }
    devices.push_back({*std::move(device), arms});
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
