#include "imaging/steps/couch.h"

#include <algorithm>
#include <cmath>

#include "imaging/steps/detail/couch_kinds.h"

namespace trephine {

namespace {

constexpr int kPadLowHu = -970, kPadHighHu = -300;  // foam and cloth, as a cell's mean
constexpr double kPad_mm = 60.0;                    // how far pads reach from the couch

// Larger cells do not tell a hand from a plate.
constexpr double kCoarsest_mm = 4.6;

// A couch's least size: wide (corner to corner of one slice's piece) and long, or, in a scan that
// is too short to tell its length, wider.
constexpr double kWide_mm = 70.0, kWideIfStraight_mm = 40.0, kLong_mm = 100.0;
constexpr double kWideInShort_mm = 120.0, kShortest_mm = 30.0;

// For each cell across: the last before the border of the volume, or before the rim of a round
// field of view, beyond which all is one number. There, body parts may be cut to slivers.
CoarseCells rimOfField(const CoarseGrid& grid) {
  CoarseCells rim(std::size_t(grid.size[0]) * std::size_t(grid.size[1]));
  const Vec3& mm = grid.cell_mm;
  const double radius = 0.5 * std::min(grid.size[0] * mm[0], grid.size[1] * mm[1]);
  const int middle = grid.size[2] / 2;
  const std::int16_t corner = grid.mean[grid.indexOf(0, 0, middle)];
  bool round = true;
  for (int b = 0; b < grid.size[1]; ++b) {
    for (int a = 0; a < grid.size[0]; ++a) {
      const double x = (a - 0.5 * (grid.size[0] - 1)) * mm[0];
      const double y = (b - 0.5 * (grid.size[1] - 1)) * mm[1];
      const double beyond = std::sqrt(x * x + y * y) - radius;
      std::uint8_t& cell = rim[grid.indexOf(a, b, 0)];
      if (a == 0 || b == 0 || a == grid.size[0] - 1 || b == grid.size[1] - 1) cell |= 1;
      if (beyond > -mm[0] && beyond < 0.5 * mm[0]) cell |= 2;
      const std::size_t n = grid.indexOf(a, b, middle);
      if (beyond > 2 * mm[0] && std::abs(grid.mean[n] - corner) > 2) round = false;
    }
  }
  for (auto& cell : rim) cell = (cell & 1) || (round && (cell & 2));
  return rim;
}

// How far the body reaches in each row (b, s) and column (a, s) of cells.
class BodyExtent {
 public:
  explicit BodyExtent(const CoarseGrid& grid)
      : nb_(grid.size[1]),
        na_(grid.size[0]),
        rows_(std::size_t(nb_) * std::size_t(grid.size[2])),
        columns_(std::size_t(na_) * std::size_t(grid.size[2])) {}

  void add(const CellRun& run) {
    row(run.b, run.s).add(run.first, run.last);
    for (int a = run.first; a <= run.last; ++a) column(a, run.s).add(run.b, run.b);
  }
  // Body on both sides, both ways.
  bool encloses(int a, int b, int s) { return row(b, s).holds(a) && column(a, s).holds(b); }

 private:
  struct Extent {
    std::int16_t low = 32767, high = -1;
    void add(int from, int to) {
      low = std::min(low, std::int16_t(from));
      high = std::max(high, std::int16_t(to));
    }
    bool holds(int n) const { return low < n && n < high; }
  };
  Extent& row(int b, int s) { return rows_[std::size_t(s * nb_ + b)]; }
  Extent& column(int a, int s) { return columns_[std::size_t(s * na_ + a)]; }

  int nb_, na_;
  std::vector<Extent> rows_, columns_;
};

// What tells a part of the couch from a part of the patient.
struct Shape {
  std::uint32_t thick = 0, bony = 0, at_rim = 0, enclosed = 0;
  std::uint32_t bulk = 0;  // cells with their own kind all around: a lung's, dry bone's, an ear's
  int wide_slices = 0, last_wide_slice = -1;
  double all_widths_mm = 0.0;  // of all pieces together
};

class CouchSearch {
 public:
  CouchSearch(const CoarseGrid& grid, const CoarseCells& thick, CoarseCells& kind)
      : grid_(grid),
        kind_(kind),
        found_(coarseParts(grid.size, kind)),
        shapes_(found_.parts.size()),
        is_couch_(found_.parts.size()) {
    for (const CellRun& run : found_.runs) {
      const std::size_t row = grid_.indexOf(0, run.b, run.s);
      Shape& shape = shapes_[run.part];
      for (int a = run.first; a <= run.last; ++a) shape.thick += thick[row + std::size_t(a)];
    }
    measure();
  }

