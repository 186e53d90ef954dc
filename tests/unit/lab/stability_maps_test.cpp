#include "lab/stability/stability_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

#include "render/display_probe.h"
#include "render/picture.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

MapCell damper(double period_s, double b, bool stable = true) {
  MapCell cell;
  cell.controller = "direct";
  cell.mass_kg = 0.045;
  cell.period_s = period_s;
  cell.tissue_b = b;
  cell.stable = stable;
  return cell;
}

MapCell wall(double period_s, double k, bool stable = true) {
  MapCell cell = damper(period_s, 0.0, stable);
  cell.tissue_k = k;
  return cell;
}

MapCell held(MapCell cell, double hand_k, double hand_b) {
  cell.hand_k = hand_k;
  cell.hand_b = hand_b;
  return cell;
}

// Three masses, delays, encoders and hands at each of 3 x 4 markers; some stable, some not.
std::vector<MapCell> grid(const std::string& controller) {
  std::vector<MapCell> cells;
  for (const double mass : {0.02, 0.045, 0.2}) {
    for (const int delay : {0, 1, 3}) {
      for (const double encoder : {0.0, 0.055e-3, 0.2e-3}) {
        for (const double hand : {0.0, 2.0, 10.0}) {
          for (const double period : {0.25e-3, 1e-3, 2e-3}) {
            for (const double value : {1.0, 50.0, 1e3, 1e6}) {
              MapCell cell = held(damper(period, value), 150.0 * hand, hand);
              cell.controller = controller;
              cell.mass_kg = mass;
              cell.delay_samples = delay;
              cell.encoder_m = encoder;
              cell.stable = value < (2.0 * mass / period + 3.0 * hand) / (1.0 + delay);
              cells.push_back(cell);
              std::swap(cell.tissue_b, cell.tissue_k);
              cells.push_back(cell);
            }
          }
        }
      }
    }
  }
  return cells;
}

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

std::size_t filesIn(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
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

TEST(LogCentres, AreTheValuesThemselvesWhereTheyAreFewAndApart) {
  EXPECT_EQ(logCentres({2, 0.25, 1, 2, 1}, 20), (std::vector<double>{0.25, 1, 2}));
  EXPECT_EQ(logCentres({7}, 20), std::vector<double>{7});
  EXPECT_TRUE(logCentres({}, 20).empty());
}

TEST(LogCentres, CountValuesThatDifferInTheLastDigitsAsOne) {
  EXPECT_EQ(logCentres({0.1 + 0.2, 0.3, 1.0}, 20).size(), 2u);
}

TEST(LogCentres, OfManyValuesAreEvenlySpacedAndKeepBothEnds) {
  std::vector<double> values;
  for (int i = 0; i <= 500; ++i) values.push_back(std::pow(10.0, i / 100.0));
  const std::vector<double> centres = logCentres(values, 20);
  ASSERT_EQ(centres.size(), 20u);
  EXPECT_EQ(centres.front(), values.front());
  EXPECT_EQ(centres.back(), values.back());
  for (std::size_t i = 1; i < centres.size(); ++i) {
    EXPECT_NEAR(std::log10(centres[i] / centres[i - 1]), 5.0 / 19.0, 1e-9);
  }
}

TEST(LogCentres, OfFewValuesThatLieTogetherAreEvenlySpacedToo) {
  EXPECT_EQ(logCentres({1.0, 1.01, 1000.0}, 20).size(), 20u);
}

TEST(LogCentres, GiveEachValueTheNearestCentreByItsLogarithm) {
  const std::vector<double> centres{1, 10, 100};
  EXPECT_EQ(nearestCentre(centres, 0.001), 0u);
  EXPECT_EQ(nearestCentre(centres, 3.0), 0u);
  EXPECT_EQ(nearestCentre(centres, 3.3), 1u);
  EXPECT_EQ(nearestCentre(centres, 10.0), 1u);
  EXPECT_EQ(nearestCentre(centres, 50.0), 2u);
  EXPECT_EQ(nearestCentre(centres, 1e9), 2u);
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
  EXPECT_EQ(none.error().code, "BAD_ARGUMENT");
  const auto zero = stabilityMaps({damper(1e-3, 0)});
  ASSERT_FALSE(zero.ok());
  EXPECT_EQ(zero.error().code, "BAD_ARGUMENT");
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
    EXPECT_EQ(maps.error().code, "BAD_ARGUMENT") << which;
    EXPECT_NE(maps.error().where.find("cell 2"), std::string::npos) << which;
  }
}

