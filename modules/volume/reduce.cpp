#include "volume/reduce.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <vector>

#include "base/codes.h"
#include "base/tr.h"
#include "volume/codes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

std::string text(const Index3& v) {
  return std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]);
}

Error noMemory(const std::string& where) {
  return {code::kOutOfMemory, tr("There is not enough memory for the smaller volume"), where,
          tr("Close other programs")};
}

Status checkBox(const GridGeometry& geometry, const VoxelBox& box) {
  const std::string where = tr("{} up to {}", text(box.low), text(box.high));
  for (int axis = 0; axis < 3; ++axis) {
    if (box.low[axis] >= box.high[axis]) {
      return Error{code::kBadCrop, tr("The box to keep has nothing in it"), where,
                   tr("Choose a larger box")};
    }
    if (box.low[axis] < 0 || box.high[axis] > geometry.size[axis]) {
      return Error{code::kBadCrop, tr("The box to keep reaches outside the volume"), where,
                   tr("The volume has {} voxels", text(geometry.size))};
    }
  }
  return {};
}

GridGeometry croppedGeometry(GridGeometry geometry, const VoxelBox& box) {
  geometry.origin_mm = geometry.toPatient_mm(Vec3(box.low[0], box.low[1], box.low[2]));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    geometry.size[axis] = box.high[axis] - box.low[axis];
  }
  return geometry;
}

// Row by row, first to last: `to` may be the same memory, since no row moves up.
void moveRows(const GridGeometry& geometry, const std::int16_t* from, const VoxelBox& box,
              std::int16_t* to) {
  const auto row = std::size_t(box.high[0] - box.low[0]);
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j, to += row) {
      std::memmove(to, from + geometry.indexOf(box.low[0], j, k), row * sizeof(std::int16_t));
    }
  }
}

// A vector keeps its memory when it shrinks. The whole pages behind its end are given back; they
// hold nothing, and would come back as zeros.
void releaseSpare(Voxels& hu) {
  const auto page = std::uintptr_t(::sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(hu.data() + hu.size()) + page - 1) / page;
  const auto end = reinterpret_cast<std::uintptr_t>(hu.data() + hu.capacity()) / page;
  if (end > begin)
    ::madvise(reinterpret_cast<void*>(begin * page), (end - begin) * page, MADV_DONTNEED);
}

std::int16_t meanHalfToEven(std::int32_t sum, std::int32_t count) {
  std::int32_t mean = sum / count, rest = sum % count;
  if (rest < 0) {
    rest += count;
    --mean;
  }
  if (2 * rest > count || (2 * rest == count && mean % 2 != 0)) ++mean;
  return std::int16_t(mean);
}

// One row of the result: `sums` has room for a row of the original.
void reduceRow(const Volume& volume, int factor, int j, int k, std::vector<std::int32_t>& sums,
               std::int16_t* to) {
  const Index3& size = volume.geometry.size;
  const int rows = std::min(factor, size[1] - j * factor);
  const int slices = std::min(factor, size[2] - k * factor);
  std::fill(sums.begin(), sums.end(), 0);
  for (int dk = 0; dk < slices; ++dk) {
    for (int dj = 0; dj < rows; ++dj) {
      const std::int16_t* from =
          volume.hu.data() + volume.geometry.indexOf(0, j * factor + dj, k * factor + dk);
      for (int i = 0; i < size[0]; ++i) sums[std::size_t(i)] += from[i];
    }
  }
  const auto sumOf = [&](int i, int columns) {
    std::int32_t sum = 0;
    for (int di = 0; di < columns; ++di) sum += sums[std::size_t(i + di)];
    return sum;
  };
  // Whole blocks hold a power of two: halves to even by adding just under a half, or a half where
  // the floor is odd.
  int i = 0;
  const int count = factor * rows * slices, shift = std::countr_zero(unsigned(count));
  if (std::has_single_bit(unsigned(count))) {
    for (; i + factor <= size[0]; i += factor) {
      const std::int32_t sum = sumOf(i, factor);
      *to++ = std::int16_t((sum + count / 2 - 1 + (sum >> shift & 1)) >> shift);
    }
  }
  for (; i < size[0]; i += factor) {
    const int columns = std::min(factor, size[0] - i);
    *to++ = meanHalfToEven(sumOf(i, columns), columns * rows * slices);
  }
}

// Where a voxel of the original lies between two voxels of the reduced volume, along one axis.
struct Between {
  int low, high;
  float t;  // weight of `high`
};

std::vector<Between> betweens(int size, int small_size, int factor, int stride) {
  std::vector<Between> all;
  for (int i = 0; i < size; i += stride) {
    const double at = std::clamp((i - 0.5 * (factor - 1)) / factor, 0.0, small_size - 1.0);
    const int low = std::min(int(at), std::max(small_size - 2, 0));
    all.push_back({low, std::min(low + 1, small_size - 1), float(at - low)});
  }
  return all;
}

struct LossSums {
  double square = 0.0;
  std::uint64_t samples = 0, bone = 0, bone_after = 0, bone_kept = 0;
  std::vector<std::uint32_t> differing = std::vector<std::uint32_t>(65536);  // by |difference|, HU

  void add(float before, float after) {
    const float difference = std::abs(after - before);
    square += double(difference) * difference;
    ++differing[std::size_t(difference + 0.5f)];
    const bool bone_before = before > float(kBoneHu), bone_now = after > float(kBoneHu);
    bone += bone_before;
    bone_after += bone_now;
    bone_kept += bone_before && bone_now;
    ++samples;
  }
  void add(const LossSums& other) {
    square += other.square;
    samples += other.samples;
    bone += other.bone;
    bone_after += other.bone_after;
    bone_kept += other.bone_kept;
    for (std::size_t n = 0; n < differing.size(); ++n) differing[n] += other.differing[n];
  }
};

}  // namespace

