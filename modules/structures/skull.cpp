#include "structures/skull.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/codes.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/tr.h"
#include "structures/codes.h"
#include "structures/voxel_runs.h"

namespace trephine {

namespace {

constexpr double kAirPocket_HU = -200.0;  // the mean of one that holds air
constexpr double kNear_mm = 1.5;          // where the least and the most HU are looked for
constexpr double kBlur_mm = 1.3;          // how far it reaches into bone
constexpr int kDensestBone_HU = 1600;     // beyond is enamel or metal

// Steps to the voxels whose middles lie within a ball, nearest first; one along each axis at least.
std::vector<Index3> ballSteps(const Vec3& spacing_mm, double radius_mm) {
  Index3 reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reach[axis] = std::max(1, int(radius_mm / spacing_mm[int(axis)]));
  }
  const auto far_mm = [&](const Index3& s) {
    return glm::length(Vec3(s[0], s[1], s[2]) * spacing_mm);
  };
  std::vector<Index3> steps;
  for (int c = -reach[2]; c <= reach[2]; ++c) {
    for (int b = -reach[1]; b <= reach[1]; ++b) {
      for (int a = -reach[0]; a <= reach[0]; ++a) {
        const bool beside = std::abs(a) + std::abs(b) + std::abs(c) <= 1;
        if (beside || far_mm({a, b, c}) <= radius_mm) steps.push_back({a, b, c});
      }
    }
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [&](const Index3& x, const Index3& y) { return far_mm(x) < far_mm(y); });
  return steps;
}

class SkullMask {
 public:
  enum State : std::uint8_t { kOut, kBone, kFilled, kClosed = 4, kFirstCut = 8 };

  explicit SkullMask(const Volume& volume)
      : volume_(volume), g_(volume.geometry), mask_(g_.voxelCount()) {}

  // How many voxels the largest piece has.
  std::size_t takeLargest() {
    VoxelRuns bone(g_.size, [&](int i, int j, int k) { return volume_.at(i, j, k) > kBone_HU; });
    bone.join(Touching::corners);
    if (bone.pieces().empty()) return 0;
    const std::uint32_t largest = bone.largest();
    bone.forRuns([&](int begin, int end, int j, int k, std::uint32_t piece) {
      if (piece == largest) fill(begin, end, j, k, kBone);
    });
    return bone.pieces()[largest].voxels;
  }

  // How many voxels of marrow came in: of pockets that are closed, or closed in the slices of two
  // of the three ways to cut, which a leak elsewhere does not undo and a canal is not.
  std::size_t fillPockets(const Progress& progress) {
    markPockets({0, 1, 2}, Touching::faces, kClosed);
    const std::array<std::array<std::size_t, 3>, 3> cuts{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};
    for (std::size_t n = 0; n < 3 && !progress.cancelled(); ++n) {
      markPockets(cuts[n], Touching::faces_in_layer, std::uint8_t(kFirstCut << n));
    }
    std::vector<std::size_t> filled(std::size_t(g_.size[2]));
    const std::size_t slice = std::size_t(g_.size[0]) * std::size_t(g_.size[1]);
    onTwoThreads(g_.size[2], [&](int k) {
      std::uint8_t* first = &mask_[g_.indexOf(0, 0, k)];
      for (std::uint8_t* at = first; at < first + slice; ++at) {
        if (*at <= kBone) continue;
        const bool is = (*at & kClosed) || std::popcount(unsigned(*at)) >= 2;
        *at = is ? kFilled : kOut;
        filled[std::size_t(k)] += is;
      }
    });
    return std::accumulate(filled.begin(), filled.end(), std::size_t(0));
  }

