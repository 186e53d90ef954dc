// What is seen under a pixel, by going along its ray through the voxels: for tools that work where
// one points. Pure; a fraction of a millisecond.
#pragma once

#include <optional>
#include <vector>

#include "render/clip_plane.h"
#include "render/view_camera.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// Patient frame.
struct Picked {
  Vec3 at_mm{0.0};      // the middle of the first voxel seen
  Vec3 inside_mm{0.0};  // on along the ray by at most kInside_mm, while it stays in it
};
// Far enough in that what is around is of the organ, for a seed to grow from.
constexpr double kInside_mm = 8.0;

// Where the tissue begins in which the ray becomes opaque by half; where none does, the first that
// is seen at all. Ghosts and what is hidden are passed through, as is what clip planes take away.
// `labels` are of the volume's grid; null: none.
std::optional<Picked> pick(const Volume& volume, const LabelMap* labels, const TissueSet& tissues,
                           const TissueLooks& looks, const std::vector<ClipPlane>& clip,
                           const ViewCamera::Ray& ray);

}  // namespace trephine
