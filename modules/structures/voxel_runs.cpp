#include "structures/voxel_runs.h"

#include <algorithm>
#include <limits>

#include "volume/union_find.h"

namespace trephine {

void VoxelRuns::join(Touching touching) {
  std::vector<std::uint32_t> offset(layers_.size() + 1);
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    offset[k + 1] = offset[k] + std::uint32_t(layers_[k].runs.size());
  }
  UnionFind sets(offset.back());
  const std::int32_t apart = touching == Touching::corners ? 1 : 0;
  const auto joinRows = [&](int j, int k, int other_j, int other_k) {
    if (other_j < 0 || other_j >= size_[1] || other_k < 0) return;
    const auto here = row(j, k), there = row(other_j, other_k);
    const std::uint32_t of_here =
        offset[std::size_t(k)] + layers_[std::size_t(k)].first[std::size_t(j)];
    const std::uint32_t of_there =
        offset[std::size_t(other_k)] + layers_[std::size_t(other_k)].first[std::size_t(other_j)];
    for (std::size_t a = 0, b = 0; a < here.size() && b < there.size();) {
      if (here[a].begin < there[b].end + apart && there[b].begin < here[a].end + apart) {
        sets.join(of_here + std::uint32_t(a), of_there + std::uint32_t(b));
      }
      if (here[a].end < there[b].end) {
        ++a;
      } else {
        ++b;
      }
    }
  };
  for (int k = 0; k < size_[2]; ++k) {
    for (int j = 0; j < size_[1]; ++j) {
      if (row(j, k).empty()) continue;
      joinRows(j, k, j - 1, k);
      if (touching == Touching::faces_in_layer) continue;
      joinRows(j, k, j, k - 1);
      if (touching == Touching::faces) continue;
      joinRows(j, k, j - 1, k - 1);
      joinRows(j, k, j + 1, k - 1);
    }
  }
  pieces_.clear();
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(offset.back(), kNone);
  for (int k = 0; k < size_[2]; ++k) {
    const bool end_k = touching != Touching::faces_in_layer && (k == 0 || k == size_[2] - 1);
    Layer& layer = layers_[std::size_t(k)];
    for (int j = 0; j < size_[1]; ++j) {
      for (std::uint32_t n = layer.first[std::size_t(j)]; n < layer.first[std::size_t(j) + 1];
           ++n) {
        Run& run = layer.runs[n];
        std::uint32_t& of_set = number[sets.root(offset[std::size_t(k)] + n)];
        if (of_set == kNone) {
          of_set = std::uint32_t(pieces_.size());
          pieces_.push_back({0, false, {run.begin, j, k}});
        }
        run.piece = of_set;
        Piece& piece = pieces_[of_set];
        piece.voxels += std::size_t(run.end - run.begin);
        piece.at_border = piece.at_border || end_k || j == 0 || j == size_[1] - 1 ||
                          run.begin == 0 || run.end == size_[0];
      }
    }
  }
}

std::uint32_t VoxelRuns::largest() const {
  const auto most =
      std::max_element(pieces_.begin(), pieces_.end(),
                       [](const Piece& a, const Piece& b) { return a.voxels < b.voxels; });
  return std::uint32_t(most - pieces_.begin());
}

const VoxelRuns::Run* VoxelRuns::at(const Index3& voxel) const {
  const auto runs = row(voxel[1], voxel[2]);
  const auto after = std::upper_bound(runs.begin(), runs.end(), voxel[0],
                                      [](int i, const Run& run) { return i < run.begin; });
  if (after == runs.begin() || voxel[0] >= (after - 1)->end) return nullptr;
  return &*(after - 1);
}

}  // namespace trephine
