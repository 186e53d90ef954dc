#include "structures/grow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "liver_case.h"
#include "support.h"
#include "thorough.h"

namespace trephine {
namespace {

class GrowInAbdomen : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { of_ = new test::LiverCase(test::builtInLiver()); }
  static void TearDownTestSuite() { delete of_; }
  static const test::LiverCase& of() { return *of_; }
  static double diceOf(const Result<Growth>& growth) {
    EXPECT_TRUE(growth) << growth.error().sentence();
    return growth ? of().against(growth->mask).dice : 0.0;
  }

 private:
  static inline test::LiverCase* of_ = nullptr;
};

TEST_F(GrowInAbdomen, FindsTheLiverFromAnyClickInIt) {
  for (const Vec3& click : of().clicks(4)) {
    const auto growth = grow(of().volume, click);
    EXPECT_GE(diceOf(growth), 0.97);
    EXPECT_FALSE(growth->leaked);
    EXPECT_NEAR(growth->ml, double(growth->voxels) * 1.4 * 1.4 * 1.5 / 1000.0, 1e-6);
    EXPECT_EQ(std::size_t(std::count(growth->mask.labels.begin(), growth->mask.labels.end(), 1)),
              growth->voxels);
    EXPECT_EQ(growth->mask.geometry, of().volume.geometry);
  }
}

TEST_F(GrowInAbdomen, StillFindsLiverWhereTheClickMetAVessel) {
  // The built-in liver has no vessel so wide: one is put into it.
  const GridGeometry& g = of().volume.geometry;
  test::LiverCase with = of();
  const Vec3 click = of().clicks(1).front();
  for (std::size_t n = 0; n < with.volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    const Vec3 away = g.toPatient_mm(Vec3(at[0], at[1], at[2])) - click;
    if (std::hypot(away.x, away.y) < 4.0 && std::abs(away.z) < 15.0) with.volume.hu[n] = 146;
  }
  EXPECT_GE(diceOf(grow(with.volume, click)), 0.97);
}

// Half of what lies about such a click is fat, or two other organs.
TEST_F(GrowInAbdomen, FindsTheLiverOrNothingFromAClickInItsCapsule) {
  std::vector<Vec3> seeds = of().some(of().in_capsule_mm, test::thoroughly(12, 3), 1);
  seeds.push_back({-34.30, -52.50, -8.25});
  for (const Vec3& seed : seeds) {
    const auto growth = grow(of().volume, seed);
    if (growth) {
      EXPECT_GE(diceOf(growth), 0.97) << seed.x << "," << seed.y << "," << seed.z;
    } else {
      EXPECT_EQ(growth.error().code.str(), "NOTHING_GROWN");
    }
  }
}

TEST_F(GrowInAbdomen, FindsTheLiverFromAClickNearItsEdgeOrInItsVessels) {
  for (const Vec3& seed : of().clicks(test::thoroughly(4, 2), 5.0, 15.0)) {
    EXPECT_GE(diceOf(grow(of().volume, seed)), 0.97);
  }
  for (const Vec3& seed : of().vesselClicks(test::thoroughly(4, 2))) {
    EXPECT_GE(diceOf(grow(of().volume, seed)), 0.97);
  }
}

// Half of it an organ; 4 mm beside it a thin rod of another HU that has no room for the ball.
TEST(Grow, GivesNothingWhereOnlyAnotherThingBesideTheClickHasRoom) {
  Volume volume;
  volume.geometry.size = {90, 70, 70};
  volume.geometry.spacing_mm = Vec3(1.0);
  volume.hu.assign(volume.geometry.voxelCount(), -100);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = volume.geometry.indicesOf(n);
    if (at[0] < 47) volume.hu[n] = 50;
    if (std::hypot(at[0] - 54.0, at[1] - 35.0) < 3.0) volume.hu[n] = 600;
  }
  const auto growth = grow(volume, volume.geometry.toPatient_mm({54.0, 35.0, 35.0}));
  ASSERT_FALSE(growth);
  EXPECT_EQ(growth.error().code.str(), "NOTHING_GROWN");
  EXPECT_NE(growth.error().sentence().find("another thing"), std::string::npos);
}

