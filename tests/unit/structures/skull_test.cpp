#include "structures/skull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "head_case.h"
#include "support.h"

namespace trephine {
namespace {

using test::HeadCase;

class SkullInHead : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { head_ = new HeadCase(test::builtInHead()); }
  static void TearDownTestSuite() { delete head_; }
  static const HeadCase& head() { return *head_; }
  // Prints what it finds, and checks that brain and scalp are left out.
  static double dice(const char* name, const HeadCase& of) {
    const auto skull = skullOf(of.volume);
    EXPECT_TRUE(skull) << skull.error().sentence();
    if (!skull) return 0.0;
    const std::size_t brain = of.count(skull->mask, HeadCase::isBrain);
    const std::size_t scalp =
        of.count(skull->mask, [](PhantomTissue t) { return t == PhantomTissue::scalp; });
    std::printf("[ figures  ] %s: Dice %.4f, %.0f mL, of it %.2f %% brain and %.2f %% scalp\n",
                name, of.dice(skull->mask), skull->ml,
                100.0 * double(brain) / double(skull->voxels),
                100.0 * double(scalp) / double(skull->voxels));
    EXPECT_LT(double(brain), 1e-3 * double(skull->voxels));
    EXPECT_LT(double(scalp), 0.02 * double(skull->voxels));
    return of.dice(skull->mask);
  }

 private:
  static inline HeadCase* head_ = nullptr;
};

TEST_F(SkullInHead, IsFoundWithoutScalpAndBrain) {
  const auto skull = skullOf(head().volume);
  ASSERT_TRUE(skull) << skull.error().sentence();
  EXPECT_GE(dice("built-in", head()), 0.97);
  EXPECT_EQ(skull->mask.geometry, head().volume.geometry);
  EXPECT_EQ(skull->hu, 226.0);
  EXPECT_EQ(skull->steps.size(), 3u);
  EXPECT_EQ(head().count(skull->mask, [](PhantomTissue) { return true; }), skull->voxels);
  EXPECT_NEAR(skull->ml, double(skull->voxels) * 0.8 * 0.8 * 1.0 / 1000.0, 1e-6);
  EXPECT_EQ(*std::max_element(skull->mask.labels.begin(), skull->mask.labels.end()), 1);
}

TEST_F(SkullInHead, IsFoundInNoiseAndInThickerSlices) {
  HeadCase noisy = head();
  noisy.addNoise(25.0);
  EXPECT_GE(dice("25 HU of noise", noisy), 0.95);
  EXPECT_GE(dice("1.5 mm", head().withSlices(1.5)), 0.95);
}

TEST_F(SkullInHead, OfFiveMillimetresIsCoarser) {
  const HeadCase coarse = head().withSlices(5.0);
  const auto skull = skullOf(coarse.volume);
  ASSERT_TRUE(skull);
  std::printf("[ figures  ] 5 mm: Dice %.4f, %.0f mL\n", coarse.dice(skull->mask), skull->ml);
  EXPECT_GE(coarse.dice(skull->mask), 0.90);
}

TEST_F(SkullInHead, HoldsItsMarrowButNoCavity) {
  // Diploe of fat, as light as it ever is. Where the tables end, at the base, it lies open.
  HeadCase old = head();
  const GridGeometry& g = old.volume.geometry;
  std::size_t diploe = 0;
  for (std::size_t n = 0; n < old.truth.size(); ++n) {
    if (old.at(n) != PhantomTissue::diploe) continue;
    old.volume.hu[n] = -40;
    ++diploe;
  }
  const auto skull = skullOf(old.volume);
  ASSERT_TRUE(skull);
  const std::size_t held =
      old.count(skull->mask, [](PhantomTissue t) { return t == PhantomTissue::diploe; });
  std::printf("[ figures  ] fat diploe: %.2f %% of it held; %s\n",
              100.0 * double(held) / double(diploe), skull->steps[1].c_str());
  EXPECT_GE(double(held), 0.90 * double(diploe));
  EXPECT_GE(old.dice(skull->mask), 0.95);
  const auto middle = [&](const Vec3& at_mm) {
    const Vec3 v = Vec3(g.patientToVoxel() * glm::dvec4(at_mm, 1.0)) + 0.5;
    return skull->mask.labels[g.indexOf(int(v.x), int(v.y), int(v.z))];
  };
  EXPECT_EQ(middle({20, 0, 30}), 0) << "brain";
  EXPECT_EQ(middle({31, -64.5, -28}), 0) << "eye";
  EXPECT_EQ(middle({25, -40, -28}), 0) << "behind the eye";
  EXPECT_EQ(middle({25, -53, -53}), 0) << "maxillary sinus";
  EXPECT_EQ(middle({8, -18, -36}), 0) << "sphenoid sinus, which is closed";
}

TEST_F(SkullInHead, CanBeCancelledAtAnyStep) {
  for (const std::string step : {"bone", "pockets", "border", "pieces"}) {
    Progress* told = nullptr;
    Progress progress([&](double, const std::string& now) {
      if (now == step) told->cancel();
    });
    told = &progress;
    const auto skull = skullOf(head().volume, progress);
    ASSERT_FALSE(skull) << step;
    EXPECT_EQ(skull.error().code.str(), "CANCELLED");
  }
}

TEST_F(SkullInHead, SaysWhereThereIsNoMemory) {
  const test::DataLimit limit(5.0);
  const auto skull = skullOf(head().volume);
  ASSERT_FALSE(skull);
  EXPECT_EQ(skull.error().code.str(), "OUT_OF_MEMORY");
}

TEST(Skull, OfNoBoneIsRefused) {
  Volume volume;
  volume.geometry.size = {40, 40, 40};
  volume.hu.assign(volume.geometry.voxelCount(), 40);
  const auto none = skullOf(volume);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code.str(), "NO_BONE");
  volume.geometry.size = {1, 1, 1};
  volume.hu.assign(1, 1000);
  EXPECT_EQ(skullOf(volume).error().code.str(), "NO_BONE");
}

