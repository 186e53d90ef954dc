// Places on a case that fit any patient: where a ray through the anatomy first meets a tissue.
#pragma once

#include <string>
#include <vector>

#include "base/math.h"
#include "base/progress.h"
#include "base/result.h"
#include "tissue/tissue_set.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// A ray that meets a tissue, given in one of two ways, or a place itself:
// - between two points, as fractions of the box that holds the tissue (its 1st to 99th percentile
//   on each patient axis, so that a table or noise does not count): (0, 0, 0) is right, anterior,
//   inferior and (1, 1, 1) left, posterior, superior. For a shell such as the vault.
// - towards the place with most of the tissue within `bulk_radius_mm`, from the direction
//   `outward`. For an organ, whatever else of the body the scan holds.
// - `at_mm`, of the patient's LPS frame, and from it `outward`: where a person clicked.
struct Landmark {
  std::string id;
  std::string tissue;           // a tissue's id; empty: the body, whatever it is of
  Vec3 from{0.5};               // outside the patient
  Vec3 towards{0.5};
  double bulk_radius_mm = 0.0;  // above 0: the second way
  Vec3 outward{0.0, -1.0, 0.0};
  double run_mm = 1.0;    // how long the ray must stay in the tissue to count
  bool is_place = false;  // the third way
  Vec3 at_mm{0.0};
  bool operator==(const Landmark&) const = default;
};

// Origin on the surface; +z back along the ray, out of the patient; +y towards the patient's head
// (or, for a ray along the body, towards the front); +x = y cross z.
struct LandmarkFrame {
  Vec3 position_mm{0.0};
  Quat rotation{1, 0, 0, 0};  // landmark axes to patient axes

  Vec3 toPatient_mm(const Vec3& offset_mm) const { return position_mm + rotation * offset_mm; }
  // Where the eye looks to see the landmark from outside: tilted by 24 degrees, so that a tool
  // along -z does not hide its own tip. +y is up.
  Vec3 viewDirection() const { return rotation * glm::normalize(Vec3(0.0, 0.45, -1.0)); }
  Vec3 viewUp() const { return rotation * Vec3(0.0, 1.0, 0.0); }
  bool operator==(const LandmarkFrame&) const = default;
};

// The rotation whose +z is `outward` (see LandmarkFrame).
Quat frameAlong(const Vec3& outward);

// HU are averaged over a quarter of `run_mm`, at most 3 mm, so that noise does not break a run.
// `labels`, where there are any, are fitted to the volume.
// Errors: NO_SUCH_TISSUE in the set, TISSUE_NOT_FOUND in the volume, NO_SURFACE along the ray,
// NO_PLACE outside of the scan, CANCELLED. The body is what is over -300 HU.
Result<LandmarkFrame> findLandmark(const Landmark& landmark, const Volume& volume,
                                   const TissueSet& tissues, const LabelMap* labels = nullptr,
                                   const Progress& progress = Progress());

// Each point moved along `outward`, a unit vector, to where a ray from outside first enters the
// landmark's tissue and stays in it, for kSurfaceRun_mm or the landmark's own run if that is
// shorter: from `reach_mm` outside of the point to as far inside. One whose ray does not enter it
// there stays. HU are averaged as for findLandmark; 0.02 mm exact.
constexpr double kSurfaceRun_mm = 1.0;
std::vector<Vec3> ontoSurface(std::vector<Vec3> points_mm, const Vec3& outward, double reach_mm,
                              const Landmark& landmark, const Volume& volume,
                              const TissueSet& tissues, const LabelMap* labels = nullptr);

}  // namespace trephine
