// Connected parts of a coarse grid, by runs along its rows: a body of a hundred thousand cells is a
// few thousand runs.
#pragma once

#include <cstdint>
#include <vector>

#include "imaging/steps/coarse_grid.h"

namespace trephine {

using CoarseCells =
    std::vector<std::uint8_t>;  // one byte a cell of a CoarseGrid; `size` is its size

// Consecutive cells of one kind in row (b, s), first to last.
struct CellRun {
  std::int32_t first, last, b, s;
  std::uint32_t part;   // what it belongs to in space
  std::uint32_t piece;  // and within its slice
};

struct CoarsePart {
  std::uint8_t kind = 0;
  std::int32_t first_s = 0, last_s = 0;
  std::uint32_t cells = 0;
};

// What of a part one slice shows in one piece.
struct CoarsePiece {
  std::uint32_t part = 0;
  std::int32_t s = 0;
  std::int32_t first_a = 0, last_a = 0, first_b = 0, last_b = 0;
};

struct CoarseParts {
  std::vector<CellRun> runs;  // in the order of the cells
  std::vector<CoarsePart> parts;
  std::vector<CoarsePiece> pieces;  // s never falls
};

// Cells of the same kind that touch, if only by a corner, are one part; kind 0 is none.
CoarseParts coarseParts(const Index3& size, const CoarseCells& kind);

// Air with matter (means over `matter_hu`) on five of its six sides, within 50 mm: what nose,
// sinuses, mouth and throat hold, open or not.
CoarseCells enclosedAir(const CoarseGrid& grid, int matter_hu);

// Each cell becomes the OR of itself and its eight neighbours across, and of theirs along s too.
void dilateAcross(const Index3& size, CoarseCells& cells);
void dilate(const Index3& size, CoarseCells& cells);

}  // namespace trephine
