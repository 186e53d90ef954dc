#include "lab/import/import_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "base/file.h"
#include "support.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

ImportRow row(const std::string& series, const std::string& loader, std::optional<double> seconds,
              std::optional<bool> correct) {
  ImportRow r;
  r.series = series;
  r.loader = loader;
  r.seconds_median = seconds;
  r.correct = correct;
  return r;
}

TEST(ImportSummary, IsTheMedianTimeAndTheLargestMemory) {
  const ImportRow r =
      summarizeImport({}, {{0.5, 100.0, 7.0}, {0.1, 300.0, 9.0}, {0.2, 200.0, 8.0}});
  EXPECT_EQ(r.seconds_median, 0.2);
  EXPECT_EQ(r.peak_rss_mb, 300.0);
  EXPECT_EQ(r.above_start_mb, 9.0);
  EXPECT_FALSE(summarizeImport({}, {{0.5, 100.0, {}}}).above_start_mb);
}

TEST(ImportSummary, OfALoaderThatFailedOnceHasNoFigures) {
  ImportRow failed;
  failed.skipped_reason = "took over 120 s";
  const ImportRow r = summarizeImport(failed, {{0.5, 100.0, {}}});
  EXPECT_FALSE(r.seconds_median);
  EXPECT_FALSE(r.peak_rss_mb);
  EXPECT_FALSE(summarizeImport({}, {}).seconds_median);
}

ImportMeasurement madeUp() {
  ImportMeasurement m;
  m.volume_mb = 150.0;
  m.rows = {row("int16", "trephine", 0.12, true),
            row("int16", "trephine command", 0.2, true),
            row("int16", "floor", 0.1, {}),
            row("int16", "floor kept", 0.16, {}),
            row("int16", "dcm2niix", 0.4, true),
            row("u12", "trephine", 0.15, true),
            row("u12", "floor", 0.12, {}),
            row("rle", "trephine command", 0.3, true),
            row("rle", "dcm2niix", 0.5, true),
            row("rle", "dicomtonifti", 0.1, false),
            row("jpegls", "trephine command", {}, false),
            row("jpegls", "dcm2niix", 2.0, true),
            row("jpegll", "trephine command", 1.0, true),
            row("jpegll", "dcm2niix", 4.0, true),
            row("jpegll", "dicomtonifti", 2.0, true),
            row("j2k", "trephine command", 1.0, true),
            row("j2k", "floor", 0.1, {})};
  m.scan = {{3000, "trephine", 0.3, 50.0, ""}, {3000, "gdcmscanner", 0.25, 20.0, ""}};
  return m;
}

TEST(ImportRatios, AreOfMediansOfTheSameRun) {
  const ImportRatios ratios = ratiosOf(madeUp());
  EXPECT_NEAR(ratios.int16_to_floor.value(), 1.2, 1e-12);
  EXPECT_NEAR(ratios.int16_to_floor_kept.value(), 0.75, 1e-12);
  EXPECT_NEAR(ratios.u12_to_floor.value(), 1.25, 1e-12);
  EXPECT_FALSE(ratios.u12_to_floor_kept) << "that row is missing";
  EXPECT_NEAR(ratios.command_to_dcm2niix.value(), 0.5, 1e-12);
  EXPECT_NEAR(ratios.scan_to_gdcmscanner.value(), 1.2, 1e-12);
}

TEST(ImportRatios, CompareCompressedSeriesWithTheFastestPeerThatIsRight) {
  const auto compressed = ratiosOf(madeUp()).compressed;
  ASSERT_EQ(compressed.size(), 5u);
  const auto of = [&](const std::string& series) {
    return std::find_if(compressed.begin(), compressed.end(),
                        [&](const auto& one) { return one.first == series; })
        ->second;
  };
  EXPECT_NEAR(of("rle").value(), 0.6, 1e-12) << "the faster peer is wrong";
  EXPECT_NEAR(of("jpegll").value(), 0.5, 1e-12) << "the faster of two that are right";
  EXPECT_FALSE(of("jpegls")) << "ours read nothing";
  EXPECT_FALSE(of("j2k")) << "a plain read is no peer";
  EXPECT_FALSE(of("deflated"));
}

TEST(ImportRatios, DoNotCountAWrongVolumeAsRead) {
  ImportMeasurement m = madeUp();
  for (ImportRow& r : m.rows) r.correct = false;
  const ImportRatios ratios = ratiosOf(m);
  EXPECT_FALSE(ratios.int16_to_floor);
  EXPECT_FALSE(ratios.command_to_dcm2niix);
  for (const auto& [series, value] : ratios.compressed) EXPECT_FALSE(value) << series;
}

