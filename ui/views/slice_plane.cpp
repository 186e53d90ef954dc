#include "ui/views/slice_plane.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// How far, in voxels from end to end, a grid's axis may leave the patient's and count as along it.
constexpr double kAlongWithin = 0.1;
// Of a stack through an oblique grid.
constexpr int kMostPixels = 4096;

// Right, down and away from the eye, LPS.
Mat3 axesOf(SliceAxis axis) {
  switch (axis) {
    case SliceAxis::axial:
      return {1, 0, 0, 0, 1, 0, 0, 0, 1};
    case SliceAxis::coronal:
      return {1, 0, 0, 0, 0, -1, 0, 1, 0};
    case SliceAxis::sagittal:
      break;
  }
  return {0, 1, 0, 0, 0, -1, -1, 0, 0};
}

Vec3 lastVoxel(const GridGeometry& g) {
  return Vec3(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1);
}

// The grid with its axes in another order and each pointing towards `wanted`; nothing where one of
// them does not lie along the patient.
std::optional<GridGeometry> permuted(const GridGeometry& grid, const Mat3& wanted) {
  GridGeometry stack;
  std::array<bool, 3> taken{};
  Vec3 first(0.0);  // the voxel that becomes (0, 0, 0)
  const Vec3 extent = lastVoxel(grid) + 1.0;
  const double finest = std::min({grid.spacing_mm.x, grid.spacing_mm.y, grid.spacing_mm.z});
  for (int n = 0; n < 3; ++n) {
    int best = 0;
    for (int a = 1; a < 3; ++a) {
      const auto along = [&](int axis) {
        return std::abs(glm::dot(grid.direction[axis], wanted[n]));
      };
      if (along(a) > along(best)) best = a;
    }
    if (taken[std::size_t(best)]) return {};
    taken[std::size_t(best)] = true;
    const double sign = glm::dot(grid.direction[best], wanted[n]) < 0.0 ? -1.0 : 1.0;
    const Vec3 off = grid.direction[best] * sign - wanted[n];
    const double end_mm = extent[best] * grid.spacing_mm[best];
    if (glm::length(off) * end_mm > kAlongWithin * finest) return {};
    stack.size[std::size_t(n)] = grid.size[std::size_t(best)];
    stack.spacing_mm[n] = grid.spacing_mm[best];
    stack.direction[n] = grid.direction[best] * sign;
    if (sign < 0.0) first[best] = grid.size[std::size_t(best)] - 1;
  }
  stack.origin_mm = grid.toPatient_mm(first);
  return stack;
}

// The lowest and highest of what the corners of a box of voxels are along a direction.
std::pair<double, double> reach(const GridGeometry& grid, const VoxelBox& box, const Vec3& along) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 voxel;
    for (int axis = 0; axis < 3; ++axis) {
      const Index3& end = corner >> axis & 1 ? box.high : box.low;
      voxel[axis] = double(end[std::size_t(axis)]) - 0.5;
    }
    const double at = glm::dot(grid.toPatient_mm(voxel), along);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return {low, high};
}

}  // namespace

GridGeometry sliceStack(const GridGeometry& grid, SliceAxis axis) {
  const Mat3 wanted = axesOf(axis);
  if (const std::optional<GridGeometry> same = permuted(grid, wanted)) return *same;
  GridGeometry stack;
  stack.direction = wanted;
  const Mat3 to_voxel(grid.patientToVoxel());
  for (int n = 0; n < 3; ++n) {
    const auto [low, high] = reach(grid, {{0, 0, 0}, grid.size}, wanted[n]);
    // As many pixels a mm as voxels are passed.
    const double finest_mm = 1.0 / glm::length(to_voxel * wanted[n]);
    stack.spacing_mm[n] = std::max(finest_mm, (high - low) / kMostPixels);
    const int count = int(std::ceil((high - low) / stack.spacing_mm[n] - 1e-6));
    stack.size[std::size_t(n)] = std::max(1, count);
    const double spare = stack.size[std::size_t(n)] * stack.spacing_mm[n] - (high - low);
    stack.origin_mm += wanted[n] * (low + 0.5 * (stack.spacing_mm[n] - spare));
  }
  return stack;
}

bool hasVoxelsForPixels(const GridGeometry& stack, const GridGeometry& grid) {
  const Mat3 to_voxel(grid.patientToVoxel());
  for (int n = 0; n < 3; ++n) {
    const Vec3 step = to_voxel * (stack.direction[n] * stack.spacing_mm[n]);
    const double off = glm::length(step - glm::round(step)) * stack.size[std::size_t(n)];
    if (off > kAlongWithin + 1e-9) return false;
  }
  return true;
}

Vec3 toVoxel(const GridGeometry& grid, const Vec3& patient_mm) {
  return Vec3(grid.patientToVoxel() * glm::dvec4(patient_mm, 1.0));
}

std::optional<Index3> voxelAt(const GridGeometry& grid, const Vec3& patient_mm) {
  const Vec3 at = toVoxel(grid, patient_mm);
  Index3 voxel;
  for (int axis = 0; axis < 3; ++axis) {
    // Also true for anything not finite, which must not become an index.
    if (!(at[axis] >= -0.5 && at[axis] < grid.size[std::size_t(axis)] - 0.5)) return {};
    voxel[std::size_t(axis)] = std::int32_t(std::floor(at[axis] + 0.5));
  }
  return voxel;
}

bool touches(const GridGeometry& stack, int k, const GridGeometry& grid, const VoxelBox& box) {
  const Vec3 onwards = stack.direction[2];
  // Between voxels a picture shows half a voxel more of each.
  VoxelBox seen = box;
  if (!hasVoxelsForPixels(stack, grid)) {
    for (std::size_t a = 0; a < 3; ++a) --seen.low[a], ++seen.high[a];
  }
  const auto [low, high] = reach(grid, seen, onwards);
  const double at = glm::dot(stack.origin_mm, onwards) + k * stack.spacing_mm.z;
  const double slack = 1e-6 * stack.spacing_mm.z;
  return at >= low - slack && at <= high + slack;
}

int mainAxis(const Vec3& direction) {
  const Vec3 size = glm::abs(direction);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

Mirroring mirroringOf(const Mat3& direction) {
  const Vec3 &across = direction[0], &down = direction[1];
  const double onwards = down[mainAxis(down)];
  return {across[mainAxis(across)] < 0.0, mainAxis(down) == 2 ? onwards > 0.0 : onwards < 0.0};
}

int axisAlong(const GridGeometry& grid, const Vec3& direction) {
  return mainAxis(glm::transpose(grid.direction) * direction);
}

char patientLetter(const Vec3& direction) {
  const int axis = mainAxis(direction);
  return (direction[axis] > 0.0 ? "LPS" : "RAI")[axis];
}

}  // namespace trephine
