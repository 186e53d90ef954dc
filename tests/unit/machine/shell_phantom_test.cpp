#include "machine/common/shell_phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace trephine {
namespace {

double ellipsoid_mm3(const Vec3& half_axes_mm) {
  return 4.0 / 3.0 * std::numbers::pi * half_axes_mm.x * half_axes_mm.y * half_axes_mm.z;
}

// What the HU above air are worth, in bone.
double bone_mm3(const Volume& volume, const EllipsoidShell& shell) {
  double sum = 0.0;
  for (std::int16_t hu : volume.hu) sum += hu - kAirHu;
  return sum / (shell.bone_hu - kAirHu) * volume.geometry.voxelVolume_mm3();
}

TEST(ShellPhantom, HasItsSurfaceOnTheHalfAxesAndItsNormalsAcross) {
  const EllipsoidShell shell;
  EXPECT_NEAR(surfacePoint_mm(shell, {2.0, 0.0, 0.0}).x, 85.0, 1e-12);
  EXPECT_NEAR(surfacePoint_mm(shell, {0.0, 0.0, -1.0}).z, -75.0, 1e-12);
  const Vec3 p = surfacePoint_mm(shell, {1.0, 2.0, -0.5});
  const Vec3 normal = surfaceNormal(shell, p);
  EXPECT_NEAR(glm::length(normal), 1.0, 1e-12);
  EXPECT_GT(glm::dot(normal, p), 0.0);
  for (const Vec3& towards : {Vec3(1.0, 2.001, -0.5), Vec3(1.0, 2.0, -0.501)}) {
    const Vec3 along = glm::normalize(surfacePoint_mm(shell, towards) - p);
    EXPECT_NEAR(glm::dot(along, normal), 0.0, 1e-3);
  }
  EXPECT_TRUE(isBone(shell, p - 0.1 * normal));
  EXPECT_FALSE(isBone(shell, p + 0.1 * normal));
  EXPECT_FALSE(isBone(shell, {0.0, 0.0, 67.9}));
  EXPECT_TRUE(isBone(shell, {0.0, 0.0, 68.1}));
}

TEST(ShellPhantom, SharpIsEveryVoxelAsItsCentre) {
  const EllipsoidShell shell;
  const GridGeometry g = cubeGeometry(60, 60.0, {3.0, -2.0, 70.0});
  const Volume volume = sharpShell(shell, g);
  std::size_t bone = 0;
  for (std::size_t n = 0; n < g.voxelCount(); ++n) {
    const Index3 v = g.indicesOf(n);
    const bool is = isBone(shell, g.toPatient_mm({v[0], v[1], v[2]}));
    bone += is;
    ASSERT_EQ(volume.hu[n], is ? shell.bone_hu : kAirHu) << v[0] << ' ' << v[1] << ' ' << v[2];
  }
  EXPECT_GT(bone, 10000u);
}

TEST(ShellPhantom, ScannedHoldsTheVolumeOfTheShellBetterThanSharp) {
  const EllipsoidShell shell;
  const GridGeometry g = cubeGeometry(64, 200.0, Vec3(0.0));
  const double exact_mm3 =
      ellipsoid_mm3(shell.half_axes_mm) - ellipsoid_mm3(shell.half_axes_mm - Vec3(7.0));
  const Volume scanned = scannedShell(shell, g, 0.0, 1);
  const double off_mm3 = std::abs(bone_mm3(scanned, shell) - exact_mm3);
  const double sharp_off_mm3 = std::abs(bone_mm3(sharpShell(shell, g), shell) - exact_mm3);
  EXPECT_LT(off_mm3, 1e-3 * exact_mm3);
  EXPECT_LT(sharp_off_mm3, 2e-2 * exact_mm3);
  EXPECT_LT(off_mm3, 0.5 * sharp_off_mm3);
  const auto partial = std::count_if(scanned.hu.begin(), scanned.hu.end(), [&](std::int16_t hu) {
    return hu > kAirHu && hu < shell.bone_hu;
  });
  EXPECT_GT(partial, 1000);
}

TEST(ShellPhantom, NoiseIsOfItsSizeAndTheSameEveryTime) {
  const EllipsoidShell shell;
  const GridGeometry g = cubeGeometry(32, 20.0, {0.0, 0.0, 0.0});  // in the hollow: air
  const Volume one = scannedShell(shell, g, 10.0, 5), two = scannedShell(shell, g, 10.0, 5);
  EXPECT_EQ(one.hu, two.hu);
  EXPECT_NE(one.hu, scannedShell(shell, g, 10.0, 6).hu);
  double squares = 0.0;
  for (std::int16_t hu : one.hu) squares += double(hu - kAirHu) * (hu - kAirHu);
  EXPECT_NEAR(std::sqrt(squares / double(one.hu.size())), 10.0, 0.3);
}

}  // namespace
}  // namespace trephine
