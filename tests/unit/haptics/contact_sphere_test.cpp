#include "haptics/contact_sphere.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trephine {
namespace {

// Layers below a plane through the origin: HU by depth [mm], with edges averaged over a voxel.
struct Layer {
  double from_mm;
  std::int16_t hu;
};
Volume layers(const Vec3& normal, double spacing_mm, const std::vector<Layer>& stack,
              const Mat3& direction = Mat3(1.0)) {
  Volume volume;
  const int n = int(16.0 / spacing_mm);
  volume.geometry.size = {n, n, n};
  volume.geometry.spacing_mm = Vec3(spacing_mm);
  volume.geometry.direction = direction;
  volume.geometry.origin_mm = direction * Vec3(-0.5 * (n - 1) * spacing_mm);
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    const Index3 at = volume.geometry.indicesOf(v);
    double hu = 0.0;
    constexpr int kParts = 4;
    for (int part = 0; part < kParts * kParts * kParts; ++part) {
      const Vec3 off(part % kParts, part / kParts % kParts, part / kParts / kParts);
      const Vec3 p = volume.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]) +
                                                  (off + 0.5) / double(kParts) - 0.5);
      const double depth = -glm::dot(p, normal);
      double here = kAirHu;
      for (const Layer& layer : stack) {
        if (depth >= layer.from_mm) here = layer.hu;
      }
      hu += here / (kParts * kParts * kParts);
    }
    volume.hu[v] = std::int16_t(std::lround(hu));
  }
  return volume;
}

// Air below 0 HU, so that an edge lies where half of a voxel is tissue.
TissueTable table(double soft = 200.0, double hard = 800.0) {
  TissueTable t;
  t.count = 2;
  t.classes[0] = {{0, soft, 0, 0, 0}, 0, 999, 1, 0};
  t.classes[1] = {{0, hard, 0, 0, 0}, 1500, 3000, 1, 0};
  return t;
}
constexpr std::int16_t kSoft = 1000 - 1, kHard = 2001;

ElasticPush pushOf(const Volume& volume, const Vec3& centre_mm, double radius_mm,
                   const TissueTable& tissues = table()) {
  Grid grid{Volume(volume)};
  StiffnessOfHu stiffness;
  stiffness.set(tissues);
  return ContactSphere(grid.geometry(), radius_mm, kBluntDirections)
      .push(TissueField(grid, tissues), stiffness, centre_mm);
}

const Vec3 kNormals[] = {{0, 0, 1},
                         {1, 0, 0},
                         glm::normalize(Vec3(1, 1, 0)),
                         glm::normalize(Vec3(0.3, -0.5, 0.8)),
                         glm::normalize(Vec3(-1, 1, 1))};

TEST(ContactSphere, PushesByStiffnessTimesDepthAlongTheNormal) {
  for (const Vec3& normal : kNormals) {
    for (double spacing : {0.25, 0.5}) {
      const Volume volume = layers(normal, spacing, {{0.0, kSoft}});
      for (double depth_mm : {0.5, 1.0, 1.5, 2.0}) {
        const ElasticPush push = pushOf(volume, normal * (2.0 - depth_mm), 2.0);
        EXPECT_NEAR(glm::length(push.force_N), 200.0 * depth_mm * 1e-3,
                    0.01 + 0.05 * 200.0 * depth_mm * 1e-3)
            << spacing << " " << depth_mm;
        EXPECT_GT(glm::dot(glm::normalize(push.force_N), normal), std::cos(glm::radians(9.0)));
        EXPECT_NEAR(push.stiffness, 200.0, 1e-6);
        // k d^2 / 2, up to 0.15 mm at the surface.
        EXPECT_NEAR(push.stored_J, 0.5 * 200.0 * std::pow(depth_mm * 1e-3, 2),
                    200.0 * depth_mm * 1e-3 * 1.5e-4);
      }
    }
  }
}

// A layer 1 mm thick, then another: k1 d1 + (k2 - k1) d2.
TEST(ContactSphere, PushesByTheSumOverLayers) {
  for (const Vec3& normal : kNormals) {
    const Volume volume = layers(normal, 0.25, {{0.0, kSoft}, {1.0, kHard}});
    const double depth_mm = 2.2;
    const ElasticPush push = pushOf(volume, normal * (2.5 - depth_mm), 2.5);
    EXPECT_NEAR(glm::length(push.force_N), 1e-3 * (200.0 * 2.2 + 600.0 * 1.2), 0.15);
    EXPECT_NEAR(push.stiffness, 800.0, 1e-6);
  }
}

TEST(ContactSphere, GivesNothingInAirAndNothingDeepInOneTissue) {
  const Volume volume = layers({0, 0, 1}, 0.5, {{0.0, kSoft}});
  EXPECT_EQ(pushOf(volume, {0, 0, 5}, 2.0).force_N, Vec3(0.0));
  const ElasticPush deep = pushOf(volume, {0, 0, -4}, 2.0);
  EXPECT_NEAR(glm::length(deep.force_N), 0.0, 1e-12);
  EXPECT_EQ(deep.at_centre, 200.0);
}

TEST(ContactSphere, AnswersOutsideTheGridAndWithWhatIsNoNumber) {
  const Volume volume = layers({0, 0, 1}, 0.5, {{0.0, kSoft}});
  EXPECT_EQ(pushOf(volume, {0, 0, 1e300}, 2.0).force_N, Vec3(0.0));
  EXPECT_EQ(pushOf(volume, Vec3(std::nan("")), 2.0).force_N, Vec3(0.0));
  // At the grid's bottom tissue ends: it pushes out of there as from a surface.
  EXPECT_LT(pushOf(volume, {0, 0, -9}, 2.0).force_N.z, -0.1);
}

TEST(ContactSphere, TurnsWithTheGrid) {
  const Vec3 normal = glm::normalize(Vec3(0.3, -0.5, 0.8));
  const Mat3 turned = glm::mat3_cast(glm::angleAxis(0.6, glm::normalize(Vec3(1, 2, -1))));
  const Vec3 straight = pushOf(layers(normal, 0.4, {{0.0, kSoft}}), normal * 1.1, 2.0).force_N;
  const Vec3 other = pushOf(layers(normal, 0.4, {{0.0, kSoft}}, turned), normal * 1.1, 2.0).force_N;
  EXPECT_LT(glm::length(straight - other), 0.06 * glm::length(straight));
}

TEST(StiffnessOfHu, IsTheMeanAlongAStraightRunOfHu) {
  StiffnessOfHu stiffness;
  stiffness.set(table());
  EXPECT_EQ(stiffness.at(500), 200.0);
  EXPECT_EQ(stiffness.at(-500), 0.0);
  EXPECT_EQ(stiffness.at(1200), 0.0);
  EXPECT_NEAR(stiffness.mean(-1000, 999.5), 100.0, 0.1);
  EXPECT_NEAR(stiffness.mean(999.5, -1000), 100.0, 0.1);
  EXPECT_NEAR(stiffness.mean(0, 3000), (1000 * 200.0 + 1500 * 800.0) / 3000, 1.0);
  EXPECT_EQ(stiffness.mean(-1000, -300), 0.0);
}

}  // namespace
}  // namespace trephine
