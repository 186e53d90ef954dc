// A recorded session: everything the tick was given and everything it answered, at haptic rate.
// The file: HDF5, layout in resources/schemas/recording.md. It names no patient and no folder: a
// case is known by the sha256 of its voxels.
#pragma once

#include <cstdint>
#include <string>

#include "base/json.h"
#include "volume/volume.h"

namespace trephine {

// A recording replays by the touch of its version (HapticParameters::touch_version).
constexpr int kRecordingVersion = 12, kOldestRecording = 8;  // those between are read

struct RecordingHeader {
  Json exercise;                 // toJson(RecordedExercise) with fixed maps and the controller at the start
  std::string volume_sha256;  // before the first tick
  GridGeometry geometry;
  std::string build;
  std::string labels_sha256{};  // of the label map, fitted to the volume; empty: none
  int version = kRecordingVersion;  // as read
};

// Written when a session ends by itself; a recording without it was cut short.
struct RecordingEnd {
  std::uint64_t ticks = 0;
  std::uint64_t dropped = 0;  // more than none: the session cannot be replayed
  std::uint64_t missed_deadlines = 0;
  std::string volume_sha256;  // after the last tick
};

}  // namespace trephine
