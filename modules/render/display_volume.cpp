#include "render/display_volume.h"

#include <algorithm>

namespace trephine {

namespace {

int shareOf(int size, int factor) {
  return (size + factor - 1) / factor;
}

}  // namespace

Index3 reductionFor(const Index3& size, int most, bool labels) {
  Index3 factors{1, 1, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto edge = [&] {
      const int voxels = shareOf(size[axis], factors[axis]);
      return labels && axis == 2 ? voxels + shareOf(voxels, 8) + 1 : voxels;
    };
    while (edge() > std::max(most, 16)) factors[axis] *= 2;
  }
  return factors;
}

DisplayVolume::DisplayVolume(const Volume& full, const Index3& factors) : factors_(factors) {
  const GridGeometry& from = full.geometry;
  GridGeometry& to = volume_.geometry;
  to = from;
  Vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    to.size[a] = shareOf(from.size[a], factors[a]);
    to.spacing_mm[axis] *= factors[a];
    middle[axis] = 0.5 * (factors[a] - 1);
  }
  to.origin_mm = from.toPatient_mm(middle);
  volume_.hu.resize(to.voxelCount());
  fill(full, {{0, 0, 0}, to.size});
}

VoxelBox DisplayVolume::mine(const VoxelBox& box) const {
  VoxelBox mine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mine.low[axis] = box.low[axis] / factors_[axis];
    mine.high[axis] = shareOf(box.high[axis], factors_[axis]);
  }
  return mine;
}

VoxelBox DisplayVolume::update(const Volume& full, const VoxelBox& box) {
  const VoxelBox changed = mine(box);
  fill(full, changed);
  return changed;
}

void DisplayVolume::fill(const Volume& full, const VoxelBox& box) {
  const Index3& size = full.geometry.size;
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        const int i_end = std::min((i + 1) * factors_[0], size[0]);
        const int j_end = std::min((j + 1) * factors_[1], size[1]);
        const int k_end = std::min((k + 1) * factors_[2], size[2]);
        std::int64_t sum = 0, count = 0;
        for (int z = k * factors_[2]; z < k_end; ++z) {
          for (int y = j * factors_[1]; y < j_end; ++y) {
            for (int x = i * factors_[0]; x < i_end; ++x, ++count) sum += full.at(x, y, z);
          }
        }
        volume_.hu[volume_.geometry.indexOf(i, j, k)] =
            std::int16_t(sum / std::max<std::int64_t>(1, count));
      }
    }
  }
}

std::shared_ptr<LabelMap> DisplayVolume::labels(const LabelMap& full) const {
  auto map = std::make_shared<LabelMap>(
      LabelMap{volume_.geometry, std::vector<std::uint8_t>(volume_.geometry.voxelCount())});
  fillLabels(full, {{0, 0, 0}, volume_.geometry.size}, *map);
  return map;
}

VoxelBox DisplayVolume::updateLabels(const LabelMap& full, const VoxelBox& box,
                                     LabelMap& labels) const {
  const VoxelBox changed = mine(box);
  fillLabels(full, changed, labels);
  return changed;
}

void DisplayVolume::fillLabels(const LabelMap& full, const VoxelBox& box, LabelMap& labels) const {
  const Index3& from = full.geometry.size;
  const auto middle = [&](int at, std::size_t axis) {
    return std::min(at * factors_[axis] + factors_[axis] / 2, from[axis] - 1);
  };
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        labels.labels[labels.geometry.indexOf(i, j, k)] =
            full.labels[full.geometry.indexOf(middle(i, 0), middle(j, 1), middle(k, 2))];
      }
    }
  }
}

}  // namespace trephine
