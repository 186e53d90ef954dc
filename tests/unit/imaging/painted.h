// Volumes painted from formulas whose every voxel knows whether it is patient or couch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "volume/two_threads.h"
#include "volume/volume.h"

namespace trephine::test {

enum class Owner : std::uint8_t { air, patient, couch };
struct Matter {
  int hu = kAirHu;
  Owner owner = Owner::air;
};

struct Painted {
  Volume volume;
  std::vector<std::uint8_t> patient, couch;  // quarters of the voxel, 0 to 4
};

// A grid of `size` voxels with its middle at the origin. Columns of `direction` are the voxel axes.
inline GridGeometry centredGrid(const Index3& size, const Vec3& spacing_mm,
                                const Mat3& direction = Mat3(1.0)) {
  GridGeometry geometry;
  geometry.size = size;
  geometry.spacing_mm = spacing_mm;
  geometry.direction = direction;
  geometry.origin_mm = Vec3(0.0) - geometry.centre_mm();
  return geometry;
}

// The mean of four points a voxel, plus noise of about 12 HU that depends on the voxel's number.
template <class Truth>  // Matter(const Vec3& patient_mm), from two threads
Painted paint(const GridGeometry& geometry, const Truth& truth) {
  const std::size_t count = geometry.voxelCount();
  Painted painted{{geometry, std::vector<std::int16_t>(count)},
                  std::vector<std::uint8_t>(count),
                  std::vector<std::uint8_t>(count)};
  onTwoThreads(geometry.size[2], [&](int k) {
    for (int j = 0; j < geometry.size[1]; ++j) {
      for (int i = 0; i < geometry.size[0]; ++i) {
        const std::size_t n = geometry.indexOf(i, j, k);
        int sum = 0;
        // The corners of a tetrahedron: no two share a coordinate with a third.
        for (const Vec3& at : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
          const Matter matter = truth(geometry.toPatient_mm(Vec3(i, j, k) + 0.25 * at));
          sum += matter.hu;
          painted.patient[n] += matter.owner == Owner::patient;
          painted.couch[n] += matter.owner == Owner::couch;
        }
        const auto hash = std::uint32_t((n + 1) * 2654435761u);
        painted.volume.hu[n] = std::int16_t(sum / 4 + int(hash >> 16 & 31) - int(hash >> 24 & 31));
      }
    }
  });
  return painted;
}

// The same patient and couch, stored along other axes: voxel axis n of the result is axis order[n]
// of `painted`. Every voxel keeps its place in the patient.
inline Painted permuted(const Painted& painted, const std::array<int, 3>& order) {
  const GridGeometry& from = painted.volume.geometry;
  GridGeometry to = from;
  for (int n = 0; n < 3; ++n) {
    to.size[n] = from.size[order[n]];
    to.spacing_mm[n] = from.spacing_mm[order[n]];
    to.direction[n] = from.direction[order[n]];
  }
  Painted result{
      {to, std::vector<std::int16_t>(painted.volume.hu.size())}, painted.patient, painted.couch};
  for (std::size_t n = 0; n < result.volume.hu.size(); ++n) {
    const Index3 at = to.indicesOf(n);
    Index3 source;
    for (std::size_t axis = 0; axis < 3; ++axis) source[std::size_t(order[axis])] = at[axis];
    const std::size_t m = from.indexOf(source[0], source[1], source[2]);
    result.volume.hu[n] = painted.volume.hu[m];
    result.patient[n] = painted.patient[m];
    result.couch[n] = painted.couch[m];
  }
  return result;
}

// Shapes; negative inside.
inline double ellipse(double x, double y, double rx, double ry) {
  return std::sqrt(x * x / (rx * rx) + y * y / (ry * ry)) - 1.0;
}
inline double rod(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::distance(p, a + (b - a) * t) - radius;
}

// A man on his back, 400 mm of him: chest to thighs, arms and hands at his sides, fingers apart.
// Supine: his back is at y = +100 and below; z is up his body.
inline Matter man(const Vec3& p) {
  const double wide = 165.0 + 12.0 * std::sin(p.z / 45.0),
               deep = 100.0 + 9.0 * std::sin(p.z / 60.0);
  const double trunk = ellipse(p.x, p.y + 8.0 - 0.05 * p.z, wide, deep);
  if (trunk < 0.0) {
    if (p.z > 60 && ellipse(std::abs(p.x) - 75, p.y, 50, 65) < 0.0) return {-850, Owner::patient};
    if (ellipse(p.x, p.y - 55, 18, 16) < 0.0) return {500, Owner::patient};
    return {trunk > -0.1 ? -95 : 45, Owner::patient};
  }
  const Vec3 m(std::abs(p.x), p.y, p.z);
  double arm = rod(m, {225, 30, 200}, {222, 40, -30}, 36.0);
  arm = std::min(arm, rod(m, {222, 45, -30}, {220, 58, -90}, 22.0));
  for (int finger = 0; finger < 4; ++finger) {
    const double x = 203.0 + 14.0 * finger;  // 1 mm between two
    arm = std::min(arm, rod(m, {x, 64, -90}, {x, 73, -150}, 6.5));
  }
  if (arm < 0.0) return {arm > -6.0 ? -60 : 50, Owner::patient};
  return {};
}

// A couch under him: two thin plates with foam between, rising by `bend` mm at 200 mm aside,
// its top at y = `top` in the middle.
inline Matter couchPlates(const Vec3& p, double top, double bend) {
  const double y = p.y - top + bend * (p.x / 200) * (p.x / 200);
  if (std::abs(p.x) > 235.0 || y < 0.0 || y > 50.0) return {};
  const bool plate = y < 2.5 || y > 47.5 || std::abs(p.x) > 232.0;
  return {plate ? 80 : -930, Owner::couch};
}

}  // namespace trephine::test
