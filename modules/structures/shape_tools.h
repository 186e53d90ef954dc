// Tools that mend one structure of a label map by hand: a brush, holes, smoothing, pieces, a shell,
// growing and shrinking.
//
// Each looks at the map and says what would change, as a LabelEdit; apply() does it and undo()
// takes it back. So a list of edits is a journal (edit_history.h). Voxels of other structures stay
// as they are unless `over` names their labels; what a structure loses is of none.
//
// Pure functions, for any thread; two threads inside where said. Errors: BAD_ARGUMENT (a radius
// that is not in its range, a label below 1 or over 255, a map without the voxels it states),
// NO_STRUCTURE (the label has no voxel), CANCELLED, OUT_OF_MEMORY; others where said.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "structures/voxel_runs.h"
#include "structures/work_grid.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// Voxels of a map that change, as runs along its rows: what they were, all the same, and become.
struct LabelEdit {
  struct Run {
    std::uint64_t first = 0;  // index of a voxel
    std::uint32_t count = 0;
    std::uint8_t before = 0, after = 0;
  };
  std::vector<Run> runs;  // in rising order, none twice
  std::size_t voxels = 0;
  VoxelBox box;  // that holds them all; empty where none changes

  bool empty() const { return runs.empty(); }
  std::size_t bytes() const { return sizeof(LabelEdit) + runs.capacity() * sizeof(Run); }
};

// Of a map of the grid that the edit was made of, and, of undo, as apply() left it.
void apply(LabelMap& map, const LabelEdit& edit);
void undo(LabelMap& map, const LabelEdit& edit);

using Labels = std::bitset<256>;

struct Brush {
  enum class Shape {
    ball,
    disc  // of the slice that a point lies in, one voxel thick
  };
  Shape shape = Shape::ball;
  double radius_mm = 5.0;    // 0.05 to 200
  int across = 2;            // the disc's slices lie across this axis of the grid: 0 i, 1 j, 2 k
  std::optional<HuSpan> hu;  // takes, or erases, voxels within it alone; needs the volume
  bool erase = false;
  Labels over;  // of other structures that it may take
};

// The voxels whose middle the brush covers on its way along `path_mm` (points in the patient's LPS
// frame, joined by straight lines; of a disc within a slice). At least the voxel that a point lies
// in. Costs as much as the stroke is large, on one thread. Errors: OTHER_GRID where the volume's
// size is not the map's. No NO_STRUCTURE: a stroke may be a structure's first.
Result<LabelEdit> brushEdit(const LabelMap& map, int label, std::span<const Vec3> path_mm,
                            const Brush& brush, const Volume* volume = nullptr);

// What makes the structure be where the mask is 1, and nowhere else: what was grown, a skull. Two
// threads. Error: OTHER_GRID where the mask has not a value a voxel. No NO_STRUCTURE.
Result<LabelEdit> maskEdit(const LabelMap& map, std::span<const std::uint8_t> mask, int label,
                           const Labels& over = {});

// What no way across faces leads into from the border of the structure's box becomes part of it;
// with `across` (0 i, 1 j, 2 k) slice by slice. Two threads.
Result<LabelEdit> holesEdit(const LabelMap& map, int label,
                            std::optional<int> across = std::nullopt, const Labels& over = {},
                            const Progress& progress = Progress());

// Rounds off what is smaller than `radius_mm` (0.1 to 20): a Gaussian of half of that as its
// standard deviation, by VTK and on its threads, cut where as many voxels are in as before.
Result<LabelEdit> smoothEdit(const LabelMap& map, int label, double radius_mm,
                             const Labels& over = {}, const Progress& progress = Progress());

// The piece at a point, or the nearest within kNearPiece_mm: the rest goes, or it alone.
// Error: NOTHING_THERE.
constexpr double kNearPiece_mm = 5.0;
Result<LabelEdit> keepPieceEdit(const LabelMap& map, int label, const Vec3& at_mm,
                                Touching touching = Touching::faces);
Result<LabelEdit> removePieceEdit(const LabelMap& map, int label, const Vec3& at_mm,
                                  Touching touching = Touching::faces);

// The structure's outermost layer (shellOf() of volume/label_map.h; 0.1 to 50 mm) becomes `into`,
// a label of its own: a capsule, an outer table. Two threads.
Result<LabelEdit> shellEdit(const LabelMap& map, int label, double thickness_mm, int into,
                            const Progress& progress = Progress());

// By so many mm (0.05 to 20), from middle to middle of voxels: the voxels within that distance of
// it come in, or those within that distance of what is outside go. The grid's end is not outside.
// Two threads; memory for some slices.
Result<LabelEdit> growEdit(const LabelMap& map, int label, double mm, const Labels& over = {},
                           const Progress& progress = Progress());
Result<LabelEdit> shrinkEdit(const LabelMap& map, int label, double mm,
                             const Progress& progress = Progress());

}  // namespace trephine
