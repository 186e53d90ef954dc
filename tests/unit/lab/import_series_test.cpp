#include "lab/import/import_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "imaging/importer.h"
#include "support.h"

namespace trephine {
namespace {

ImportSeries tiny() {
  ImportSeries series;
  series.names = {"u12", "int16"};
  series.size = {41, 32, 10};
  series.scan_series = 3;
  series.scan_slices = 10;
  return series;
}

TEST(OwnSeries, AreReadByTheImporterAsTheyAreKnown) {
  const test::TemporaryFolder folder;
  const ImportSeries series = tiny();
  const auto known = writeOwnSeries(series, folder.path(), Progress());
  ASSERT_TRUE(known) << known.error().sentence();
  ASSERT_EQ(known->size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    SCOPED_TRACE(series.names[n]);
    Result<CtFolder> read = CtFolder::scan(folder / series.names[n], Progress());
    ASSERT_TRUE(read);
    ASSERT_TRUE(read->bestSeries());
    const Result<Volume> volume = read->read(*read->bestSeries(), {}, Progress());
    ASSERT_TRUE(volume) << volume.error().sentence();
    EXPECT_EQ(read->report().series.front().verdict, Verdict::pass);
    EXPECT_EQ(volume->geometry.size, series.size);
    EXPECT_EQ(volumeSha256(*volume), (*known)[n].sha256);
    EXPECT_EQ((*known)[n].geometry.size, series.size);
    const int lowest = *std::min_element(volume->hu.begin(), volume->hu.end());
    EXPECT_EQ(lowest, series.names[n] == "u12" ? -1024 : -1025) << "below -1024 words are signed";
  }
  EXPECT_NE((*known)[0].sha256, (*known)[1].sha256);
}

TEST(OwnSeries, HaveNoRowAndNoSliceThatIsLikeItsNeighbour) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeOwnSeries(tiny(), folder.path(), Progress()));
  Result<CtFolder> read = CtFolder::scan(folder / "u12", Progress());
  ASSERT_TRUE(read);
  const Result<Volume> volume = read->read(*read->bestSeries(), {}, Progress());
  ASSERT_TRUE(volume);
  const Index3 size = volume->geometry.size;
  const auto row = [&](int j, int k) { return &volume->hu[volume->geometry.indexOf(0, j, k)]; };
  for (int k = 0; k + 1 < size[2]; ++k) {
    EXPECT_FALSE(std::equal(row(0, k), row(0, k) + size[0] * size[1], row(0, k + 1))) << k;
    for (int j = 0; j + 1 < size[1]; ++j) {
      EXPECT_FALSE(std::equal(row(j, k), row(j, k) + size[0], row(j + 1, k))) << j << " of " << k;
    }
  }
}

TEST(OwnSeries, OfTheScanAreAsManyAsAsked) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeOwnSeries(tiny(), folder.path(), Progress()));
  const Result<CtFolder> read = CtFolder::scan(folder / "scan", Progress());
  ASSERT_TRUE(read);
  ASSERT_EQ(read->report().series.size(), 3u);
  for (const SeriesReport& series : read->report().series) {
    EXPECT_EQ(series.verdict, Verdict::pass);
    EXPECT_EQ(series.geometry.size, (Index3{64, 64, 10}));
  }
}

TEST(OwnSeries, SayThatTheyCannotBeWrittenAndStopWhenCancelled) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  EXPECT_EQ(writeOwnSeries(tiny(), folder / "file", Progress()).error().code.str(), "CANNOT_WRITE");
  Progress cancelled;
  cancelled.cancel();
  EXPECT_EQ(writeOwnSeries(tiny(), folder.path(), cancelled).error().code.str(), "CANCELLED");
}

TEST(SeriesSize, IsRefusedWhereNoSeriesCanHaveIt) {
  for (const Index3 size :
       {Index3{1, 8, 8}, Index3{8, 2049, 8}, Index3{8, 8, 0}, Index3{1024, 1024, 257}}) {
    EXPECT_EQ(checkSeriesSize(size).error().code.str(), "BAD_ARGUMENT");
  }
  EXPECT_TRUE(checkSeriesSize({1024, 1024, 256}));
}

}  // namespace
}  // namespace trephine
