#include "render/cut_marks.h"

#include <algorithm>

namespace trephine {

std::int16_t cutMark(std::int16_t lowest_HU) {
  // Some scanners fill what they did not see with -2000 or less; the noise of air ends before this.
  constexpr std::int16_t kFarthest = -1100;
  if (lowest_HU <= kFarthest) return kFarthest;
  // Below the ramp of a tissue that begins right above removed voxels, as finely as tables tell it.
  constexpr std::int16_t kBelowAir = 15;
  return std::int16_t(std::min<int>(lowest_HU, kAirHu - kBelowAir) - 1);
}

VoxelBox boxOfCuts(const VolumeMirror& mirror, const Index3& factors) {
  VoxelBox box = mirror.whole() ? mirror.touched() : VoxelBox{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] /= factors[axis];
    box.high[axis] = (box.high[axis] + factors[axis] - 1) / factors[axis];
  }
  return box;
}

CutMarks::CutMarks(Volume& copy, const VoxelBox& box, const VolumeMirror& mirror,
                   const Index3& factors, std::int16_t mark)
    : copy_(copy) {
  const std::shared_ptr<const Volume> whole = mirror.whole();
  if (!whole || mark == kAirHu) return;
  const VoxelBox touched = boxOfCuts(mirror, factors);
  VoxelBox both;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.low[axis] = std::max(box.low[axis], touched.low[axis]);
    both.high[axis] = std::min(box.high[axis], touched.high[axis]);
  }
  const Index3& size = whole->geometry.size;
  // A block's middle speaks for all of it.
  const auto middle = [&](int at, std::size_t axis) {
    return std::min(at * factors[axis] + factors[axis] / 2, size[axis] - 1);
  };
  for (int k = both.low[2]; k < both.high[2]; ++k) {
    for (int j = both.low[1]; j < both.high[1]; ++j) {
      for (int i = both.low[0]; i < both.high[0]; ++i) {
        const std::size_t index = copy_.geometry.indexOf(i, j, k);
        if (copy_.hu[index] != kAirHu) continue;
        if (whole->at(middle(i, 0), middle(j, 1), middle(k, 2)) == kAirHu) continue;
        copy_.hu[index] = mark;
        marked_.push_back(index);
      }
    }
  }
}

CutMarks::~CutMarks() {
  for (const std::size_t index : marked_) copy_.hu[index] = kAirHu;
}

}  // namespace trephine
