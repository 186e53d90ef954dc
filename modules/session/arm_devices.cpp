#include "session/arm_devices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/json.h"
#include "base/range.h"
#include "base/system.h"
#include "base/tr.h"
#include "device/codes.h"
#include "exercise/arms_file.h"
#include "exercise/codes.h"

namespace trephine {

namespace {

// The first whose samples come at the exercise's rate is the clock: a sample of it is never old.
// Where there is none, the host's is.
void choosePace(const Exercise& exercise, std::vector<LoopDevice>& devices) {
  constexpr double kSameRate = 1e-3;
  for (LoopDevice& of : devices) {
    if (of.arms.empty()) continue;
    const double rate_hz = of.device->capabilities(0).rate_hz;
    if (!of.device->hasClock() || std::abs(rate_hz / exercise.rate_hz - 1.0) > kSameRate) continue;
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

Result<std::string> readDeviceFile(const std::string& file) {
  if (file.empty()) return std::string("{}");
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  return json->dump();
}

Result<std::unique_ptr<Device>> openDevice(const std::string& plugin_name,
                                           const std::vector<std::uint32_t>& places,
                                           const std::string& config) {
  Result<std::shared_ptr<const DevicePlugin>> plugin =
      DevicePlugin::load(plugin_name, pluginFolder());
  if (!plugin) return plugin.error();
  // A real one is as this workstation, or Trephine, has it.
  const std::string file =
      config.empty() && plugin_name != kSimulated ? deviceFile(plugin_name) : config;
  Result<std::string> text = readDeviceFile(file);
  if (!text) return text.error();
  Result<std::unique_ptr<Device>> device = Device::open(*plugin, places, *text);
  if (device) return device;
  Error error = device.error();
  if (error.code == code::kBadDeviceConfig && !file.empty()) error.where = file;
  return error;
}

Status openDevices(Exercise& exercise, Rig& rig, std::vector<LoopDevice>& devices,
                   std::vector<TrephineCapabilities>& capabilities) {
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> arms_by_device;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ArmDevice& device = rig.arms[i].device;
    arms_by_device[{device.plugin, device.config}].push_back(i);
  }
  capabilities.resize(exercise.arms.size());
  for (const auto& [key, arms] : arms_by_device) {
    const auto& [name, config] = key;
    std::vector<std::uint32_t> device_arms;
    for (std::size_t arm : arms) device_arms.push_back(rig.arms[arm].device.place);
    Result<std::unique_ptr<Device>> device = openDevice(name, device_arms, config);
    if (!device) return device.error();
    for (std::size_t i = 0; i < arms.size(); ++i) {
      capabilities[arms[i]] = (*device)->capabilities(i);
      if (capabilities[arms[i]].input_dof == 0) {
        return Error{code::kNoDevice,
                     tr("The {} arm's device '{}' is a pedal: it has no place",
                        exercise.arms[arms[i]].name, name),
                     "", tr("Choose an arm for it")};
      }
      if (exercise.rate_hz > capabilities[arms[i]].rate_hz) {
        return Error{
            code::kBadScene,
            tr("The scene asks for {} Hz, and the {} arm's device '{}' keeps at most {} Hz",
               plainNumber(exercise.rate_hz), exercise.arms[arms[i]].name, name,
               plainNumber(capabilities[arms[i]].rate_hz)),
            "rate_hz", tr("Lower the scene's rate_hz, or use another device")};
      }
    }
    const bool real = !(*device)->takesTargets();
    devices.push_back({*std::move(device), arms, false, real});
  }
  if (rig.pedal) {
    const ArmDevice& of = *rig.pedal;
    Result<std::unique_ptr<Device>> pedal = openDevice(of.plugin, {of.place}, of.config);
    if (!pedal) return pedal.error();
    if ((*pedal)->capabilities(0).input_dof != 0) {
      return Error{code::kNoDevice, tr("The pedal's device '{}' is an arm", of.plugin), "",
                   tr("Choose a pedal for it")};
    }
    devices.push_back({*std::move(pedal), {}});
  }
  choosePace(exercise, devices);
  for (const LoopDevice& of : devices) {
    for (std::size_t i = 0; i < of.arms.size(); ++i) {
      ExerciseArm& arm = exercise.arms[of.arms[i]];
      Rig::Arm& moved = rig.arms[of.arms[i]];
      const TrephineCapabilities& able = capabilities[of.arms[i]];
      const double delay_s = delayOf(of, able);
      if (delay_s * exercise.rate_hz > kMaxDelayTicks) {
        return Error{code::kBadScene,
                     tr("The {} arm's device '{}' answers {} ms late, more than {} periods of the "
                        "scene's {} Hz",
                        arm.name, moved.device.plugin, plainNumber(1e3 * delay_s), kMaxDelayTicks,
                        plainNumber(exercise.rate_hz)),
                     "rate_hz", tr("Lower the scene's rate_hz, or use another device")};
      }
      arm.max_force_N = std::min(arm.max_force_N, able.peak_force_N);
      moved.dynamics =
          ArmDynamics{able.apparent_mass_kg,   able.encoder_step_m, arm.max_force_N, delay_s,
                      able.continuous_force_N, able.thermal_s,      able.friction_N};
    }
  }
  return {};
}

Result<ArmDevice> deviceOf(const FoundArm& wanted, const std::string& arm, const FoundArms& here) {
  for (const FoundArm& found : here.arms) {
    if (found.isSame(wanted)) return ArmDevice{found.plugin, found.place, deviceFile(found.plugin)};
  }
  const auto of_plugin = [&](const Error& problem) {
    return problem.where.find("trephine_" + wanted.plugin + ".so") != std::string::npos;
  };
  const auto problem = std::ranges::find_if(here.problems, of_plugin);
  if (problem != here.problems.end()) return *problem;
  return Error{code::kNoDevice,
               tr("The device of the {} arm is not there: {} at {}", arm,
                  (wanted.model.empty() ? wanted.plugin : wanted.model), wanted.bus_path),
               "", tr("Plug it in, or choose another under Devices")};
}

Status readArmDynamics(const Exercise& exercise, Rig& rig, std::vector<Vec3>* workspaces_mm) {
  std::vector<LoopDevice> devices;
  std::vector<TrephineCapabilities> capabilities;
  Exercise asked = exercise;
  for (ExerciseArm& arm : asked.arms) arm.max_force_N = kPeakForce_N.high;
  Rig answered = rig;
  if (Status opened = openDevices(asked, answered, devices, capabilities); !opened) return opened;
  rig = std::move(answered);
  if (!workspaces_mm) return {};
  workspaces_mm->clear();
  for (const TrephineCapabilities& of : capabilities) {
    const Vec3 size_m(of.workspace_m[0], of.workspace_m[1], of.workspace_m[2]);
    workspaces_mm->push_back(1000.0 * size_m);
  }
  return {};
}

Result<Rig> rigOf(const Exercise& exercise, const ChosenArms& chosen) {
  std::vector<NamedDevice> devices;
  std::optional<FoundArms> here;
  std::vector<std::string> names;
  for (const ExerciseArm& arm : exercise.arms) names.push_back(arm.name);
  names.push_back(kPedal);
  for (const std::string& name : names) {
    const auto wanted = chosen.find(name);
    if (wanted == chosen.end()) continue;
    if (!here) here = findArms(pluginFolder());
    Result<ArmDevice> device = deviceOf(wanted->second, name, *here);
    if (!device) return device.error();
    devices.push_back({name, *std::move(device)});
  }
  return rigWith(exercise, devices, "Devices");
}

}  // namespace trephine
