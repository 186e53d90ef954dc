// The class of a voxel in one load, and which of two tissues is firmer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tissue/tissue_set.h"
#include "volume/grid.h"

namespace trephine {

static_assert(kRemovedHu == kAirHu);

// classify() as a table: a row of HU for each label that the tissues name, and the first for all
// others. There are rows for as many labels as tissues. Nobody looks up while set() writes.
class TissueLookup {
 public:
  TissueLookup() : class_of_(LabelRows::kMost * kHus, -1) {}
  explicit TissueLookup(const TissueTable& tissues) : TissueLookup() { set(tissues); }
  // No allocation; a few microseconds a row.
  void set(const TissueTable& tissues) {
    rows_ = LabelRows(tissues);
    for (int row = 0; row < rows_.count; ++row) {
      std::fill_n(at(row, -32768), kHus, std::int8_t(-1));
      fill(tissues, row, 0);
      if (row > 0) fill(tissues, row, rows_.label[std::size_t(row)]);
      *at(row, kAirHu) = -1;
    }
    solid_.fill(false);
    for (int c = 0; c < tissues.count; ++c) {
      solid_[std::size_t(c)] = tissues.classes[std::size_t(c)].solid != 0;
    }
  }
  bool isSolid(int tissue_class) const {
    return tissue_class >= 0 && solid_[std::size_t(tissue_class)];
  }
  int classOf(std::int16_t hu, std::uint8_t label = 0) const {
    return class_of_[rows_.row[label] * kHus + std::size_t(int(hu) + 32768)];
  }
  // Of a voxel whose HU is known already.
  int classAt(const Grid& grid, std::size_t voxel, std::int16_t hu) const {
    if (rows_.count > 1) return classOf(hu, grid.label(voxel));
    return class_of_[std::size_t(int(hu) + 32768)];
  }
  int classAt(const Grid& grid, std::size_t voxel) const {
    return classAt(grid, voxel, grid.hu(voxel));
  }

 private:
  static constexpr std::size_t kHus = 65536;
  std::int8_t* at(int row, int hu) {
    return class_of_.data() + std::size_t(row) * kHus + std::size_t(hu + 32768);
  }
  void fill(const TissueTable& tissues, int row, std::int32_t label) {
    for (int c = tissues.count - 1; c >= 0; --c) {  // the first of two that overlap holds
      const TissueClass& t = tissues.classes[std::size_t(c)];
      if (t.label != label) continue;
      for (std::int32_t hu = std::max(t.hu_min, -32768); hu <= std::min(t.hu_max, 32767); ++hu) {
        *at(row, hu) = std::int8_t(c);
      }
    }
  }

  LabelRows rows_;
  std::vector<std::int8_t> class_of_;
  std::array<bool, kMaxTissues> solid_{};
};

// The firmest tissue is that of the largest friction, then stiffness, then damping. -1 is air.
inline bool firmer(const TissueTable& tissues, int a, int b) {
  if (a < 0 || b < 0) return b < 0 && a >= 0;
  const TissueClass& x = tissues.classes[std::size_t(a)];
  const TissueClass& y = tissues.classes[std::size_t(b)];
  if (x.friction_N != y.friction_N) return x.friction_N > y.friction_N;
  if (x.stiffness_N_per_m != y.stiffness_N_per_m) return x.stiffness_N_per_m > y.stiffness_N_per_m;
  return x.damping_Ns_per_m > y.damping_Ns_per_m;
}

}  // namespace trephine