  // Marks the couch's cells; all other cells stay of their kind. False where there is none.
  bool mark() {
    bool found = false;
    for (std::size_t n = 0; n < is_couch_.size(); ++n) {
      is_couch_[n] = isCouch(found_.parts[n], shapes_[n]);
      found |= is_couch_[n];
    }
    if (found) markCells();
    return found;
  }

  // Once there is a couch with its pads: what else is straight, long parts that touch it, and
  // crumbs that lie on it with half their cells and touch no body (a fingertip does). False where
  // there is nothing like it.
  bool markRest() {
    struct Touch {
      std::uint32_t couch = 0, body = 0;
    };
    std::vector<Touch> touching(is_couch_.size());
    for (const CellRun& run : found_.runs) {
      if (is_couch_[run.part] || found_.parts[run.part].kind == matter) continue;
      Touch& touch = touching[run.part];
      for (int a = run.first; a <= run.last; ++a) {
        bool couch_there = false, body_there = false;
        forNeighbours(a, run.b, run.s, [&](std::uint8_t kind) {
          couch_there |= kind >= couch;
          body_there |= kind == matter;
        });
        touch.couch += couch_there;
        touch.body += body_there;
      }
    }
    constexpr std::uint32_t kCrumb = 60;
    bool more = false;
    for (std::size_t n = 0; n < is_couch_.size(); ++n) {
      const CoarsePart& part = found_.parts[n];
      if (is_couch_[n] || isUnlikeCouch(part, shapes_[n])) continue;
      const Touch& touch = touching[n];
      const bool crumb = part.cells <= kCrumb && touch.couch * 2 >= part.cells && touch.body == 0;
      const bool long_part = touch.couch > 0 && length_mm(part) >= kLong_mm;
      if (part.kind != straight && !crumb && !long_part) continue;
      is_couch_[n] = true;
      more = true;
    }
    if (more) markCells();
    return more;
  }

 private:
  double length_mm(const CoarsePart& part) const {
    return (part.last_s - part.first_s + 1) * grid_.cell_mm[2];
  }
  double scan_mm() const { return grid_.size[2] * grid_.cell_mm[2]; }
  bool shortScan() const { return scan_mm() < kLong_mm; }

  double leastWidth_mm(const CoarsePart& part) const {
    return shortScan() ? kWideInShort_mm : part.kind == straight ? kWideIfStraight_mm : kWide_mm;
  }

  // Arms, legs and heads have thick cells; a shell has next to none.
  bool isBody(const CoarsePart& part, const Shape& shape) const {
    return part.kind == matter && shape.thick > 0;
  }

  void measure() {
    for (const CoarsePiece& piece : found_.pieces) {
      Shape& shape = shapes_[piece.part];
      const double across = (piece.last_a - piece.first_a + 1) * grid_.cell_mm[0];
      const double down = (piece.last_b - piece.first_b + 1) * grid_.cell_mm[1];
      const double width = std::sqrt(across * across + down * down);
      shape.all_widths_mm += width;
      if (width < leastWidth_mm(found_.parts[piece.part])) continue;
      if (shape.last_wide_slice != piece.s) ++shape.wide_slices;
      shape.last_wide_slice = piece.s;
    }
    const CoarseCells rim = rimOfField(grid_);
    BodyExtent body(grid_);
    for (const CellRun& run : found_.runs) {
      if (isBody(found_.parts[run.part], shapes_[run.part])) body.add(run);
    }
    for (const CellRun& run : found_.runs) {
      Shape& shape = shapes_[run.part];
      if (isBody(found_.parts[run.part], shape)) continue;
      for (int a = run.first; a <= run.last; ++a) {
        shape.bony += (grid_.marks[grid_.indexOf(a, run.b, run.s)] & kBoneCell) != 0;
        shape.at_rim += rim[grid_.indexOf(a, run.b, 0)];
        shape.enclosed += body.encloses(a, run.b, run.s);
        shape.bulk += isBulk(a, run.b, run.s);
      }
    }
  }

  bool isUnlikeCouch(const CoarsePart& part, const Shape& shape) const {
    // Two plates and their sides are about four rows of cells; noise in a lung fills an area.
    const bool fills = part.cells * grid_.cell_mm[0] > 7.0 * shape.all_widths_mm;
    return fills || part.kind == matter || shape.bony * 10 > part.cells ||
           shape.at_rim * 3 > part.cells || shape.enclosed * 10 > part.cells ||
           shape.bulk * 12 > part.cells;
  }
  bool isCouch(const CoarsePart& part, const Shape& shape) const {
    if (isUnlikeCouch(part, shape)) return false;
    const int slices = part.last_s - part.first_s + 1;
    if (5 * shape.wide_slices < 3 * slices) return false;
    return shortScan() ? scan_mm() >= kShortest_mm && length_mm(part) >= 0.8 * scan_mm()
                       : length_mm(part) >= kLong_mm;
  }

