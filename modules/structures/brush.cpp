// The brush of shape_tools.h: capsules about a path, row by row of the grid.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/codes.h"
#include "base/tr.h"
#include "structures/label_edits.h"
#include "structures/shape_tools.h"
#include "volume/codes.h"

namespace trephine {

namespace {

constexpr double kFlat = 1e-12;
constexpr double kStraight = 0.1;  // voxels; a path that bends by less is a line
constexpr std::size_t kMostAhead = 64;

struct Span {
  double low = 0.0, high = 0.0;
};

// Of a row of the grid, what lies in a ball and in a capsule. `row` is a point of the row, its x
// is what is looked for. A capsule is convex: from the least end of its parts to the greatest.
std::optional<Span> inBall(const Vec3& middle, double radius, const Vec3& row) {
  const double y = row.y - middle.y, z = row.z - middle.z;
  const double square = radius * radius - y * y - z * z;
  if (square < 0.0) return std::nullopt;
  const double half = std::sqrt(square);
  return Span{middle.x - half, middle.x + half};
}

std::optional<Span> inCylinder(const Vec3& from, const Vec3& to, double radius, const Vec3& row) {
  const Vec3 d = to - from;
  const double length2 = glm::dot(d, d);
  if (length2 < kFlat) return std::nullopt;
  const double y = row.y - from.y, z = row.z - from.z, c = y * d.y + z * d.z;
  // |w|^2 - (w d)^2 / |d|^2 <= r^2 of w = (t, y, z), as a t^2 - 2 b t + e <= 0.
  const double a = 1.0 - d.x * d.x / length2, b = d.x * c / length2;
  const double e = y * y + z * z - c * c / length2 - radius * radius;
  double low, high;
  if (a > kFlat) {
    const double root2 = b * b - a * e;
    if (root2 < 0.0) return std::nullopt;
    low = (b - std::sqrt(root2)) / a;
    high = (b + std::sqrt(root2)) / a;
  } else {
    if (e > 0.0) return std::nullopt;
    low = -std::numeric_limits<double>::infinity();
    high = -low;
  }
  // Between its ends: 0 <= t dx + c <= |d|^2.
  if (std::abs(d.x) > kFlat) {
    const double one = -c / d.x, other = (length2 - c) / d.x;
    low = std::max(low, std::min(one, other));
    high = std::min(high, std::max(one, other));
  } else if (c < 0.0 || c > length2) {
    return std::nullopt;
  }
  if (low > high) return std::nullopt;
  return Span{from.x + low, from.x + high};
}

std::optional<Span> inCapsule(const Vec3& from, const Vec3& to, double radius, const Vec3& row) {
  std::optional<Span> all = inBall(from, radius, row);
  for (const std::optional<Span>& part :
       {inBall(to, radius, row), inCylinder(from, to, radius, row)}) {
    if (!part) continue;
    all = all ? Span{std::min(all->low, part->low), std::max(all->high, part->high)} : *part;
  }
  return all;
}

double toSegment(const Vec3& at, const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  const double length2 = glm::dot(d, d);
  const double part =
      length2 < kFlat ? 0.0 : std::clamp(glm::dot(at - from, d) / length2, 0.0, 1.0);
  return glm::length(at - from - part * d);
}

// A path without the points that lie on the way from one before to one after.
std::vector<Vec3> straightened(const std::vector<Vec3>& path, double within) {
  std::vector<Vec3> out;
  for (std::size_t at = 0; at < path.size();) {
    out.push_back(path[at]);
    std::size_t next = at + 1;
    while (next + 1 < path.size() && next - at < kMostAhead) {
      bool straight = true;
      for (std::size_t n = at + 1; n <= next && straight; ++n) {
        straight = toSegment(path[n], path[at], path[next + 1]) <= within;
      }
      if (!straight) break;
      ++next;
    }
    at = next;
  }
  return out;
}

int brushedVoxel(double voxels, int size) {
  return int(std::clamp(std::floor(voxels), -1.0, double(size)));
}

// What a stroke covers: intervals of rows, the rows as they come.
class Cover {
 public:
  explicit Cover(const GridGeometry& g) : g_(g) {}

  // `from` and `to` in mm along the grid's axes; nothing outside of `box`.
  void capsule(const Vec3& from, const Vec3& to, double radius_mm, const VoxelBox& box) {
    const Vec3& edge = g_.spacing_mm;
    Index3 low, high;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      const int a = int(axis);
      const double first = (std::min(from[a], to[a]) - radius_mm) / edge[a];
      const double last = (std::max(from[a], to[a]) + radius_mm) / edge[a];
      low[axis] = std::max(box.low[axis], brushedVoxel(std::ceil(first), g_.size[axis]));
      high[axis] = std::min(box.high[axis], brushedVoxel(last, g_.size[axis]) + 1);
    }
    for (int k = low[2]; k < high[2]; ++k) {
      for (int j = low[1]; j < high[1]; ++j) {
        const auto span = inCapsule(from, to, radius_mm, Vec3(0.0, j * edge.y, k * edge.z));
        if (!span) continue;
        const int begin =
            std::max(box.low[0], brushedVoxel(std::ceil(span->low / edge.x), g_.size[0]));
        const int end = std::min(box.high[0], brushedVoxel(span->high / edge.x, g_.size[0]) + 1);
        add(begin, end, j, k);
      }
    }
  }
  void voxel(const Vec3& at_mm, const VoxelBox& box) {
    Index3 at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = brushedVoxel(at_mm[int(axis)] / g_.spacing_mm[int(axis)] + 0.5, g_.size[axis]);
      if (at[axis] < box.low[axis] || at[axis] >= box.high[axis]) return;
    }
    add(at[0], at[0] + 1, at[1], at[2]);
  }