TEST(Grow, SaysThatAClickIsInBoneThatHasNoRoomAndWhatFindsIt) {
  Volume volume;
  volume.geometry.size = {70, 70, 70};
  volume.hu.assign(volume.geometry.voxelCount(), -1000);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const int i = volume.geometry.indicesOf(n)[0];
    if (i > 32 && i < 38) volume.hu[n] = 800;
  }
  const auto growth = grow(volume, volume.geometry.toPatient_mm({35.0, 35.0, 35.0}));
  ASSERT_FALSE(growth);
  EXPECT_EQ(growth.error().code.str(), "NOTHING_GROWN");
  EXPECT_NE(growth.error().sentence().find("bone"), std::string::npos) << growth.error().sentence();
  EXPECT_NE(growth.error().sentence().find("Skull"), std::string::npos);
}

TEST_F(GrowInAbdomen, NoiseContrastAndSlicesDoNotLoseIt) {
  test::LiverCase other = of();
  other.addNoise(25.0);
  EXPECT_GE(other.against(grow(other.volume, of().clicks(1).front())->mask).dice, 0.95);
  other = of();
  other.addContrast(50.0);
  EXPECT_GE(other.against(grow(other.volume, of().clicks(1).front())->mask).dice, 0.95);
  other = of().withSlices(5.0);
  EXPECT_GE(other.against(grow(other.volume, of().clicks(1).front())->mask).dice, 0.95);
}

TEST_F(GrowInAbdomen, KeepsInsideABox) {
  const GridGeometry& g = of().volume.geometry;
  const Vec3 click = of().clicks(1).front();
  const Vec3 voxel = Vec3(g.patientToVoxel() * glm::dvec4(click, 1.0));
  GrowOptions options;
  options.box = VoxelBox{{0, 0, int(voxel.z) - 11}, {g.size[0], g.size[1], int(voxel.z) + 12}};
  const auto growth = grow(of().volume, click, options);
  ASSERT_TRUE(growth) << growth.error().sentence();
  EXPECT_GT(growth->voxels, 10000u);
  for (std::size_t n = 0; n < growth->mask.labels.size(); ++n) {
    const int k = g.indicesOf(n)[2];
    if (k < options.box->low[2] || k >= options.box->high[2]) {
      ASSERT_EQ(growth->mask.labels[n], 0) << "slice " << k;
    }
  }
  options.box->high[2] = int(voxel.z) - 3;
  EXPECT_EQ(grow(of().volume, click, options).error().code.str(), "BAD_SEED");
}

TEST_F(GrowInAbdomen, TakesTheRangeThatIsGiven) {
  GrowOptions options;
  options.hu = HuSpan{30.0, 70.0};
  const auto growth = grow(of().volume, of().clicks(1).front(), options);
  EXPECT_EQ(growth->hu, *options.hu);
  EXPECT_GE(diceOf(growth), 0.97);
  options.hu = HuSpan{300.0, 900.0};
  const auto none = grow(of().volume, of().clicks(1).front(), options);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code.str(), "NOTHING_GROWN");
  EXPECT_NE(none.error().sentence().find("300 to 900 HU"), std::string::npos);
}

TEST_F(GrowInAbdomen, SaysWhenItReachesTheScansBorder) {
  // The liver is cut by the border of this scan.
  const GridGeometry& g = of().volume.geometry;
  const Vec3 click = of().clicks(1).front();
  const int k = int(std::lround((g.patientToVoxel() * glm::dvec4(click, 1.0)).z));
  Volume part;
  part.geometry = g;
  part.geometry.size[2] = k + 12;
  part.hu.assign(of().volume.hu.begin(),
                 of().volume.hu.begin() + std::ptrdiff_t(part.geometry.voxelCount()));
  const auto growth = grow(part, click);
  ASSERT_TRUE(growth) << growth.error().sentence();
  EXPECT_TRUE(growth->leaked);
  // Soft tissue of any kind, with no room asked for: all that hangs together.
  GrowOptions all;
  all.hu = HuSpan{-150.0, 3000.0};
  all.open_mm = 0.0;
  const auto body = grow(of().volume, click, all);
  ASSERT_TRUE(body);
  EXPECT_TRUE(body->leaked);
}

