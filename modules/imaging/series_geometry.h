// Where the slices of one stack lie: order, spacing, tilt, and what forbids calling it a volume.
// Pure: headers in, geometry and findings out. Thresholds: README.md of this room.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "imaging/importer.h"

namespace trephine {

struct StackInput {
  int rows = 0, columns = 0;
  std::array<double, 2> pixel_spacing_mm{0.0, 0.0};  // as in DICOM: between rows, between columns
  std::array<double, 6> orientation{};               // row's cosines, then column's, in LPS
  std::vector<Vec3> positions_mm;                    // ImagePositionPatient of each slice
};

struct Stack {
  // Axes i = row direction, j = column direction, k = i x j, so it is always right-handed. One
  // slice has spacing 0 along k. Where slices are missing it is the geometry without them.
  GridGeometry geometry;
  std::vector<std::size_t> order;  // of the input's slices, in increasing place along k
  std::vector<double> places_mm;   // of the ordered slices along k
  double tilt_deg = 0.0;           // between the line of positions and k
  std::vector<Finding> findings;   // refusals: NOT_ORTHONORMAL, ONE_LOCATION, PHASES,
                                   // DUPLICATE_POSITIONS, MISSING_SLICES, UNEVEN_SPACING,
                                   // GANTRY_TILT, SHIFTED_SLICES
};

// The result is the same for any order of the input's positions, but for slices at one place, which
// keep the input's order. All numbers must be finite and the spacings positive.
Stack stackSlices(const StackInput& input);

}  // namespace trephine
