#include "volume/grid.h"

#include <algorithm>
#include <utility>

#include "volume/two_threads.h"

namespace trephine {

Grid::Grid(Volume volume, std::shared_ptr<const LabelMap> labels)
    : volume_(std::move(volume)),
      voxels_(volume_.hu.data()),
      labels_(std::move(labels)),
      of_voxel_(labels_ ? labels_->labels.data() : nullptr),
      by_width_(std::uint64_t(std::max(geometry().size[0], 1))),
      by_height_(std::uint64_t(std::max(geometry().size[1], 1))) {
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    bricks_[axis] = (geometry().size[axis] + kBrickEdge - 1) / kBrickEdge;
    count *= std::size_t(bricks_[axis]);
  }
  brick_count_ = count;
  dirty_ = std::make_unique<std::atomic<std::uint8_t>[]>(brick_count_);
}

std::optional<Grid::Writer> Grid::takeWriter() {
  if (taken_.exchange(true, std::memory_order_acquire)) return std::nullopt;
  return Writer(this);
}

void Grid::copyChanges(Volume& copy, std::vector<VoxelBox>& boxes) {
  const Index3& size = geometry().size;
  for (std::size_t brick = 0; brick < brick_count_; ++brick) {
    if (dirty_[brick].load(std::memory_order_relaxed) == 0) continue;
    dirty_[brick].exchange(0, std::memory_order_acquire);
    const auto nx = std::size_t(bricks_[0]), ny = std::size_t(bricks_[1]);
    const Index3 at{std::int32_t(brick % nx), std::int32_t(brick / nx % ny),
                    std::int32_t(brick / (nx * ny))};
    VoxelBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = at[axis] * kBrickEdge;
      box.high[axis] = std::min(box.low[axis] + kBrickEdge, size[axis]);
    }
    for (int k = box.low[2]; k < box.high[2]; ++k) {
      for (int j = box.low[1]; j < box.high[1]; ++j) {
        for (int i = box.low[0]; i < box.high[0]; ++i) {
          const std::size_t index = geometry().indexOf(i, j, k);
          copy.hu[index] = hu(index);
        }
      }
    }
    const bool joins = !boxes.empty() && boxes.back().high[0] == box.low[0] &&
                       boxes.back().low[1] == box.low[1] && boxes.back().low[2] == box.low[2];
    if (joins) {
      boxes.back().high[0] = box.high[0];
    } else {
      boxes.push_back(box);
    }
  }
}

Volume Grid::snapshot() const {
  Volume copy{geometry(), Voxels(volume_.hu.size())};
  const Index3& size = geometry().size;
  const std::size_t slice = std::size_t(size[0]) * std::size_t(size[1]);
  onTwoThreads(size[2], [&](int k) {
    const std::size_t from = slice * std::size_t(k);
    for (std::size_t index = from; index < from + slice; ++index) copy.hu[index] = hu(index);
  });
  return copy;
}

}  // namespace trephine
