// What the ray caster is told of each visible tissue beside its opacity, and of the ball of places
// around a sample that it looks at. Pure.
#pragma once

#include <vector>

#include "base/math.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/volume.h"

namespace trephine {

struct TissueShade {
  double low_HU = 0.0;  // where its opacity is over zero, ramps included
  double high_HU = 0.0;
  int row = 0;          // of its label (LabelRows); 0: of any voxel
  bool passed = false;  // tissues lie above it in HU, and no label says where it is
  bool ghosted = false;
  Vec3 colour{1.0};
  friend bool operator==(const TissueShade&, const TissueShade&) = default;
};

// The set as it is looked at: hidden tissues are transparent, ghosted ones visible in any case.
TissueSet asSeen(TissueSet set, const TissueLooks& looks);

// Of the visible tissues of a set asSeen(), those without a label first: where several hold a HU,
// the last counts. `highest_HU` is the highest that a voxel may have.
std::vector<TissueShade> tissueShades(const TissueSet& seen, const TissueLooks& looks,
                                      double highest_HU);

// Directions spread evenly over a sphere (Fibonacci's spiral), and the ball's half-axes in mm along
// the axes of the grid: the sum of HU times direction over the ball is the normal of a surface.
std::vector<Vec3> sphereDirections(int count);
Vec3 ballRadii_mm(const Vec3& spacing_mm);

}  // namespace trephine
