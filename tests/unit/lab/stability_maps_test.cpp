#include "lab/stability/stability_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "map_cells.h"

namespace trephine {
namespace {

using test::damper;
using test::held;
using test::wall;

std::vector<StabilityMap> mapsOf(const std::vector<MapCell>& cells) {
  auto maps = stabilityMaps(cells);
  EXPECT_TRUE(maps.ok()) << (maps.ok() ? "" : maps.error().sentence());
  return maps.ok() ? *maps : std::vector<StabilityMap>();
}

std::vector<std::string> namesOf(const std::vector<StabilityMap>& maps) {
  std::vector<std::string> names;
  for (const StabilityMap& map : maps) names.push_back(map.file_name);
  return names;
}

TEST(StabilityLimits, FollowTheirFormulas) {
  EXPECT_DOUBLE_EQ(damperLimit_Ns_per_m(0.045, 1e-3), 90.0);
  EXPECT_DOUBLE_EQ(wallLimit_N_per_m(2.05, 1e-3), 4100.0);
  EXPECT_DOUBLE_EQ(encoderLimit_N_per_m(2.05, 1e-3, 0.26, 0.2e-3), 2600.0);
  EXPECT_DOUBLE_EQ(encoderLimit_N_per_m(2.05, 2e-3, 0.26, 0.2e-3), 2050.0);
}

TEST(StabilityLimits, OfDampersAreOneForEachMass) {
  std::vector<MapCell> cells{damper(1e-3, 5), damper(1e-3, 5), damper(1e-3, 5)};
  cells[0].mass_kg = 0.2;
  const StabilityMap map = mapsOf(cells).at(0);
  ASSERT_EQ(map.limits.size(), 2u);
  EXPECT_EQ(map.limits[0].name, "m = 0.045 kg");
  EXPECT_DOUBLE_EQ(map.limits[0].at(1e-3), 90.0);
  EXPECT_DOUBLE_EQ(map.limits[1].at(1e-3), 400.0);
}

TEST(StabilityLimits, OfManyMassesAreAFewThatSaySo) {
  std::vector<MapCell> cells;
  for (int i = 1; i <= 37; ++i) {
    cells.push_back(damper(1e-3, 5));
    cells.back().mass_kg = 0.01 * i;
  }
  const StabilityMap map = mapsOf(cells).at(0);
  ASSERT_EQ(map.limits.size(), 4u);
  EXPECT_DOUBLE_EQ(map.limits.front().at(1e-3), 20.0);
  EXPECT_DOUBLE_EQ(map.limits.back().at(1e-3), 740.0);
  EXPECT_NE(map.limits.back().legend.find("4 of 37 masses"), std::string::npos);
}

TEST(StabilityLimits, OfWallsTakeTheArmAndTheHandThatDampsLeastAndNameThem) {
  const StabilityMap map =
      mapsOf({held(wall(1e-3, 300), 1000, 10), held(wall(1e-3, 300), 300, 2)}).at(0);
  ASSERT_EQ(map.limits.size(), 1u);
  EXPECT_DOUBLE_EQ(map.limits[0].at(1e-3), 4100.0);
  EXPECT_NE(map.limits[0].legend.find("lightest hand: 300 N/m + 2 N s/m"), std::string::npos);
}

TEST(StabilityLimits, OfWallsWithAndWithoutAHandAreDrawnForBoth) {
  const StabilityMap map = mapsOf({wall(1e-3, 300), held(wall(1e-3, 300), 300, 2)}).at(0);
  ASSERT_EQ(map.limits.size(), 2u);
  EXPECT_DOUBLE_EQ(map.limits[0].at(1e-3), 4100.0);
  EXPECT_DOUBLE_EQ(map.limits[1].at(1e-3), 100.0);
  EXPECT_NE(map.limits[1].legend.find("no hand"), std::string::npos);
}

TEST(StabilityLimits, OfEncodersAreOneForEachStepThatIsNotZero) {
  std::vector<MapCell> cells(4, held(wall(1e-3, 300), 300, 2));
  cells[1].encoder_m = 0.2e-3;
  cells[2].encoder_m = 0.055e-3;
  cells[3].encoder_m = 0.2e-3;
  const StabilityMap map = mapsOf(cells).at(0);
  ASSERT_EQ(map.limits.size(), 3u);
  EXPECT_EQ(map.limits[1].name, "A&O, 0.055 mm");
  EXPECT_EQ(map.limits[2].name, "A&O, 0.2 mm");
  EXPECT_DOUBLE_EQ(map.limits[2].at(1e-3), 2600.0);
  EXPECT_NE(map.limits[2].legend.find("f_c = 0.26 N"), std::string::npos);
}

TEST(StabilityMaps, CountTheCellsThatSharePeriodAndTissue) {
  std::vector<MapCell> cells{damper(1e-3, 5), damper(1e-3, 5, false), damper(1e-3, 5),
                             damper(1e-3, 50, false), damper(2e-3, 5)};
  cells[1].mass_kg = 0.2;
  cells[2].encoder_m = 0.2e-3;
  const StabilityMap map = mapsOf(cells).at(0);
  ASSERT_EQ(map.bins.size(), 3u);
  EXPECT_EQ(map.bins[0].period_s, 1e-3);
  EXPECT_EQ(map.bins[0].tissue, 5.0);
  EXPECT_EQ(map.bins[0].unstable, 1u);
  EXPECT_EQ(map.bins[0].total, 3u);
  EXPECT_EQ(map.bins[1].tissue, 50.0);
  EXPECT_EQ(map.bins[1].unstable, 1u);
  EXPECT_EQ(map.bins[1].total, 1u);
  EXPECT_EQ(map.bins[2].period_s, 2e-3);
  EXPECT_EQ(map.bins[2].unstable, 0u);
  EXPECT_TRUE(map.note.empty());
}

TEST(StabilityMaps, LoseNoCellOfAGridWithHundredsOfValues) {
  std::vector<MapCell> cells;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 200; ++j) cells.push_back(wall(1e-4 * (1 + i), 10.0 + j * j, i % 3 > 0));
  }
  const StabilityMap map = mapsOf(cells).at(0);
  EXPECT_LE(map.periods.size(), kMostCentres);
  EXPECT_LE(map.tissues.size(), kMostCentres);
  std::size_t total = 0, unstable = 0;
  for (const MapBin& bin : map.bins) total += bin.total, unstable += bin.unstable;
  EXPECT_EQ(total, 60000u);
  EXPECT_EQ(unstable, 20000u);
  EXPECT_NE(map.note.find("300 periods put together into 20"), std::string::npos) << map.note;
  EXPECT_NE(map.note.find("200 stiffnesses"), std::string::npos) << map.note;
}

