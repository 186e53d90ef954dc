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
// Where the build put the built-in cases, ../lib/trephine/cases.
std::filesystem::path builtInFolder();
// trephine-lab, beside this program.
std::filesystem::path labProgram();
// Of this person on this machine: what is chosen, what is made, and what happened here. By
// XDG_CONFIG_HOME, XDG_DATA_HOME and XDG_STATE_HOME, else ~/.config/trephine,
// ~/.local/share/trephine and ~/.local/state/trephine; nothing where neither is given from the
// root.
std::optional<std::filesystem::path> configFolder();
std::optional<std::filesystem::path> dataFolder();
std::optional<std::filesystem::path> stateFolder();
// From now on both are where they were installed: takes the two out of this process's
// environment, and so out of that of what it starts. Before there are threads.
void keepToOwnFolders();

}  // namespace trephine