// A block of bone with a canal right through it, and with a sheet of marrow that lies open on one
// side.
TEST(Skull, KeepsItsCanalsAndFillsMarrowThatHasALeak) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {90, 80, 70};
  g.spacing_mm = Vec3(0.7);
  volume.hu.resize(g.voxelCount());
  const auto inBlock = [&](const Index3& at) {
    return at[0] >= 10 && at[0] < 80 && at[1] >= 10 && at[1] < 70 && at[2] >= 10 && at[2] < 60;
  };
  const auto inCanal = [](const Index3& at) { return std::hypot(at[0] - 25, at[1] - 40) < 4.0; };
  const auto inMarrow = [](const Index3& at) {
    return at[0] >= 60 && at[0] < 64 && at[1] >= 15 && at[1] < 65 && at[2] >= 15 && at[2] < 55;
  };
  const auto inLeak = [](const Index3& at) {
    return at[0] >= 60 && at[1] >= 30 && at[1] < 36 && at[2] >= 30 && at[2] < 36;
  };
  std::size_t marrow = 0, filled = 0;
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    const bool soft = !inBlock(at) || inCanal(at) || inMarrow(at) || inLeak(at);
    volume.hu[n] = soft ? 40 : 1000;
  }
  const auto skull = skullOf(volume);
  ASSERT_TRUE(skull) << skull.error().sentence();
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    if (inCanal(at) || !inBlock(at)) {
      ASSERT_EQ(skull->mask.labels[n], 0);
    }
    if (!inMarrow(at)) continue;
    ++marrow;
    filled += skull->mask.labels[n];
  }
  // But for the slices that the leak opens.
  EXPECT_GT(double(filled), 0.7 * double(marrow));
}

// A ball of 1000 HU through a Gaussian is half as bright at its surface, whatever lies outside.
TEST(Skull, EndsHalfWayToWhatLiesAboutIt) {
  for (const double outside_HU : {-1000.0, 40.0}) {
    Volume volume;
    volume.geometry.size = {80, 80, 80};
    volume.geometry.spacing_mm = Vec3(0.6);
    volume.hu.resize(volume.geometry.voxelCount());
    constexpr double kRadius_mm = 18.0, kSpread_mm = 0.6;
    double expected = 0.0;
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      const Index3 at = volume.geometry.indicesOf(n);
      const double depth_mm =
          kRadius_mm - 0.6 * glm::length(Vec3(at[0], at[1], at[2]) - Vec3(39.5));
      const double part = 0.5 * std::erfc(-depth_mm / (kSpread_mm * std::sqrt(2.0)));
      const double hu = outside_HU + part * (1000.0 - outside_HU);
      volume.hu[n] = std::int16_t(std::lround(hu));
      // Never below the threshold: in air that is a little inside of half-way.
      expected += hu > std::max(226.0, 0.5 * (1000.0 + outside_HU));
    }
    const auto skull = skullOf(volume);
    ASSERT_TRUE(skull) << skull.error().sentence();
    EXPECT_NEAR(double(skull->voxels), expected, 0.02 * expected) << outside_HU;
  }
}

}  // namespace
}  // namespace trephine
