#include <grp.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <chrono>
#include <fstream>
#include <random>

#include "base/memory.h"
#include "imaging/codes.h"
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

// The resident memory that `work` adds at its peak. Linux can reset what it remembers as the peak.
double peakDuring_mb(const std::function<void()>& work) {
  const auto value_mb = [](const std::string& name) {
    std::ifstream in("/proc/self/status");
    for (std::string word; in >> word;) {
      double kilobytes = 0.0;
      if (word == name && in >> kilobytes) return kilobytes / 1024.0;
    }
    ADD_FAILURE() << "no " << name;
    return 0.0;
  };
  std::ofstream("/proc/self/clear_refs") << 5;
  const double before = value_mb("VmRSS:");
  work();
  return value_mb("VmHWM:") - before;
}

// The file meta header of a data set in this transfer syntax.
std::string metaHeader(std::string syntax, std::string sop_class = "") {
  const auto element = [](const char* tag, std::string uid) {
    if (uid.size() % 2) uid += '\0';
    return std::string(tag, 4) + "UI" + char(uid.size()) + '\0' + uid;
  };
  std::string meta = std::string(128, '\0') + "DICM";
  if (!sop_class.empty()) meta += element("\x02\x00\x02\x00", std::move(sop_class));
  return meta + element("\x02\x00\x10\x00", std::move(syntax));
}

constexpr const char* kDeflated = "1.2.840.10008.1.2.1.99";

// A deflated data set: `start`, then `times` times `block`, then `end`.
std::string deflated(const std::string& start, const std::string& block, int times,
                     const std::string& end) {
  z_stream zlib{};
  EXPECT_EQ(deflateInit2(&zlib, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed;
  const auto put = [&](const std::string& bytes, int flush) {
    std::string out(bytes.size() + 4096, '\0');
    zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    zlib.avail_in = uInt(bytes.size());
    zlib.next_out = reinterpret_cast<Bytef*>(out.data());
    zlib.avail_out = uInt(out.size());
    deflate(&zlib, flush);
    EXPECT_EQ(zlib.avail_in, 0U);
    packed.append(out, 0, out.size() - zlib.avail_out);
  };
  put(start, Z_NO_FLUSH);
  for (int n = 0; n < times; ++n) put(block, Z_NO_FLUSH);
  put(end, Z_FINISH);
  deflateEnd(&zlib);
  return packed;
}

// One more level of sequence and item; it never ends. Explicit and implicit VR, little endian.
const std::string kExplicitLevel(
    "\x08\x00\x40\x11SQ\0\0\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF", 20);
const std::string kImplicitLevel("\x08\x00\x40\x11\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF",
                                 16);

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int n = 0; n < times; ++n) all += text;
  return all;
}

}  // namespace

// Root may open any folder: somebody else looks.
TEST_F(BadFiles, AFolderThatMayNotBeOpenedIsNotSaidToBeEmpty) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can be other accounts";
  constexpr uid_t kStranger = 23004;
  write(rampVolume({4, 4, 4}));
  fs::create_directories(folder() / "open" / "closed");
  for (const fs::path& way : {folder().parent_path(), folder(), folder() / "open"}) {
    fs::permissions(way, fs::perms(0755));
  }
  fs::permissions(folder() / "open" / "closed", fs::perms(0700));
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setgroups(0, nullptr) != 0 || ::setgid(kStranger) != 0 || ::setuid(kStranger) != 0)
      ::_exit(2);
    const auto says = [](const fs::path& path) {
      const auto ct = CtFolder::scan(path, Progress());
      if (!ct || !ct->report().error) return false;
      const Error& error = *ct->report().error;
      return error.what.find("no right to open") != std::string::npos &&
             error.what.find("no files") == std::string::npos &&
             error.next.find("right to read") != std::string::npos;
    };
    ::_exit(says(folder() / "open" / "closed") && says(folder() / "open") ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(BadFiles, AMissingFolderIsAnError) {
  const auto result = CtFolder::scan(folder() / "nowhere", Progress());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "MISSING_FOLDER");
}

TEST_F(BadFiles, AnEmptyFolderIsAnAnswerWithAnError) {
  fs::create_directories(folder());
  CtFolder ct = scan();
  EXPECT_EQ(ct.report().error->code.str(), "EMPTY_FOLDER");
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
  EXPECT_EQ(ct.report().error->code.str(), "NO_CT");
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
  const std::string meta = metaHeader("1.2.840.10008.1.2");
  writeBytes(folder() / "deep", meta + repeated(kImplicitLevel, 100000));
  writeBytes(folder() / "deeper", meta + repeated(kImplicitLevel, 200000));
  const ImportReport report = scan().report();
  EXPECT_EQ(report.files_read, 0);
  EXPECT_EQ(skippedFor(report, "cut short or damaged"), 1);
  EXPECT_EQ(skippedFor(report, "nested too deeply"), 1);
}