TEST_F(GrowInAbdomen, RefusesWhatCannotBeMeant) {
  const Vec3 click = of().clicks(1).front();
  EXPECT_EQ(grow(of().volume, Vec3(1e4, 0, 0)).error().code.str(), "BAD_SEED");
  EXPECT_EQ(grow(of().volume, Vec3(std::nan(""), 0, 0)).error().code.str(), "BAD_SEED");
  GrowOptions options;
  options.open_mm = -1.0;
  EXPECT_EQ(grow(of().volume, click, options).error().code.str(), "BAD_ARGUMENT");
  options.open_mm = 7.0;
  options.hu = HuSpan{60.0, 40.0};
  EXPECT_EQ(grow(of().volume, click, options).error().code.str(), "BAD_ARGUMENT");
}

// Two balls of 20 mm of liver in fat, their middles 30 mm apart to both sides of the grid's, and a
// bar of 24 mm between them.
Volume twoBallsAndABar() {
  Volume volume;
  volume.geometry.size = {120, 70, 70};
  volume.geometry.spacing_mm = Vec3(1.0);
  volume.hu.assign(volume.geometry.voxelCount(), -100);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = volume.geometry.indicesOf(n);
    const Vec3 off = Vec3(at[0], at[1], at[2]) - Vec3(60.0, 35.0, 35.0);
    const bool ball = glm::length(Vec3(std::abs(off.x) - 30.0, off.y, off.z)) < 20.0;
    const bool bar = std::abs(off.x) < 30.0 && std::hypot(off.y, off.z) < 12.0;
    if (ball || bar) volume.hu[n] = 50;
  }
  return volume;
}

TEST(Grow, DoesNotPassAWallNorTakeWhatOthersHave) {
  const Volume volume = twoBallsAndABar();
  const GridGeometry& g = volume.geometry;
  const Vec3 left = g.toPatient_mm({30.0, 35.0, 35.0});
  // Voxels from there on to the right.
  const auto from = [&](const LabelMap& map, int i) {
    std::size_t voxels = 0;
    for (std::size_t n = 0; n < map.labels.size(); ++n) {
      voxels += map.labels[n] && g.indicesOf(n)[0] >= i;
    }
    return voxels;
  };
  GrowOptions options;
  options.open_mm = 5.0;
  const auto both = grow(volume, left, options);
  ASSERT_TRUE(both) << both.error().sentence();
  EXPECT_GT(from(both->mask, 61), 30000u);

  // A wall of one voxel in the bar's middle; then one that leaves a gap of two all around: what
  // reaches around it is less than a block.
  LabelMap others{g, std::vector<std::uint8_t>(g.voxelCount())};
  for (const auto& [half, reach] : {std::pair(14, 1), std::pair(10, 4)}) {
    std::fill(others.labels.begin(), others.labels.end(), std::uint8_t(0));
    for (int k = 35 - half; k <= 35 + half; ++k) {
      for (int j = 35 - half; j <= 35 + half; ++j) others.labels[g.indexOf(60, j, k)] = 7;
    }
    options.others = std::make_shared<const LabelMap>(others);
    const auto one = grow(volume, left, options);
    ASSERT_TRUE(one) << one.error().sentence();
    EXPECT_EQ(from(one->mask, 60 + reach), 0u) << half;
    const double left_half = double(both->voxels - from(both->mask, 60));
    EXPECT_NEAR(double(one->voxels - from(one->mask, 60)), left_half, 0.06 * left_half);
    for (std::size_t n = 0; n < others.labels.size(); ++n) {
      ASSERT_FALSE(others.labels[n] && one->mask.labels[n]);
    }
  }
  others.geometry.size = {60, 70, 140};
  options.others = std::make_shared<const LabelMap>(others);
  EXPECT_EQ(grow(volume, left, options).error().code.str(), "OTHER_GRID");
}

