#include "structures/block_border.h"

#include <algorithm>
#include <cmath>

#include "volume/two_threads.h"

namespace trephine {

namespace {

// What a block and the 26 around it say: none is in, some are, all are.
enum Near : std::uint8_t { kNone, kSome, kAll };
std::vector<std::uint8_t> nearOf(const BlockMask& in, const WorkGrid& grid) {
  std::vector<std::uint8_t> near(in.size(), kSome);
  const Index3& n = grid.size;
  onTwoThreads(n[2], [&](int k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        int count = 0, of = 0;
        for (int z = std::max(k - 1, 0); z <= std::min(k + 1, n[2] - 1); ++z) {
          for (int y = std::max(j - 1, 0); y <= std::min(j + 1, n[1] - 1); ++y) {
            for (int x = std::max(i - 1, 0); x <= std::min(i + 1, n[0] - 1); ++x) {
              count += in[grid.indexOf(x, y, z)];
              ++of;
            }
          }
        }
        if (count == 0 || count == of) near[grid.indexOf(i, j, k)] = count ? kAll : kNone;
      }
    }
  });
  return near;
}

// The mean of the voxels around one, nearer ones weighing more (1 2 1), along axes on which a block
// has several voxels: as much noise as a block's, at a third of its width.
double smoothHu(const Volume& volume, const WorkGrid& grid, int i, int j, int k) {
  const GridGeometry& g = volume.geometry;
  const int wide_i = grid.factor[0] > 1, wide_j = grid.factor[1] > 1, wide_k = grid.factor[2] > 1;
  int sum = 0, weights = 0;
  for (int dk = -wide_k; dk <= wide_k; ++dk) {
    for (int dj = -wide_j; dj <= wide_j; ++dj) {
      for (int di = -wide_i; di <= wide_i; ++di) {
        if (!g.contains(i + di, j + dj, k + dk)) continue;
        const int weight = (di ? 1 : 2) * (dj ? 1 : 2) * (dk ? 1 : 2);
        sum += weight * volume.at(i + di, j + dj, k + dk);
        weights += weight;
      }
    }
  }
  return double(sum) / weights;
}

// A mask as it was, a bit a voxel: a copy of its bytes would take as much as the mask again.
class BitsOf {
 public:
  explicit BitsOf(const std::vector<std::uint8_t>& mask) : words_((mask.size() + 63) / 64) {}

  void take(const std::vector<std::uint8_t>& mask) {
    constexpr std::size_t kWords = 16384;  // at a time
    onTwoThreads(int((words_.size() + kWords - 1) / kWords), [&](int part) {
      const std::size_t end = std::min((std::size_t(part) + 1) * kWords, words_.size());
      for (std::size_t n = std::size_t(part) * kWords; n < end; ++n) {
        const std::uint8_t* at = mask.data() + 64 * n;
        const int count = int(std::min<std::size_t>(64, mask.size() - 64 * n));
        std::uint64_t word = 0;
        for (int bit = 0; bit < count; ++bit) word |= std::uint64_t(at[bit]) << bit;
        words_[n] = word;
      }
    });
  }
  bool operator[](std::size_t at) const { return words_[at / 64] >> (at % 64) & 1; }

 private:
  std::vector<std::uint64_t> words_;
};

// A structure's blocks as voxels.
class Border {
 public:
  Border(const BlockMask& in, const WorkGrid& grid, const Volume& volume, const HuSpan& hu,
         const std::optional<VoxelBox>& box)
      : in_(in),
        near_(nearOf(in, grid)),
        grid_(grid),
        volume_(volume),
        g_(volume.geometry),
        hu_(hu) {
    inside_ = box ? *box : VoxelBox{{0, 0, 0}, g_.size};
  }

  std::vector<std::uint8_t> voxels() {
    std::vector<std::uint8_t> mask(g_.voxelCount());
    byRange(mask);
    const bool blocks = grid_.factor != Index3{1, 1, 1};
    if (!blocks) return mask;  // the range's smoothing was of about a voxel: it is at half-way
    BitsOf before(mask);
    before.take(mask);
    asMost(before, mask);
    const double edge_mm = std::min({g_.spacing_mm.x, g_.spacing_mm.y, g_.spacing_mm.z});
    const int layers = std::clamp(int(std::lround(kBlur_mm / edge_mm)), 1, 3);
    for (int layer = 0; layer < layers; ++layer) {
      before.take(mask);
      addHalf(before, mask);
    }
    return mask;
  }