  // How many voxels went. In layers of a voxel; an axis on which voxels are longer has fewer.
  std::size_t peel(const Progress& progress) {
    const std::vector<Index3> near = ballSteps(g_.spacing_mm, kNear_mm);
    std::vector<std::ptrdiff_t> offsets;
    Index3 reach{0, 0, 0};
    for (const Index3& s : near) {
      offsets.push_back((std::ptrdiff_t(s[2]) * g_.size[1] + s[1]) * g_.size[0] + s[0]);
      for (std::size_t axis = 0; axis < 3; ++axis) reach[axis] = std::max(reach[axis], s[axis]);
    }
    Index3 depth;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      depth[axis] = std::max(1, int(std::lround(kBlur_mm / g_.spacing_mm[int(axis)])));
    }
    const int layers = std::max({depth[0], depth[1], depth[2]});
    const std::size_t slices = std::size_t(g_.size[2]);
    std::vector<std::vector<std::size_t>> gone(slices), going(slices);
    std::size_t count = 0;
    for (int layer = 0; layer < layers && !progress.cancelled(); ++layer) {
      // Decided first, then done: what goes depends on the layer before alone.
      onTwoThreadsOrThrow(g_.size[2], [&](int k) {
        std::vector<std::size_t>& list = going[std::size_t(k)];
        list = layer == 0 ? surface(k) : beside(gone, k, layer, depth);
        std::erase_if(list,
                      [&](std::size_t at) { return !isLessThanHalf(near, offsets, reach, at, k); });
      });
      for (const std::vector<std::size_t>& list : going) {
        for (const std::size_t at : list) mask_[at] = kOut;
        count += list.size();
      }
      gone.swap(going);
    }
    return count;
  }

  // Makes it 0 and 1; how many voxels are left.
  std::size_t keepLargest() {
    VoxelRuns bone(g_.size,
                   [&](int i, int j, int k) { return mask_[g_.indexOf(i, j, k)] != kOut; });
    bone.join(Touching::corners);
    if (bone.pieces().empty()) return 0;
    const std::uint32_t largest = bone.largest();
    bone.forRuns([&](int begin, int end, int j, int k, std::uint32_t piece) {
      fill(begin, end, j, k, piece == largest ? kBone : kOut);
    });
    return bone.pieces()[largest].voxels;
  }

  std::vector<std::uint8_t> take() { return std::move(mask_); }

 private:
  void fill(int begin, int end, int j, int k, State state) {
    std::uint8_t* row = &mask_[g_.indexOf(0, j, k)];
    std::fill(row + begin, row + end, state);
  }

  // A bit a voxel in the order of `axes`: the mask itself is slow to read across its rows.
  std::vector<std::uint64_t> boneBits(const Index3& size,
                                      const std::array<std::size_t, 3>& axes) const {
    std::vector<std::uint64_t> bits(mask_.size() / 64 + 1);
    const std::size_t in_order[3] = {1, std::size_t(size[0]),
                                     std::size_t(size[0]) * std::size_t(size[1])};
    std::size_t step[3];  // of the bits, along i, j and k
    for (std::size_t n = 0; n < 3; ++n) step[axes[n]] = in_order[n];
    const std::size_t row = std::size_t(g_.size[0]);
    for (int k = 0; k < g_.size[2]; ++k) {
      for (int j = 0; j < g_.size[1]; ++j) {
        const std::uint8_t* first = &mask_[g_.indexOf(0, j, k)];
        const std::size_t from = std::size_t(j) * step[1] + std::size_t(k) * step[2];
        for (std::size_t i = 0; i < row; ++i) {
          if (first[i] != kBone) continue;
          const std::size_t at = from + i * step[0];
          bits[at / 64] |= std::uint64_t(1) << (at % 64);
        }
      }
    }
    return bits;
  }

