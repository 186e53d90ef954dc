// Whether eyes, nose and mouth are still there once a face was cut away.
//
// They are told by their own anatomy, not by where the cut took the face to be nor by which way the
// head looks: an eye is a ball of water HU, about 24 mm wide, with fat, bone and air around it; a
// nose is skin that stands out narrowly, with bone and enclosed air behind it and head on both
// sides of it; the mouth lies below the nose, by half of what parts the eyes. So it does not matter
// whether the patient lies supine, prone or upside down, with the neck extended or the arms up, and
// a header that says so wrongly is found out.
//
// Pure functions.
#pragma once

#include <optional>
#include <vector>

#include "imaging/steps/coarse_grid.h"

namespace trephine {

// LPS mm: middles of the eyeballs, tip of the nose, middle of the lips.
struct FaceMarks {
  std::vector<Vec3> eyes;  // none, one or two
  std::optional<Vec3> nose, mouth;
  Vec3 forwards{0.0, -1.0, 0.0};  // unit, out of the face
};

// Cells of about 2 x 2 x 3 mm: an eye has some ten of them along each axis. Up to 24 MB; those of
// a longer scan are coarser. Two threads.
CoarseGrid faceGrid(const Volume& volume);
// What of a face `grid` shows; a head over about 40 degrees turned to a side may show no nose.
FaceMarks findFaceMarks(const CoarseGrid& grid);

// How much of what lay around each mark is as it was, 0 to 1: the fuller of two eyes.
struct FaceLeft {
  double eyes = 0.0, nose = 0.0, mouth = 0.0;
};
// `before` and `after` are grids of one volume.
FaceLeft faceLeft(const FaceMarks& marks, const CoarseGrid& before, const CoarseGrid& after);

}  // namespace trephine
