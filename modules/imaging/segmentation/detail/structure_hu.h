// Inside: the HU that structures have where they lie, and whether they can be what they are named.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "imaging/segmentation/structure_fit.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

class StructureHu {
 public:
  void add(std::int16_t hu);
  std::size_t total() const { return total_; }
  double percentile(double share) const;
  double shareIn(double low, double high) const;

 private:
  static constexpr int kBins = 4096;  // of -1024 to 3071
  std::vector<std::uint32_t> bins_ = std::vector<std::uint32_t>(kBins);
  std::size_t total_ = 0;
};

using HuByLabel = std::array<std::optional<StructureHu>, 256>;

// Of each label's voxels, as the map lies or, with an axis, turned about along it within the box.
HuByLabel huOf(const LabelMap& map, const Volume& ct);
HuByLabel huOfTurned(const LabelMap& map, const Volume& ct, int axis, const VoxelBox& box);

// Most voxels have HU of the kind or nearly (noise, blur), and the median has.
bool isOfKind(const StructureHu& hu, const HuOfKind& kind);

// Labels whose names say a kind that their HU are not, neither as they lie nor moved by up to
// `slack_mm`: a rib that is a voxel off lies on muscle. `here`: huOf() of them.
std::array<bool, 256> notOfTheirKind(const LabelMap& map, const Volume& ct, const HuByLabel& here,
                                     double slack_mm);

// Along which axis of the CT the structures would have to be turned about, within the part that
// the file covers, to have HU of their kinds, which most do not have as they lie. Those whose names
// say no kind say nothing. `wrong`: notOfTheirKind() as they lie.
std::optional<int> mirroredAxis(const LabelMap& map, const Volume& ct, const VoxelBox& covers,
                                const HuByLabel& here, const std::array<bool, 256>& wrong);

}  // namespace trephine
