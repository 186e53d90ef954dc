#include "lab/import/import_measurement.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <locale>
#include <sstream>

#include "base/codes.h"
#include "base/file.h"
#include "base/locked_folder.h"
#include "machine/common/spread.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kMakingShare = 0.4;  // of the progress
constexpr double kMb = 1024.0 * 1024.0;

Error badArgument(const char* what, const char* where) {
  return {code::kBadArgument, what, where, ""};
}

Status check(const ImportOptions& options, const std::vector<std::string>& names) {
  const ImportSeries& series = options.series;
  if (Status can = checkSeriesSize(series.size); !can) return can;
  if (options.repetitions < 1 || options.repetitions > 100) {
    return badArgument("There are 1 to 100 repetitions", "--repetitions");
  }
  if (series.scan_series < 1 || series.scan_series > 1000 || series.scan_slices < 2 ||
      series.scan_slices > 2048) {
    return badArgument("A scan has 1 to 1000 series of 2 to 2048 files", "--scan-series");
  }
  for (const std::string& name : series.names) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    Error error = badArgument("There is no series", "--series");
    error.what += " '" + name + "'";
    for (const std::string& other : names) {
      error.next += (error.next.empty() ? "Use one of: " : ", ") + other;
    }
    return error;
  }
  return {};
}

// The figures of one loader under one of its names, on their way to a row.
struct Gathered {
  ImportRow row;
  std::vector<ImportSample> samples;
};

// Every loader once untimed, then `repetitions` times in turns. One that has a problem is not run
// again and keeps no figures.
Result<std::vector<Gathered>> takeTurns(const std::vector<Loader>& loaders, const fs::path& place,
                                        const std::string& series, const KnownVolume* known,
                                        int repetitions, const Progress& progress) {
  const fs::path folder = place / series, empty = place / "run";
  std::vector<std::vector<Gathered>> gathered;
  for (const Loader& loader : loaders) {
    std::vector<Gathered> figures;
    for (const std::string& name : loader.names) {
      ImportRow row;
      row.series = series;
      row.loader = name;
      row.threads = loader.threads;
      row.skipped_reason = loader.missing;
      figures.push_back({row, {}});
    }
    gathered.push_back(std::move(figures));
  }
  const std::size_t count = loaders.size();
  for (int turn = 0; turn <= repetitions; ++turn) {
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t which = (n + std::size_t(turn)) % count;
      std::vector<Gathered>& figures = gathered[which];
      if (!figures.front().row.skipped_reason.empty()) continue;
      const double done = (turn + double(n) / double(count)) / (repetitions + 1);
      progress.at(done, series + ": " + loaders[which].names.front());
      if (Status made = makeFolder(empty); !made) return made.error();
      Result<LoaderRun> run =
          loaders[which].run({folder, empty, turn == 0 ? known : nullptr, progress});
      std::error_code none;
      fs::remove_all(empty, none);
      if (!run) return run.error();
      for (std::size_t f = 0; f < figures.size(); ++f) {
        if (run->correct) figures[f].row.correct = run->correct;
        figures[f].row.skipped_reason = run->problem;
        if (turn > 0 && run->problem.empty()) figures[f].samples.push_back(run->samples[f]);
      }
    }
  }
  std::vector<Gathered> all;
  for (std::vector<Gathered>& figures : gathered) {
    std::move(figures.begin(), figures.end(), std::back_inserter(all));
  }
  return all;
}

const ImportRow* find(const ImportMeasurement& m, const std::string& series,
                      const std::string& loader) {
  const auto found = std::find_if(m.rows.begin(), m.rows.end(), [&](const ImportRow& row) {
    return row.series == series && row.loader == loader && row.seconds_median;
  });
  return found == m.rows.end() ? nullptr : &*found;
}

