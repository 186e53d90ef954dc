// Removed voxels as the shader tells them from air that was there before: on the graphics card they
// have a HU of their own. In the copy that is sent they have it only while this lives. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "volume/volume.h"
#include "volume/volume_mirror.h"

namespace trephine {

// A HU that no voxel of a volume has whose lowest is this, or hardly one: near to air, since what
// lies beside it is interpolated with it.
std::int16_t cutMark(std::int16_t lowest_HU);

// What was touched since the mirror was whole, in a copy whose voxels stand for `factors` of its.
// Empty where nothing was, or where the mirror does not know what it was before.
VoxelBox boxOfCuts(const VolumeMirror& mirror, const Index3& factors);

class CutMarks {
 public:
  // Voxels in the box of `copy`, which is the mirror's own or has one for `factors` of its.
  CutMarks(Volume& copy, const VoxelBox& box, const VolumeMirror& mirror, const Index3& factors,
           std::int16_t mark);
  ~CutMarks();
  CutMarks(const CutMarks&) = delete;
  CutMarks& operator=(const CutMarks&) = delete;

 private:
  Volume& copy_;
  std::vector<std::size_t> marked_;
};

}  // namespace trephine
