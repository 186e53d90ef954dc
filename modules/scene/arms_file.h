// Which devices move a scene's arms, in place of those that it would have: a file of the workstation
// that it runs on. JSON, resources/schemas/arms.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace trephine {

struct ArmDevice {
  std::string name;         // of the scene's arm
  std::string plugin;       // device plugin
  std::uint32_t place = 0;  // in the plugin's enumeration
  std::string config;       // file of the plugin's configuration, empty for none
};

// Errors: those of a file and of JSON, BAD_FIELD (file, field and value named).
Result<std::vector<ArmDevice>> readArmsFile(const std::filesystem::path& file);

// Gives the scene's arms of those names these devices; the others keep theirs. Errors: NO_SUCH_ARM
// where the scene has none of a name, BAD_SCENE where two arms would have one device. `file` is
// named in them.
Status useArms(Scene& scene, const std::vector<ArmDevice>& devices,
               const std::filesystem::path& file);

}  // namespace trephine
