// The live HU grid: one writer at a time, readers that copy what changed.
//
// Protocol (architecture.md): the holder of the write token stores int16 with relaxed atomics, then
// marks the 16^3 brick with a store(release). The one reader takes marks with exchange(acquire)
// and copies those bricks with relaxed loads into its own Volume. Drawing and slices see only such
// copies; saving and hashing read the grid itself, while its writer stands still (voxel_slabs.h).
// Labels never change, so any thread may read them.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

constexpr int kBrickEdge = 16;
constexpr int kBrickShift = 4;  // dividing by the edge
static_assert(1 << kBrickShift == kBrickEdge);

class Grid {
 public:
  // `labels`, where there are any, are fitted to the volume: fitTo().
  explicit Grid(Volume volume, std::shared_ptr<const LabelMap> labels = nullptr);
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  const GridGeometry& geometry() const { return volume_.geometry; }

  // Any thread. A voxel outside the grid is air.
  std::int16_t hu(std::size_t index) const {
    return std::atomic_ref<std::int16_t>(voxels_[index]).load(std::memory_order_relaxed);
  }
  // 0: none. Any thread.
  std::uint8_t label(std::size_t index) const { return of_voxel_ ? of_voxel_[index] : 0; }
  // Null where the case has none.
  const std::shared_ptr<const LabelMap>& labels() const { return labels_; }
  // Hints that a voxel, or the eight from one on, will be read.
  void prefetch(std::size_t index) const {
    __builtin_prefetch(voxels_ + index);
    if (of_voxel_) __builtin_prefetch(of_voxel_ + index);
  }
  void prefetch(std::size_t index, std::size_t row, std::size_t slice) const {
    for (std::size_t at : {index, index + row, index + slice, index + slice + row}) prefetch(at);
  }
  std::int16_t hu(int i, int j, int k) const {
    return geometry().contains(i, j, k) ? hu(geometry().indexOf(i, j, k)) : kAirHu;
  }

  // The number of the brick that holds a voxel, i fastest. Any thread.
  std::size_t brickOf(std::size_t index) const {
    const std::size_t row = by_width_.divide(index);
    const std::size_t k = by_height_.divide(row);
    return brickAt(index - row * std::size_t(geometry().size[0]),
                   row - k * std::size_t(geometry().size[1]), k);
  }

  // The right to write voxels. Moves between threads; given back when destroyed. Holding it is the
  // caller's promise to write from one thread at a time. Wait-free, no allocation.
  class Writer {
   public:
    Writer(Writer&& other) noexcept : grid_(std::exchange(other.grid_, nullptr)) {}
    Writer& operator=(Writer&&) = delete;
    ~Writer() {
      if (grid_) grid_->taken_.store(false, std::memory_order_release);
    }
    // Stores `hu` and marks the brick; returns what was there before. The voxel lies in the grid.
    std::int16_t store(std::size_t index, std::int16_t hu) {
      const std::size_t row = grid_->by_width_.divide(index);
      const std::size_t k = grid_->by_height_.divide(row);
      const Index3& size = grid_->geometry().size;
      return grid_->store(index, index - row * std::size_t(size[0]), row - k * std::size_t(size[1]),
                          k, hu);
    }
    // The same for a caller that knows the voxel by its three numbers.
    std::int16_t store(int i, int j, int k, std::int16_t hu) {
      return grid_->store(grid_->geometry().indexOf(i, j, k), std::size_t(i), std::size_t(j),
                          std::size_t(k), hu);
    }
    const Grid& grid() const { return *grid_; }

   private:
    friend class Grid;
    explicit Writer(Grid* grid) : grid_(grid) {}
    Grid* grid_;
  };
  // Nothing while another writer stands.
  std::optional<Writer> takeWriter();

  // The reader's side: one thread at a time.
  // Copies every brick marked since the last call into `copy` (of this geometry) and appends the
  // boxes, neighbours along i merged.
  void copyChanges(Volume& copy, std::vector<VoxelBox>& boxes);
  // A full copy; relaxed loads, so it may be taken while the writer works.
  Volume snapshot() const;

 private:
  // Divides by a number known in advance, without a division: multiplies by 2^64 / d,
  // rounded up, and keeps the upper 64 bits. Exact where n * d < 2^64, which a grid's voxel numbers
  // and edges satisfy.
  struct Divisor {
    std::uint64_t factor = 0;  // 0: by one
    explicit Divisor(std::uint64_t d) : factor(d == 1 ? 0 : ~std::uint64_t(0) / d + 1) {}
    std::uint64_t divide(std::uint64_t n) const {
      return factor == 0 ? n : std::uint64_t((static_cast<unsigned __int128>(n) * factor) >> 64);
    }
  };

  std::int16_t store(std::size_t index, std::size_t i, std::size_t j, std::size_t k,
                     std::int16_t hu) {
    std::atomic_ref<std::int16_t> voxel(voxels_[index]);
    const std::int16_t before = voxel.load(std::memory_order_relaxed);
    voxel.store(hu, std::memory_order_relaxed);
    dirty_[brickAt(i, j, k)].store(1, std::memory_order_release);
    return before;
  }
  std::size_t brickAt(std::size_t i, std::size_t j, std::size_t k) const {
    return ((k >> kBrickShift) * std::size_t(bricks_[1]) + (j >> kBrickShift)) *
               std::size_t(bricks_[0]) +
           (i >> kBrickShift);
  }

  Volume volume_;
  std::int16_t* voxels_;
  std::shared_ptr<const LabelMap> labels_;
  const std::uint8_t* of_voxel_;  // the labels; null: none
  Divisor by_width_;
  Divisor by_height_;
  Index3 bricks_;
  // A byte a brick: with one writer a plain store marks it, where bits in a shared word would need
  // a locked one.
  std::unique_ptr<std::atomic<std::uint8_t>[]> dirty_;
  std::size_t brick_count_;
  std::atomic<bool> taken_{false};
};

}  // namespace trephine
