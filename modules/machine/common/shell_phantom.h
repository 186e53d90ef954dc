// An ellipsoid shell of bone in air: tissue whose surface and normals are known exactly.
#pragma once

#include <cstdint>

#include "volume/volume.h"

namespace trephine {

// Bone between two ellipsoids around the patient's origin, the inner one with each half axis less
// the thickness; air inside and outside.
struct EllipsoidShell {
  Vec3 half_axes_mm{85.0, 70.0, 75.0};
  double thickness_mm = 7.0;
  std::int16_t bone_hu = 1000;
};

// The outer surface in a direction from the centre [mm], and its outward normal there.
Vec3 surfacePoint_mm(const EllipsoidShell& shell, const Vec3& direction);
Vec3 surfaceNormal(const EllipsoidShell& shell, const Vec3& surface_mm);
bool isBone(const EllipsoidShell& shell, const Vec3& at_mm);

// A cube of `size`^3 voxels with edges of `box_mm` around `centre_mm`.
GridGeometry cubeGeometry(int size, double box_mm, const Vec3& centre_mm);

// Every voxel as its centre is.
Volume sharpShell(const EllipsoidShell& shell, const GridGeometry& geometry);

// As a scanner sees it: a voxel at a surface is the mean of 4^3 samples, and all have Gaussian
// noise of `noise_hu` from a generator with this seed.
Volume scannedShell(const EllipsoidShell& shell, const GridGeometry& geometry, double noise_hu,
                    std::uint32_t seed);

// The top of an EllipsoidShell, sharp, in a cube of `grid`^3 voxels with edges of `box_mm` that
// holds every stroke and tool of the measurements of touch.
Volume shellTop(int grid, double box_mm);

}  // namespace trephine
