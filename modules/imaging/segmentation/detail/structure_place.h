// Inside: whether a segmentation would explain the CT far better in another place, or mirrored.
// Needs no names: what a structure is has HU of its own, and other HU around it.
#pragma once

#include <optional>

#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct BetterPlace {
  bool mirrored = false;  // along the axis; how far it has to be moved as well is not told
  int axis = 0;           // of the CT
  int voxels = 0;         // by which it is to be moved along the axis
};

// Looked for along each of the CT's axes. `covers`: what the file has a say about; `slack_mm`: what
// a good segmentation may be off by, at least a cell of about 3.5 mm. None where the map fits about
// as well as anywhere else, where nothing can be told from HU, and of less than about 100 mL.
std::optional<BetterPlace> betterPlace(const LabelMap& map, const Volume& ct,
                                       const VoxelBox& covers, double slack_mm);

}  // namespace trephine
