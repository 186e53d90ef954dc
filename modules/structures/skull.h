// The skull of a head CT, without a click: the largest piece of bone, its border half-way to what
// lies about it, its marrow filled. By HU and shape alone.
//
// 1. The largest piece of what is over kBone_HU; voxels that share a corner hang together, since
//    that is all that holds the thinnest bones.
// 2. Pockets in it where no ball of kPocket_mm has room and which do not hold air: marrow between
//    the tables. No way across faces leads into them, at least within the slices of two of the
//    three ways to cut the grid. Brain, orbits, nose and sinuses are none, and canals are closed in
//    one.
// 3. Bone is denser than kBone_HU, and a scanner's blur spreads it: from its surface inwards, as
//    far as the blur reaches, what is less than half-way between the least and the most HU near it
//    goes. In air half-way lies below kBone_HU, so a bare skull keeps all of it.
// 4. The largest piece of what stayed.
//
// What touches the skull and is as dense comes along: the upper neck, a jaw that is shut. Where
// they do not touch, they are pieces of their own and left out.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

constexpr double kBone_HU = 226.0;  // where programs for CT commonly let bone begin
constexpr double kPocket_mm = 4.0;  // radius
constexpr double kLeastBone_ml = 5.0;

struct Skull {
  LabelMap mask;         // 0 and 1, on the volume's grid
  double hu = kBone_HU;  // the threshold of step 1
  std::size_t voxels = 0;
  double ml = 0.0;
  std::vector<std::string> steps;  // what was done, in words
};

// The largest bone of whatever the volume shows, a head or not; the mask lists no structures. Two
// threads inside; takes a byte a voxel beside the volume, and 12 a run of voxels. Errors:
// NO_BONE (no piece of kLeastBone_ml), CANCELLED, OUT_OF_MEMORY.
Result<Skull> skullOf(const Volume& volume, const Progress& progress = Progress());

}  // namespace trephine
