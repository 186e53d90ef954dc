#include "structures/work_grid.h"

#include <vtkFloatArray.h>
#include <vtkImageConnectivityFilter.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

// VTK looks at the values where they are, and only reads them.
template <class Array, class Value>
vtkNew<vtkImageData> imageOf(const std::vector<Value>& values, const WorkGrid& grid) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.size[0], grid.size[1], grid.size[2]);
  image->SetSpacing(grid.block_mm.x, grid.block_mm.y, grid.block_mm.z);
  vtkNew<Array> array;
  array->SetArray(const_cast<Value*>(values.data()), vtkIdType(values.size()), 1);
  image->GetPointData()->SetScalars(array);
  return image;
}

// Squared distances along one line of `n` places `step` apart, `edge_mm` each: the lower envelope
// of the parabolas that stand on `at`.
class LineOfParabolas {
 public:
  explicit LineOfParabolas(int n)
      : value_(std::size_t(n)), from_(std::size_t(n)), starts_(std::size_t(n) + 1) {}

  void put(float* at, std::size_t step, int n, double edge_mm) {
    const double square = edge_mm * edge_mm;
    int last = -1;
    for (int q = 0; q < n; ++q) {
      const double f = value_[std::size_t(q)] = at[std::size_t(q) * step];
      if (f == kFar) continue;
      double start = -std::numeric_limits<double>::infinity();
      while (last >= 0) {
        const int p = from_[std::size_t(last)];
        start = ((f / square + double(q) * q) - (value_[std::size_t(p)] / square + double(p) * p)) /
                (2.0 * (q - p));
        if (start > starts_[std::size_t(last)]) break;
        --last;
      }
      if (last < 0) start = -std::numeric_limits<double>::infinity();
      ++last;
      from_[std::size_t(last)] = q;
      starts_[std::size_t(last)] = start;
    }
    if (last < 0) return;
    int of = 0;
    for (int q = 0; q < n; ++q) {
      while (of < last && starts_[std::size_t(of) + 1] < q) ++of;
      const int p = from_[std::size_t(of)];
      at[std::size_t(q) * step] = float(square * (q - p) * (q - p) + value_[std::size_t(p)]);
    }
  }

 private:
  std::vector<double> value_;
  std::vector<int> from_;
  std::vector<double> starts_;
};

}  // namespace

WorkGrid workGridOf(const GridGeometry& geometry, double block_mm) {
  WorkGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = geometry.spacing_mm[int(axis)];
    grid.factor[axis] =
        std::clamp(int(std::lround(block_mm / edge)), 1, std::max(1, geometry.size[axis]));
    grid.size[axis] = (geometry.size[axis] + grid.factor[axis] - 1) / grid.factor[axis];
    grid.block_mm[int(axis)] = edge * grid.factor[axis];
  }
  return grid;
}

Blocks blockMeans(const Volume& volume, const WorkGrid& grid) {
  Blocks means(grid.count());
  const GridGeometry& g = volume.geometry;
  const Index3& f = grid.factor;
  onTwoThreads(grid.size[2], [&](int k) {
    std::vector<std::int32_t> sums(std::size_t(grid.size[0]));
    const int k_end = std::min((k + 1) * f[2], g.size[2]);
    for (int j = 0; j < grid.size[1]; ++j) {
      const int j_end = std::min((j + 1) * f[1], g.size[1]);
      std::fill(sums.begin(), sums.end(), 0);
      for (int z = k * f[2]; z < k_end; ++z) {
        for (int y = j * f[1]; y < j_end; ++y) {
          const std::int16_t* hu = &volume.hu[g.indexOf(0, y, z)];
          for (int i = 0; i < grid.size[0]; ++i) {
            const int end = std::min((i + 1) * f[0], g.size[0]);
            for (int x = i * f[0]; x < end; ++x) sums[std::size_t(i)] += hu[x];
          }
        }
      }
      const int lines = (k_end - k * f[2]) * (j_end - j * f[1]);
      for (int i = 0; i < grid.size[0]; ++i) {
        const int wide = std::min((i + 1) * f[0], g.size[0]) - i * f[0];
        means[grid.indexOf(i, j, k)] = float(sums[std::size_t(i)]) / float(wide * lines);
      }
    }
  });
  return means;
}

Blocks smoothed(const Blocks& blocks, const WorkGrid& grid, double sigma_mm) {
  const auto image = imageOf<vtkFloatArray>(blocks, grid);
  vtkNew<vtkImageGaussianSmooth> filter;
  filter->SetInputData(image);
  filter->SetStandardDeviations(sigma_mm / grid.block_mm.x, sigma_mm / grid.block_mm.y,
                                sigma_mm / grid.block_mm.z);
  filter->SetRadiusFactor(3.0);
  filter->Update();
  const auto* out = vtkFloatArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  const float* from = const_cast<vtkFloatArray*>(out)->GetPointer(0);
  return {from, from + blocks.size()};
}

