#include "scene/arms_file.h"

#include <algorithm>
#include <set>

#include "base/json.h"
#include "base/system.h"
#include "scene/scene_numbers.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArms = std::size_t(kMaxArms);

// What a simulated arm is like where nobody says otherwise.
std::string usualArm() {
  return (resourceFolder() / "devices" / "omni.json").string();
}

}  // namespace

ArmDevice readDevice(JsonReader& item, const fs::path& folder) {
  ArmDevice device;
  device.plugin = item.text("plugin");
  if (item.ok() && device.plugin.empty()) {
    item.fail("plugin", "It names no plugin", "Name one, such as simulated");
  }
  readNumbers(item, kDeviceNumbers, device);
  const std::string config = item.text("config", "");
  if (config.empty()) return device;
  device.config = (folder / config).lexically_normal().string();
  std::error_code ec;
  if (!fs::is_regular_file(device.config, ec)) {
    item.fail("config", "The file '" + config + "' is not there", "Check the name");
  }
  return device;
}

void addSimulatedDevices(Scene& scene) {
  const std::string config = usualArm();
  std::uint32_t place = 0;
  for (SceneArm& arm : scene.arms) {
    if (!arm.device.plugin.empty()) continue;
    const auto taken = [&](const SceneArm& other) {
      return other.device.plugin == kSimulated && other.device.place == place;
    };
    while (std::ranges::any_of(scene.arms, taken)) ++place;
    arm.device = {kSimulated, place, config};
  }
}

Result<std::vector<NamedDevice>> readArmsFile(const fs::path& file) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format("trephine.arms", 1);
  std::vector<NamedDevice> devices;
  std::set<std::string> names;
  for (JsonReader& item : reader.objects("arms", kMostArms)) {
    devices.push_back({item.text("name"), readDevice(item, file.parent_path())});
    if (devices.back().arm == kPedal) {
      item.fail("name", "'pedal' is no arm", "Give the pedal beside 'arms', under 'pedal'");
    }
    if (names.insert(devices.back().arm).second) continue;
    item.fail("name", "The arm '" + devices.back().arm + "' stands twice in the list",
              "Name each arm once");
  }
  if (reader.has(kPedal)) {
    JsonReader pedal = reader.object(kPedal);
    devices.push_back({kPedal, readDevice(pedal, file.parent_path())});
  }
  if (Status whole = reader.finish(); !whole) return whole.error();
  return devices;
}

Status useArms(Scene& scene, const std::vector<NamedDevice>& devices, const std::string& where) {
  Scene with = scene;
  for (SceneArm& arm : with.arms) arm.device = {};
  for (const NamedDevice& of : devices) {
    if (of.arm == kPedal) {
      with.pedal = of.device;
      continue;
    }
    const auto arm = std::ranges::find(with.arms, of.arm, &SceneArm::name);
    if (arm == with.arms.end()) {
      std::string names;
      for (const SceneArm& one : scene.arms) names += (names.empty() ? "" : ", ") + one.name;
      return Error{"NO_SUCH_ARM", "The scene has no arm '" + of.arm + "'", where,
                   "Its arms are: " + names};
    }
    arm->device = of.device;
    if (of.device.plugin == kSimulated && of.device.config.empty()) {
      arm->device.config = usualArm();
    }
  }
  // The simulated ones that others need not have, in their places.
  for (std::size_t i = 0; i < with.arms.size(); ++i) {
    const auto has = [&](const SceneArm& arm) {
      return arm.device.plugin == kSimulated && arm.device.place == scene.arms[i].device.place;
    };
    const bool was_simulated = scene.arms[i].device.plugin == kSimulated;
    if (!with.arms[i].device.plugin.empty() || !was_simulated) continue;
    if (std::ranges::none_of(with.arms, has)) with.arms[i].device = scene.arms[i].device;
  }
  addSimulatedDevices(with);
  for (const SceneArm& one : with.arms) {
    for (const SceneArm& other : with.arms) {
      const ArmDevice &a = one.device, &b = other.device;
      if (&one == &other || a.plugin != b.plugin || a.place != b.place) continue;
      return Error{"BAD_SCENE",
                   "The arms '" + one.name + "' and '" + other.name + "' would have one device, '" +
                       a.plugin + "' " + std::to_string(a.place),
                   where, "Give each arm a device of its own"};
    }
  }
  for (const SceneArm& arm : with.arms) {
    if (!with.pedal || arm.device.plugin != with.pedal->plugin ||
        arm.device.place != with.pedal->place) {
      continue;
    }
    return Error{"BAD_SCENE", "The arm '" + arm.name + "' and the pedal would have one device",
                 where, "Give each a device of its own"};
  }
  scene = std::move(with);
  return {};
}

}  // namespace trephine
