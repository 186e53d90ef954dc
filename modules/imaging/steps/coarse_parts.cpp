#include "imaging/steps/detail/coarse_parts.h"

#include <algorithm>

#include "volume/two_threads.h"
#include "volume/union_find.h"

namespace trephine {

namespace {

// Every run of one kind; `row_begin` gets the first of each row and, at last, their count.
std::vector<CellRun> findRuns(const Index3& size, const CoarseCells& kind,
                              std::vector<std::uint32_t>& row_begin) {
  std::vector<CellRun> runs;
  runs.reserve(kind.size() / 32);
  const std::uint8_t* cell = kind.data();
  for (int s = 0; s < size[2]; ++s) {
    for (int b = 0; b < size[1]; ++b, cell += size[0]) {
      row_begin.push_back(std::uint32_t(runs.size()));
      for (int a = 0; a < size[0];) {
        const int first = a;
        const std::uint8_t own = cell[a];
        while (a < size[0] && cell[a] == own) ++a;
        if (own != 0) runs.push_back({first, a - 1, b, s, 0, 0});
      }
    }
  }
  row_begin.push_back(std::uint32_t(runs.size()));
  return runs;
}

}  // namespace

CoarseParts coarseParts(const Index3& size, const CoarseCells& kind) {
  CoarseParts found;
  std::vector<std::uint32_t> row_begin;  // of row b + s * size
  found.runs = findRuns(size, kind, row_begin);
  std::vector<CellRun>& runs = found.runs;
  const auto kindOf = [&](const CellRun& run) {
    return kind[(std::size_t(run.s) * std::size_t(size[1]) + std::size_t(run.b)) *
                    std::size_t(size[0]) +
                std::size_t(run.first)];
  };

  UnionFind parts(runs.size()), pieces(runs.size());
  const auto joinRows = [&](std::size_t row, std::size_t other, bool same_slice) {
    std::uint32_t p = row_begin[row], q = row_begin[other];
    while (p < row_begin[row + 1] && q < row_begin[other + 1]) {
      const CellRun &x = runs[p], &y = runs[q];
      if (x.first <= y.last + 1 && y.first <= x.last + 1 && kindOf(x) == kindOf(y)) {
        parts.join(p, q);
        if (same_slice) pieces.join(p, q);
      }
      if (x.last < y.last) {
        ++p;
      } else {
        ++q;
      }
    }
  };
  const auto rows = std::size_t(size[1]);
  for (std::size_t s = 0; s < std::size_t(size[2]); ++s) {
    for (std::size_t b = 0; b < rows; ++b) {
      const std::size_t row = s * rows + b;
      if (b > 0) joinRows(row, row - 1, true);
      if (s == 0) continue;
      joinRows(row, row - rows, false);
      if (b > 0) joinRows(row, row - rows - 1, false);
      if (b + 1 < rows) joinRows(row, row - rows + 1, false);
    }
  }

  // A root comes before all that point to it.
  for (std::uint32_t r = 0; r < runs.size(); ++r) {
    CellRun& run = runs[r];
    const std::uint32_t part = parts.root(r), piece = pieces.root(r);
    if (part == r) {
      run.part = std::uint32_t(found.parts.size());
      found.parts.push_back({kindOf(run), run.s, run.s, 0});
    }
    run.part = runs[part].part;
    if (piece == r) {
      run.piece = std::uint32_t(found.pieces.size());
      found.pieces.push_back({run.part, run.s, run.first, run.last, run.b, run.b});
    }
    run.piece = runs[piece].piece;
    CoarsePart& whole = found.parts[run.part];
    whole.last_s = run.s;
    whole.cells += std::uint32_t(run.last - run.first + 1);
    CoarsePiece& cut = found.pieces[run.piece];
    cut.first_a = std::min(cut.first_a, run.first);
    cut.last_a = std::max(cut.last_a, run.last);
    cut.last_b = run.b;
  }
  return found;
}

CoarseCells enclosedAir(const CoarseGrid& grid, int matter_hu) {
  CoarseCells sides(grid.count());
  const std::ptrdiff_t strides[3] = {1, grid.size[0], std::ptrdiff_t(grid.size[0]) * grid.size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const int reach = int(50.0 / grid.cell_mm[int(axis)]), count = grid.size[axis];
    for (int j = 0; j < grid.size[v]; ++j) {
      for (int i = 0; i < grid.size[u]; ++i) {
        const std::ptrdiff_t first = i * strides[u] + j * strides[v];
        for (const int way : {1, -1}) {
          int since = reach;  // cells since matter was met
          for (int n = way > 0 ? 0 : count - 1; n >= 0 && n < count; n += way) {
            const auto cell = std::size_t(first + n * strides[axis]);
            since = grid.mean[cell] > matter_hu ? 0 : since + 1;
            sides[cell] = std::uint8_t(sides[cell] + (since > 0 && since <= reach));
          }
        }
      }
    }
  }
  for (std::uint8_t& cell : sides) cell = cell >= 5;
  return sides;
}

// Plain loops over bytes are done 16 at a time, once the compiler sees that no store can change
// their bounds: hence pointers and counts by value.
static void orInto(std::uint8_t* to, const std::uint8_t* from, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) to[n] |= from[n];
}

void dilateAcross(const Index3& size, CoarseCells& cells) {
  const auto na = std::size_t(size[0]), nb = std::size_t(size[1]);
  std::vector<CoarseCells> scratch(2, CoarseCells(2 * na));
  onTwoThreads(2, [&](int half) {
    std::uint8_t* before = scratch[std::size_t(half)].data();  // the row before, widened along a
    std::uint8_t* own = before + na;
    for (int s = half * size[2] / 2; s < (half + 1) * size[2] / 2; ++s) {
      std::uint8_t* row = cells.data() + std::size_t(s) * na * nb;
      std::fill(before, before + na, std::uint8_t(0));
      for (std::size_t b = 0; b < nb; ++b, row += na) {
        std::copy(row, row + na, own);
        orInto(row + 1, own, na - 1);
        orInto(row, own + 1, na - 1);
        std::copy(row, row + na, own);
        orInto(row, before, na);
        // The row before is finished once this one's widening is added to it.
        if (b > 0) orInto(row - na, own, na);
        std::swap(own, before);
      }
    }
  });
}

void dilate(const Index3& size, CoarseCells& cells) {
  dilateAcross(size, cells);
  const auto slice = std::size_t(size[0]) * std::size_t(size[1]);
  CoarseCells before(slice), own(slice);
  for (int s = 0; s < size[2]; ++s) {
    std::uint8_t* to = cells.data() + std::size_t(s) * slice;
    std::copy(to, to + slice, own.begin());
    orInto(to, before.data(), slice);
    if (s > 0) orInto(to - slice, own.data(), slice);
    before.swap(own);
  }
}

}  // namespace trephine