 private:
  // take(x, y, z, all around are in) of the voxels of blocks that are in or beside one that is, of
  // those whose neighbours are all in only where asked for.
  template <class Take>
  void forVoxels(bool inner, const Take& take) const {
    onTwoThreads(grid_.size[2], [&](int k) {
      for (int j = 0; j < grid_.size[1]; ++j) {
        for (int i = 0; i < grid_.size[0]; ++i) {
          const std::uint8_t near = near_[grid_.indexOf(i, j, k)];
          if (near == kNone || (near == kAll && !inner)) continue;
          const Index3 at{i, j, k};
          Index3 low, high;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::max(at[axis] * grid_.factor[axis], inside_.low[axis]);
            high[axis] = std::min((at[axis] + 1) * grid_.factor[axis], inside_.high[axis]);
          }
          for (int z = low[2]; z < high[2]; ++z) {
            for (int y = low[1]; y < high[1]; ++y) {
              for (int x = low[0]; x < high[0]; ++x) take(x, y, z, near == kAll);
            }
          }
        }
      }
    });
  }

  // Blocks whose neighbours are all in stay; the others' voxels are asked one by one. Blocks of one
  // voxel were asked before.
  void byRange(std::vector<std::uint8_t>& mask) const {
    const bool blocks = grid_.factor != Index3{1, 1, 1};
    forVoxels(true, [&](int x, int y, int z, bool all) {
      const std::size_t at = g_.indexOf(x, y, z);
      if (!blocks) {
        mask[at] = in_[at];
      } else if (all) {
        mask[at] = 1;
      } else {
        const double hu = smoothHu(volume_, grid_, x, y, z);
        mask[at] = hu >= hu_.low && hu <= hu_.high;
      }
    });
  }

  // Each as most of its 27 are.
  void asMost(const BitsOf& before, std::vector<std::uint8_t>& mask) const {
    forVoxels(false, [&](int x, int y, int z, bool) {
      int votes = 0, voters = 0;
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (!g_.contains(x + dx, y + dy, z + dz)) continue;
            ++voters;
            votes += before[g_.indexOf(x + dx, y + dy, z + dz)];
          }
        }
      }
      mask[g_.indexOf(x, y, z)] = 2 * votes > voters;
    });
  }

  // A voxel beside one that is in, towards something lighter or denser, is in where its HU are at
  // most half-way there: that is where a scanner's blur leaves the border.
  void addHalf(const BitsOf& before, std::vector<std::uint8_t>& mask) const {
    const double middle = 0.5 * (hu_.low + hu_.high);
    Index3 beyond;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      beyond[axis] = std::max(1, int(std::lround(kBeyond_mm / g_.spacing_mm[int(axis)])));
    }
    forVoxels(false, [&](int x, int y, int z, bool) {
      const std::size_t at = g_.indexOf(x, y, z);
      if (before[at]) return;
      const Index3 voxel{x, y, z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int towards : {-1, 1}) {
          Index3 from = voxel, to = voxel;
          from[axis] -= towards;
          to[axis] += towards * beyond[axis];
          if (!g_.contains(from[0], from[1], from[2]) || !g_.contains(to[0], to[1], to[2]) ||
              !before[g_.indexOf(from[0], from[1], from[2])]) {
            continue;
          }
          const double there = smoothHu(volume_, grid_, to[0], to[1], to[2]);
          if (there >= hu_.low && there <= hu_.high) continue;
          const double part = (smoothHu(volume_, grid_, x, y, z) - middle) / (there - middle);
          if (part > 0.5) continue;
          mask[at] = 1;
          return;
        }
      }
    });
  }

  static constexpr double kBlur_mm = 1.3, kBeyond_mm = 2.5;
  const BlockMask& in_;
  std::vector<std::uint8_t> near_;
  const WorkGrid& grid_;
  const Volume& volume_;
  const GridGeometry& g_;
  HuSpan hu_;
  VoxelBox inside_;
};

}  // namespace

std::vector<std::uint8_t> voxelsOf(const BlockMask& in, const WorkGrid& grid, const Volume& volume,
                                   const HuSpan& hu, const std::optional<VoxelBox>& box) {
  return Border(in, grid, volume, hu, box).voxels();
}

}  // namespace trephine