  bool isBulk(int a, int b, int s) const {
    if (a == 0 || b == 0 || a == grid_.size[0] - 1 || b == grid_.size[1] - 1) return false;
    const std::uint8_t own = kind_[grid_.indexOf(a, b, s)];
    for (int y = b - 1; y <= b + 1; ++y) {
      const std::size_t row = grid_.indexOf(a, y, s);
      if (kind_[row - 1] != own || kind_[row] != own || kind_[row + 1] != own) return false;
    }
    return true;
  }
  template <class See>
  void forNeighbours(int a, int b, int s, const See& see) const {
    const Index3& size = grid_.size;
    for (int z = std::max(0, s - 1); z <= std::min(size[2] - 1, s + 1); ++z) {
      for (int y = std::max(0, b - 1); y <= std::min(size[1] - 1, b + 1); ++y) {
        for (int x = std::max(0, a - 1); x <= std::min(size[0] - 1, a + 1); ++x) {
          see(kind_[grid_.indexOf(x, y, z)]);
        }
      }
    }
  }
  void markCells() {
    for (const CellRun& run : found_.runs) {
      if (!is_couch_[run.part]) continue;
      const std::size_t row = grid_.indexOf(run.first, run.b, run.s);
      std::fill_n(kind_.begin() + std::ptrdiff_t(row), run.last - run.first + 1, couch);
    }
  }