TEST(ImportMeasurement, IsAnsweredWithExactlyItsKeys) {
  ImportMeasurement m;
  m.volume_mb = 150.0;
  m.rows.push_back({"int16", "trephine", 2, 0.12, 200.0, 160.0, true, ""});
  m.rows.push_back({"int16", "dcm2niix", 1, {}, {}, {}, {}, "not installed"});
  m.scan.push_back({3000, "trephine", 0.25, 50.0, ""});
  EXPECT_EQ(toJson(m), Json::parse(R"({
    "volume_mb": 150.0,
    "rows": [
      {"series": "int16", "loader": "trephine", "threads": 2, "seconds_median": 0.12,
       "peak_rss_mb": 200.0, "above_start_mb": 160.0, "correct": true, "skipped_reason": null},
      {"series": "int16", "loader": "dcm2niix", "threads": 1, "seconds_median": null,
       "peak_rss_mb": null, "above_start_mb": null, "correct": null,
       "skipped_reason": "not installed"}],
    "scan": [{"files": 3000, "loader": "trephine", "seconds_median": 0.25, "peak_rss_mb": 50.0,
              "skipped_reason": null}],
    "ratios": {"int16_to_floor": null, "int16_to_floor_kept": null, "u12_to_floor": null,
               "u12_to_floor_kept": null, "command_to_dcm2niix": null, "scan_to_gdcmscanner": null,
               "compressed": {"deflated": null, "rle": null, "jpegls": null, "jpegll": null,
                              "j2k": null}}})"));
}

TEST(ImportMeasurement, ReadsAsATableWithItsRatiosBelow) {
  ImportMeasurement m = madeUp();
  m.rows[4].skipped_reason = "not installed";
  const std::string text = toText(m);
  EXPECT_NE(text.find("not installed"), std::string::npos);
  EXPECT_NE(text.find("scan / gdcmscanner                                         1.20"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("dicomtonifti            1      0.1000          -                 -  NO"),
            std::string::npos)
      << text;
}

// A volume file that another program might write of the known volume.
class KnownVoxels : public ::testing::Test {
 protected:
  KnownVoxels() {
    volume_.geometry.size = {4, 3, 2};
    for (int n = 0; n < 24; ++n) volume_.hu.push_back(std::int16_t(n * n - 100));
    known_ = {volume_.geometry, volumeSha256(volume_)};
  }
  // The same voxels in the same places, rows and slices the other way round.
  Volume turned() const {
    Volume out = volume_;
    GridGeometry& g = out.geometry;
    g.origin_mm = volume_.geometry.toPatient_mm(Vec3(0, 2, 1));
    g.direction[1] = -g.direction[1];
    g.direction[2] = -g.direction[2];
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) out.hu[g.indexOf(i, j, k)] = volume_.at(i, 2 - j, 1 - k);
      }
    }
    return out;
  }
  bool holds(const Volume& volume) const {
    const Status written = writeVolume(volume, folder_ / "x.nii");
    EXPECT_TRUE(written);
    return holdsKnownVoxels(folder_ / "x.nii", known_);
  }

  TemporaryFolder folder_;
  Volume volume_;
  KnownVolume known_;
};

TEST_F(KnownVoxels, AreFoundWhicheverWayRowsAndSlicesRun) {
  EXPECT_TRUE(holds(volume_));
  EXPECT_TRUE(holds(turned()));
}

TEST_F(KnownVoxels, AreNotThereWhereOneIsOffOrOutOfItsPlace) {
  Volume off = volume_;
  off.hu[7] += 1;
  EXPECT_FALSE(holds(off));
  Volume mirrored = turned();
  mirrored.geometry.direction = volume_.geometry.direction;
  EXPECT_FALSE(holds(mirrored));
  Volume shorter = volume_;
  shorter.geometry.size[2] = 1;
  shorter.hu.resize(12);
  EXPECT_FALSE(holds(shorter));
  EXPECT_FALSE(holdsKnownVoxels(folder_ / "none.nii", known_));
}

