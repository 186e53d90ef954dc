#include <random>

#include "base/system.h"
#include "series_fixture.h"

namespace trephine::test {

using BadFiles = SeriesFixture;
namespace fs = std::filesystem;

namespace {

int skippedFor(const ImportReport& report, const std::string& words) {
  int count = 0;
  for (const SkippedFiles& files : report.skipped) {
    if (files.reason.find(words) != std::string::npos) count += files.count;
  }
  return count;
}

std::string randomBytes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = char(random() & 0xFF);
  return bytes;
}

}  // namespace

TEST_F(BadFiles, AMissingFolderIsAnError) {
  const auto result = CtFolder::scan(folder() / "nowhere", Progress());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, "MISSING_FOLDER");
}

TEST_F(BadFiles, AnEmptyFolderIsAnAnswerWithAnError) {
  fs::create_directories(folder());
  CtFolder ct = scan();
  EXPECT_EQ(ct.report().error->code, "EMPTY_FOLDER");
  EXPECT_FALSE(ct.bestSeries().has_value());
}

TEST_F(BadFiles, FilesThatAreNoDicomAreCountedEachWithItsReason) {
  const Volume volume = rampVolume();
  write(volume);
  writeBytes(folder() / "empty", "");
  writeBytes(folder() / "readme.txt", std::string(5000, 'x'));
  writeBytes(folder() / "short", "DICM");
  writeBytes(folder() / "random.dcm", randomBytes(4096, 1));
  writeBytes(folder() / "cut header", readBytes(slice(1)).substr(0, 200));
  writeBytes(folder() / "marked random", std::string(128, '\0') + "DICM" + randomBytes(4096, 2));
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(report_.files_seen, 12);
  EXPECT_EQ(report_.files_read, 6);
  EXPECT_EQ(skippedFor(report_, "empty"), 1);
  EXPECT_EQ(skippedFor(report_, "not a DICOM file"), 3);
  EXPECT_EQ(skippedFor(report_, ""), 6);
}

TEST_F(BadFiles, AFolderWithoutCtSaysWhatWasSkipped) {
  writeBytes(folder() / "notes.txt", std::string(1000, 'x'));
  CtFolder ct = scan();
  EXPECT_EQ(ct.report().error->code, "NO_CT");
  EXPECT_NE(ct.report().error->what.find("not a DICOM file"), std::string::npos);
}

TEST_F(BadFiles, AFileWithoutItsUidsIsSkippedByName) {
  write(rampVolume());
  edit(slice(1), [](DcmDataset& data) { data.findAndDeleteElement(DCM_SeriesInstanceUID); });
  EXPECT_EQ(skippedFor(scan().report(), "without a Series Instance UID"), 1);
}

TEST_F(BadFiles, OneFileIsAnAnswerToo) {
  write(rampVolume());
  CtFolder ct = scan(slice(1));
  ASSERT_EQ(ct.report().series.size(), 1u);
  EXPECT_NE(find(ct.report().series.front(), "ONE_LOCATION"), nullptr);
}

TEST_F(BadFiles, SequencesNestedAHundredThousandDeepDoNotExhaustTheStack) {
  std::string bytes = std::string(128, '\0') + "DICM";
  bytes += std::string(
      "\x02\x00\x10\x00UI\x12\x00"
      "1.2.840.10008.1.2\0",
      26);
  const std::string level("\x08\x00\x40\x11\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF", 16);
  std::string nested;
  for (int n = 0; n < 100000; ++n) nested += level;
  writeBytes(folder() / "deep", bytes + nested);
  writeBytes(folder() / "deeper", bytes + nested + nested);
  const ImportReport report = scan().report();
  EXPECT_EQ(report.files_read, 0);
  EXPECT_EQ(skippedFor(report, "cut short or damaged"), 1);
  EXPECT_EQ(skippedFor(report, "nested too deeply"), 1);
}

TEST_F(BadFiles, AValueThatClaimsFourGigabytesIsNotAllocated) {
  write(rampVolume());
  std::string bytes = readBytes(slice(1));
  const std::size_t at = bytes.find("Test series");
  ASSERT_NE(at, std::string::npos);
  bytes[at - 4] = 'U';  // LO with a length of two bytes becomes UT with four
  bytes[at - 3] = 'T';
  bytes.replace(at - 2, 6, std::string("\0\0\xF0\xFF\xFF\xFF", 6));
  writeBytes(slice(1), bytes);
  const double before_mb = peakResidentMb();
  EXPECT_LT(scan().report().peak_rss_mb, before_mb + 200.0);
}

TEST_F(BadFiles, NoSpoiltByteCrashesTheImport) {
  const Volume volume = rampVolume({4, 4, 2});
  write(volume);
  const std::string whole = readBytes(slice(2));
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = whole;
    for (int n = 0; n < 1 + round % 4; ++n) bytes[random() % bytes.size()] = char(random());
    if (round % 3 == 0) bytes.resize(random() % bytes.size());
    writeBytes(slice(2), bytes);
    CtFolder ct = scan();
    for (const SeriesReport& series : ImportReport(ct.report()).series) {
      const auto result = ct.read(series.uid, {}, Progress());
      EXPECT_TRUE(result.ok() || !result.error().code.empty());
    }
    EXPECT_NO_THROW(toJson(ct.report()).dump());
  }
}

}  // namespace trephine::test
