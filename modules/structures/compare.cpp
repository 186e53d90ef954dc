#include "structures/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/tr.h"
#include "structures/work_grid.h"
#include "volume/codes.h"
#include "volume/grid_place.h"

namespace trephine {

namespace {

// Voxels of it with one across a face that is not; beyond the grid nothing is.
std::vector<std::size_t> borderOf(const LabelMap& map, std::uint8_t label) {
  std::vector<std::size_t> border;
  const GridGeometry& g = map.geometry;
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const std::size_t at = g.indexOf(i, j, k);
        if (map.labels[at] != label) continue;
        const auto out = [&](int x, int y, int z) {
          return !g.contains(x, y, z) || map.labels[g.indexOf(x, y, z)] != label;
        };
        if (out(i - 1, j, k) || out(i + 1, j, k) || out(i, j - 1, k) || out(i, j + 1, k) ||
            out(i, j, k - 1) || out(i, j, k + 1)) {
          border.push_back(at);
        }
      }
    }
  }
  return border;
}

double percentile95_mm(const std::vector<std::size_t>& from, const std::vector<std::size_t>& to,
                       const GridGeometry& g) {
  WorkGrid grid;
  grid.size = g.size;
  grid.block_mm = g.spacing_mm;
  BlockMask in(g.voxelCount());
  for (const std::size_t at : to) in[at] = 1;
  const std::vector<float> away = distance_mm(in, grid);
  std::vector<float> mm;
  mm.reserve(from.size());
  for (const std::size_t at : from) mm.push_back(away[at]);
  const auto at = mm.begin() + std::ptrdiff_t(0.95 * double(mm.size() - 1));
  std::nth_element(mm.begin(), at, mm.end());
  return *at;
}

// A file's float affine and the CT's may differ in the last digits.
bool sameGrid(const GridGeometry& a, const GridGeometry& b) {
  return cornersApart_mm(a, b) <= 1e-3 * std::min({a.spacing_mm.x, a.spacing_mm.y, a.spacing_mm.z});
}

// The same voxels, whose axes come in another order or run the other way.
bool sameVoxels(const GridGeometry& a, const GridGeometry& b) {
  const Mat4 to_a = a.patientToVoxel() * b.voxelToPatient();
  const Vec3 last_b(b.size[0] - 1, b.size[1] - 1, b.size[2] - 1);
  constexpr double kWithin = 1e-3;  // voxels
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step(to_a[axis]);
    const double most = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)});
    if (std::abs(most - 1.0) * last_b[axis] > kWithin) return false;
    if (std::abs(glm::length(step) - most) * last_b[axis] > kWithin) return false;
  }
  const Vec3 first = Vec3(to_a[3]), last = Vec3(to_a * glm::dvec4(last_b, 1.0));
  const Vec3 end(a.size[0] - 1, a.size[1] - 1, a.size[2] - 1);
  return glm::length(glm::min(first, last)) <= kWithin &&
         glm::length(glm::max(first, last) - end) <= kWithin;
}

}  // namespace

Result<Likeness> likeness(const LabelMap& a, std::uint8_t of_a, const LabelMap& b,
                          std::uint8_t of_b) {
  if (!sameGrid(a.geometry, b.geometry)) {
    if (sameVoxels(a.geometry, b.geometry)) {
      const Result<LabelMap> turned = fitTo(b, a.geometry);
      return turned ? likeness(a, of_a, *turned, of_b) : turned.error();
    }
    return Error{code::kOtherGrid, tr("The two label maps are not of the same grid"), "",
                 tr("Compare label maps of one CT")};
  }
  std::size_t in_a = 0, in_b = 0, both = 0;
  for (std::size_t n = 0; n < a.labels.size(); ++n) {
    const bool is_a = a.labels[n] == of_a, is_b = b.labels[n] == of_b;
    in_a += is_a;
    in_b += is_b;
    both += is_a && is_b;
  }
  Likeness of;
  const double voxel_ml = a.geometry.voxelVolume_mm3() / 1000.0;
  of.ml_a = double(in_a) * voxel_ml;
  of.ml_b = double(in_b) * voxel_ml;
  of.dice = in_a + in_b == 0 ? 1.0 : 2.0 * double(both) / double(in_a + in_b);
  of.hd95_mm = std::numeric_limits<double>::quiet_NaN();
  if (in_a == 0 || in_b == 0) return of;
  const std::vector<std::size_t> a_border = borderOf(a, of_a), b_border = borderOf(b, of_b);
  of.hd95_mm = std::max(percentile95_mm(a_border, b_border, a.geometry),
                        percentile95_mm(b_border, a_border, a.geometry));
  return of;
}

ChangedStructures changedStructures(const LabelMap* before, const LabelMap* after) {
  static const LabelMap kNone;
  const LabelMap &was = before ? *before : kNone, &is = after ? *after : kNone;
  const bool same_grid = was.labels.size() == is.labels.size() && was.geometry == is.geometry;
  std::array<bool, 256> had{}, has{}, other{};
  for (const std::uint8_t label : was.labels) had[label] = true;
  for (const std::uint8_t label : is.labels) has[label] = true;
  for (std::size_t n = 0; same_grid && n < is.labels.size(); ++n) {
    if (was.labels[n] == is.labels[n]) continue;
    other[was.labels[n]] = true;
    other[is.labels[n]] = true;
  }
  ChangedStructures result;
  for (const Structure& s : is.structures) {
    const auto label = std::size_t(s.label);
    const Structure* old = was.find(s.label);
    const bool same =
        same_grid && !other[label] && old && old->name == s.name && old->colour == s.colour;
    if (has[label] && !same) result.changed.push_back(s.name);
  }
  for (const Structure& s : was.structures) {
    const Structure* now = is.find(s.label);
    if (had[std::size_t(s.label)] && !(now && has[std::size_t(s.label)])) {
      result.gone.push_back(s.name);
    }
  }
  return result;
}

}  // namespace trephine
