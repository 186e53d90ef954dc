#include "exercise/arms_file.h"

#include <algorithm>
#include <set>

#include "base/json.h"
#include "base/system.h"
#include "base/tr.h"
#include "exercise/codes.h"
#include "exercise/exercise_fields.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArms = std::size_t(kMaxArms);

}  // namespace

ArmDevice readDevice(JsonReader& item, const fs::path& folder) {
  ArmDevice device;
  device.plugin = item.text("plugin");
  if (item.ok() && device.plugin.empty()) {
    item.fail("plugin", tr("It names no plugin"), tr("Name one, such as simulated"));
  }
  readFields(item, kDeviceFields, device);
  const std::string config = item.text("config", "");
  if (config.empty()) return device;
  device.config = (folder / config).lexically_normal().string();
  std::error_code ec;
  if (!fs::is_regular_file(device.config, ec)) {
    item.fail("config", tr("The file '{}' is not there", config), tr("Check the name"));
  }
  return device;
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
      item.fail("name", tr("'pedal' is no arm"), tr("Give the pedal beside 'arms', under 'pedal'"));
    }
    if (names.insert(devices.back().arm).second) continue;
    item.fail("name", tr("The arm '{}' stands twice in the list", devices.back().arm),
              tr("Name each arm once"));
  }
  if (reader.has(kPedal)) {
    JsonReader pedal = reader.object(kPedal);
    devices.push_back({kPedal, readDevice(pedal, file.parent_path())});
  }
  if (Status whole = reader.finish(); !whole) return whole.error();
  return devices;
}

Result<Rig> rigWith(const Exercise& exercise, const std::vector<NamedDevice>& devices,
                    const std::string& where) {
  Rig rig;
  rig.arms.resize(exercise.arms.size());
  for (const NamedDevice& of : devices) {
    if (of.arm == kPedal) {
      rig.pedal = of.device;
      continue;
    }
    const auto arm = std::ranges::find(exercise.arms, of.arm, &ExerciseArm::name);
    if (arm == exercise.arms.end()) {
      std::string names;
      for (const ExerciseArm& one : exercise.arms) names += (names.empty() ? "" : ", ") + one.name;
      return Error{code::kNoSuchArm, tr("The scene has no arm '{}'", of.arm), where,
                   tr("Its arms are: {}", names)};
    }
    ArmDevice& device = rig.arms[std::size_t(arm - exercise.arms.begin())].device;
    device = of.device;
    if (device.plugin == kSimulated && device.config.empty()) device.config = usualArmFile();
  }
  // The simulated ones that others need not have, in their places.
  const Rig simulated = simulatedRig(exercise);
  for (std::size_t i = 0; i < rig.arms.size(); ++i) {
    const ArmDevice& own = simulated.arms[i].device;
    const auto has = [&](const Rig::Arm& arm) {
      return arm.device.plugin == kSimulated && arm.device.place == own.place;
    };
    if (rig.arms[i].device.plugin.empty() && std::ranges::none_of(rig.arms, has)) {
      rig.arms[i].device = own;
    }
  }
  addSimulatedArms(rig, exercise.arms.size());
  for (std::size_t i = 0; i < rig.arms.size(); ++i) {
    const ArmDevice& a = rig.arms[i].device;
    for (std::size_t j = i + 1; j < rig.arms.size(); ++j) {
      const ArmDevice& b = rig.arms[j].device;
      if (a.plugin != b.plugin || a.place != b.place) continue;
      return Error{code::kBadScene,
                   tr("The arms '{}' and '{}' would have one device, '{}' {}",
                      exercise.arms[i].name, exercise.arms[j].name, a.plugin, a.place),
                   where, tr("Give each arm a device of its own")};
    }
    if (!rig.pedal || a.plugin != rig.pedal->plugin || a.place != rig.pedal->place) continue;
    return Error{code::kBadScene,
                 tr("The arm '{}' and the pedal would have one device", exercise.arms[i].name),
                 where, tr("Give each a device of its own")};
  }
  return rig;
}

}  // namespace trephine
