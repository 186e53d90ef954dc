// What is plugged in: every plugin of a folder is asked for its arms, "simulated" and "pedal" as
// well, so that an arm that is found need not be hardware. A folder that is not there has none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace trephine {

// An arm, or a pedal, as its plugin found it. Plugin, bus path and serial tell it from all others,
// from one start of the program to the next.
struct FoundArm {
  std::string plugin, bus_path, serial, model;
  std::uint32_t place = 0;  // in the plugin's enumeration, until something is plugged in or out

  bool isSame(const FoundArm& other) const {
    return plugin == other.plugin && bus_path == other.bus_path && serial == other.serial;
  }
};

struct FoundArms {
  std::vector<FoundArm> arms;  // by plugin, and as it lists them
  // A plugin that cannot be asked, or that can have none and says why; two that have one device.
  std::vector<Error> problems;
};

// A plugin may take long over it: not on a window's thread, and not while its arms are in use. What
// cannot be asked is a problem, and the rest is found.
FoundArms findArms(const std::filesystem::path& plugin_folder);

// The file that configures a plugin's arms here: the hospital's,
// /etc/trephine/devices/<plugin>.json, or the product's; empty where there is neither.
std::string deviceFile(const std::string& plugin);

}  // namespace trephine
