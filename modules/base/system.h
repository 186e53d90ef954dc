// What this process and machine are: build name, places of our own files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace trephine {

// "0.1.0 Release": version and build type, in every answer under --json.
std::string buildName();

// Where scenes, tissues and devices are, ../share/trephine from the program's folder; the
// environment's TREPHINE_RESOURCES comes first.
std::filesystem::path resourceFolder();
// Where device plugins are, ../lib/trephine/plugins; the environment's TREPHINE_PLUGINS comes
// first.
std::filesystem::path pluginFolder();
// Of this person on this machine: $XDG_CONFIG_HOME/trephine, else ~/.config/trephine; nothing where
// neither is known.
std::optional<std::filesystem::path> configFolder();
// From now on both are where they were installed: takes the two out of this process's
// environment, and so out of that of what it starts. Before there are threads.
void keepToOwnFolders();

}  // namespace trephine