TEST_F(BadFiles, NorDoThoseThatAreHiddenByDeflation) {
  writeBytes(folder() / "deep",
             metaHeader(kDeflated) + deflated("", repeated(kExplicitLevel, 10000), 100, ""));
  EXPECT_EQ(skippedFor(scan().report(), "longer than any real one"), 1);
}

TEST_F(BadFiles, NorDoThoseOfADicomDir) {
  const fs::path file = folder() / "DICOMDIR";
  writeBytes(file, metaHeader("1.2.840.10008.1.2", "1.2.840.10008.1.3.10") +
                       repeated(kImplicitLevel, 1000000));
  EXPECT_EQ(scan(file).report().files_read, 0);
}

TEST_F(BadFiles, AValueThatUnpacksToHalfAGigabyteIsNotKept) {
  const std::string head("\x09\x00\x10\x10OB\0\0\x00\x00\x00\x20", 12);  // 512 MB, private
  const std::string file =
      metaHeader(kDeflated) + deflated(head, std::string(std::size_t(1) << 20, '\0'), 512, "");
  ASSERT_LT(file.size(), 1000000U);
  writeBytes(folder() / "bomb", file);
  EXPECT_LT(peakDuring_mb([&] { EXPECT_EQ(scan().report().files_read, 0); }), 100.0);
}

TEST_F(BadFiles, DeflatedPixelsThatAreCutShortAreAMissingSlice) {
  write(rampVolume());
  editAll([](DcmDataset&) {}, EXS_DeflatedLittleEndianExplicit);
  const std::string whole = readBytes(slice(3));
  writeBytes(slice(3), whole.substr(0, whole.size() - 20));
  CtFolder ct = scan();
  const auto best = ct.bestSeries();
  ASSERT_TRUE(best.has_value());
  const auto result = ct.read(*best, {}, Progress());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "MISSING_SLICES");
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

TEST_F(BadFiles, ALongValueStaysInItsFile) {
  write(rampVolume());
  const std::string bytes = readBytes(slice(1));
  const std::size_t at = bytes.find("MONOCHROME2");
  ASSERT_NE(at, std::string::npos);
  // CS with a length of two bytes becomes UT with four: half a gigabyte, which the file holds.
  writeBytes(slice(1), bytes.substr(0, at - 4) + std::string("UT\0\0\0\0\0\x20", 8));
  fs::resize_file(slice(1), at + 4 + (std::uintmax_t(512) << 20));
  EXPECT_LT(peakDuring_mb([&] { scan(); }), 100.0);
}

TEST_F(BadFiles, NoAnswerMakesAVolumeOfSlicesThatAllLostTheirPlace) {
  write(rampVolume());
  const std::string position("\x20\x00\x32\x00", 4);
  for (int n = 1; n <= 6; ++n) {
    const std::string bytes = readBytes(slice(n));
    writeBytes(slice(n), bytes.substr(0, bytes.find(position) + 10));
  }
  const Finding refusal = expectRefused("MISSING_SLICES");
  EXPECT_EQ(refusal.slices.size(), 6u);
  EXPECT_TRUE(report_.series.front().choices.empty());
  CtFolder ct = scan();
  ImportRequest request;
  request.answers[code::kMissingSlices] = "part";
  const auto result = ct.read(report_.series.front().uid, request, Progress());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "MISSING_SLICES");
}

TEST_F(BadFiles, WhatIsLeftOfACutValueIsNotTakenForTheValue) {
  write(rampVolume());
  edit(slice(3), [](DcmDataset& data) { put(data, DCM_InstanceNumber, "12345678"); });
  const std::string bytes = readBytes(slice(3));
  writeBytes(slice(3), bytes.substr(0, bytes.find("12345678") + 4));
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(report_.series.front().findings.back().slices,
            std::vector<std::string>{"a slice without number"});
}

TEST_F(BadFiles, ValuesThatAreWholeAreKeptOfACutFileWhateverTheirLength) {
  write(rampVolume());
  // A writer that does not pad: three bytes where an even number is due.
  edit(slice(1), [](DcmDataset& data) { put(data, DCM_InstanceNumber, "1234"); });
  std::string bytes = readBytes(slice(1));
  const std::size_t at = bytes.find("1234");
  bytes[at - 2] = 3;
  bytes.erase(at + 3, 1);
  writeBytes(slice(1), bytes.substr(0, bytes.find("MONOCHROME2")));
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(report_.series.front().findings.back().slices, std::vector<std::string>{"slice 123"});
}

