// Which voxels of a grid are solid, a bit each: rows along x are searched 64 voxels at a time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "base/math.h"

namespace trephine {

// An eighth of a byte a voxel. No allocation after it is made.
class SolidBits {
 public:
  explicit SolidBits(const Index3& size)
      : rows_(std::size_t(size[1])),
        words_((std::size_t(size[0]) + kBits - 1) / kBits),
        bits_(words_ * rows_ * std::size_t(size[2]), 0) {}

  bool at(const Index3& voxel) const { return word(voxel) >> (voxel[0] % kBits) & 1u; }
  void set(const Index3& voxel, bool solid) {
    const std::uint64_t bit = std::uint64_t(1) << (voxel[0] % kBits);
    std::uint64_t& word = bits_[row(voxel[1], voxel[2]) + std::size_t(voxel[0] / kBits)];
    word = solid ? word | bit : word & ~bit;
  }

  // The first solid voxel of row (j, k) from `from` up to `to`; to + 1 where there is none.
  int up(int from, int to, int j, int k) const {
    if (from > to) return to + 1;
    const std::uint64_t* words = bits_.data() + row(j, k);
    int n = from / kBits;
    std::uint64_t left = words[n] & ~std::uint64_t(0) << (from % kBits);
    for (const int last = to / kBits; left == 0; left = words[n]) {
      if (n++ == last) return to + 1;
    }
    return std::min(to + 1, n * kBits + std::countr_zero(left));
  }
  // The first from `from` down to `to`; to - 1 where there is none.
  int down(int from, int to, int j, int k) const {
    if (from < to) return to - 1;
    const std::uint64_t* words = bits_.data() + row(j, k);
    int n = from / kBits;
    std::uint64_t left = words[n] & ~std::uint64_t(0) >> (kBits - 1 - from % kBits);
    for (const int last = to / kBits; left == 0; left = words[n]) {
      if (n-- == last) return to - 1;
    }
    return std::max(to - 1, n * kBits + kBits - 1 - std::countl_zero(left));
  }
  void prefetch(int i, int j, int k) const {
    __builtin_prefetch(bits_.data() + row(j, k) + std::size_t(i / kBits));
  }
  std::size_t bytes() const { return bits_.size() * sizeof(std::uint64_t); }

 private:
  static constexpr int kBits = 64;
  std::size_t row(int j, int k) const { return (std::size_t(k) * rows_ + std::size_t(j)) * words_; }
  const std::uint64_t& word(const Index3& v) const {
    return bits_[row(v[1], v[2]) + std::size_t(v[0] / kBits)];
  }

  std::size_t rows_, words_;  // rows of a slice, words of a row
  std::vector<std::uint64_t> bits_;
};

}  // namespace trephine