  const CoarseGrid& grid_;
  CoarseCells& kind_;
  CoarseParts found_;
  std::vector<Shape> shapes_;
  std::vector<bool> is_couch_;
};

// Foam and cloth that hang together with the couch, but for what touches matter that stays: there
// the skin's own edge is as light.
void markPads(const CoarseGrid& grid, CoarseCells& kind) {
  const int na = grid.size[0], nb = grid.size[1];
  const std::size_t slice = std::size_t(na) * std::size_t(nb);
  const auto touchesMatter = [&](std::size_t n) {
    const int a = int(n % slice) % na, b = int(n % slice) / na;
    for (int y = std::max(0, b - 1); y <= std::min(nb - 1, b + 1); ++y) {
      for (int x = std::max(0, a - 1); x <= std::min(na - 1, a + 1); ++x) {
        const std::size_t m = n - n % slice + std::size_t(y * na + x);
        if (stays(kind[m]) && grid.mean[m] > kPadHighHu) return true;
      }
    }
    return false;
  };
  std::vector<std::uint32_t> front, next;
  for (std::size_t n = 0; n < kind.size(); ++n) {
    if (kind[n] == couch) front.push_back(std::uint32_t(n));
  }
  const int steps = int(kPad_mm / grid.cell_mm[0]);
  for (int step = 0; step < steps && !front.empty(); ++step) {
    next.clear();
    for (const std::size_t n : front) {
      const auto visit = [&](bool inside, std::size_t m) {
        if (!inside || kind[m] >= couch || grid.mean[m] <= kPadLowHu ||
            grid.mean[m] >= kPadHighHu || touchesMatter(m)) {
          return;
        }
        kind[m] = pad;
        next.push_back(std::uint32_t(m));
      };
      const std::size_t in_slice = n % slice, a = in_slice % std::size_t(na);
      visit(a > 0, n - 1);
      visit(a + 1 < std::size_t(na), n + 1);
      visit(in_slice >= std::size_t(na), n - std::size_t(na));
      visit(in_slice + std::size_t(na) < slice, n + std::size_t(na));
      visit(n >= slice, n - slice);
      visit(n + slice < kind.size(), n + slice);
    }
    front.swap(next);
  }
}

// What to do in each cell: everything within one cell of couch or pad goes, but where matter that
// stays is as near, cells are shared. So are those of the body's side in the columns of a straight
// couch that the body lies on, but beyond its ends: there are shoulders and lungs in them.
CoarseCells actions(const CoarseGrid& grid, const CoarseCells& kind) {
  constexpr std::uint8_t kGoing = 1, kStaying = 2;
  const auto slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  CoarseCells near(grid.count());
  struct Column {
    int cells = 0, first = 0, last = -1;  // of the couch
  };
  std::vector<Column> columns(slice);
  for (int s = 0; s < grid.size[2]; ++s) {
    const std::size_t n = slice * std::size_t(s);
    for (std::size_t m = 0; m < slice; ++m) {
      const std::uint8_t own = kind[n + m];
      near[n + m] = std::uint8_t((own >= couch ? kGoing : 0) | (stays(own) ? kStaying : 0));
      if (own != couch) continue;
      Column& column = columns[m];
      if (column.cells++ == 0) column.first = s;
      column.last = s;
    }
  }
  dilate(grid.size, near);
  // Where air follows, a couch ends there; where the body follows at once, it goes on within.
  std::vector<Column> wide(slice);  // with the columns beside it
  for (int b = 0; b < grid.size[1]; ++b) {
    for (int a = 0; a < grid.size[0]; ++a) {
      const std::size_t m = grid.indexOf(a, b, 0);
      Column column = columns[m];
      if (column.cells * 10 < grid.size[2] || column.cells == 0) continue;
      const auto isBody = [&](int s) { return stays(kind[slice * std::size_t(s) + m]); };
      while (column.first > 0 && isBody(column.first - 1)) --column.first;
      while (column.last + 1 < grid.size[2] && isBody(column.last + 1)) ++column.last;
      for (int y = std::max(0, b - 1); y <= std::min(grid.size[1] - 1, b + 1); ++y) {
        for (int x = std::max(0, a - 1); x <= std::min(grid.size[0] - 1, a + 1); ++x) {
          Column& beside = wide[grid.indexOf(x, y, 0)];
          const bool none = beside.last < 0;
          beside.first = none ? column.first : std::min(beside.first, column.first);
          beside.last = std::max(beside.last, column.last);
        }
      }
    }
  }
  for (int s = 0; s < grid.size[2]; ++s) {
    for (std::size_t m = 0; m < slice; ++m) {
      const std::size_t n = slice * std::size_t(s) + m;
      const std::uint8_t cell = near[n];
      const bool within = s >= wide[m].first && s <= wide[m].last;
      const bool some = (cell & kGoing) || (stays(kind[n]) && within);
      near[n] = cell == kGoing ? CouchFinding::remove
                : some         ? CouchFinding::share
                               : CouchFinding::keep;
    }
  }
  return near;
}

// How far the couch reaches along the grid's axes. The patient or the edge of the field may have
// cut it into parts.
std::array<double, 3> boxOf(const CoarseGrid& grid, const CoarseCells& kind) {
  Index3 low = grid.size, high{-1, -1, -1};
  for (int s = 0; s < grid.size[2]; ++s) {
    for (int b = 0; b < grid.size[1]; ++b) {
      for (int a = 0; a < grid.size[0]; ++a) {
        if (kind[grid.indexOf(a, b, s)] != couch) continue;
        const Index3 cell{a, b, s};
        for (std::size_t n = 0; n < 3; ++n) {
          low[n] = std::min(low[n], cell[n]);
          high[n] = std::max(high[n], cell[n]);
        }
      }
    }
  }
  std::array<double, 3> box_mm;
  for (std::size_t n = 0; n < 3; ++n) {
    const auto axis = std::size_t(grid.axis[n]);
    const double field_mm = grid.voxels.size[axis] * grid.voxels.spacing_mm[int(axis)];
    box_mm[n] = std::min((high[n] - low[n] + 1) * grid.cell_mm[n], field_mm);
  }
  return box_mm;
}

}  // namespace

CouchFinding findCouch(const Volume& volume) {
  return findCouch(coarseGrid(volume));
}

CouchFinding findCouch(const CoarseGrid& grid) {
  CouchFinding finding;
  if (std::max(grid.cell_mm[0], grid.cell_mm[1]) > kCoarsest_mm || grid.count() == 0) {
    return finding;
  }
  const CoarseCells thick = thickCells(grid);
  CoarseCells kind = couchKinds(grid, thick);
  CouchSearch search(grid, thick, kind);
  finding.found = search.mark();
  if (!finding.found) return finding;
  markPads(grid, kind);
  for (int round = 0; round < 3 && search.markRest(); ++round) markPads(grid, kind);
  finding.axis = grid.axis;
  finding.step = grid.step;
  finding.size = grid.size;
  finding.cells = actions(grid, kind);
  const auto box = boxOf(grid, kind);
  finding.width_mm = std::max(box[0], box[1]);
  finding.length_mm = box[2];
  // A cell that is partly air holds as many voxels of couch as its mean says.
  const double per_cell = double(grid.step[0]) * grid.step[1] * grid.step[2];
  double voxels = 0.0;
  for (std::size_t n = 0; n < kind.size(); ++n) {
    if (kind[n] < couch || grid.mean[n] < -900) continue;
    voxels += kind[n] == pad ? 1.0 : std::min((grid.mean[n] - kAirHu) / 600.0, 1.0);
  }
  finding.voxels = std::uint64_t(voxels * per_cell);
  return finding;
}

}  // namespace trephine