TEST(StabilityMapFiles, OfNothingAreRefusedBeforeAFolderIsMade) {
  const test::TemporaryFolder folder;
  const auto files = writeStabilityMaps({}, folder / "maps", Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, "BAD_ARGUMENT");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(StabilityMapFiles, WithoutADisplayAreAnErrorAndNoFolder) {
  const char* display = std::getenv("DISPLAY");
  const std::optional<std::string> before =
      display ? std::optional<std::string>(display) : std::nullopt;
  ::unsetenv("DISPLAY");
  const test::TemporaryFolder folder;
  const auto files = writeStabilityMaps({damper(1e-3, 5)}, folder / "maps", Progress());
  if (before) ::setenv("DISPLAY", before->c_str(), 1);
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, "NO_DISPLAY");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

#define DISPLAY_OR_SKIP()                                     \
  if (const Status display = probeDisplay(); !display.ok()) { \
    GTEST_SKIP() << display.error().sentence();               \
  }

// The maps of `cells` as pictures. Each has its size and ink, and keeps clear of its edges, or
// something was cut off.
std::vector<Picture> picturesOf(const std::vector<MapCell>& cells) {
  const test::TemporaryFolder folder;
  const auto files = writeStabilityMaps(cells, folder / "new" / "maps", Progress());
  EXPECT_TRUE(files.ok()) << (files.ok() ? "" : files.error().sentence());
  std::vector<Picture> pictures;
  if (!files.ok()) return pictures;
  EXPECT_EQ(filesIn(folder / "new" / "maps"), files->size());
  for (const fs::path& file : *files) {
    const auto read = readPng(file);
    EXPECT_TRUE(read.ok()) << file;
    if (!read.ok()) continue;
    const Picture& picture = *read;
    EXPECT_EQ(picture.width, 1200);
    EXPECT_EQ(picture.height, 900);
    bool clear = true, ink = false;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const std::size_t at = (std::size_t(y) * 1200 + std::size_t(x)) * 3;
        const bool white = picture.rgb[at] + picture.rgb[at + 1] + picture.rgb[at + 2] == 765;
        const bool edge = x < 8 || y < 8 || x >= 1192 || y >= 892;
        if (edge && !white) clear = false;
        if (!white) ink = true;
      }
    }
    EXPECT_TRUE(clear && ink) << file;
    pictures.push_back(picture);
  }
  return pictures;
}

// Pixels of the plot (not the legend) in a marker's colour.
int pixelsIn(const Picture& picture, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  int count = 0;
  for (std::size_t at = 0; at < std::size_t(1200) * 650 * 3; at += 3) {
    count += picture.rgb[at] == r && picture.rgb[at + 1] == g && picture.rgb[at + 2] == b;
  }
  return count;
}
int green(const Picture& picture) {
  return pixelsIn(picture, 46, 170, 125);
}
int amber(const Picture& picture) {
  return pixelsIn(picture, 255, 239, 170) + pixelsIn(picture, 252, 202, 70) +
         pixelsIn(picture, 240, 145, 25);
}
int red(const Picture& picture) {
  return pixelsIn(picture, 165, 15, 38);
}

TEST(StabilityMapFiles, ShowStableCellsGreenUnstableOnesRedAndOthersAmber) {
  DISPLAY_OR_SKIP();
  const auto stable = picturesOf({damper(1e-3, 5), damper(2e-3, 5)});
  const auto unstable = picturesOf({damper(1e-3, 5, false), damper(2e-3, 5, false)});
  const auto mixed = picturesOf({damper(1e-3, 5), damper(1e-3, 5, false)});
  ASSERT_EQ(stable.size(), 1u);
  ASSERT_EQ(unstable.size(), 1u);
  ASSERT_EQ(mixed.size(), 1u);
  EXPECT_GT(green(stable[0]), 1000);
  EXPECT_EQ(amber(stable[0]) + red(stable[0]), 0);
  EXPECT_GT(red(unstable[0]), 1000);
  EXPECT_EQ(amber(unstable[0]) + green(unstable[0]), 0);
  EXPECT_GT(amber(mixed[0]), 500);
  EXPECT_EQ(green(mixed[0]) + red(mixed[0]), 0);
}