// A click in a vessel of the ball, then in fat that is as wide as a vessel but far from all that
// has room.
TEST(Grow, SaysHowFarThePlaceLiesBesideItAndGivesNothingThatIsFarOff) {
  Volume volume = twoBallsAndABar();
  const GridGeometry& g = volume.geometry;
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    if (std::hypot(at[0] - 30.0, at[1] - 35.0) < 6.0 && volume.hu[n] == 50) volume.hu[n] = 180;
  }
  GrowOptions options;
  options.hu = HuSpan{20.0, 80.0};
  options.open_mm = 5.0;
  const auto around = grow(volume, g.toPatient_mm({30.0, 35.0, 35.0}), options);
  ASSERT_TRUE(around) << around.error().sentence();
  EXPECT_NEAR(around->seed_off_mm, 6.0, 1.5);
  EXPECT_NE(around->steps.back().find("beside"), std::string::npos);
  const auto inside = grow(volume, g.toPatient_mm({40.0, 35.0, 35.0}), options);
  ASSERT_TRUE(inside) << inside.error().sentence();
  EXPECT_EQ(inside->seed_off_mm, 0.0);
  // 30 mm from the ball.
  const auto far_off = grow(volume, g.toPatient_mm({60.0, 62.0, 62.0}), options);
  ASSERT_FALSE(far_off);
  EXPECT_EQ(far_off.error().code.str(), "NOTHING_GROWN");
}

TEST_F(GrowInAbdomen, CanBeCancelledAtAnyStep) {
  for (const std::string step : {"blocks", "core", "border"}) {
    Progress* told = nullptr;
    Progress progress([&](double, const std::string& now) {
      if (now == step) told->cancel();
    });
    told = &progress;
    const auto growth = grow(of().volume, of().clicks(1).front(), {}, progress);
    ASSERT_FALSE(growth) << step;
    EXPECT_EQ(growth.error().code.str(), "CANCELLED");
  }
}

TEST(Grow, OfScansThatAreHardlyAnyNeverFails) {
  for (const Index3& size :
       {Index3{1, 1, 1}, Index3{2, 2, 2}, Index3{64, 64, 1}, Index3{1, 1, 300}}) {
    Volume volume;
    volume.geometry.size = size;
    volume.hu.resize(volume.geometry.voxelCount(), 50);
    const auto growth = grow(volume, Vec3(0.0));
    ASSERT_TRUE(growth) << growth.error().sentence();
    EXPECT_EQ(growth->voxels, volume.geometry.voxelCount());
    EXPECT_TRUE(growth->leaked);
  }
}

TEST(GrowInRealAbdomen, FindsTheLiverInTheSlicesInWhichItIsKnown) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const test::LiverCase of = test::realLiver(data);
  for (const Vec3& click : of.clicks(4)) {
    const auto growth = grow(of.volume, click);
    ASSERT_TRUE(growth) << growth.error().sentence();
    const Likeness like = of.against(growth->mask);
    EXPECT_GE(like.dice, 0.92);
    EXPECT_LE(like.hd95_mm, 9.5);
    EXPECT_TRUE(growth->leaked) << "the scan ends in the liver's dome";
  }
}

TEST(GrowInRealAbdomen, FindsTheLiverFromItsPortalVeinAndFromNearItsEdge) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const test::LiverCase of = test::realLiver(data);
  std::vector<Vec3> seeds = of.vesselClicks(test::thoroughly(6, 2));
  seeds.push_back({-47.04, -179.32, 397.30});
  for (const Vec3& seed : of.clicks(test::thoroughly(6, 2), 5.0, 15.0)) seeds.push_back(seed);
  seeds.push_back({-68.04, -185.32, 376.30});
  for (const Vec3& seed : seeds) {
    const auto growth = grow(of.volume, seed);
    ASSERT_TRUE(growth) << growth.error().sentence();
    EXPECT_GE(of.against(growth->mask).dice, 0.92) << seed.x << "," << seed.y << "," << seed.z;
  }
}

}  // namespace
}  // namespace trephine
