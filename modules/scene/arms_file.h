// Which devices move a scene's arms, in place of those that it would have: a file of the
// workstation that it runs on. JSON, resources/schemas/arms.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace trephine {

inline constexpr const char* kSimulated = "simulated";

// A device as scenes of before and arms files name it; `folder` is the file's.
ArmDevice readDevice(JsonReader& item, const std::filesystem::path& folder);

// Gives each arm that has no device a simulated one, which no other arm has.
void addSimulatedDevices(Scene& scene);

struct NamedDevice {
  std::string arm;  // the scene's name of it, or kPedal
  ArmDevice device;
};
inline constexpr const char* kPedal = "pedal";

// Errors: those of a file and of JSON, BAD_FIELD (file, field and value named).
Result<std::vector<NamedDevice>> readArmsFile(const std::filesystem::path& file);

// Gives the scene's arms of those names these devices; the others are simulated, as they were or by
// the next that nobody has. Errors: NO_SUCH_ARM where the scene has none of a
// name, BAD_SCENE where two arms would have one device. `where` is named in them.
Status useArms(Scene& scene, const std::vector<NamedDevice>& devices, const std::string& where);

}  // namespace trephine
