// Measures series of nothing with scripts in the places of trephine-lab and trephine-measure.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include "base/codes.h"
#include "base/file.h"
#include "lab/import/import_measurement.h"
#include "support.h"

namespace trephine::test {

inline ImportRow row(const std::string& series, const std::string& loader,
                     std::optional<double> seconds, std::optional<bool> correct) {
  ImportRow r;
  r.series = series;
  r.loader = loader;
  r.seconds_median = seconds;
  r.correct = correct;
  return r;
}

class Measured : public ::testing::Test {
 protected:
  Measured() : subjects_(ownSubjects({folder_ / "trephine-lab", folder_ / "trephine-measure"})) {
    options_.series.scan_series = 2;
    options_.series.scan_slices = 3;
    options_.repetitions = 2;
    subjects_.write = [](const ImportSeries& series, const std::filesystem::path& folder,
                         const Progress& progress) -> Result<std::vector<KnownVolume>> {
      progress.at(0.5, "making");
      if (progress.cancelled()) return Error{code::kCancelled, "Cancelled", "", ""};
      for (const std::string& name : series.names) {
        std::filesystem::create_directories(folder / name);
      }
      GridGeometry geometry;
      geometry.size = {8, 8, 4};
      return std::vector<KnownVolume>(series.names.size(), {geometry, "known"});
    };
    program("trephine-lab",
            "case \"$1 $2\" in\n"
            "  import*u12) echo '{\"error\": {\"code\": \"X\", \"what\": \"u12 is refused\"}}'; "
            "exit 2;;\n"
            "  import*) echo '" +
                report("known") +
                "';;\n"
                "esac");
    program("trephine-measure", "echo '{\"seconds\": 0.1, \"kept_seconds\": 0.2}'");
  }

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
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }
  ImportMeasurement measure() const {
    Result<ImportMeasurement> measured = measureImport(options_, subjects_, folder_ / "out");
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
    return int(std::distance(std::filesystem::directory_iterator(folder_ / "out"),
                             std::filesystem::directory_iterator{}));
  }

  TemporaryFolder folder_;
  ImportOptions options_;
  ImportSubjects subjects_;
};

}  // namespace trephine::test
