#include "machine/common/shell_phantom.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace trephine {

namespace {

constexpr int kSamples = 4;  // of a voxel's edge

Vec3 innerAxes_mm(const EllipsoidShell& shell) {
  return shell.half_axes_mm - Vec3(shell.thickness_mm);
}

bool within(const Vec3& half_axes_mm, const Vec3& at_mm) {
  const Vec3 u = at_mm / half_axes_mm;
  return glm::dot(u, u) < 1.0;
}

// To first order the distance from an ellipsoid's surface: enough to tell which voxels it may cut.
double roughDistance_mm(const Vec3& half_axes_mm, const Vec3& at_mm) {
  const Vec3 u = at_mm / half_axes_mm;
  const double length = glm::length(u);
  if (!(length > 0.0)) return -std::min({half_axes_mm.x, half_axes_mm.y, half_axes_mm.z});
  return length * (length - 1.0) / glm::length(u / half_axes_mm);
}

// Half the chord of an ellipsoid along x through (y, z); 0 where it misses.
double halfChord_mm(const Vec3& half_axes_mm, double y_mm, double z_mm) {
  const double y = y_mm / half_axes_mm.y, z = z_mm / half_axes_mm.z;
  const double left = 1.0 - y * y - z * z;
  return left > 0.0 ? half_axes_mm.x * std::sqrt(left) : 0.0;
}

double meanHu(const EllipsoidShell& shell, const Vec3& centre_mm, double spacing_mm) {
  int bone = 0;
  for (int n = 0; n < kSamples * kSamples * kSamples; ++n) {
    const Vec3 place(n % kSamples, n / kSamples % kSamples, n / kSamples / kSamples);
    bone += isBone(shell, centre_mm + spacing_mm * ((place + 0.5) / double(kSamples) - 0.5));
  }
  const double share = double(bone) / (kSamples * kSamples * kSamples);
  return kAirHu + share * (shell.bone_hu - kAirHu);
}

}  // namespace

Vec3 surfacePoint_mm(const EllipsoidShell& shell, const Vec3& direction) {
  return direction / glm::length(direction / shell.half_axes_mm);
}

Vec3 surfaceNormal(const EllipsoidShell& shell, const Vec3& surface_mm) {
  return glm::normalize(surface_mm / (shell.half_axes_mm * shell.half_axes_mm));
}

bool isBone(const EllipsoidShell& shell, const Vec3& at_mm) {
  return within(shell.half_axes_mm, at_mm) && !within(innerAxes_mm(shell), at_mm);
}

GridGeometry cubeGeometry(int size, double box_mm, const Vec3& centre_mm) {
  GridGeometry geometry;
  geometry.size = {size, size, size};
  geometry.spacing_mm = Vec3(box_mm / size);
  geometry.origin_mm = centre_mm - 0.5 * (size - 1) * geometry.spacing_mm;
  return geometry;
}

Volume sharpShell(const EllipsoidShell& shell, const GridGeometry& geometry) {
  Volume volume;
  volume.geometry = geometry;
  volume.hu.assign(geometry.voxelCount(), kAirHu);
  const int count = geometry.size[0];
  const double spacing_mm = geometry.spacing_mm.x;
  // Voxels with centres less than `half_mm` from the middle of the row: first, and one past last.
  const auto range = [&](double half_mm) {
    const double first = std::ceil((-half_mm - geometry.origin_mm.x) / spacing_mm);
    const double last = std::floor((half_mm - geometry.origin_mm.x) / spacing_mm);
    const int from = int(std::clamp(first, 0.0, double(count)));
    return std::pair(from, std::max(from, int(std::clamp(last + 1.0, 0.0, double(count)))));
  };
  for (int k = 0; k < geometry.size[2]; ++k) {
    const double z_mm = geometry.origin_mm.z + k * geometry.spacing_mm.z;
    for (int j = 0; j < geometry.size[1]; ++j) {
      const double y_mm = geometry.origin_mm.y + j * geometry.spacing_mm.y;
      const double outer_mm = halfChord_mm(shell.half_axes_mm, y_mm, z_mm);
      if (!(outer_mm > 0.0)) continue;
      std::int16_t* row = volume.hu.data() + geometry.indexOf(0, j, k);
      const auto [from, to] = range(outer_mm);
      std::fill(row + from, row + to, shell.bone_hu);
      const double inner_mm = halfChord_mm(innerAxes_mm(shell), y_mm, z_mm);
      if (!(inner_mm > 0.0)) continue;
      const auto [hollow_from, hollow_to] = range(inner_mm);
      std::fill(row + hollow_from, row + hollow_to, kAirHu);
    }
  }
  return volume;
}

Volume scannedShell(const EllipsoidShell& shell, const GridGeometry& geometry, double noise_hu,
                    std::uint32_t seed) {
  Volume volume;
  volume.geometry = geometry;
  volume.hu.reserve(geometry.voxelCount());
  std::mt19937 generator(seed);
  std::normal_distribution<float> noise(0.0f, 1.0f);
  const double spacing_mm = geometry.spacing_mm.x;
  for (int k = 0; k < geometry.size[2]; ++k) {
    for (int j = 0; j < geometry.size[1]; ++j) {
      for (int i = 0; i < geometry.size[0]; ++i) {
        const Vec3 at_mm = geometry.origin_mm + geometry.spacing_mm * Vec3(i, j, k);
        const bool cut = std::abs(roughDistance_mm(shell.half_axes_mm, at_mm)) < spacing_mm ||
                         std::abs(roughDistance_mm(innerAxes_mm(shell), at_mm)) < spacing_mm;
        const double hu = cut                    ? meanHu(shell, at_mm, spacing_mm)
                          : isBone(shell, at_mm) ? shell.bone_hu
                                                 : kAirHu;
        volume.hu.push_back(std::int16_t(std::lround(hu + noise_hu * double(noise(generator)))));
      }
    }
  }
  return volume;
}

Volume shellTop(int grid, double box_mm) {
  const EllipsoidShell shell;
  // The shell's own middle for a large box, a place near its top for a small one.
  const double top_mm = shell.half_axes_mm.z;
  const Vec3 centre_mm(0.0, 0.0, std::max(0.0, top_mm + 22.6 - 0.5 * box_mm));
  return sharpShell(shell, cubeGeometry(grid, box_mm, centre_mm));
}

}  // namespace trephine