  // Sets `mark` where narrow pockets are. `axes`: along rows, from row to row, across layers.
  void markPockets(const std::array<std::size_t, 3>& axes, Touching touching, std::uint8_t mark) {
    const std::size_t strides[3] = {1, std::size_t(g_.size[0]),
                                    std::size_t(g_.size[0]) * std::size_t(g_.size[1])};
    const std::size_t along = strides[axes[0]], down = strides[axes[1]], deep = strides[axes[2]];
    const Index3 size{g_.size[axes[0]], g_.size[axes[1]], g_.size[axes[2]]};
    const auto indexOf = [&](int a, int b, int c) {
      return std::size_t(a) * along + std::size_t(b) * down + std::size_t(c) * deep;
    };
    const std::vector<std::uint64_t> bone = boneBits(size, axes);
    VoxelRuns about(size, [&](int a, int b, int c) {
      const std::size_t at =
          (std::size_t(c) * std::size_t(size[1]) + std::size_t(b)) * std::size_t(size[0]) +
          std::size_t(a);
      return (bone[at / 64] >> (at % 64) & 1) == 0;
    });
    about.join(touching);
    Vec3 spacing_mm;
    for (int n = 0; n < 3; ++n) spacing_mm[n] = g_.spacing_mm[int(axes[std::size_t(n)])];
    std::vector<Index3> ball = ballSteps(spacing_mm, kPocket_mm);
    if (touching == Touching::faces_in_layer) {
      std::erase_if(ball, [](const Index3& s) { return s[2] != 0; });
    }
    const auto hasRoom = [&](int a, int b, int c) {
      return std::none_of(ball.begin(), ball.end(), [&](const Index3& s) {
        const int x = a + s[0], y = b + s[1], z = c + s[2];
        return x >= 0 && y >= 0 && z >= 0 && x < size[0] && y < size[1] && z < size[2] &&
               mask_[indexOf(x, y, z)] == kBone;
      });
    };
    const std::vector<VoxelRuns::Piece>& pieces = about.pieces();
    std::vector<std::uint8_t> open(pieces.size());
    std::vector<double> hu(pieces.size());
    for (std::size_t n = 0; n < open.size(); ++n) {
      open[n] = touching == Touching::faces_in_layer && pieces[n].at_border;
    }
    for (int c = 0; c < size[2]; ++c) {
      for (int b = 0; b < size[1]; ++b) {
        for (const VoxelRuns::Run& run : about.row(b, c)) {
          for (int a = run.begin; a < run.end && !open[run.piece]; ++a) {
            open[run.piece] = hasRoom(a, b, c);
            hu[run.piece] += volume_.hu[indexOf(a, b, c)];
          }
        }
      }
    }
    for (std::size_t n = 0; n < open.size(); ++n) {
      open[n] = open[n] || hu[n] < kAirPocket_HU * double(pieces[n].voxels);
    }
    // On one thread: layers across i share their bytes' cache lines.
    for (int c = 0; c < size[2]; ++c) {
      for (int b = 0; b < size[1]; ++b) {
        for (const VoxelRuns::Run& run : about.row(b, c)) {
          if (open[run.piece]) continue;
          for (int a = run.begin; a < run.end; ++a) mask_[indexOf(a, b, c)] |= mark;
        }
      }
    }
  }

  // Bone of slice k with a face to what is out.
  std::vector<std::size_t> surface(int k) const {
    std::vector<std::size_t> found;
    const std::size_t row = std::size_t(g_.size[0]), slice = row * std::size_t(g_.size[1]);
    for (int j = 0; j < g_.size[1]; ++j) {
      const std::uint8_t* first = &mask_[g_.indexOf(0, j, k)];
      const std::uint8_t* const end = first + row;
      for (const std::uint8_t* at = first;
           (at = static_cast<const std::uint8_t*>(std::memchr(at, kBone, std::size_t(end - at))));
           ++at) {
        const bool open =
            (at > first && at[-1] == kOut) || (at + 1 < end && at[1] == kOut) ||
            (j > 0 && *(at - row) == kOut) || (j + 1 < g_.size[1] && at[row] == kOut) ||
            (k > 0 && *(at - slice) == kOut) || (k + 1 < g_.size[2] && at[slice] == kOut);
        if (open) found.push_back(std::size_t(at - mask_.data()));
        if (at + 1 == end) break;
      }
    }
    return found;
  }

