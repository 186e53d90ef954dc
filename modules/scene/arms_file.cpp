#include "scene/arms_file.h"

#include <algorithm>
#include <set>

#include "base/json.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArms = std::size_t(kMaxArms);

ArmDevice readArm(JsonReader& item, const fs::path& folder) {
  ArmDevice device;
  device.name = item.text("name");
  device.plugin = item.text("plugin");
  device.place = std::uint32_t(item.integer("arm", {0, kMaxArmsOfAPlugin - 1}, 0));
  const std::string config = item.text("config", "");
  if (config.empty()) return device;
  device.config = (folder / config).lexically_normal().string();
  std::error_code ec;
  if (!fs::is_regular_file(device.config, ec)) {
    item.fail("config", "The file '" + config + "' is not there", "Check the name");
  }
  return device;
}

}  // namespace

Result<std::vector<ArmDevice>> readArmsFile(const fs::path& file) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format("trephine.arms", 1);
  std::vector<ArmDevice> devices;
  std::set<std::string> names;
  for (JsonReader& item : reader.objects("arms", kMostArms)) {
    devices.push_back(readArm(item, file.parent_path()));
    if (names.insert(devices.back().name).second) continue;
    item.fail("name", "The arm '" + devices.back().name + "' stands twice in the list",
              "Name each arm once");
  }
  if (Status whole = reader.finish(); !whole) return whole.error();
  return devices;
}

Status useArms(Scene& scene, const std::vector<ArmDevice>& devices, const fs::path& file) {
  for (const ArmDevice& device : devices) {
    const auto of = std::find_if(scene.arms.begin(), scene.arms.end(),
                                 [&](const SceneArm& arm) { return arm.name == device.name; });
    if (of == scene.arms.end()) {
      std::string names;
      for (const SceneArm& arm : scene.arms) names += (names.empty() ? "" : ", ") + arm.name;
      return Error{"NO_SUCH_ARM", "The scene has no arm '" + device.name + "'", file.string(),
                   "Its arms are: " + names};
    }
    of->plugin = device.plugin;
    of->device_arm = device.place;
    of->device_config = device.config;
  }
  for (const SceneArm& one : scene.arms) {
    for (const SceneArm& other : scene.arms) {
      if (&one == &other || one.plugin != other.plugin || one.device_arm != other.device_arm) {
        continue;
      }
      return Error{"BAD_SCENE",
                   "The arms '" + one.name + "' and '" + other.name + "' would have one device, '" +
                       one.plugin + "' " + std::to_string(one.device_arm),
                   file.string(), "Give each arm a device of its own"};
    }
  }
  return {};
}

}  // namespace trephine
