// Which devices move an exercise's arms, in place of simulated ones: a file of the workstation that
// it runs on. JSON, resources/schemas/arms.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "exercise/exercise.h"

namespace trephine {

// A device as recordings and arms files name it; `folder` is the file's.
ArmDevice readDevice(JsonReader& item, const std::filesystem::path& folder);

struct NamedDevice {
  std::string arm;  // the exercise's name of it, or kPedal
  ArmDevice device;
};
inline constexpr const char* kPedal = "pedal";

// Errors: those of a file and of JSON, BAD_FIELD (file, field and value named).
Result<std::vector<NamedDevice>> readArmsFile(const std::filesystem::path& file);

// The exercise's arms of those names moved by these devices; the others are simulated. Errors:
// NO_SUCH_ARM where the exercise has none of a name, BAD_SCENE where two arms would have one
// device. `where` is named in them.
Result<Rig> rigWith(const Exercise& exercise, const std::vector<NamedDevice>& devices,
                    const std::string& where);

}  // namespace trephine
