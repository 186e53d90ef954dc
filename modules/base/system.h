// What this process and machine are: build name, memory, places of our own files.
#pragma once

#include <filesystem>
#include <string>

namespace trephine {

// "0.1.0 Release": version and build type, in every answer under --json.
std::string buildName();

// Resident memory now and at its peak, in MB of 2^20 bytes.
double residentMb();
double peakResidentMb();
// What could be allocated now without pushing anything out to disk.
double availableMemoryMb();

// Where scenes, tissues and devices are; the environment's TREPHINE_RESOURCES comes first.
std::filesystem::path resourceFolder();
// Where device plugins are; the environment's TREPHINE_PLUGINS comes first.
std::filesystem::path pluginFolder();

}  // namespace trephine
