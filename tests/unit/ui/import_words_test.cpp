#include "ui/cases/import_words.h"

#include <gtest/gtest.h>

#include "imaging/codes.h"
#include "import_support.h"
#include "qt_support.h"
#include "ui/views/slice_image.h"

namespace trephine {
namespace {

using test::fakeSeries;

class ImportWordsTest : public ::testing::Test {
 protected:
  QApplication& application_ = test::application();
};

TEST_F(ImportWordsTest, NoTwoStatesShareAWord) {
  QStringList words;
  for (int i = 0; i <= int(SeriesState::refused); ++i) words << stateWord(SeriesState(i));
  EXPECT_EQ(words.removeDuplicates(), 0) << words.join(", ").toStdString();
}

TEST_F(ImportWordsTest, TheReportTellsEachFindingWithItsActionAndWhatItMeans) {
  SeriesReport series = fakeSeries("1", Verdict::repaired);
  series.findings = {
      {code::kPaddingToAir, Severity::notice, "12 voxels are padding", {}, "They became air"},
      {code::kUnevenSpacing, Severity::repair, "Slices are uneven", {"3.0"}, "They were evened"}};
  const QString html = reportHtml(series);
  for (const char* text : {"12 voxels are padding.", "They became air.", "Slices are uneven.",
                           "They were evened.", "Slices: 3.0.", "differs from the files"}) {
    EXPECT_TRUE(html.contains(text)) << text;
  }
  EXPECT_LT(html.indexOf("Slices are uneven"), html.indexOf("12 voxels"))
      << "what changed the volume comes before what did not";
  EXPECT_TRUE(verdictSentence(series, {}).contains("One thing is put right"));
}

TEST_F(ImportWordsTest, MarkUpInAFileStaysText) {
  SeriesReport series = fakeSeries("1", Verdict::refused);
  series.body_part = "<i>HEAD</i>";
  series.findings = {{Code("X"), Severity::refusal, "<img src=a>", {"<b>"}, "<a href=b>c</a>"}};
  const QString html = reportHtml(series);
  for (const char* tag : {"<i>", "<img", "<b>.", "<a "}) EXPECT_FALSE(html.contains(tag)) << tag;
  EXPECT_TRUE(html.contains("&lt;img src=a&gt;"));
}

TEST_F(ImportWordsTest, LongListsOfSlicesAreShortened) {
  EXPECT_EQ(slicesWords({}), "");
  EXPECT_EQ(slicesWords({"1", "2"}), "1, 2");
  EXPECT_EQ(slicesWords({"1", "2", "3", "4", "5", "6"}), "1, 2, 3, 4, 5, 6");
  EXPECT_EQ(slicesWords(std::vector<std::string>(27, "7")), "7, 7, 7, 7, 7, 7 and 21 more");
}

TEST_F(ImportWordsTest, TooLittleMemoryIsSaidWithWhatToDo) {
  EXPECT_FALSE(memoryWords(100.0, 2048.0).contains("Close other programs"));
  EXPECT_TRUE(memoryWords(100.0, 2048.0).contains("100 MB"));
  EXPECT_TRUE(memoryWords(100.0, 2048.0).contains("2.0 GB"));
  EXPECT_TRUE(memoryWords(3000.0, 2048.0).contains("Close other programs"));
  EXPECT_EQ(memoryWords(0.0, 2048.0), "");
}

TEST_F(ImportWordsTest, ALossIsToldInNumbersWithTheirSign) {
  const QString words = lossWords({12.34, 80.4, -0.26});
  EXPECT_TRUE(words.contains("12.3")) << words.toStdString();
  EXPECT_TRUE(words.contains("80"));
  EXPECT_TRUE(words.contains("-0.3 %"));
}

TEST_F(ImportWordsTest, WhatWasLeftOutOfTheFolderIsSaidWithItsReason) {
  ImportReport report;
  report.files_seen = 12;
  report.path = "/somewhere/Doe";
  report.series = {fakeSeries("1", Verdict::pass)};
  report.skipped = {{"the file is empty", 2}};
  const QString words = folderWords(report);
  EXPECT_TRUE(words.contains("12 files, 1 series")) << words.toStdString();
  EXPECT_TRUE(words.contains("2 left out: the file is empty"));
  EXPECT_FALSE(words.contains("Doe"));
}

TEST(HuWindow, GoesFromBlackToWhiteOverItsWidth) {
  const SlicePicture slice{5, 1, Vec3(1.0), {-2000, -500, 0, 500, 2000}};
  const QImage image = windowed(slice, {0.0, 1000.0});
  ASSERT_EQ(image.size(), QSize(5, 1));
  const uchar* grey = image.constScanLine(0);
  EXPECT_EQ(grey[0], 0);
  EXPECT_EQ(grey[1], 0);
  EXPECT_EQ(grey[2], 128);
  EXPECT_EQ(grey[3], 255);
  EXPECT_EQ(grey[4], 255);
}

TEST(HuWindow, OfWhatIsNoCtReachesFromItsLowestToItsHighestValue) {
  const SlicePicture slice{3, 1, Vec3(1.0), {100, 150, 300}};
  const QImage image = windowed(slice, wholeRange(slice));
  EXPECT_EQ(image.constScanLine(0)[0], 0);
  EXPECT_EQ(image.constScanLine(0)[1], 64);
  EXPECT_EQ(image.constScanLine(0)[2], 255);
}

TEST(HuWindow, MakesNoPictureOfASliceWithTooFewValues) {
  EXPECT_TRUE(windowed({2, 2, Vec3(1.0), {0, 0, 0}}, kWideWindow).isNull());
  EXPECT_TRUE(windowed({}, kWideWindow).isNull());
}

}  // namespace
}  // namespace trephine
