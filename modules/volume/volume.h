// A CT volume as a plain value: int16 HU and where they lie in the patient.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "volume/voxels.h"

namespace trephine {

constexpr std::int16_t kAirHu = -1000;

// Size, spacing and place of a grid of voxels. Voxel (0, 0, 0) has its centre at `origin_mm`;
// `direction` holds the unit i, j, k axes in LPS as its columns.
struct GridGeometry {
  Index3 size{0, 0, 0};
  Vec3 spacing_mm{1.0};
  Vec3 origin_mm{0.0};
  Mat3 direction{1.0};

  std::size_t voxelCount() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  double voxelVolume_mm3() const { return spacing_mm.x * spacing_mm.y * spacing_mm.z; }
  std::size_t indexOf(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  bool contains(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  }
  Index3 indicesOf(std::size_t index) const;

  // 4x4, voxel (i, j, k, 1) to patient mm, and back.
  Mat4 voxelToPatient() const;
  Mat4 patientToVoxel() const;
  Vec3 centre_mm() const;
  Vec3 toPatient_mm(const Vec3& voxel) const;
  // Distance between opposite corners.
  double diagonal_mm() const;

  friend bool operator==(const GridGeometry&, const GridGeometry&) = default;
};

// Voxels [low, high) on each axis.
struct VoxelBox {
  Index3 low{0, 0, 0};
  Index3 high{0, 0, 0};
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

struct Volume {
  GridGeometry geometry;
  Voxels hu;  // i fastest, then j, then k

  std::int16_t at(int i, int j, int k) const { return hu[geometry.indexOf(i, j, k)]; }
};

// The same voxels once more, on two threads: most of the time goes into fresh memory.
// std::bad_alloc where there is none.
Volume copyOf(const Volume& volume);

// SHA-256 over the voxels as int16 little-endian, i fastest. Geometry is not part of it.
std::string volumeSha256(const Volume& volume);

// Checks a size before anything is allocated: positive, and at most `max_voxels`.
Status checkSize(const Index3& size, const std::string& where,
                 std::uint64_t max_voxels = std::uint64_t(2048) * 2048 * 2048);

// Trilinear HU at a patient position; kAirHu outside.
double sampleHu(const Volume& volume, const Vec3& patient_mm);

}  // namespace trephine
