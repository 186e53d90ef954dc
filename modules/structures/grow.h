// A structure grown from a click: what hangs together with it at about its HU, without what only
// narrow bridges lead to. By HU and shape alone.
//
// 1. The range of HU: what most of a cube about the click is like, so that a vessel under the
//    click or an edge beside it does not matter, as narrow as finds more than crumbs; median and
//    spread (1.4826 MAD) of what was found, until they settle, so that where one clicks does not
//    matter either.
// 2. The core: blocks of about 3 mm (work_grid.h), smoothed by the noise, that lie in the range and
//    have room for a ball of `open_mm` around them; the piece at the click. This is what stops
//    leaks.
// 3. Around the core, as far as the ball and two blocks reach, what lies in the wider range of the
//    less smoothed blocks; small holes and notches are closed.
// 4. Its border at the CT's own resolution.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "structures/work_grid.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct GrowOptions {
  std::optional<HuSpan> hu;     // instead of step 1
  double open_mm = 7.0;         // 0 to 50
  std::optional<VoxelBox> box;  // nothing outside of it
  // What has a label here is neither taken nor passed: other structures, a wall that was drawn.
  // Null: none. A block of step 2 that holds one such voxel stops the core.
  std::shared_ptr<const LabelMap> others{};
};

struct Growth {
  LabelMap mask;  // 0 and 1, on the volume's grid
  HuSpan hu;      // of step 3
  std::size_t voxels = 0;
  double ml = 0.0;
  // It reaches the scan's border, or over kMostOfScan of it: perhaps not the structure alone.
  bool leaked = false;
  double seed_off_mm = 0.0;  // from the seed to the nearest of its voxels; 0: it holds the seed
  std::vector<std::string> steps;  // what was done, in words
};
constexpr double kMostOfScan = 0.15;
// A click in a vessel, or in a thin rim, still grows what is around or beside it, and says so.
constexpr double kMostOff_mm = 20.0;

// `seed_mm` in the patient's LPS frame. Two threads inside; takes one and a half bytes a voxel
// beside the volume. Errors: BAD_SEED (outside of the scan or of the box), BAD_ARGUMENT,
// OTHER_GRID (of the others), NOTHING_GROWN (no room for the ball near the seed, or what has it is
// another organ: it does not come within kMostOff_mm of the seed, or lies beside it and is of
// another HU), CANCELLED, OUT_OF_MEMORY.
Result<Growth> grow(const Volume& volume, const Vec3& seed_mm, const GrowOptions& options = {},
                    const Progress& progress = Progress());

}  // namespace trephine
