// What each voxel of a case is made of, as far as its CT and its labels tell: for results, live
// tallies and summaries, which must not name what is not there.
//
// Touch goes by each voxel's own HU and label (classify), so that the border between fat and bone
// is felt as whatever tissue has the HU half-way. Here such a voxel is named after the side that it
// is mostly of, or not at all. In this order:
// 1. A label that a tissue is restricted to says it, whatever the HU: its map is taken at its word.
// 2. Of a built-in case, the formula that painted it says what lies at the voxel's centre.
// 3. Else HU. Where they rise by kEdge_HU across the voxel, along their gradient, it lies at an
//    edge, unless it is a layer between two: mostly of the upper side, it is of that side's
//    tissue; mostly of the lower, of its own where that is the lower side's too, else of none.
//    No mean makes it a tissue that no voxel within two of it has.
//    (The rule by which the picture tells tissue from partial volume.) A layer that is over or
//    under both of its sides, as thin bone, keeps its own. Elsewhere its neighbours' mean takes
//    the noise away.
// 4. A tissue that is enclosed by another (Tissue::within) only where that one is met in at least
//    kEnclosed of 26 directions, with no air before it: HU like a brain's are no brain outside a
//    skull. Where directions leave the scan first, all others must meet it, and kLeastMet of them:
//    beside a skull it is about half of them, at most.
//
// What a CT does not hold is not told: soft layers thinner than three voxels, as a membrane, are
// taken for what lies about them, and noise over some 30 HU for tissue. A tissue whose encloser is
// nowhere in the case is nowhere either.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>

#include "tissue/tissue_set.h"
#include "volume/label_map.h"
#include "volume/phantom.h"
#include "volume/volume.h"

namespace trephine {

class TrueTissues {
 public:
  static constexpr int kUnnamed = -1;
  static constexpr double kEdge_HU = 60.0;
  static constexpr double kEnclosed = 0.9;
  static constexpr int kLeastMet = 16;

  // `tissues`: placed in the case. `before`: its voxels, as they are while nothing is cut;
  // `labels`: those that the tissues were placed in, of its grid, or null. Both outlive it.
  // `case_source`: as the exercise has it; a built-in case's formula holds on its own grid alone.
  TrueTissues(const TissueSet& tissues, const Volume& before, const LabelMap* labels,
              const std::string& case_source);

  // What was found of places, for voxels near them that are asked for later. Of one TrueTissues.
  using Enclosed = std::unordered_map<std::size_t, bool>;

  // The tissue's place in the set, or kUnnamed; the same with what is `known` as without. Some
  // microseconds, of a tissue that may be enclosed 10 to 20, a hundredth of that with `known`. Any
  // thread.
  int at(std::size_t voxel, Enclosed* known = nullptr) const;

 private:
  int ofLabel(int hu, int label) const;
  int ofFormula(const Index3& voxel, Enclosed* known) const;
  int ofHu(const Index3& voxel, Enclosed* known) const;
  enum class Meets { neither, wall, air };
  Meets meets(std::size_t voxel, int by) const;
  bool isEnclosed(const Index3& voxel, int by, Enclosed* known) const;
  bool isEnclosedAt(const Index3& voxel, int by) const;

  TissueTable table_;
  std::array<int, kMaxTissues> within_{};  // by tissue: its encloser's place, or -1
  const Volume& before_;
  const LabelMap* labels_;
  std::optional<PhantomTruth> formula_;
  bool is_head_ = false;  // the built-in one
  Mat4 to_mm_{1.0};
};

}  // namespace trephine
