#include "device/find_arms.h"

#include <algorithm>

#include "base/system.h"
#include "base/tr.h"
#include "device/codes.h"
#include "device/device.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSiteDevices = "/etc/trephine/devices";
constexpr std::string_view kBefore = "trephine_", kAfter = ".so";

std::vector<std::string> pluginNames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    const std::string file = at->path().filename().string();
    if (file.size() <= kBefore.size() + kAfter.size() || !file.starts_with(kBefore) ||
        !file.ends_with(kAfter)) {
      continue;
    }
    names.push_back(file.substr(kBefore.size(), file.size() - kBefore.size() - kAfter.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

FoundArms findArms(const fs::path& plugin_folder) {
  FoundArms found;
  for (const std::string& name : pluginNames(plugin_folder)) {
    const auto plugin = DevicePlugin::load(name, plugin_folder);
    if (!plugin) {
      found.problems.push_back(plugin.error());
      continue;
    }
    std::uint32_t place = 0;
    const std::vector<TrephineArmInfo> infos = (*plugin)->enumerate();
    if (const std::string why = infos.empty() ? (*plugin)->whyNone() : ""; !why.empty()) {
      found.problems.push_back(
          {code::kNoDevice, why, (plugin_folder / ("trephine_" + name + ".so")).string(), ""});
    }
    for (const TrephineArmInfo& info : infos) {
      const FoundArm arm{name, info.bus_path, info.serial, info.model, place++};
      const auto other = std::ranges::find_if(found.arms, [&](const FoundArm& has) {
        return has.plugin != name && has.bus_path == arm.bus_path && has.serial == arm.serial;
      });
      if (other == found.arms.end()) {
        found.arms.push_back(arm);
        continue;
      }
      found.problems.push_back({code::kTwoPlugins,
                                tr("The plugins '{}' and '{}' both have the device at {}",
                                   other->plugin, name, arm.bus_path),
                                (plugin_folder / ("trephine_" + name + ".so")).string(),
                                tr("It is used by '{}'; remove one of the two", other->plugin)});
    }
  }
  return found;
}

std::string deviceFile(const std::string& plugin) {
  const fs::path name = plugin + ".json";
  std::error_code ec;
  for (const fs::path& folder : {fs::path(kSiteDevices), resourceFolder() / "devices"}) {
    if (fs::is_regular_file(folder / name, ec)) return (folder / name).string();
  }
  return {};
}

}  // namespace trephine