Json textOrNull(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

// Scan and read against a plain read.
struct FloorRatio {
  const char *key, *series, *floor, *text;
};
constexpr FloorRatio kFloorRatios[] = {
    {"int16_to_floor", "int16", "floor", "int16: scan and read / plain read"},
    {"int16_to_floor_kept", "int16", "floor kept",
     "int16: scan and read / plain read that keeps all"},
    {"u12_to_floor", "u12", "floor", "u12: scan and read / plain read"},
    {"u12_to_floor_kept", "u12", "floor kept", "u12: scan and read / plain read that keeps all"}};

std::optional<double> of(const ImportMeasurement& m, const FloorRatio& ratio) {
  return ratioOf(secondsOf(m, ratio.series, "trephine"), secondsOf(m, ratio.series, ratio.floor));
}

// "-" for nothing.
std::string cell(const std::optional<double>& value, int digits) {
  if (!value) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, *value);
  return text;
}

std::string toCsv(const ImportMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "series,loader,threads,seconds_median,peak_rss_mb,above_start_mb,correct,"
          "skipped_reason\n"
       << std::fixed;
  const auto put = [&](const std::optional<double>& value, int digits) {
    if (value) text << std::setprecision(digits) << *value;
    text << ',';
  };
  for (const ImportRow& row : measurement.rows) {
    text << row.series << ',' << row.loader << ',' << row.threads << ',';
    put(row.seconds_median, 4);
    put(row.peak_rss_mb, 1);
    put(row.above_start_mb, 1);
    if (row.correct) text << (*row.correct ? "true" : "false");
    text << ',' << std::quoted(row.skipped_reason, '"', '"') << '\n';
  }
  for (const ScanRow& row : measurement.scan) {
    text << "scan of " << row.files << ',' << row.loader << ",,";
    put(row.seconds_median, 4);
    put(row.peak_rss_mb, 1);
    text << ",," << std::quoted(row.skipped_reason, '"', '"') << '\n';
  }
  return text.str();
}

}  // namespace

ImportRow summarizeImport(ImportRow row, const std::vector<ImportSample>& samples) {
  if (samples.empty() || !row.skipped_reason.empty()) return row;
  std::vector<double> seconds;
  for (const ImportSample& sample : samples) {
    seconds.push_back(sample.seconds);
    row.peak_rss_mb = std::max(row.peak_rss_mb.value_or(0.0), sample.peak_rss_mb);
    if (sample.above_start_mb) {
      row.above_start_mb = std::max(row.above_start_mb.value_or(0.0), *sample.above_start_mb);
    }
  }
  std::sort(seconds.begin(), seconds.end());
  row.seconds_median = quantile(seconds, 500);
  return row;
}

std::optional<double> ratioOf(std::optional<double> ours, std::optional<double> reference) {
  if (!ours || !reference || !(*reference > 0.0)) return std::nullopt;
  return *ours / *reference;
}

std::optional<double> secondsOf(const ImportMeasurement& m, const std::string& series,
                                const std::string& loader) {
  const ImportRow* row = find(m, series, loader);
  if (!row || row->correct == false) return std::nullopt;
  return row->seconds_median;
}

ImportSubjects ownSubjects(const OwnProgram& program) {
  return {{"int16", "u12"}, writeOwnSeries, ownLoaders(program), {ownScanner(program)}};
}

Result<ImportMeasurement> measureImport(const ImportOptions& options,
                                        const ImportSubjects& subjects, const fs::path& out,
                                        const Progress& progress) {
  if (Status good = check(options, subjects.names); !good) return good.error();
  if (Status made = makeFolder(out); !made) return made.error();
  const Result<LockedFolder> folder = LockedFolder::make(out, ".import-", out);
  if (!folder) return folder.error();
  ImportSeries series = options.series;
  if (series.names.empty()) series.names = subjects.names;
  const Progress making(progress, 0.0, kMakingShare);
  const Result<std::vector<KnownVolume>> known = subjects.write(series, folder->path(), making);
  if (!known) return known.error();
  ::sync();  // what is still on its way to the disk would be timed with the first runs

  ImportMeasurement result;
  result.volume_mb = double(known->front().geometry.voxelCount() * sizeof(std::int16_t)) / kMb;
  const double part = (1.0 - kMakingShare) / double(series.names.size() + 1);
  double from = kMakingShare;
  for (std::size_t n = 0; n < series.names.size(); ++n) {
    const Progress reading(progress, from, from + part);
    Result<std::vector<Gathered>> gathered =
        takeTurns(subjects.loaders, folder->path(), series.names[n], &(*known)[n],
                  options.repetitions, reading);
    if (!gathered) return gathered.error();
    for (const Gathered& g : *gathered) result.rows.push_back(summarizeImport(g.row, g.samples));
    from += part;
  }
  const Progress scanning(progress, from, 1.0);
  Result<std::vector<Gathered>> scans =
      takeTurns(subjects.scanners, folder->path(), "scan", nullptr, options.repetitions, scanning);
  if (!scans) return scans.error();
  for (const Gathered& g : *scans) {
    const ImportRow row = summarizeImport(g.row, g.samples);
    result.scan.push_back({series.scan_series * series.scan_slices, row.loader, row.seconds_median,
                           row.peak_rss_mb, row.skipped_reason});
  }
  if (Status table = writeTextFile(out / "import.csv", toCsv(result)); !table) {
    return table.error();
  }
  progress.at(1.0, "done");
  return result;
}

