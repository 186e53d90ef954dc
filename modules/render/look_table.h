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
  double low_HU = 0.0;  // half a HU beyond its range
  double high_HU = 0.0;
  int row = 0;          // of its label (LabelRows); 0: of any voxel
  bool passed = false;  // tissues lie above it in HU, and no label says where it is
  bool ghosted = false;
  Vec3 colour{1.0};
  friend bool operator==(const TissueShade&, const TissueShade&) = default;
};

// Of the visible tissues of a set asSeen(), those without a label first: where several hold a HU,
// the last counts. `highest_HU` is the highest that a voxel may have.
std::vector<TissueShade> tissueShades(const TissueSet& seen, const TissueLooks& looks,
                                      double highest_HU);

// The same tissue where a tool has cut it: light ones, as bone, in a warm pink, dark ones, as
// liver, paler.
Vec3 cutColour(const Vec3& colour);

// A place around a sample, in mm along the grid's axes, and what its HU adds to the normal there.
// The sum over a ball's places is as long as the contrast across a flat edge in its middle.
struct RayPlace {
  Vec3 from_mm{0.0};
  Vec3 weight{0.0};
};
using RayBall = std::vector<RayPlace>;
constexpr int kBallPlaces = 24;
constexpr int kFewPlaces = 12;  // where pictures are coarse

// Directions spread evenly (Fibonacci's spiral) at 1.75 voxels, or one where slices are far apart:
// the sum of HU times direction is the normal of a surface.
Vec3 ballRadii_mm(const Vec3& spacing_mm);
RayBall rayBall(const Vec3& spacing_mm, int places = kBallPlaces);
// VTK's: the six neighbours.
RayBall centralDifferences(const Vec3& spacing_mm);

}  // namespace trephine
