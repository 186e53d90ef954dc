// What was cut of a case, by tissue (true_tissues.h) and by structure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "exercise/true_tissues.h"
#include "volume/grid.h"

namespace trephine {

// Voxels whose HU is not what it was.
struct CutVoxels {
  std::array<std::uint64_t, kMaxTissues> of_tissue{};  // by its place in the set
  std::uint64_t unnamed = 0;                           // of no tissue of the set, or at an edge
  std::array<std::uint64_t, 256> of_label{};           // of the case's structures; 0: of none
  friend bool operator==(const CutVoxels&, const CutVoxels&) = default;
};

// By tissue alone; all are on one grid. Nobody writes `after` meanwhile.
CutVoxels cutVoxels(const TrueTissues& tissues, const Volume& before, const Grid& after);

// The same while it is being cut, in steps that a window has time for. One thread.
class CutTally {
 public:
  // A step looks at so many voxels at most, and names so many that it has not met before.
  struct Step {
    std::size_t voxels = 4'000'000;
    int names = 2000;
  };

  // `structures`: the case's, or null. All that is given outlives it.
  CutTally(const TrueTissues& tissues, const Volume& before, const LabelMap* structures);

  // Goes on through `box`, which holds all that was cut so far (VolumeMirror::touched), in `now`,
  // a copy of the voxels. True: it has been through, and counts() is what it found.
  bool look(const Volume& now, const VoxelBox& box, const Step& step);
  const CutVoxels& counts() const { return counts_; }
  // The next look() begins anew, so that the pass that it begins misses nothing of now.
  void beginAgain() { next_.reset(); }

 private:
  int nameOf(std::size_t voxel, int& left);

  const TrueTissues& tissues_;
  const Volume& before_;
  const LabelMap* structures_;
  // What was named, by blocks of 2^kBlockBits voxels in a row.
  static constexpr int kBlockBits = 10;
  static constexpr std::int8_t kNotYet = -2;
  std::unordered_map<std::size_t, std::array<std::int8_t, 1 << kBlockBits>> names_;
  TrueTissues::Enclosed enclosed_;
  CutVoxels counts_, so_far_;
  VoxelBox box_{};              // the one that it is going through
  std::optional<Index3> next_;  // where it goes on
};

}  // namespace trephine