Json toJson(const ImportMeasurement& measurement) {
  Json rows = Json::array(), scan = Json::array(), ratios = Json::object(), compressed;
  for (const ImportRow& row : measurement.rows) {
    rows.push_back({{"series", row.series},
                    {"loader", row.loader},
                    {"threads", row.threads},
                    {"seconds_median", orNull(row.seconds_median)},
                    {"peak_rss_mb", orNull(row.peak_rss_mb)},
                    {"above_start_mb", orNull(row.above_start_mb)},
                    {"correct", orNull(row.correct)},
                    {"skipped_reason", textOrNull(row.skipped_reason)}});
  }
  for (const ScanRow& row : measurement.scan) {
    scan.push_back({{"files", row.files},
                    {"loader", row.loader},
                    {"seconds_median", orNull(row.seconds_median)},
                    {"peak_rss_mb", orNull(row.peak_rss_mb)},
                    {"skipped_reason", textOrNull(row.skipped_reason)}});
  }
  for (const FloorRatio& ratio : kFloorRatios) ratios[ratio.key] = orNull(of(measurement, ratio));
  for (const char* key : {"command_to_dcm2niix", "scan_to_gdcmscanner"}) ratios[key] = nullptr;
  for (const char* series : {"deflated", "rle", "jpegls", "jpegll", "j2k"}) {
    compressed[series] = nullptr;
  }
  ratios["compressed"] = compressed;
  return {{"volume_mb", measurement.volume_mb}, {"rows", rows}, {"scan", scan}, {"ratios", ratios}};
}

std::string toText(const ImportMeasurement& measurement) {
  char line[400];
  std::string text =
      "series      loader            threads  median [s]  peak [MB]  above start [MB]  correct\n";
  for (const ImportRow& row : measurement.rows) {
    std::snprintf(line, sizeof line, "%-11s %-17s %7d %11s %10s %17s  %-7s  %s\n",
                  row.series.c_str(), row.loader.c_str(), row.threads,
                  cell(row.seconds_median, 4).c_str(), cell(row.peak_rss_mb, 1).c_str(),
                  cell(row.above_start_mb, 1).c_str(),
                  !row.correct   ? "-"
                  : *row.correct ? "yes"
                                 : "NO",
                  row.skipped_reason.c_str());
    text += line;
  }
  for (const ScanRow& row : measurement.scan) {
    std::snprintf(line, sizeof line, "headers of %5d files %-18s %9s %10s  %s\n", row.files,
                  row.loader.c_str(), cell(row.seconds_median, 4).c_str(),
                  cell(row.peak_rss_mb, 1).c_str(), row.skipped_reason.c_str());
    text += line;
  }
  std::snprintf(line, sizeof line, "the volume has %.1f MB\n", measurement.volume_mb);
  text += line;
  for (const FloorRatio& ratio : kFloorRatios) {
    std::snprintf(line, sizeof line, "%-56s %6s\n", ratio.text,
                  cell(of(measurement, ratio), 2).c_str());
    text += line;
  }
  return text;
}

}  // namespace trephine