// Measures tiny series with a script in trephine-lab's place, and one in each peer's.
class Measured : public ::testing::Test {
 protected:
  Measured() : path_(std::getenv("PATH")) {
    options_.program = folder_ / "trephine-lab";
    options_.size = {8, 8, 4};
    options_.repetitions = 2;
    options_.scan_series = 2;
    options_.scan_slices = 3;
    options_.syntaxes = {SeriesSyntax::int16, SeriesSyntax::rle};
    const Result<Volume> volume = makeNoisyCt(options_.size, {Progress()});
    sha256_ = volumeSha256(*volume);
    program("trephine-lab",
            "case \"$1 $2\" in\n"
            "  import*rle) echo '{\"error\": {\"code\": \"X\", \"what\": \"RLE is refused\"}}'; "
            "exit 2;;\n"
            "  import*) echo '" +
                report(sha256_) +
                "';;\n"
                "  *) echo '{\"seconds\": 0.1, \"kept_seconds\": 0.2}';;\n"
                "esac");
    fs::create_directory(folder_ / "peers");
    ::setenv("PATH", (folder_ / "peers").c_str(), 1);
  }
  ~Measured() override { ::setenv("PATH", path_.c_str(), 1); }

  static std::string report(const Json& sha256, const Json& other_sha256 = nullptr,
                            double read_s = 0.5) {
    return Json{{"chosen", "1.2"},
                {"series",
                 {{{"uid", "1.1"}, {"volume_sha256", other_sha256}},
                  {{"uid", "1.2"}, {"volume_sha256", sha256}}}},
                {"seconds", {{"scan", 0.25}, {"read", read_s}, {"hash", 0.0}}},
                {"start_rss_mb", 30.0},
                {"peak_rss_mb", 190.5}}
        .dump();
  }
  void program(const std::string& name, const std::string& script) const {
    ASSERT_TRUE(writeTextFile(folder_ / name, "#!/bin/sh\n" + script + "\n"));
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  ImportMeasurement measure() const {
    Result<ImportMeasurement> measured = measureImport(options_, folder_ / "out");
    EXPECT_TRUE(measured) << measured.error().sentence();
    return *std::move(measured);
  }
  static const ImportRow& find(const ImportMeasurement& m, const std::string& series,
                               const std::string& loader) {
    return *std::find_if(m.rows.begin(), m.rows.end(), [&](const ImportRow& r) {
      return r.series == series && r.loader == loader;
    });
  }
  int entriesOfOut() const {
    return int(std::distance(fs::directory_iterator(folder_ / "out"), fs::directory_iterator{}));
  }

  TemporaryFolder folder_;
  ImportOptions options_;
  std::string path_, sha256_;
};

TEST_F(Measured, RowsHaveWhatTheProgramsReport) {
  const ImportMeasurement m = measure();
  ASSERT_EQ(m.rows.size(), 8u) << "two loaders of two names each, no peers";
  const ImportRow& ours = find(m, "int16", "trephine");
  EXPECT_EQ(ours.seconds_median, 0.75);
  EXPECT_EQ(ours.above_start_mb, 160.5);
  EXPECT_EQ(ours.correct, true);
  EXPECT_GT(find(m, "int16", "trephine command").seconds_median.value(), 0.0);
  EXPECT_EQ(find(m, "int16", "floor").seconds_median, 0.1);
  EXPECT_EQ(find(m, "int16", "floor kept").seconds_median, 0.2);
  EXPECT_FALSE(find(m, "int16", "floor").correct);
  EXPECT_EQ(find(m, "rle", "trephine").skipped_reason, "RLE is refused");
  EXPECT_EQ(find(m, "rle", "trephine").correct, false);
  EXPECT_FALSE(find(m, "rle", "trephine command").seconds_median);
  ASSERT_EQ(m.scan.size(), 1u);
  EXPECT_EQ(m.scan[0].files, 6);
  EXPECT_EQ(m.scan[0].seconds_median, 0.25);

  std::ifstream table(folder_ / "out" / fs::path("import.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 1 + m.rows.size() + m.scan.size());
  EXPECT_EQ(lines[0],
            "series,loader,threads,seconds_median,peak_rss_mb,above_start_mb,correct,"
            "skipped_reason");
  for (const std::string& line : lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
  }
  EXPECT_EQ(entriesOfOut(), 1) << "the series are gone";
}

TEST_F(Measured, AVolumeThatIsNotTheKnownOneIsWrong) {
  program("trephine-lab", "echo '" + report("0000", sha256_) + "'");
  EXPECT_EQ(find(measure(), "int16", "trephine").correct, false);
}

TEST_F(Measured, TheLoadersTakeTurnsAndTheFirstRunOfEachDoesNotCount) {
  options_.syntaxes = {SeriesSyntax::u12};
  options_.repetitions = 1;
  const std::string log = (folder_ / "log").string();
  program("trephine-lab", "echo $1 >> " + log + "\n" + "if [ -e " + log + ".warm ]; then echo '" +
                              report(sha256_) + "'\n" + "else : > " + log + ".warm; echo '" +
                              report(sha256_, nullptr, 0.1) + "'; fi");
  EXPECT_EQ(find(measure(), "u12", "trephine").seconds_median, 0.75);
  std::ifstream in(log);
  const std::vector<std::string> ran(std::istream_iterator<std::string>{in}, {});
  EXPECT_EQ(ran, (std::vector<std::string>{"import", "measure", "measure", "import",  // the series
                                           "import", "import"}));                     // the scan
}

TEST_F(Measured, PeersThatAreNotInstalledAreSkipped) {
  options_.peers = true;
  const ImportMeasurement m = measure();
  for (const char* peer : {"dcm2niix", "dicomtonifti"}) {
    const ImportRow& r = find(m, "int16", peer);
    EXPECT_EQ(r.skipped_reason, "not installed");
    EXPECT_FALSE(r.seconds_median);
    EXPECT_FALSE(r.correct);
  }
  ASSERT_EQ(m.scan.size(), 2u);
  EXPECT_EQ(m.scan[1].loader, "gdcmscanner");
  EXPECT_EQ(m.scan[1].skipped_reason, "not installed");
  EXPECT_FALSE(ratiosOf(m).scan_to_gdcmscanner);
}

TEST_F(Measured, PeersThatFailWriteNothingOrTakeTooLongSaySo) {
  options_.peers = true;
  options_.limit_s = 1.0;
  options_.syntaxes = {SeriesSyntax::int16};
  program("peers/dcm2niix", "exec /bin/sleep 60");
  program("peers/dicomtonifti", ":");
  program("peers/gdcmscanner", "exit 3");
  const ImportMeasurement m = measure();
  const ImportRow& slow = find(m, "int16", "dcm2niix");
  if (slow.skipped_reason.find("Operation not permitted") != std::string::npos) {
    GTEST_SKIP() << "this system grants no namespaces";
  }
  EXPECT_EQ(slow.skipped_reason, "took over 1 s");
  EXPECT_EQ(find(m, "int16", "dicomtonifti").skipped_reason, "wrote 0 volumes");
  EXPECT_EQ(find(m, "int16", "dicomtonifti").correct, false);
  EXPECT_EQ(m.scan[1].skipped_reason, "failed with exit code 3");
}

TEST_F(Measured, NothingStaysWhenItIsCancelled) {
  for (const char* when : {"Making the phantom", "int16: floor"}) {
    Progress* to_cancel = nullptr;
    Progress progress([&](double, const std::string& step) {
      if (step == when) to_cancel->cancel();
    });
    to_cancel = &progress;
    const Result<ImportMeasurement> measured = measureImport(options_, folder_ / "out", progress);
    ASSERT_FALSE(measured) << when;
    EXPECT_EQ(measured.error().code, "CANCELLED");
    EXPECT_EQ(entriesOfOut(), 0) << when;
  }
}

TEST_F(Measured, ProgressGoesForwardTo1) {
  std::vector<double> fractions;
  const Progress progress([&](double f, const std::string&) { fractions.push_back(f); });
  ASSERT_TRUE(measureImport(options_, folder_ / "out", progress));
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(Measured, WhatCannotBeMeasuredIsRefusedBeforeAnythingIsMade) {
  const auto refused = [&](const char* what, auto&& change) {
    ImportOptions options = options_;
    change(options);
    const Result<ImportMeasurement> measured = measureImport(options, folder_ / "none");
    ASSERT_FALSE(measured) << what;
    EXPECT_EQ(measured.error().code, "BAD_ARGUMENT") << what;
  };
  refused("size", [](ImportOptions& o) { o.size[0] = 4096; });
  refused("slices", [](ImportOptions& o) { o.size[2] = 1; });
  refused("repetitions", [](ImportOptions& o) { o.repetitions = 0; });
  refused("scan series", [](ImportOptions& o) { o.scan_series = 0; });
  refused("scan slices", [](ImportOptions& o) { o.scan_slices = 1; });
  EXPECT_FALSE(fs::exists(folder_ / "none"));
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_EQ(measureImport(options_, folder_ / "file").error().code, "CANNOT_WRITE");
}

}  // namespace
}  // namespace trephine