Result<Volume> crop(const Volume& volume, const VoxelBox& box) {
  if (const Status status = checkBox(volume.geometry, box); !status.ok()) return status.error();
  try {
    Volume part{croppedGeometry(volume.geometry, box), {}};
    part.hu.resize(part.geometry.voxelCount());
    moveRows(volume.geometry, volume.hu.data(), box, part.hu.data());
    return part;
  } catch (const std::bad_alloc&) {
    return noMemory("crop");
  }
}

Result<Volume> crop(Volume&& volume, const VoxelBox& box) {
  if (const Status status = checkBox(volume.geometry, box); !status.ok()) return status.error();
  Volume part{croppedGeometry(volume.geometry, box), std::move(volume.hu)};
  moveRows(volume.geometry, part.hu.data(), box, part.hu.data());
  part.hu.resize(part.geometry.voxelCount());
  releaseSpare(part.hu);
  return part;
}

Result<Volume> reduced(const Volume& volume, int factor) {
  if (factor != 2 && factor != 4) {
    return Error{code::kBadFactor, tr("A volume can be reduced by 2 or 4, not by {}", factor),
                 "reduce", ""};
  }
  const GridGeometry& from = volume.geometry;
  if (const Status status = checkSize(from.size, "reduce"); !status.ok()) return status.error();
  try {
    Volume small{from, {}};
    for (auto& n : small.geometry.size) n = (n + factor - 1) / factor;
    small.geometry.spacing_mm *= double(factor);
    small.geometry.origin_mm = from.toPatient_mm(Vec3(0.5 * (factor - 1)));
    small.hu.resize(small.geometry.voxelCount());
    const Index3& size = small.geometry.size;
    // Half the slices a call: the two calls allocate their row before they start.
    std::vector<std::vector<std::int32_t>> sums(
        2, std::vector<std::int32_t>(std::size_t(from.size[0])));
    onTwoThreads(2, [&](int half) {
      for (int k = half * size[2] / 2; k < (half + 1) * size[2] / 2; ++k) {
        for (int j = 0; j < size[1]; ++j) {
          reduceRow(volume, factor, j, k, sums[std::size_t(half)],
                    small.hu.data() + small.geometry.indexOf(0, j, k));
        }
      }
    });
    return small;
  } catch (const std::bad_alloc&) {
    return noMemory("reduce");
  }
}

ReductionLoss reductionLoss(const Volume& original, const Volume& small, int factor) {
  constexpr std::uint64_t kSamples = 4'000'000;
  const Index3& size = original.geometry.size;
  ReductionLoss loss;
  const auto asked = [&](int axis) {
    return std::uint64_t((size[axis] - 1) / loss.stride[axis] + 1);
  };
  for (int axis = 0; asked(0) * asked(1) * asked(2) > kSamples; axis = (axis + 1) % 3) {
    loss.stride[axis] += 2;
  }
  std::array<std::vector<Between>, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = betweens(size[axis], small.geometry.size[axis], factor, loss.stride[axis]);
  }
  std::array<LossSums, 2> sums;
  onTwoThreads(2, [&](int half) {
    const std::size_t slices = at[2].size();
    for (std::size_t n = slices * half / 2; n < slices * (half + 1) / 2; ++n) {
      const Between& k = at[2][n];
      for (std::size_t m = 0; m < at[1].size(); ++m) {
        const Between& j = at[1][m];
        const std::int16_t* row[4] = {&small.hu[small.geometry.indexOf(0, j.low, k.low)],
                                      &small.hu[small.geometry.indexOf(0, j.high, k.low)],
                                      &small.hu[small.geometry.indexOf(0, j.low, k.high)],
                                      &small.hu[small.geometry.indexOf(0, j.high, k.high)]};
        const float weight[4] = {(1 - j.t) * (1 - k.t), j.t * (1 - k.t), (1 - j.t) * k.t,
                                 j.t * k.t};
        const std::int16_t* voxel = &original.hu[original.geometry.indexOf(
            0, int(m) * loss.stride[1], int(n) * loss.stride[2])];
        for (const Between& i : at[0]) {
          float after = 0.0f;
          for (int corner = 0; corner < 4; ++corner) {
            after += weight[corner] * (row[corner][i.low] * (1 - i.t) + row[corner][i.high] * i.t);
          }
          sums[std::size_t(half)].add(*voxel, after);
          voxel += loss.stride[0];
        }
      }
    }
  });
  LossSums& all = sums[0];
  all.add(sums[1]);
  loss.samples = all.samples;
  loss.rms_hu = std::sqrt(all.square / double(all.samples));
  std::uint64_t within = 0;
  std::size_t difference = 0;
  while ((within += all.differing[difference]) * 100 < all.samples * 99) ++difference;
  loss.p99_hu = double(difference);
  if (all.bone > 0) {
    const auto bone = double(all.bone);
    loss.bone_volume_change_percent = 100.0 * (double(all.bone_after) - bone) / bone;
    loss.bone_lost_percent = 100.0 * double(all.bone - all.bone_kept) / bone;
  }
  return loss;
}

GridGeometry outcomeOf(const GridGeometry& grid, const VoxelBox& box, int factor) {
  GridGeometry out = grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = std::max(0, box.high[axis] - box.low[axis]);
    out.size[axis] = (size + factor - 1) / factor;
  }
  out.spacing_mm *= double(factor);
  return out;
}

}  // namespace trephine
