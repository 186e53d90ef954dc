// What this process and machine are: build name, places of our own files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace trephine {

// "0.1.0 Release": version and build type, in every answer under --json.
std::string buildName();

// Where exercises, tissues and devices are, ../share/trephine from the program's folder; the
// environment's TREPHINE_RESOURCES comes first.
std::filesystem::path resourceFolder();
// Where device plugins are, ../lib/trephine/plugins; the environment's TREPHINE_PLUGINS comes
// first.
std::filesystem::path pluginFolder();
// Where the build put the built-in cases, ../lib/trephine/cases.
std::filesystem::path builtInFolder();
// trephine-lab and trephine-measure, beside this program. The second is of a package of its own and
// may not be there.
std::filesystem::path labProgram();
std::filesystem::path measureProgram();
// Of this person on this machine: what is chosen, what is made, and what happened here. By
// XDG_CONFIG_HOME, XDG_DATA_HOME and XDG_STATE_HOME, else ~/.config/trephine,
// ~/.local/share/trephine and ~/.local/state/trephine; nothing where neither is given from the
// root.
std::optional<std::filesystem::path> configFolder();
std::optional<std::filesystem::path> dataFolder();
std::optional<std::filesystem::path> stateFolder();
// From now on this process, and what it starts, loads code and settings of devices from where they
// were installed: takes out of the environment TREPHINE_RESOURCES and TREPHINE_PLUGINS, and what
// names other plugins, drivers, layers or tables to Qt, VTK, HDF5, OpenXR, OpenSSL, DCMTK, OpenGL
// and the C library. LD_PRELOAD and its like have acted before any program runs: only what starts
// it can keep them out. The loaders of OpenXR and Vulkan still read the user's own ~/.config and
// ~/.local/share. Before there are threads.
void keepToOwnFolders();

// The memory of this process holds patients' names and voxels: no core of it is written, by no way
// that the system has, and no other process of the user may read it. A child that runs another
// program begins anew. Before anything is read.
void keepMemoryPrivate();

}  // namespace trephine
