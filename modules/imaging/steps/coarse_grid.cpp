#include "imaging/steps/coarse_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kSolidHu = -400, kMatterHu = -500, kBoneHu = 600;

int alongBody(const GridGeometry& geometry) {
  int along = 2;
  for (int axis : {0, 1}) {
    if (std::abs(geometry.direction[axis].z) > std::abs(geometry.direction[along].z)) along = axis;
  }
  return along;
}

// Sums and extremes of one row of cells, before neighbours along the row are joined. At most eight
// lines go into a row, so that sums of an eighth of the HU fit 16 bits: half the work.
constexpr int kLines = 8;
struct RowBuffers {
  std::vector<std::int16_t> sum, highest, lowest;
  explicit RowBuffers(std::size_t n) : sum(n), highest(n), lowest(n) {}
};

template <class Stride>
void addRow(const std::int16_t* from, Stride stride, std::size_t n, RowBuffers& row) {
  std::int16_t *sum = row.sum.data(), *highest = row.highest.data(), *lowest = row.lowest.data();
  for (std::size_t a = 0; a < n; ++a) {
    const std::int16_t hu = from[a * stride];
    sum[a] = std::int16_t(sum[a] + (hu >> 3));
    highest[a] = std::max(highest[a], hu);
    lowest[a] = std::min(lowest[a], hu);
  }
}

}  // namespace

bool CoarseGrid::isIn(const VoxelBox& box, int a, int b, int s) const {
  const Index3 cell{a, b, s};
  for (std::size_t n = 0; n < 3; ++n) {
    const auto along = std::size_t(axis[n]);
    const int from = cell[n] * step[n];
    if (from + step[n] <= box.low[along] || from >= box.high[along]) return false;
  }
  return true;
}

Vec3 CoarseGrid::place_mm(double a, double b, double s) const {
  const double cell[3] = {a, b, s};
  Vec3 voxel(0.0);
  for (std::size_t n = 0; n < 3; ++n) voxel[axis[n]] = cell[n] * step[n] + 0.5 * (step[n] - 1);
  return voxels.toPatient_mm(voxel);
}

Index3 CoarseGrid::cellAt(const Vec3& mm) const {
  const Vec3 from_first = glm::transpose(voxels.direction) * (mm - place_mm(0, 0, 0));
  Index3 cell;
  for (std::size_t n = 0; n < 3; ++n) {
    cell[n] = int(std::lround(from_first[axis[n]] / cell_mm[int(n)]));
  }
  return cell;
}

CoarseGrid coarseGrid(const Volume& volume, const CellSize& cells) {
  const GridGeometry& g = volume.geometry;
  CoarseGrid grid;
  grid.voxels = g;
  grid.axis[2] = alongBody(g);
  grid.axis[0] = grid.axis[2] == 0 ? 1 : 0;
  grid.axis[1] = grid.axis[2] == 2 ? 1 : 2;
  // Too many cells: longer ones first, since what is looked for is long.
  for (double scale = 1.0;; scale *= 1.1) {
    for (int n = 0; n < 3; ++n) {
      const double target = n == 2 ? cells.along_mm * std::min(scale, 3.0)
                                   : cells.across_mm * std::max(1.0, scale / 3.0);
      const double spacing = g.spacing_mm[grid.axis[n]];
      grid.step[n] = std::clamp(int(target / spacing + 0.5), 1, std::max(1, g.size[grid.axis[n]]));
      grid.size[n] = (g.size[grid.axis[n]] + grid.step[n] - 1) / grid.step[n];
      grid.cell_mm[n] = spacing * grid.step[n];
    }
    if (grid.count() <= cells.most) break;
  }
  grid.mean.resize(grid.count());
  grid.marks.resize(grid.count());

  const std::size_t stride_of[3] = {1, std::size_t(g.size[0]),
                                    std::size_t(g.size[0]) * std::size_t(g.size[1])};
  const std::size_t stride = stride_of[grid.axis[0]];
  const int voxels[3] = {g.size[grid.axis[0]], g.size[grid.axis[1]], g.size[grid.axis[2]]};
  const int line_step = (grid.step[1] + kLines - 1) / kLines;
  std::vector<RowBuffers> buffers(2, RowBuffers(std::size_t(voxels[0])));
  onTwoThreads(2, [&](int half) {
    RowBuffers& row = buffers[std::size_t(half)];
    const auto n = std::size_t(voxels[0]);
    for (int s = half * grid.size[2] / 2; s < (half + 1) * grid.size[2] / 2; ++s) {
      const int slice = std::min(s * grid.step[2] + grid.step[2] / 2, voxels[2] - 1);
      for (int b = 0; b < grid.size[1]; ++b) {
        std::fill(row.sum.begin(), row.sum.end(), std::int16_t(0));
        std::fill(row.highest.begin(), row.highest.end(), std::numeric_limits<std::int16_t>::min());
        std::fill(row.lowest.begin(), row.lowest.end(), std::numeric_limits<std::int16_t>::max());
        const int last = std::min((b + 1) * grid.step[1], voxels[1]);
        int lines = 0;
        for (int line = b * grid.step[1]; line < last; line += line_step, ++lines) {
          const std::int16_t* from = volume.hu.data() +
                                     std::size_t(slice) * stride_of[grid.axis[2]] +
                                     std::size_t(line) * stride_of[grid.axis[1]];
          if (stride == 1) {
            addRow(from, std::integral_constant<std::size_t, 1>(), n, row);
          } else {
            addRow(from, stride, n, row);
          }
        }
        std::size_t cell = grid.indexOf(0, b, s);
        for (int a = 0; a < voxels[0]; a += grid.step[0], ++cell) {
          const int end = std::min(a + grid.step[0], voxels[0]);
          std::int32_t sum = 0;
          std::int16_t highest = row.highest[std::size_t(a)], lowest = row.lowest[std::size_t(a)];
          for (int v = a; v < end; ++v) {
            sum += row.sum[std::size_t(v)];
            highest = std::max(highest, row.highest[std::size_t(v)]);
            lowest = std::min(lowest, row.lowest[std::size_t(v)]);
          }
          grid.mean[cell] = std::int16_t(sum * 8 / ((end - a) * lines) + 3);
          grid.marks[cell] = std::uint8_t((lowest >= kSolidHu ? kSolidCell : 0) |
                                          (highest > kMatterHu ? kMatterCell : 0) |
                                          (highest > kBoneHu ? kBoneCell : 0));
        }
      }
    }
  });
  return grid;
}

}  // namespace trephine
