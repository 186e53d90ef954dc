#include "lab/touch/extremes_touch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "volume/phantom_file.h"

namespace trephine {
namespace {

// 20 mm of bone below the plane z = 0 (between two voxels), air above it.
Volume bone() {
  Volume volume;
  volume.geometry.size = {40, 40, 40};
  volume.geometry.origin_mm = Vec3(-19.5);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), 40 * 40 * 20, std::int16_t(1000));
  return volume;
}

const Tool& burr() {
  static const Tool tool = makeBurr(0.003, 32, 8, 0.03);
  return tool;
}

// Where HU crosses 226: 1000 half a millimetre below z = 0, -1000 half a millimetre above.
constexpr double kSurface_mm = -0.113;

TEST(InsideSolid, IsHowFarTheBodyReachesBeyondTheSurface) {
  const Grid grid(bone());
  const auto inside = [&](double tip_mm) {
    return insideSolid_mm(burr(), {Vec3(-0.5, -0.5, tip_mm), Quat(1, 0, 0, 0)}, grid, 226);
  };
  EXPECT_EQ(inside(0.5), 0.0);
  EXPECT_NEAR(inside(-1.5), 1.5 + kSurface_mm, 0.15);
  EXPECT_NEAR(inside(-0.75), 0.75 + kSurface_mm, 0.15);
}

TEST(APress, IsHeldByBoneThatItCannotCut) {
  const PressResult held =
      pressInto(burr(), boneOnly(true), bone(), {Vec3(0.0), Vec3(0, 0, -1), 2.0, 300.0}, 4.0);
  EXPECT_TRUE(held.held);
  EXPECT_LE(held.inside_mm, 0.5);
  EXPECT_GT(held.beyond_mm, 0.5);
  EXPECT_LT(held.beyond_share, 1.5);
}

// What turning stretches is put in by the hand, though no arm feels it: or the force went, and the
// arm sank to three times its depth.
TEST(APress, IsHeldAsFirmlyWhileTheToolIsTurnedAndDragged) {
  Press press{Vec3(0.0, 0.0, -89.9), Vec3(0, 0, 1), 2.0, 50.0};
  press.moves = true;
  const PressResult held = pressInto(burr(), boneOnly(true), openPhantom("cranium")->volume, press);
  EXPECT_TRUE(held.held);
  EXPECT_LT(held.beyond_share, 1.5);
}

TEST(APress, IsSeenInsideWhatDoesNotStopIt) {
  TissueTable soft = boneOnly(true);
  soft.classes[0].solid = 0;
  soft.classes[0].stiffness_N_per_m = 20.0;
  soft.classes[0].friction_N = 0.1;
  const PressResult sunk =
      pressInto(burr(), soft, bone(), {Vec3(0.0), Vec3(0, 0, -1), 2.0, 300.0}, 4.0);
  EXPECT_FALSE(sunk.held);
  EXPECT_GT(sunk.inside_mm, 2.0);
}

}  // namespace
}  // namespace trephine
