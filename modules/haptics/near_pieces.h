// Which of many places lie near one, without a look at each.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace trephine {

// Numbered places, in slabs across each axis: a bit a place. No allocation but in its constructor.
class NearPieces {
 public:
  explicit NearPieces(std::size_t most) {
    for (auto& axis : slabs_) axis.assign(std::size_t(kSlabs) * wordsOf(most), 0);
  }

  // Forgets all; those that follow lie between `low_mm` and `high_mm` and have numbers below
  // `count`, which is at most what it was made for.
  void clear(const Vec3& low_mm, const Vec3& high_mm, std::size_t count) {
    words_ = wordsOf(count);
    for (auto& axis : slabs_) std::fill_n(axis.begin(), std::size_t(kSlabs) * words_, 0);
    low_mm_ = low_mm;
    for (int axis = 0; axis < 3; ++axis) {
      per_mm_[axis] = kSlabs / std::max(1e-3, high_mm[axis] - low_mm[axis]);
    }
  }
  void add(std::size_t number, const Vec3& at_mm) {
    const std::uint64_t bit = std::uint64_t(1) << (number % kBits);
    for (int axis = 0; axis < 3; ++axis) {
      slabs_[std::size_t(axis)][at(axis, at_mm[axis]) + number / kBits] |= bit;
    }
  }
  // Calls `look` with the numbers of all places within `reach_mm`, and of some beyond, in order.
  template <class Look>
  void around(const Vec3& at_mm, double reach_mm, Look look) const {
    std::array<std::size_t, 3> from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[std::size_t(axis)] = at(axis, at_mm[axis] - reach_mm);
      to[std::size_t(axis)] = at(axis, at_mm[axis] + reach_mm);
    }
    for (std::size_t word = 0; word < words_; ++word) {
      std::uint64_t in = ~std::uint64_t(0);
      for (std::size_t axis = 0; axis < 3 && in != 0; ++axis) {
        std::uint64_t any = 0;
        for (std::size_t n = from[axis]; n <= to[axis]; n += words_) any |= slabs_[axis][n + word];
        in &= any;
      }
      for (; in != 0; in &= in - 1) look(word * kBits + std::size_t(std::countr_zero(in)));
    }
  }

 private:
  static constexpr std::size_t kBits = 64;
  static constexpr int kSlabs = 32;
  static std::size_t wordsOf(std::size_t count) { return (count + kBits - 1) / kBits; }
  // Where the slab begins in which a coordinate lies, or the nearest.
  std::size_t at(int axis, double mm) const {
    const double slab = (mm - low_mm_[axis]) * per_mm_[axis];
    return std::size_t(std::clamp(slab, 0.0, kSlabs - 1.0)) * words_;
  }

  std::size_t words_ = 0;
  std::array<std::vector<std::uint64_t>, 3> slabs_;  // by axis: words_ a slab
  Vec3 low_mm_{0.0}, per_mm_{1.0};
};

}  // namespace trephine
