#include "imaging/steps/detail/couch_kinds.h"

#include <algorithm>
#include <cmath>

#include "volume/two_threads.h"

namespace trephine {

namespace {

// A straight part changes by less from one slice to the next, over at least this length.
constexpr int kSteadyHu = 80;
constexpr double kStraight_mm = 100.0;
constexpr double kPressed_mm = 60.0;  // how far the body may press on it in one go

// A column of cells that hardly changes along s, so far. Where the body lies on a couch, cells that
// hold some of both are denser for a while.
struct SteadyColumn {
  int start = 0, last = -1;  // slices
  int steady = 0, near = 0;  // how many held the column's HU, and how many were near thick cells
  int hu = 0;

  // Takes slice s if it belongs to the column.
  bool take(int s, int next_hu, bool is_near, int longest_gap) {
    if (next_hu < hu - kSteadyHu || s - last > longest_gap) return false;
    near += is_near;
    if (next_hu > hu + kSteadyHu) return true;
    last = s;
    ++steady;
    hu += (next_hu - hu) / 4;
    return true;
  }
};

// Marks the matter that is steady over kStraight_mm and, on most of that way, not near anything
// thick: a flank runs straight, too.
void markStraight(const CoarseGrid& grid, const CoarseCells& near_thick, CoarseCells& kind) {
  const int least = int(std::ceil(kStraight_mm / grid.cell_mm[2]));
  const int gap = 1 + int(kPressed_mm / grid.cell_mm[2]);
  if (grid.size[2] < least) return;
  const std::size_t slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  const auto mark = [&](const SteadyColumn& column, std::size_t cell) {
    SteadyColumn again{column.start, column.start - 1, 0, 0,
                       grid.mean[cell + slice * std::size_t(column.start)]};
    for (int s = column.start; s <= column.last; ++s) {
      const std::size_t n = cell + slice * std::size_t(s);
      again.take(s, grid.mean[n], false, gap);
      if (again.last == s) kind[n] = straight;
    }
  };
  std::vector<std::vector<SteadyColumn>> rows(2);
  for (auto& row : rows) row.resize(std::size_t(grid.size[0]));
  onTwoThreads(2, [&](int half) {
    std::vector<SteadyColumn>& columns = rows[std::size_t(half)];
    for (int b = half * grid.size[1] / 2; b < (half + 1) * grid.size[1] / 2; ++b) {
      std::fill(columns.begin(), columns.end(), SteadyColumn());
      for (int s = 0; s <= grid.size[2]; ++s) {
        const bool beyond = s == grid.size[2];
        std::size_t cell = grid.indexOf(0, b, beyond ? s - 1 : s);
        for (int a = 0; a < grid.size[0]; ++a, ++cell) {
          SteadyColumn& column = columns[std::size_t(a)];
          const bool is_matter = !beyond && kind[cell] != nothing;
          if (is_matter && column.steady > 0 &&
              column.take(s, grid.mean[cell], near_thick[cell], gap)) {
            continue;
          }
          if (column.steady >= least && 2 * column.near <= s - column.start) {
            mark(column, grid.indexOf(a, b, 0));
          }
          column = SteadyColumn();
          if (is_matter) column = {s, s, 1, near_thick[cell], grid.mean[cell]};
        }
      }
    }
  });
}

}  // namespace

CoarseCells thickCells(const CoarseGrid& grid) {
  const auto isHollow = [](std::uint8_t marks) { return std::uint8_t(~marks & kSolidCell); };
  CoarseCells cells(grid.count());
  std::transform(grid.marks.begin(), grid.marks.end(), cells.begin(), isHollow);
  dilateAcross(grid.size, cells);
  std::transform(cells.begin(), cells.end(), cells.begin(), isHollow);
  return cells;
}

CoarseCells couchKinds(const CoarseGrid& grid, const CoarseCells& thick) {
  CoarseCells near_thick = thick;
  dilateAcross(grid.size, near_thick);
  dilate(grid.size, near_thick);
  CoarseCells kind(grid.count());
  std::transform(grid.marks.begin(), grid.marks.end(), near_thick.begin(), kind.begin(),
                 [](std::uint8_t marks, std::uint8_t near) {
                   return std::uint8_t(marks & kMatterCell ? int(near ? matter : loose) : nothing);
                 });
  markStraight(grid, near_thick, kind);
  return kind;
}

}  // namespace trephine