  // Bone of slice k with a face to what went in the layer before, each once.
  std::vector<std::size_t> beside(const std::vector<std::vector<std::size_t>>& gone, int k,
                                  int layer, const Index3& depth) const {
    std::vector<std::size_t> found;
    const std::size_t strides[3] = {1, std::size_t(g_.size[0]),
                                    std::size_t(g_.size[0]) * std::size_t(g_.size[1])};
    const auto add = [&](std::size_t at) {
      if (mask_[at] == kBone) found.push_back(at);
    };
    for (const std::size_t at : gone[std::size_t(k)]) {
      const Index3 voxel = g_.indicesOf(at);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (layer >= depth[axis]) continue;
        if (voxel[axis] > 0) add(at - strides[axis]);
        if (voxel[axis] + 1 < g_.size[axis]) add(at + strides[axis]);
      }
    }
    if (layer < depth[2]) {
      if (k > 0) {
        for (const std::size_t at : gone[std::size_t(k) - 1]) add(at + strides[2]);
      }
      if (k + 1 < g_.size[2]) {
        for (const std::size_t at : gone[std::size_t(k) + 1]) add(at - strides[2]);
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  // `offsets` are those of `near`, for voxels that lie `reach` inside of the grid.
  bool isLessThanHalf(const std::vector<Index3>& near, const std::vector<std::ptrdiff_t>& offsets,
                      const Index3& reach, std::size_t at, int k) const {
    const std::size_t in_slice = at - g_.indexOf(0, 0, k);
    const int i = int(in_slice % std::size_t(g_.size[0])),
              j = int(in_slice / std::size_t(g_.size[0]));
    const std::int16_t* hu = &volume_.hu[at];
    std::int16_t most = *hu, least = *hu;
    const auto take = [&](std::ptrdiff_t offset) {
      most = std::max(most, hu[offset]);
      least = std::min(least, hu[offset]);
    };
    if (g_.contains(i - reach[0], j - reach[1], k - reach[2]) &&
        g_.contains(i + reach[0], j + reach[1], k + reach[2])) {
      for (const std::ptrdiff_t offset : offsets) take(offset);
    } else {
      for (std::size_t n = 0; n < near.size(); ++n) {
        if (g_.contains(i + near[n][0], j + near[n][1], k + near[n][2])) take(offsets[n]);
      }
    }
    return 2 * int(*hu) < std::max(int(least), int(kAirHu)) + std::min(int(most), kDensestBone_HU);
  }

  const Volume& volume_;
  const GridGeometry& g_;
  std::vector<std::uint8_t> mask_;
};

Result<Skull> make(const Volume& volume, const Progress& progress) {
  const Error cancelled{code::kCancelled, tr("Finding the skull was cancelled"), "", ""};
  const auto on = [&](double fraction, const char* step) {
    progress.at(fraction, step);
    return !progress.cancelled();
  };
  const double voxel_ml = volume.geometry.voxelVolume_mm3() / 1000.0;
  const auto ml = [&](std::size_t voxels) { return double(voxels) * voxel_ml; };
  Skull skull;
  skull.mask.geometry = volume.geometry;
  if (!on(0.0, "bone")) return cancelled;
  SkullMask mask(volume);
  const std::size_t bone = mask.takeLargest();
  if (ml(bone) < kLeastBone_ml) {
    return Error{code::kNoBone,
                 tr("The largest piece over {} HU has {} mL", formatted("%.0f", kBone_HU),
                    formatted("%.1f", ml(bone))),
                 "", tr("Choose a CT of a head whose values are HU")};
  }
  if (!on(0.3, "pockets")) return cancelled;
  const std::size_t filled = mask.fillPockets(progress);
  if (!on(0.5, "border")) return cancelled;
  const std::size_t peeled = mask.peel(progress);
  if (!on(0.9, "pieces")) return cancelled;
  skull.voxels = mask.keepLargest();
  skull.ml = ml(skull.voxels);
  skull.mask.labels = mask.take();
  skull.steps = {formatted("largest piece over %.0f HU: %.1f mL", kBone_HU, ml(bone)),
                 formatted("%.1f mL of marrow filled", ml(filled)),
                 formatted("border half-way: %.1f mL less", ml(peeled))};
  return skull;
}

}  // namespace

Result<Skull> skullOf(const Volume& volume, const Progress& progress) {
  const double needed_mb = 2.0 * double(volume.geometry.voxelCount()) / (1 << 20) + 50.0;
  if (Status enough = enoughMemory(needed_mb, tr("Finding the skull"), ""); !enough) {
    return enough.error();
  }
  try {
    return make(volume, progress);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the skull"), "");
  }
}

}  // namespace trephine