double softTissueNoise_HU(const Blocks& blocks, const WorkGrid& grid) {
  constexpr float kLow = -50.0f, kHigh = 150.0f;
  std::vector<float> differences;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 1; i + 1 < grid.size[0]; ++i) {
        const float* at = &blocks[grid.indexOf(i, j, k)];
        if (at[0] > kLow && at[0] < kHigh) {
          differences.push_back(std::abs(at[-1] - 2.0f * at[0] + at[1]));
        }
      }
    }
  }
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + std::ptrdiff_t(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  // 1.4826: of a normal distribution's median deviation; a second difference has six variances.
  return 1.4826 * double(*middle) / std::sqrt(6.0);
}

BlockMask within(const Blocks& blocks, double low, double high) {
  BlockMask in(blocks.size());
  for (std::size_t n = 0; n < blocks.size(); ++n) in[n] = blocks[n] >= low && blocks[n] <= high;
  return in;
}

std::vector<float> distance_mm(const BlockMask& in, const WorkGrid& grid) {
  std::vector<float> squares(in.size());
  for (std::size_t n = 0; n < in.size(); ++n) squares[n] = in[n] ? 0.0f : kFar;
  const Index3& n = grid.size;
  const std::size_t row = std::size_t(n[0]), slice = row * std::size_t(n[1]);
  onTwoThreads(n[2], [&](int k) {
    LineOfParabolas line(std::max(n[0], n[1]));
    float* first = &squares[std::size_t(k) * slice];
    for (int j = 0; j < n[1]; ++j) line.put(first + std::size_t(j) * row, 1, n[0], grid.block_mm.x);
    for (int i = 0; i < n[0]; ++i) line.put(first + i, row, n[1], grid.block_mm.y);
  });
  onTwoThreads(n[1], [&](int j) {
    LineOfParabolas line(n[2]);
    float* first = &squares[std::size_t(j) * row];
    for (int i = 0; i < n[0]; ++i) line.put(first + i, slice, n[2], grid.block_mm.z);
  });
  for (float& square : squares) square = std::sqrt(square);
  return squares;
}

BlockMask eroded(const BlockMask& in, const WorkGrid& grid, double radius_mm) {
  BlockMask out(in.size());
  for (std::size_t n = 0; n < in.size(); ++n) out[n] = !in[n];
  const std::vector<float> mm = distance_mm(out, grid);
  for (std::size_t n = 0; n < in.size(); ++n) out[n] = mm[n] > float(radius_mm);
  return out;
}

BlockMask dilated(const BlockMask& in, const WorkGrid& grid, double radius_mm) {
  const std::vector<float> mm = distance_mm(in, grid);
  BlockMask out(in.size());
  for (std::size_t n = 0; n < in.size(); ++n) out[n] = mm[n] <= float(radius_mm);
  return out;
}

std::vector<std::int32_t> pieces(const BlockMask& in, const WorkGrid& grid) {
  const auto image = imageOf<vtkUnsignedCharArray>(in, grid);
  vtkNew<vtkImageConnectivityFilter> filter;
  filter->SetInputData(image);
  filter->SetScalarRange(1.0, 1.0);
  filter->SetExtractionModeToAllRegions();
  filter->SetLabelModeToSizeRank();
  filter->SetLabelScalarTypeToInt();
  filter->Update();
  auto* out = vtkIntArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  return {out->GetPointer(0), out->GetPointer(0) + in.size()};
}

void fillHoles(BlockMask& in, const WorkGrid& grid) {
  BlockMask outside(in.size());
  for (std::size_t n = 0; n < in.size(); ++n) outside[n] = !in[n];
  const std::vector<std::int32_t> piece = pieces(outside, grid);
  std::vector<std::uint8_t> open(std::size_t(*std::max_element(piece.begin(), piece.end())) + 1);
  const Index3& n = grid.size;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      const bool whole_row = k == 0 || j == 0 || k == n[2] - 1 || j == n[1] - 1;
      for (int i = 0; i < n[0]; i += whole_row ? 1 : std::max(1, n[0] - 1)) {
        open[std::size_t(piece[grid.indexOf(i, j, k)])] = 1;
      }
    }
  }
  open[0] = 1;
  for (std::size_t at = 0; at < in.size(); ++at) {
    if (!open[std::size_t(piece[at])]) in[at] = 1;
  }
}

BlockMask majority(const BlockMask& in, const WorkGrid& grid) {
  BlockMask out(in.size());
  const Index3& n = grid.size;
  onTwoThreads(n[2], [&](int k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        int votes = 0, voters = 0;
        for (int dk = -1; dk <= 1; ++dk) {
          for (int dj = -1; dj <= 1; ++dj) {
            for (int di = -1; di <= 1; ++di) {
              if (std::abs(di) + std::abs(dj) + std::abs(dk) > 2) continue;
              if (!grid.holds(i + di, j + dj, k + dk)) continue;
              ++voters;
              votes += in[grid.indexOf(i + di, j + dj, k + dk)];
            }
          }
        }
        out[grid.indexOf(i, j, k)] = 2 * votes > voters;
      }
    }
  });
  return out;
}

}  // namespace trephine
