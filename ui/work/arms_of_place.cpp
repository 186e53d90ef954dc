#include "ui/work/arms_of_place.h"

#include "exercise/arms_file.h"
#include "ui/common/preferences.h"
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

ArmSettings armSettings() {
  ArmSettings arms;
  arms.most_N = preferences().arms_most_N;
  for (const char* name : kNames) {
    const QStringList of = read(settingOf(name));
    if (of.size() != 4 || of[0].isEmpty()) continue;
    arms.chosen[name] = {of[0].toStdString(), of[1].toStdString(), of[2].toStdString(),
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

}  // namespace trephine