TEST(StabilityMapFiles, OfAWholeGridAreTwoForEachController) {
  DISPLAY_OR_SKIP();
  std::vector<MapCell> cells = grid("direct");
  const std::vector<MapCell> more = grid("bounded");
  cells.insert(cells.end(), more.begin(), more.end());
  const auto pictures = picturesOf(cells);
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_FALSE(pictures[0] == pictures[1]);
  for (const Picture& picture : pictures) EXPECT_GT(amber(picture), 1000);
}

TEST(StabilityMapFiles, OfAnyValuesAreDrawnAndNotCutOff) {
  DISPLAY_OR_SKIP();
  std::vector<MapCell> cells;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      cells.push_back(wall(1e-4 * (1 + i), 10.0 + j * j, i > j));
      cells.back().controller = "a controller with a long name " + std::string(200, 'x');
      cells.back().mass_kg = 0.01 + 1e-5 * i * j;
      cells.back().encoder_m = 1.234567e-8 * i * j;
      cells.back().hand_b = 1.234567e-5 * (i + j);
      cells.back().hand_k = 12345.678 * i;
    }
  }
  EXPECT_EQ(picturesOf(cells).size(), 1u);
  EXPECT_EQ(picturesOf({damper(1e-3, 5)}).size(), 1u);
  EXPECT_EQ(picturesOf({damper(1e-3, 5), damper(1.000001e-3, 5.000001)}).size(), 1u);
  EXPECT_EQ(picturesOf({damper(1e-300, 1e-300), damper(1e300, 1e300)}).size(), 1u);
  EXPECT_EQ(picturesOf({wall(1e-300, 1e300), wall(1e-3, 1e-300)}).size(), 1u);
  MapCell odd = wall(1e-3, 300);
  odd.controller = "\xff\xfe\n\t<b>";
  odd.encoder_m = 5e-324;
  EXPECT_EQ(picturesOf({odd}).size(), 1u);
}

TEST(StabilityMapFiles, ShowACurveOverANarrowRangeOfPeriods) {
  DISPLAY_OR_SKIP();
  // 2 m / T lies between the two dampers.
  const auto pictures = picturesOf({damper(1e-3, 89.0), damper(1.001e-3, 91.0)});
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_GT(pixelsIn(pictures[0], 0, 92, 175), 300);
}

TEST(StabilityMapFiles, KeepNarrowMarkersReadableWhereALimitLiesFarAbove) {
  DISPLAY_OR_SKIP();
  const auto pictures = picturesOf({damper(1e-3, 5.0), damper(1e-3, 5.0001)});
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_GT(green(pictures[0]), 1000);
}

TEST(StabilityMapFiles, InAFolderThatCannotBeMadeAreAnError) {
  DISPLAY_OR_SKIP();
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const auto files = writeStabilityMaps({damper(1e-3, 5)}, folder / "file", Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, "CANNOT_WRITE");
}

TEST(StabilityMapFiles, ThatCannotBeWrittenLeaveNothingHalfWritten) {
  DISPLAY_OR_SKIP();
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "direct-dampers-no-hand.png" / "in the way");
  const auto files = writeStabilityMaps({damper(1e-3, 5)}, folder.path(), Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(StabilityMapFiles, StopWhenCancelledAndTellTheirProgress) {
  DISPLAY_OR_SKIP();
  const test::TemporaryFolder folder;
  Progress* running = nullptr;
  std::vector<double> fractions;
  Progress progress([&](double fraction, const std::string&) {
    fractions.push_back(fraction);
    running->cancel();
  });
  running = &progress;
  const auto files =
      writeStabilityMaps({damper(1e-3, 5), wall(1e-3, 300)}, folder.path(), progress);
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, "CANCELLED");
  EXPECT_EQ(fractions, std::vector<double>{0.0});
  EXPECT_TRUE(fs::exists(folder / "direct-dampers-no-hand.png"));
  EXPECT_FALSE(fs::exists(folder / "direct-walls-no-hand.png"));
}

}  // namespace
}  // namespace trephine
