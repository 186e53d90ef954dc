// From tissues to what the ray caster looks up: colour and opacity over HU, and which HU are seen.
#pragma once

#include <vector>

#include "base/math.h"
#include "tissue/tissue_set.h"

namespace trephine {

// Piecewise linear between points of increasing HU, constant beyond the ends.
struct TransferPoint {
  double hu = 0.0;
  Vec3 colour{0.0};
  double opacity = 0.0;  // per mm
  friend bool operator==(const TransferPoint&, const TransferPoint&) = default;
};

// [low, high] in HU.
struct HuInterval {
  double low = 0.0;
  double high = 0.0;
  friend bool operator==(const HuInterval&, const HuInterval&) = default;
};

// Half of a ramp's width in HU. Ramps lie across a range's two edges, half a HU beyond its end
// values, and become narrower where a range is too small for them; a hard step would show the
// sampling of the rays as rings.
constexpr double kRampHalfWidth_HU = 12.0;

// An opacity of 1 per mm would make every step of a ray a hard shell of its own.
constexpr double kMaxOpacity = 0.995;

// Of voxels with a label (0: none), as in classify(): a tissue of the label goes before one of any
// voxel, and what removal leaves is of no tissue, with all HU within a ramp of it. HU of no tissue
// are transparent. A transparent tissue lends its colour to no ramp, so that the edge of a visible
// tissue keeps the tissue's colour.
std::vector<TransferPoint> transferFunction(const TissueSet& set, int label = 0);

// Several functions as one, so that one look-up table serves them all: each is squeezed into its
// share of [low_HU, high_HU], with a margin at its ends. sideBySide_HU says where a HU of it went.
std::vector<TransferPoint> sideBySide(const std::vector<std::vector<TransferPoint>>& functions,
                                      double low_HU, double high_HU);
double sideBySide_HU(double hu, std::size_t function, std::size_t count, double low_HU,
                     double high_HU);
constexpr double kSideMargin = 0.01;  // of a share

// The function at a HU, as the ray caster interpolates it. Transparent black for no points.
TransferPoint evaluate(const std::vector<TransferPoint>& points, double hu);

// The HU whose opacity is over zero, as disjoint increasing intervals.
std::vector<HuInterval> visibleIntervals(const std::vector<TransferPoint>& points);

}  // namespace trephine
