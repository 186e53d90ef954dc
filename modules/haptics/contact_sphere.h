// The push of elastic tissue on a tool's contact sphere: depth and a smoothed normal in one sum, at
// a cost that does not depend on the size of voxels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "haptics/tissue_field.h"
#include "tissue/tissue_set.h"

namespace trephine {

// K(h), the stiffness [N/m] of the tissue at a HU, as its integral over h: the mean stiffness along
// a line on which HU runs evenly from a to b is then (C(b) - C(a)) / (b - a), which places a
// surface within a voxel by its partial volume. Ranges of a class end half-way to the next integer.
class StiffnessOfHu {
 public:
  StiffnessOfHu() : integral_(kCount + 1, 0.0) {}
  void set(const TissueTable& tissues, int label = 0);  // of voxels with that label; no allocation
  // HU below or above the table count as its ends.
  double mean(double hu_a, double hu_b) const;
  // Below the HU of every tissue.
  bool isAir(double hu) const { return hu < first_; }
  double at(double hu) const;

  static constexpr int kLowest = -1100, kCount = 4400;  // HU; metal counts as 3300

 private:
  double integral(double hu) const;
  std::vector<double> integral_;
  double first_ = 0.0;  // no tissue below
};

// The same for each label that the tissues name, a row each; row 0 where it is one for all. No
// allocation.
class StiffnessByLabel {
 public:
  void set(const TissueTable& tissues) {
    rows_ = LabelRows(tissues);
    for (int row = 0; row < rows_.count; ++row) {
      of_row_[std::size_t(row)].set(tissues, rows_.label[std::size_t(row)]);
    }
  }
  bool oneForAll() const { return rows_.count == 1; }
  std::uint8_t rowOf(std::uint8_t label) const { return rows_.row[label]; }
  const StiffnessOfHu& ofRow(std::size_t row) const { return of_row_[row]; }

 private:
  LabelRows rows_;
  std::array<StiffnessOfHu, LabelRows::kMost> of_row_;
};

// For blunt tools, and for sharp ones, whose normal matters less; `trephine-measure haptics` has
// the errors.
constexpr int kBluntDirections = 48, kSharpDirections = 24;
inline int sphereDirections(bool blunt) {
  return blunt ? kBluntDirections : kSharpDirections;
}

struct ElasticPush {
  Vec3 force_N{0.0};       // on the tool, patient axes
  double stored_J = 0.0;   // the force is minus its gradient
  double stiffness = 0.0;  // N/m, of the firmest tissue that pushes
  double at_centre = 0.0;  // N/m, of the tissue at the sphere's centre
};

// For a sphere of radius r and tissue of stiffness K(x):
//
//   F = -(1 / 2 pi) integral over directions d of  d [ integral_0^r K(c + s d) ds + r K(c + r d) ]
//
// minus the gradient of the energy (1 / 2 pi) integral over d of integral_0^r s K(c + s d) ds.
//
// Over a half-space this is k times the sphere's depth along the surface's normal, exactly, while
// the centre is outside (the weights were chosen for that: derivation in README.md); over layers it
// is the sum of (k_i - k_(i-1)) times the depth in each. The directions are a fixed set of opposite
// pairs in the grid's axes, so that evenly surrounded means no push. The surface term is taken over
// a shell of +-r/6.
//
// Where tissues are restricted to labels, K at a place is the sum of each label's K(HU) times its
// share of the eight voxels around the place, so that a border between labels is as smooth as one
// of HU. Removed voxels have no share, and their HU does not count.
class ContactSphere {
 public:
  // `directions` is rounded up to a whole number of opposite pairs.
  ContactSphere(const GridGeometry& geometry, double radius_mm, int directions);

  // Beyond the grid lies air. The second takes the quick way of the first where one is for all.
  ElasticPush push(const TissueField& tissue, const StiffnessOfHu& stiffness,
                   const Vec3& centre_mm) const;
  ElasticPush push(const TissueField& tissue, const StiffnessByLabel& stiffness,
                   const Vec3& centre_mm) const;

 private:
  template <class Field, class Stiffness>
  ElasticPush pushIn(const TissueField& tissue, const Stiffness& stiffness,
                     const Vec3& centre_mm) const;

  struct Ray {
    Vec3 direction;  // patient axes
    Vec3 reach;      // the radius in voxels
  };
  std::vector<Ray> rays_;
  Mat4 patient_to_voxel_;
  double radius_m_;
  Vec3 reach_;  // voxels, of the outermost sample on each axis
};

}  // namespace trephine