TEST(StabilityMaps, AreOneForEachControllerAndKindInTheOrderOfTheCells) {
  std::vector<MapCell> cells{wall(1e-3, 300), damper(1e-3, 5), damper(1e-3, 5)};
  cells[0].controller = cells[1].controller = "z";
  cells[2].controller = "a";
  EXPECT_EQ(namesOf(mapsOf(cells)),
            (std::vector<std::string>{"z-dampers-no-hand.png", "z-walls-no-hand.png",
                                      "a-dampers-no-hand.png"}));
}

TEST(StabilityMaps, AreNamedAfterTheOneHandOrAllHands) {
  const MapCell one = held(damper(1e-3, 5), 300, 2), other = held(damper(1e-3, 5), 1e6, 10);
  EXPECT_EQ(namesOf(mapsOf({one})).at(0), "direct-dampers-hand-300-2.png");
  EXPECT_EQ(namesOf(mapsOf({other})).at(0), "direct-dampers-hand-1e6-10.png");
  EXPECT_EQ(namesOf(mapsOf({one, other})).at(0), "direct-dampers-all-hands.png");
}

TEST(StabilityMaps, OfControllersWithOddNamesStayInTheFolderAndApart) {
  std::vector<MapCell> cells(4, damper(1e-3, 5));
  cells[0].controller = "../a b";
  cells[1].controller = "../a/b";
  cells[2].controller = "";
  cells[3].controller = std::string(5000, '\xff');
  const std::vector<std::string> names = namesOf(mapsOf(cells));
  ASSERT_EQ(names.size(), 4u);
  EXPECT_EQ(names[0], "_._a_b-dampers-no-hand.png");
  EXPECT_EQ(names[1], "_._a_b-dampers-no-hand-2.png");
  EXPECT_EQ(names[2], "controller-dampers-no-hand.png");
  EXPECT_LT(names[3].size(), 120u);
}

TEST(StabilityMaps, LeaveOutDampersOfZeroAndSayHowMany) {
  const StabilityMap map = mapsOf({damper(1e-3, 5), damper(1e-3, 0), damper(2e-3, 0)}).at(0);
  EXPECT_EQ(map.bins.size(), 1u);
  EXPECT_EQ(map.periods, std::vector<double>{1e-3});
  EXPECT_NE(map.note.find("2 cells with b = 0 left out"), std::string::npos) << map.note;
}

TEST(StabilityMaps, OfWallsThatDampSaySo) {
  std::vector<MapCell> cells(2, wall(1e-3, 300));
  EXPECT_EQ(mapsOf(cells).at(0).conditions.find("damping of the wall"), std::string::npos);
  cells[1].tissue_b = 5.0;
  const StabilityMap map = mapsOf(cells).at(0);
  EXPECT_EQ(map.bins.size(), 1u);
  EXPECT_NE(map.conditions.find("damping of the wall 0, 5 N s/m"), std::string::npos);
}

TEST(StabilityMaps, OfNothingAreRefused) {
  const auto none = stabilityMaps({});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code.str(), "BAD_ARGUMENT");
  const auto zero = stabilityMaps({damper(1e-3, 0)});
  ASSERT_FALSE(zero.ok());
  EXPECT_EQ(zero.error().code.str(), "BAD_ARGUMENT");
}

TEST(StabilityMaps, OfValuesThatCannotBeAreRefusedWithTheCellsNumber) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (int which = 0; which < 10; ++which) {
    std::vector<MapCell> cells(3, damper(1e-3, 5));
    MapCell& cell = cells[1];
    if (which == 0) cell.period_s = 0.0;
    if (which == 1) cell.period_s = infinite;
    if (which == 2) cell.mass_kg = -0.1;
    if (which == 3) cell.delay_samples = -1;
    if (which == 4) cell.encoder_m = std::nan("");
    if (which == 5) cell.hand_k = -1.0;
    if (which == 6) cell.hand_b = infinite;
    if (which == 7) cell.tissue_b = -5.0;
    if (which == 8) cell.tissue_k = std::nan("");
    if (which == 9) cell.mass_kg = 0.0;
    const auto maps = stabilityMaps(cells);
    ASSERT_FALSE(maps.ok()) << which;
    EXPECT_EQ(maps.error().code.str(), "BAD_ARGUMENT") << which;
    EXPECT_NE(maps.error().where.find("cell 2"), std::string::npos) << which;
  }
}

}  // namespace
}  // namespace trephine
