// A volume as the graphics card can take it: where it is too large, fewer and larger voxels, for
// display only. Pure.
#pragma once

#include <memory>

#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// How many voxels become one along i, j and k, powers of two, so that no edge of a texture exceeds
// `most`. With labels their texture is to fit too, which needs an eighth more slices and one.
Index3 reductionFor(const Index3& size, int most, bool labels);

// Means of blocks of `full`, at the blocks' middles; those at the far faces may hold fewer voxels.
class DisplayVolume {
 public:
  DisplayVolume(const Volume& full, const Index3& factors);

  Volume& volume() { return volume_; }
  // These voxels of `full` changed: which of the display's did.
  VoxelBox update(const Volume& full, const VoxelBox& box);
  // The label that the most voxels of a block have would need a count; its middle's is taken.
  std::shared_ptr<LabelMap> labels(const LabelMap& full) const;
  // The same of labels that changed: which of the display's did.
  VoxelBox updateLabels(const LabelMap& full, const VoxelBox& box, LabelMap& labels) const;

 private:
  VoxelBox mine(const VoxelBox& box) const;  // of the display's voxels
  void fillLabels(const LabelMap& full, const VoxelBox& box, LabelMap& labels) const;
  void fill(const Volume& full, const VoxelBox& box);  // of the display's voxels

  Index3 factors_;
  Volume volume_;
};

}  // namespace trephine
