#include "ui/work/arms_of_place.h"

#include <algorithm>

#include "base/system.h"
#include "scene/arms_file.h"
#include "session/arm_devices.h"
#include "ui/common/settings.h"

namespace trephine {

namespace {

constexpr const char* kNames[] = {"left", "right", kPedal};

const Setting<QStringList>& settingOf(const std::string& arm) {
  return arm == kPedal   ? settings::kFootPedal
         : arm == "left" ? settings::kLeftArm
                         : settings::kRightArm;
}

}  // namespace

ArmsOfPlace armsOfThisPlace() {
  ArmsOfPlace arms;
  for (const char* name : kNames) {
    const QStringList of = read(settingOf(name));
    if (of.size() != 4 || of[0].isEmpty()) continue;
    arms[name] = {of[0].toStdString(), of[1].toStdString(), of[2].toStdString(),
                  of[3].toStdString()};
  }
  return arms;
}

void chooseArm(const std::string& arm, const std::optional<FoundArm>& device) {
  const auto words = [](const std::string& of) { return QString::fromStdString(of); };
  write(settingOf(arm), device && device->plugin != kSimulated
                            ? QStringList{words(device->plugin), words(device->bus_path),
                                          words(device->serial), words(device->model)}
                            : QStringList());
}

Result<Rig> rigOf(const Scene& scene, const ArmsOfPlace& chosen) {
  std::vector<NamedDevice> devices;
  std::optional<FoundArms> here;
  std::vector<std::string> names;
  for (const SceneArm& arm : scene.arms) names.push_back(arm.name);
  names.push_back(kPedal);
  for (const std::string& name : names) {
    const auto wanted = chosen.find(name);
    if (wanted == chosen.end()) continue;
    if (!here) here = findArms(pluginFolder());
    Result<ArmDevice> device = deviceOf(wanted->second, name, *here);
    if (!device) return device.error();
    devices.push_back({name, *std::move(device)});
  }
  return rigWith(scene, devices, "Devices");
}

Scene withForceLimit(Scene scene) {
  const double most_N =
      readWithin(settings::kArmsLimit_N, settings::kArmsLeast_N, settings::kArmsMost_N);
  for (SceneArm& arm : scene.arms) arm.max_force_N = std::min(arm.max_force_N, most_N);
  return scene;
}

}  // namespace trephine
