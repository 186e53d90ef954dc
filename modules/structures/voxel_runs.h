// A mask as runs of voxels along its rows, and the pieces that they make: at the CT's own
// resolution, where a number a voxel would take four times the mask. 12 bytes a run, and a bone has
// one every few dozen voxels.
#pragma once

#include <atomic>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "volume/two_threads.h"
#include "volume/volume.h"

namespace trephine {

// onTwoThreads() for work that may run out of memory: std::bad_alloc comes out at its end.
template <class Work>
void onTwoThreadsOrThrow(int count, const Work& work) {
  std::atomic<bool> full{false};
  onTwoThreads(count, [&](int n) {
    try {
      work(n);
    } catch (const std::bad_alloc&) {
      full = true;
    }
  });
  if (full) throw std::bad_alloc();
}

// What makes two voxels of one piece: a face that they share, or a corner at least (26 neighbours);
// a face within one layer (k) alone.
enum class Touching { faces, corners, faces_in_layer };

class VoxelRuns {
 public:
  struct Run {
    std::int32_t begin = 0, end = 0;  // [begin, end) along the row
    std::uint32_t piece = 0;          // from join() on
  };
  struct Piece {
    std::size_t voxels = 0;
    bool at_border = false;  // of the grid; along the layer alone with faces_in_layer
    Index3 first{0, 0, 0};   // the first of its voxels
  };

  // in(i, j, k) says whether that voxel is in. Two threads. std::bad_alloc where there is no
  // memory.
  template <class In>
  VoxelRuns(const Index3& size, const In& in);

  // Numbers the pieces, in the order of their first voxels.
  void join(Touching touching);
  const std::vector<Piece>& pieces() const { return pieces_; }
  // The number of the largest, the first of several; nothing is asked of a mask that is empty.
  std::uint32_t largest() const;
  // The run that holds the voxel; null: it is not in.
  const Run* at(const Index3& voxel) const;

  const Index3& size() const { return size_; }
  std::span<const Run> row(int j, int k) const {
    const Layer& layer = layers_[std::size_t(k)];
    return std::span(layer.runs)
        .subspan(layer.first[std::size_t(j)],
                 layer.first[std::size_t(j) + 1] - layer.first[std::size_t(j)]);
  }
  // take(begin, end, j, k, piece) of each run; two threads, a layer at a time.
  template <class Take>
  void forRuns(const Take& take) const;

 private:
  struct Layer {
    std::vector<Run> runs;
    std::vector<std::uint32_t> first;  // of each row, and the end
  };
  Index3 size_;
  std::vector<Layer> layers_;
  std::vector<Piece> pieces_;
};

template <class In>
VoxelRuns::VoxelRuns(const Index3& size, const In& in)
    : size_(size), layers_(std::size_t(size[2])) {
  onTwoThreadsOrThrow(size[2], [&](int k) {
    Layer& layer = layers_[std::size_t(k)];
    layer.first.reserve(std::size_t(size[1]) + 1);
    for (int j = 0; j < size[1]; ++j) {
      layer.first.push_back(std::uint32_t(layer.runs.size()));
      for (int i = 0; i < size[0]; ++i) {
        if (!in(i, j, k)) continue;
        const int begin = i;
        while (i < size[0] && in(i, j, k)) ++i;
        layer.runs.push_back({begin, i, 0});
      }
    }
    layer.first.push_back(std::uint32_t(layer.runs.size()));
  });
}

template <class Take>
void VoxelRuns::forRuns(const Take& take) const {
  onTwoThreads(size_[2], [&](int k) {
    for (int j = 0; j < size_[1]; ++j) {
      for (const Run& run : row(j, k)) take(run.begin, run.end, j, k, run.piece);
    }
  });
}

}  // namespace trephine