TEST_F(BadFiles, ACutHeaderOfManyShortElementsTakesNoTime) {
  write(rampVolume());
  std::string elements;
  for (int n = 0; n < 200000; ++n) {  // group 0x2011 on, implicit, empty
    const int group = 0x2011 + 2 * (n / 32768), element = n % 32768 + 0x1000;
    for (const int byte : {group & 255, group >> 8, element & 255, element >> 8, 0, 0, 0, 0}) {
      elements.push_back(char(byte));
    }
  }
  edit(slice(1), [](DcmDataset&) {}, EXS_LittleEndianImplicit);
  const std::string bytes = readBytes(slice(1));
  const std::string pixels("\xE0\x7F\x10\x00", 4);
  writeBytes(slice(1), bytes.substr(0, bytes.rfind(pixels)) + elements + "\x21\x20\x10");
  const auto start = std::chrono::steady_clock::now();
  expectRefused("MISSING_SLICES");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(BadFiles, AClaimOfManyFramesWithoutPixelsIsOneHeader) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_NumberOfFrames, "100000");
    delete data.remove(DCM_PixelData);
  });
  EXPECT_LT(peakDuring_mb([&] { expectRefused("NOT_AN_IMAGE_SERIES"); }), 50.0);
}

TEST_F(BadFiles, AnIconsPixelsThatWereSkippedAreNotTheImages) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    delete data.remove(DCM_PixelData);
    DcmItem* icon = nullptr;
    data.findOrCreateSequenceItem(DCM_IconImageSequence, icon);
    const std::vector<Uint8> pixels(20000);
    icon->putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size());
  });
  for (int n = 1; n <= 6; ++n) {  // lengths instead of end marks, so that the file ends there
    DcmFileFormat file;
    ASSERT_TRUE(file.loadFile(slice(n).c_str()).good());
    ASSERT_TRUE(file.loadAllDataIntoMemory().good());
    ASSERT_TRUE(file.saveFile(slice(n).c_str(), EXS_LittleEndianExplicit, EET_ExplicitLength).good());
  }
  expectRefused("NOT_AN_IMAGE_SERIES");
}

TEST_F(BadFiles, SlicesOf32BitsAtOnePlaceAreRefusedAndNotCompared) {
  write(rampVolume({64, 64, 6}));
  editAll([](DcmDataset& data) {
    put(data, DCM_ImagePositionPatient, "0\\0\\0");
    data.putAndInsertUint16(DCM_BitsAllocated, 32);
    const std::vector<Uint16> words(64 * 64 * 2, 7);
    data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
  });
  expectRefused("PIXEL_FORMAT");
}

TEST_F(BadFiles, ThousandsOfFramesAtOnePlaceAreComparedInSeconds) {
  constexpr int kFrames = 20000;
  write(rampVolume({1, 1, 1}));
  edit(slice(1), [](DcmDataset& data) {
    put(data, DCM_SOPClassUID, UID_EnhancedCTImageStorage);
    put(data, DCM_NumberOfFrames, std::to_string(kFrames));
    DcmItem *groups = nullptr, *place = nullptr;
    ASSERT_TRUE(data.findOrCreateSequenceItem(DCM_SharedFunctionalGroupsSequence, groups).good());
    ASSERT_TRUE(groups->findOrCreateSequenceItem(DCM_PlanePositionSequence, place).good());
    ASSERT_TRUE(place->putAndInsertString(DCM_ImagePositionPatient, "0\\0\\0").good());
    std::vector<Uint16> words(kFrames);
    for (int n = 0; n < kFrames; ++n) words[std::size_t(n)] = Uint16(n);
    data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(expectRefused("ONE_LOCATION").severity, Severity::refusal);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(BadFiles, DeepSequencesOfDeflatedSlicesAtOnePlaceDoNotExhaustTheStack) {
  constexpr int kLevels = 40000;
  write(rampVolume({4, 4, 2}));
  // The slices as they are, at one place, in a data set that nests.
  editAll([](DcmDataset& data) { put(data, DCM_ImagePositionPatient, "0\\0\\0"); });
  const std::string ends("\xFE\xFF\x0D\xE0\0\0\0\0\xFE\xFF\xDD\xE0\0\0\0\0", 16);
  for (const int n : {1, 2}) {
    const std::string whole = readBytes(slice(n));
    const std::string tag("\x08\x00\x05\x00", 4);  // the data set's first
    const std::string data = whole.substr(whole.find(tag));
    const std::size_t behind = data.find(std::string("\x10\x00\x10\x00", 4));
    ASSERT_NE(behind, data.npos);
    writeBytes(slice(n), metaHeader(kDeflated) +
                             deflated(data.substr(0, behind), repeated(kExplicitLevel, kLevels), 1,
                                      repeated(ends, kLevels) + data.substr(behind)));
  }
  const ImportReport report = scan().report();
  EXPECT_EQ(report.files_read, 2);
}

TEST_F(BadFiles, NoSpoiltByteCrashesTheImport) {
  const Volume volume = rampVolume({4, 4, 4});
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
