// The first sorting of a coarse grid's cells, before anything is taken for a couch.
#pragma once

#include "imaging/steps/detail/coarse_parts.h"

namespace trephine {

// What a cell holds. Matter is told apart before parts are formed, so that a couch or its cover
// that touches the body comes off it: what runs straight along the scan, what is loose (over two
// cells from all that is thick), and the rest.
enum CouchKind : std::uint8_t { nothing, matter, straight, loose, couch, pad };
inline bool stays(std::uint8_t kind) {
  return kind != nothing && kind < couch;
}

// 1 for cells whose eight neighbours across are solid too: at least 9 mm both ways. Beyond the
// volume counts as solid, so that a body part cut by the field of view is not taken for a shell.
CoarseCells thickCells(const CoarseGrid& grid);

// nothing, matter, straight or loose for each cell.
CoarseCells couchKinds(const CoarseGrid& grid, const CoarseCells& thick);

}  // namespace trephine
