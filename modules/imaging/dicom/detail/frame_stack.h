// Where the frames of a segmentation lie: one grid for all of them, and the slice of each. Pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// As the file says it, in LPS.
struct FramePlane {
  Vec3 position_mm{0.0};
  std::array<double, 6> orientation{};               // row's cosines, then column's
  std::array<double, 2> pixel_spacing_mm{0.0, 0.0};  // between rows, between columns
};

struct FrameStack {
  GridGeometry geometry;    // right-handed; from the first to the last place that has a frame
  std::vector<int> slices;  // k of each frame; several may have the same
  // Where the first pixel of each frame lies in its slice, in columns and rows: all 0, and the grid
  // as large as a frame, but for frames that lie along a tilted gantry's axis.
  std::vector<std::array<int, 2>> shifts;
  std::vector<std::string> notes{};  // sentences
};

// `between_mm` and `thickness_mm` are what the file states beside positions: slices that no frame
// stands for show in them alone, and so does the step of a single slice. There is a frame at least.
// Frames that are sheared, each aside of the one before by as much, are moved by whole pixels; the
// grid grows by that. Errors, without `where`: NO_GEOMETRY, FRAMES_DIFFER, UNEVEN_SPACING,
// TOO_LARGE.
Result<FrameStack> stackFrames(const std::vector<FramePlane>& frames, int columns, int rows,
                               std::optional<double> between_mm,
                               std::optional<double> thickness_mm);

// NO_GEOMETRY: the frames' places are not stated, or make no sense.
Error noGeometry(const std::string& what);

}  // namespace trephine