  // take(first voxel, end) of each row's parts that are covered, in rising order, none twice.
  template <class Take>
  void forParts(const Take& take) {
    if (parts_.empty()) return;
    const std::size_t wide = std::size_t(high_[0] - low_[0] + 1);
    const auto row = [&](const Part& p) {
      return std::size_t(p.k - low_[1]) * wide + std::size_t(p.j - low_[0]);
    };
    std::vector<std::uint32_t> first(wide * std::size_t(high_[1] - low_[1] + 1) + 1);
    for (const Part& p : parts_) ++first[row(p) + 1];
    for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
    std::vector<Part> by_row(parts_.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Part& p : parts_) by_row[next[row(p)]++] = p;
    for (std::size_t n = 0; n + 1 < first.size(); ++n) {
      const auto begin = by_row.begin() + first[n], end = by_row.begin() + first[n + 1];
      std::sort(begin, end, [](const Part& a, const Part& b) { return a.begin < b.begin; });
      for (auto part = begin; part != end;) {
        const std::size_t in_row = g_.indexOf(0, part->j, part->k);
        const int from = part->begin;
        int to = part->end;
        for (++part; part != end && part->begin <= to; ++part) to = std::max(to, part->end);
        take(in_row + std::size_t(from), in_row + std::size_t(to));
      }
    }
  }

 private:
  struct Part {
    int j, k, begin, end;
  };
  void add(int begin, int end, int j, int k) {
    if (begin >= end) return;
    if (parts_.empty()) {
      low_ = high_ = {j, k};
    }
    low_ = {std::min(low_[0], j), std::min(low_[1], k)};
    high_ = {std::max(high_[0], j), std::max(high_[1], k)};
    parts_.push_back({j, k, begin, end});
  }

  const GridGeometry& g_;
  std::vector<Part> parts_;
  std::array<int, 2> low_{}, high_{};  // of j and k, both in
};

// The stroke's parts: points that are joined, and where they may reach.
struct Line {
  std::vector<Vec3> points;
  VoxelBox box;
};

std::vector<Line> linesOf(const GridGeometry& g, std::span<const Vec3> path_mm,
                          const Brush& brush) {
  const Mat4 to_voxel = g.patientToVoxel();
  const VoxelBox whole{{0, 0, 0}, g.size};
  const bool disc = brush.shape == Brush::Shape::disc;
  const std::size_t across = std::size_t(brush.across);
  std::vector<Line> lines;
  for (const Vec3& point_mm : path_mm) {
    Vec3 at = Vec3(to_voxel * glm::dvec4(point_mm, 1.0));
    VoxelBox box = whole;
    if (disc) {
      const int slice = brushedVoxel(at[brush.across] + 0.5, g.size[across]);
      at[brush.across] = slice;
      box.low[across] = slice;
      box.high[across] = slice < 0 ? slice : std::min(slice + 1, g.size[across]);
      if (slice < 0 || slice >= g.size[across]) box.low = box.high = {0, 0, 0};
    }
    if (lines.empty() || !(lines.back().box == box)) lines.push_back({{}, box});
    lines.back().points.push_back(at * g.spacing_mm);
  }
  return lines;
}

}  // namespace

Result<LabelEdit> brushEdit(const LabelMap& map, int label, std::span<const Vec3> path_mm,
                            const Brush& brush, const Volume* volume) {
  const GridGeometry& g = map.geometry;
  if (Status good = checkMap(map, label); !good) return good.error();
  if (Status good = checkMm(brush.radius_mm, 0.05, 200.0, tr("The brush's radius")); !good) {
    return good.error();
  }
  if (brush.across < 0 || brush.across > 2) {
    return Error{code::kBadArgument, tr("Slices lie across axis 0, 1 or 2"), "across", ""};
  }
  if (!std::all_of(path_mm.begin(), path_mm.end(), [](const Vec3& p) { return isFinite(p); })) {
    return Error{code::kBadArgument, tr("A point of the stroke is no place"), "path", ""};
  }
  if (brush.hu && !(brush.hu->low <= brush.hu->high)) {
    return Error{code::kBadArgument, tr("The HU range ends below where it begins"), "hu", ""};
  }
  if (brush.hu && !volume) {
    return Error{code::kBadArgument, tr("A range of HU needs the CT"), "hu", ""};
  }
  if (brush.hu && volume->geometry.size != g.size) {
    return Error{code::kOtherGrid, tr("The label map and the CT have other sizes"), "",
                 tr("Fit the label map to the CT")};
  }
  const std::uint8_t own = std::uint8_t(label);
  try {
    const Vec3& edge = g.spacing_mm;
    const double within = kStraight * std::min({edge.x, edge.y, edge.z});
    Cover cover(g);
    for (const Line& line : linesOf(g, path_mm, brush)) {
      for (const Vec3& point : line.points) cover.voxel(point, line.box);
      const std::vector<Vec3> points = straightened(line.points, within);
      for (std::size_t n = 0; n < points.size(); ++n) {
        if (n + 1 < points.size() || points.size() == 1) {
          cover.capsule(points[n], points[std::min(n + 1, points.size() - 1)], brush.radius_mm,
                        line.box);
        }
      }
    }
    EditMaker edit(map);
    cover.forParts([&](std::size_t first, std::size_t end) {
      for (std::size_t at = first; at < end; ++at) {
        const std::uint8_t before = map.labels[at];
        const bool takes = brush.erase ? before == own : isFree(before, own, brush.over);
        if (!takes) continue;
        if (brush.hu && !(volume->hu[at] >= brush.hu->low && volume->hu[at] <= brush.hu->high)) {
          continue;
        }
        edit.put(at, brush.erase ? 0 : own);
      }
    });
    return edit.take();
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the stroke"), "");
  }
}

}  // namespace trephine
