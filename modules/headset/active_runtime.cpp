#include "headset/active_runtime.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "base/tr.h"
#include "headset/codes.h"

namespace trephine {

namespace {

// The runtime that the loader was told of, if any: where it looks, in its order.
std::string toldOf() {
  if (const char* named = std::getenv("XR_RUNTIME_JSON"); named && *named) return named;
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::string(value ? value : "");
  };
  const std::string own = folder("XDG_CONFIG_HOME"), home = folder("HOME");
  std::vector<std::string> folders{!own.empty() ? own : home + "/.config"};
  std::istringstream shared(folder("XDG_CONFIG_DIRS"));
  for (std::string each; std::getline(shared, each, ':');) folders.push_back(each);
  for (const char* each : {"/etc/xdg", "/etc"}) folders.push_back(each);
  for (const std::string& each : folders) {
    const std::string file = each + "/openxr/1/active_runtime.json";
    std::error_code problem;
    if (std::filesystem::exists(file, problem)) return file;
  }
  return {};
}

}  // namespace

Error noActiveRuntime(const std::string& where) {
  if (const std::string broken = toldOf(); !broken.empty()) {
    return {code::kNoRuntime, tr("The active OpenXR runtime cannot be used"), broken,
            tr("Install the headset's software anew, or make another one the active runtime")};
  }
  return {code::kNoRuntime, tr("No OpenXR runtime is active on this computer"), where,
          tr("Install the headset's software, such as Monado or SteamVR, and make it the active "
             "runtime")};
}

}  // namespace trephine
