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

// Where ranges overlap (under different labels) the first tissue in the set wins, as in classify().
// HU of no tissue are transparent. A transparent tissue lends its colour to no ramp, so that the
// edge of a visible tissue keeps the tissue's colour.
std::vector<TransferPoint> transferFunction(const TissueSet& set);

// The function at a HU, as the ray caster interpolates it. Transparent black for no points.
TransferPoint evaluate(const std::vector<TransferPoint>& points, double hu);

// The HU whose opacity is over zero, as disjoint increasing intervals.
std::vector<HuInterval> visibleIntervals(const std::vector<TransferPoint>& points);

}  // namespace trephine
