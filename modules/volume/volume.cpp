#include "volume/volume.h"

#include <algorithm>

#include "base/codes.h"
#include "base/sha256.h"
#include "base/tr.h"
#include "volume/codes.h"
#include "volume/two_threads.h"

namespace trephine {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "hashing and files take int16 as stored");

Index3 GridGeometry::indicesOf(std::size_t index) const {
  const auto nx = std::size_t(size[0]), ny = std::size_t(size[1]);
  return {std::int32_t(index % nx), std::int32_t(index / nx % ny), std::int32_t(index / (nx * ny))};
}

Mat4 GridGeometry::voxelToPatient() const {
  Mat4 affine(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    affine[axis] = glm::dvec4(direction[axis] * spacing_mm[axis], 0.0);
  }
  affine[3] = glm::dvec4(origin_mm, 1.0);
  return affine;
}

Mat4 GridGeometry::patientToVoxel() const {
  return glm::inverse(voxelToPatient());
}

Vec3 GridGeometry::toPatient_mm(const Vec3& voxel) const {
  return Vec3(voxelToPatient() * glm::dvec4(voxel, 1.0));
}

Vec3 GridGeometry::centre_mm() const {
  return toPatient_mm(Vec3(size[0] - 1, size[1] - 1, size[2] - 1) * 0.5);
}

double GridGeometry::diagonal_mm() const {
  return glm::length(Vec3(size[0], size[1], size[2]) * spacing_mm);
}

Volume copyOf(const Volume& volume) {
  Volume copy{volume.geometry, Voxels(volume.hu.size())};
  constexpr std::size_t kBlock = std::size_t(1) << 21;
  const std::size_t count = volume.hu.size();
  onTwoThreads(int((count + kBlock - 1) / kBlock), [&](int n) {
    const std::size_t from = std::size_t(n) * kBlock;
    std::copy_n(volume.hu.data() + from, std::min(kBlock, count - from), copy.hu.data() + from);
  });
  return copy;
}

std::string volumeSha256(const Volume& volume) {
  return sha256Hex(volume.hu.data(), volume.hu.size() * sizeof(std::int16_t));
}

Status checkSize(const Index3& size, const std::string& where, std::uint64_t max_voxels) {
  const std::string text =
      std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]);
  std::uint64_t count = 1;
  for (std::int32_t n : size) {
    if (n <= 0)
      return Error{code::kBadSize, tr("A size of {} voxels is not possible", text), where, ""};
    if (std::uint64_t(n) > max_voxels / count) {
      return Error{code::kTooLarge, tr("A volume of {} voxels is larger than can be loaded", text),
                   where, tr("Crop it or export it at a lower resolution")};
    }
    count *= std::uint64_t(n);
  }
  return {};
}

double sampleHu(const Volume& volume, const Vec3& patient_mm) {
  const GridGeometry& g = volume.geometry;
  const Vec3 v = Vec3(g.patientToVoxel() * glm::dvec4(patient_mm, 1.0));
  for (int axis = 0; axis < 3; ++axis) {
    // Also true for anything not finite, which must not become an index.
    if (!(v[axis] > -1.0 && v[axis] < g.size[axis])) return kAirHu;
  }
  const Vec3 base = glm::floor(v);
  const Vec3 t = v - base;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
    const int i = int(base.x) + di, j = int(base.y) + dj, k = int(base.z) + dk;
    const double weight = (di ? t.x : 1 - t.x) * (dj ? t.y : 1 - t.y) * (dk ? t.z : 1 - t.z);
    sum += weight * (g.contains(i, j, k) ? volume.at(i, j, k) : kAirHu);
  }
  return sum;
}

}  // namespace trephine
