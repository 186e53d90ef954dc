#include "lab/import/import_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "import_fixture.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using test::Measured;
using test::row;

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

TEST(ImportRatios, AreOfMediansOfTheSameRunAndOnlyOfAVolumeThatIsRight) {
  ImportMeasurement m;
  m.rows = {row("int16", "trephine", 0.12, true), row("int16", "floor", 0.1, {}),
            row("int16", "floor kept", 0.16, {}), row("u12", "trephine", 0.15, true),
            row("u12", "floor", 0.12, {})};
  const Json ratios = toJson(m)["ratios"];
  EXPECT_NEAR(ratios["int16_to_floor"].get<double>(), 1.2, 1e-12);
  EXPECT_NEAR(ratios["int16_to_floor_kept"].get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(ratios["u12_to_floor"].get<double>(), 1.25, 1e-12);
  EXPECT_TRUE(ratios["u12_to_floor_kept"].is_null()) << "that row is missing";
  m.rows[0].correct = false;
  EXPECT_TRUE(toJson(m)["ratios"]["int16_to_floor"].is_null());
}

TEST(ImportMeasurement, IsAnsweredWithExactlyItsKeys) {
  ImportMeasurement m;
  m.volume_mb = 150.0;
  m.rows.push_back({"int16", "trephine", 2, 0.12, 200.0, 160.0, true, ""});
  m.rows.push_back({"u12", "trephine", 1, {}, {}, {}, {}, "took over 120 s"});
  m.scan.push_back({3000, "trephine", 0.25, 50.0, ""});
  EXPECT_EQ(toJson(m), Json::parse(R"({
    "volume_mb": 150.0,
    "rows": [
      {"series": "int16", "loader": "trephine", "threads": 2, "seconds_median": 0.12,
       "peak_rss_mb": 200.0, "above_start_mb": 160.0, "correct": true, "skipped_reason": null},
      {"series": "u12", "loader": "trephine", "threads": 1, "seconds_median": null,
       "peak_rss_mb": null, "above_start_mb": null, "correct": null,
       "skipped_reason": "took over 120 s"}],
    "scan": [{"files": 3000, "loader": "trephine", "seconds_median": 0.25, "peak_rss_mb": 50.0,
              "skipped_reason": null}],
    "ratios": {"int16_to_floor": null, "int16_to_floor_kept": null, "u12_to_floor": null,
               "u12_to_floor_kept": null, "command_to_dcm2niix": null, "scan_to_gdcmscanner": null,
               "compressed": {"deflated": null, "rle": null, "jpegls": null, "jpegll": null,
                              "j2k": null}}})"));
}

TEST(ImportMeasurement, ReadsAsATableWithItsRatiosBelow) {
  ImportMeasurement m;
  m.volume_mb = 150.0;
  m.rows = {row("int16", "trephine", 0.12, true), row("int16", "floor", 0.1, {}),
            row("u12", "trephine", {}, false)};
  m.rows[2].skipped_reason = "took over 120 s";
  const std::string text = toText(m);
  EXPECT_NE(text.find("took over 120 s"), std::string::npos);
  EXPECT_NE(text.find("int16: scan and read / plain read                          1.20\n"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("u12         trephine                1           -          -                 -"
                "  NO"),
      std::string::npos)
      << text;
}

TEST_F(Measured, RowsHaveWhatTheProgramsReport) {
  const ImportMeasurement m = measure();
  ASSERT_EQ(m.rows.size(), 8u) << "two loaders of two names each, on two series";
  const ImportRow& ours = find(m, "int16", "trephine");
  EXPECT_EQ(ours.seconds_median, 0.75);
  EXPECT_EQ(ours.above_start_mb, 160.5);
  EXPECT_EQ(ours.correct, true);
  EXPECT_GT(find(m, "int16", "trephine command").seconds_median.value(), 0.0);
  EXPECT_EQ(find(m, "int16", "floor").seconds_median, 0.1);
  EXPECT_EQ(find(m, "int16", "floor kept").seconds_median, 0.2);
  EXPECT_FALSE(find(m, "int16", "floor").correct);
  EXPECT_EQ(find(m, "u12", "trephine").skipped_reason, "u12 is refused");
  EXPECT_EQ(find(m, "u12", "trephine").correct, false);
  EXPECT_FALSE(find(m, "u12", "trephine command").seconds_median);
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
  program("trephine-lab", "echo '" + report("0000", "known") + "'");
  EXPECT_EQ(find(measure(), "int16", "trephine").correct, false);
}

TEST_F(Measured, TheLoadersTakeTurnsAndTheFirstRunOfEachDoesNotCount) {
  options_.series.names = {"u12"};
  options_.repetitions = 1;
  const std::string log = (folder_ / "log").string();
  program("trephine-lab", "echo $1 >> " + log + "\n" + "if [ -e " + log + ".warm ]; then echo '" +
                              report("known") + "'\n" + "else : > " + log + ".warm; echo '" +
                              report("known", nullptr, 0.1) + "'; fi");
  program("trephine-measure", "echo $1 >> " + log + "\n" + "echo '{}'");
  EXPECT_EQ(find(measure(), "u12", "trephine").seconds_median, 0.75);
  std::ifstream in(log);
  const std::vector<std::string> ran(std::istream_iterator<std::string>{in}, {});
  EXPECT_EQ(ran, (std::vector<std::string>{"import", "read", "read", "import",  // the series
                                           "import", "import"}));               // the scan
}

TEST_F(Measured, NothingStaysWhenItIsCancelled) {
  for (const char* when : {"making", "int16: floor"}) {
    Progress* to_cancel = nullptr;
    Progress progress([&](double, const std::string& step) {
      if (step == when) to_cancel->cancel();
    });
    to_cancel = &progress;
    const Result<ImportMeasurement> measured =
        measureImport(options_, subjects_, folder_ / "out", progress);
    ASSERT_FALSE(measured) << when;
    EXPECT_EQ(measured.error().code.str(), "CANCELLED");
    EXPECT_EQ(entriesOfOut(), 0) << when;
  }
}

TEST_F(Measured, ProgressGoesForwardTo1) {
  std::vector<double> fractions;
  const Progress progress([&](double f, const std::string&) { fractions.push_back(f); });
  ASSERT_TRUE(measureImport(options_, subjects_, folder_ / "out", progress));
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(Measured, WhatCannotBeMeasuredIsRefusedBeforeAnythingIsMade) {
  const auto refused = [&](const char* what, auto&& change) {
    ImportOptions options = options_;
    change(options);
    const Result<ImportMeasurement> measured = measureImport(options, subjects_, folder_ / "none");
    ASSERT_FALSE(measured) << what;
    EXPECT_EQ(measured.error().code.str(), "BAD_ARGUMENT") << what;
  };
  refused("size", [](ImportOptions& o) { o.series.size[0] = 4096; });
  refused("slices", [](ImportOptions& o) { o.series.size[2] = 1; });
  refused("repetitions", [](ImportOptions& o) { o.repetitions = 0; });
  refused("scan series", [](ImportOptions& o) { o.series.scan_series = 0; });
  refused("scan slices", [](ImportOptions& o) { o.series.scan_slices = 1; });
  refused("series", [](ImportOptions& o) { o.series.names = {"u12", "mp3"}; });
  EXPECT_FALSE(fs::exists(folder_ / "none"));
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_EQ(measureImport(options_, subjects_, folder_ / "file").error().code.str(),
            "CANNOT_WRITE");
}

}  // namespace
}  // namespace trephine
