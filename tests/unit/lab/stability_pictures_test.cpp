#include "lab/stability/stability_pictures.h"

#include <gtest/gtest.h>

#include <QImage>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "map_cells.h"
#include "plot/drawing.h"
#include "support.h"
#include "unit/plot/plots.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using plot::Tone;
using test::damper;
using test::held;
using test::wall;

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

std::size_t filesIn(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// The maps of `cells` as pictures, whose texts lie apart and within.
std::vector<plot::Drawing> picturesOf(const std::vector<MapCell>& cells) {
  const Result<std::vector<StabilityMap>> maps = stabilityMaps(cells);
  EXPECT_TRUE(maps);
  std::vector<plot::Drawing> pictures;
  for (const StabilityMap& map : *maps) {
    const Result<plot::Drawing> drawing = plot::draw(plotOf(map));
    EXPECT_TRUE(drawing) << (drawing ? "" : drawing.error().sentence());
    if (!drawing) continue;
    EXPECT_EQ(drawing->image.size(), QSize(1200, 900));
    plot::test::expectTextsApart(*drawing);
    pictures.push_back(*drawing);
  }
  return pictures;
}

// Pixels within the axes in this colour.
int pixelsIn(const plot::Drawing& picture, Tone tone) {
  const QRgb wanted = plot::colourOf(tone, plot::Theme::light).rgb();
  const QRect area = picture.area.toRect();
  int count = 0;
  for (int y = area.top(); y <= area.bottom(); ++y) {
    for (int x = area.left(); x <= area.right(); ++x) count += picture.image.pixel(x, y) == wanted;
  }
  return count;
}
int green(const plot::Drawing& picture) {
  return pixelsIn(picture, Tone::heat_1);
}
int amber(const plot::Drawing& picture) {
  return pixelsIn(picture, Tone::heat_2) + pixelsIn(picture, Tone::heat_3) +
         pixelsIn(picture, Tone::heat_4);
}
int red(const plot::Drawing& picture) {
  return pixelsIn(picture, Tone::heat_5);
}

bool says(const plot::Drawing& picture, const std::string& words) {
  return std::any_of(picture.texts.begin(), picture.texts.end(), [&](const plot::PlacedText& t) {
    return t.text.find(words) != std::string::npos;
  });
}

TEST(StabilityPictures, ShowStableCellsGreenUnstableOnesRedAndOthersAmber) {
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

TEST(StabilityPictures, SayWhatIsDrawnOverWhatAndAgainstWhichLimits) {
  const auto pictures = picturesOf(grid("direct"));
  ASSERT_EQ(pictures.size(), 2u);
  for (const char* words : {"Stability of 'direct' against dampers", "Mass 0.02, 0.045, 0.2 kg",
                            "Hand: ", "Sampling period T [ms]", "Damping of the tissue b [N s/m]",
                            "Markers: unstable / total", "every cell stable", "every cell unstable",
                            "Published limits: stable below", "b = 2 m/T, no hand, m = 0.045 kg",
                            "m = 0.2 kg", "0.25", "1e6"}) {
    EXPECT_TRUE(says(pictures[0], words)) << words;
  }
  for (const char* words : {"Stability of 'direct' against walls", "Stiffness of the wall k [N/m]",
                            "Colgate & Schenkel", "Abbott & Okamura 2005", "A&O, 0.2 mm"}) {
    EXPECT_TRUE(says(pictures[1], words)) << words;
  }
  for (const plot::Drawing& picture : pictures) EXPECT_GT(amber(picture), 1000);
}

TEST(StabilityPictures, OfAnyValuesAreDrawnAndNotCutOff) {
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

TEST(StabilityPictures, ShowACurveOverANarrowRangeOfPeriods) {
  // 2 m / T lies between the two dampers.
  const auto pictures = picturesOf({damper(1e-3, 89.0), damper(1.001e-3, 91.0)});
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_GT(pixelsIn(pictures[0], Tone::series_1), 300);
}

TEST(StabilityPictures, KeepNarrowMarkersReadableWhereALimitLiesFarAbove) {
  const auto pictures = picturesOf({damper(1e-3, 5.0), damper(1e-3, 5.0001)});
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_GT(green(pictures[0]), 1000);
}

TEST(StabilityPictures, AreWrittenWithoutADisplay) {
  const test::Environment none("DISPLAY", "");
  const test::TemporaryFolder folder;
  const auto files =
      writeStabilityMaps({damper(1e-3, 5), wall(1e-3, 300)}, folder / "new" / "maps", Progress());
  ASSERT_TRUE(files) << files.error().sentence();
  ASSERT_EQ(files->size(), 2u);
  EXPECT_EQ(filesIn(folder / "new" / "maps"), 2u);
  for (const fs::path& file : *files) {
    EXPECT_EQ(QImage(file.c_str()).size(), QSize(1200, 900)) << file;
  }
}

TEST(StabilityPictures, OfNothingAreRefusedBeforeAFolderIsMade) {
  const test::TemporaryFolder folder;
  const auto files = writeStabilityMaps({}, folder / "maps", Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code.str(), "BAD_ARGUMENT");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(StabilityPictures, InAFolderThatCannotBeMadeAreAnError) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const auto files = writeStabilityMaps({damper(1e-3, 5)}, folder / "file", Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code.str(), "CANNOT_WRITE");
}

TEST(StabilityPictures, ThatCannotBeWrittenLeaveNothingHalfWritten) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "direct-dampers-no-hand.png" / "in the way");
  const auto files = writeStabilityMaps({damper(1e-3, 5)}, folder.path(), Progress());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(StabilityPictures, StopWhenCancelledAndTellTheirProgress) {
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
  EXPECT_EQ(files.error().code.str(), "CANCELLED");
  EXPECT_EQ(fractions, std::vector<double>{0.0});
  EXPECT_TRUE(fs::exists(folder / "direct-dampers-no-hand.png"));
  EXPECT_FALSE(fs::exists(folder / "direct-walls-no-hand.png"));
}

}  // namespace
}  // namespace trephine
