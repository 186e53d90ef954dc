#include "structures/skin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "head_case.h"

namespace trephine {
namespace {

// A head of 40 mm in radius with a cavity of 10 mm that a canal of 2.5 mm leads into, the lower end
// of the scan through it, a table beneath and a blanket above, both with air between.
Volume smallHead() {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {110, 130, 70};
  g.spacing_mm = {1.0, 0.9, 1.3};
  g.origin_mm = {-54.5, -58.0, -30.0};
  volume.hu.resize(g.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    const Vec3 p = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
    bool tissue = glm::length(p) < 40.0;
    if (glm::length(p) < 10.0 || (p.y < 0.0 && std::hypot(p.x, p.z) < 2.5)) tissue = false;
    if (p.y > 46.0 && p.y < 52.0) tissue = true;    // the table
    if (p.y < -48.0 && p.y > -52.0) tissue = true;  // the blanket
    volume.hu[n] = tissue ? 30 : -1000;
  }
  return volume;
}

TEST(Skin, IsTheLayerThatFacesTheAirOutside) {
  const Volume volume = smallHead();
  const GridGeometry& g = volume.geometry;
  const auto skin = skinOf(volume, 3.0);
  ASSERT_TRUE(skin) << skin.error().sentence();
  EXPECT_EQ(skin->steps.size(), 3u);
  std::size_t voxels = 0;
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    const Vec3 p = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
    const double r = glm::length(p);
    const bool in = skin->mask.labels[n] != 0;
    voxels += in;
    if (in) {
      ASSERT_LT(r, 40.0) << "nothing of table and blanket";
    }
    const bool by_canal = p.y < 0.0 && std::hypot(p.x, p.z) < 8.0;
    if (in && !by_canal) {
      ASSERT_GT(r, 35.0);
    }
    if (in && by_canal) {
      ASSERT_GT(r, 28.0) << "the canal is entered by a little";
    }
    // Near the scan's end the nearest air may lie beyond it.
    if (!in && volume.hu[n] > -300 && !by_canal && p.z > -25.0) {
      ASSERT_FALSE(r > 37.5 && r < 40.0) << "a hole at " << p.x << " " << p.y << " " << p.z;
    }
  }
  EXPECT_EQ(skin->voxels, voxels);
  EXPECT_NEAR(skin->ml, double(voxels) * 1.0 * 0.9 * 1.3 / 1000.0, 1e-6);
}

TEST(Skin, IsAtLeastWhatTouchesTheAirSoThatNoRayPasses) {
  const Volume volume = smallHead();
  const GridGeometry& g = volume.geometry;
  const auto skin = skinOf(volume, 0.1);
  ASSERT_TRUE(skin);
  for (int k = 0; k < g.size[2]; ++k) {
    // Along each row that meets neither table nor blanket, what is first met.
    for (int j = 30; j < 100; ++j) {
      int i = 0;
      while (i < g.size[0] && volume.at(i, j, k) < -300) ++i;
      if (i < g.size[0]) {
        ASSERT_EQ(skin->mask.labels[g.indexOf(i, j, k)], 1) << i << " " << j << " " << k;
      }
    }
  }
}

TEST(Skin, OfScansWithoutBodyOrAirIsRefused) {
  Volume volume = smallHead();
  EXPECT_EQ(skinOf(volume, 0.0).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(skinOf(volume, std::nan("")).error().code.str(), "BAD_ARGUMENT");
  for (const std::string step : {"body", "air", "layer"}) {
    Progress* told = nullptr;
    Progress progress([&](double, const std::string& now) {
      if (now == step) told->cancel();
    });
    told = &progress;
    const auto skin = skinOf(volume, 2.0, progress);
    ASSERT_FALSE(skin) << step;
    EXPECT_EQ(skin.error().code.str(), "CANCELLED");
  }
  std::fill(volume.hu.begin(), volume.hu.end(), std::int16_t(40));
  EXPECT_EQ(skinOf(volume).error().code.str(), "NO_BODY");
  std::fill(volume.hu.begin(), volume.hu.end(), std::int16_t(-1000));
  EXPECT_EQ(skinOf(volume).error().code.str(), "NO_BODY");
}

TEST(SkinInHead, CoversItAndStaysOutsideOfNoseAndSinuses) {
  const test::HeadCase head = test::builtInHead();
  const GridGeometry& g = head.volume.geometry;
  const auto skin = skinOf(head.volume, 2.0);
  ASSERT_TRUE(skin) << skin.error().sentence();
  // From either side, from before and behind: what is first met is skin.
  std::size_t rays = 0, met = 0;
  const auto ray = [&](Index3 at, const Index3& step) {
    while (g.contains(at[0], at[1], at[2]) && head.volume.at(at[0], at[1], at[2]) <= kBody_HU) {
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += step[axis];
    }
    if (!g.contains(at[0], at[1], at[2])) return;
    ++rays;
    met += skin->mask.labels[g.indexOf(at[0], at[1], at[2])];
  };
  for (int k = 0; k < g.size[2]; ++k) {
    for (int n = 0; n < g.size[0]; ++n) {
      ray({0, n, k}, {1, 0, 0});
      ray({g.size[0] - 1, n, k}, {-1, 0, 0});
      ray({n, 0, k}, {0, 1, 0});
      ray({n, g.size[1] - 1, k}, {0, -1, 0});
    }
  }
  const std::size_t bone = head.count(skin->mask, test::HeadCase::isSkull);
  std::printf("[ figures  ] %.0f mL; %zu of %zu rays meet it first; %zu voxels of bone\n", skin->ml,
              met, rays, bone);
  // The others look into an ear, into the crease behind it or under the jaw.
  EXPECT_GT(double(met), 0.998 * double(rays));
  EXPECT_LT(double(bone), 0.01 * double(skin->voxels));
  // The walls of the pharynx, which is open to below, are no skin.
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const Vec3 p = g.toPatient_mm(Vec3(i, j, k));
        if (std::abs(p.x) > 15.0 || p.y < -35.0 || p.y > 10.0 || p.z > -50.0) continue;
        ASSERT_EQ(skin->mask.labels[g.indexOf(i, j, k)], 0) << p.x << " " << p.y << " " << p.z;
      }
    }
  }
}

}  // namespace
}  // namespace trephine
