#include "lab/import/import_measurement.h"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <locale>
#include <sstream>

#include "base/file.h"
#include "lab/common/quantile.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kMakingShare = 0.4;  // of the progress
constexpr double kMb = 1024.0 * 1024.0;

Error badArgument(const char* what, const char* where) {
  return {"BAD_ARGUMENT", what, where, ""};
}

Status check(const ImportOptions& options) {
  if (Status can = checkSeriesSize(options.size); !can) return can;
  if (options.repetitions < 1 || options.repetitions > 100) {
    return badArgument("There are 1 to 100 repetitions", "--repetitions");
  }
  if (options.scan_series < 1 || options.scan_series > 1000 || options.scan_slices < 2 ||
      options.scan_slices > 2048) {
    return badArgument("A scan has 1 to 1000 series of 2 to 2048 files", "--scan-series");
  }
  if (!(options.limit_s > 0.0 && options.limit_s <= 3600.0)) {
    return badArgument("A run takes at most an hour", "limit_s");
  }
  return {};
}

// A folder of its own in another, which goes away with all that it holds.
class TemporaryFolder {
 public:
  static Result<TemporaryFolder> in(const fs::path& folder) {
    std::string pattern = (folder / ".import-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) {
      return Error{"CANNOT_WRITE", "The folder cannot be written to", folder.string(),
                   "Choose another place"};
    }
    return TemporaryFolder(pattern);
  }
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::move(other.path_)) {
    other.path_.clear();
  }
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder() {
    std::error_code none;
    if (!path_.empty()) fs::remove_all(path_, none);
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(fs::path path) : path_(std::move(path)) {}
  fs::path path_;
};

// The figures of one loader under one of its names, on their way to a row.
struct Gathered {
  ImportRow row;
  std::vector<ImportSample> samples;
};

// Every loader once untimed, then `repetitions` times in turns. One that has a problem is not run
// again and keeps no figures.
Result<std::vector<Gathered>> takeTurns(const std::vector<Loader>& loaders, const fs::path& folder,
                                        const KnownVolume* known, int repetitions,
                                        const std::string& series, const ProgressShare& share) {
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
      share.progress.at(share.from + (share.to - share.from) * done,
                        series + ": " + loaders[which].names.front());
      Result<LoaderRun> run =
          loaders[which].run(folder, turn == 0 ? known : nullptr, share.progress);
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

std::optional<double> ratio(std::optional<double> ours, std::optional<double> reference) {
  if (!ours || !reference || !(*reference > 0.0)) return std::nullopt;
  return *ours / *reference;
}

// Only a volume that is right counts as read.
std::optional<double> secondsOf(const ImportMeasurement& m, const std::string& series,
                                const std::string& loader) {
  const ImportRow* row = find(m, series, loader);
  if (!row || row->correct == false) return std::nullopt;
  return row->seconds_median;
}

bool isOurs(const ImportRow& row) {
  return row.loader.starts_with("trephine");
}

std::optional<double> fastestPeer(const ImportMeasurement& m, const std::string& series) {
  std::optional<double> fastest;
  for (const ImportRow& row : m.rows) {
    if (row.series != series || isOurs(row) || row.correct != true || !row.seconds_median) continue;
    if (!fastest || *row.seconds_median < *fastest) fastest = row.seconds_median;
  }
  return fastest;
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json textOrNull(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
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

ImportRatios ratiosOf(const ImportMeasurement& m) {
  ImportRatios ratios;
  ratios.int16_to_floor = ratio(secondsOf(m, "int16", "trephine"), secondsOf(m, "int16", "floor"));
  ratios.int16_to_floor_kept =
      ratio(secondsOf(m, "int16", "trephine"), secondsOf(m, "int16", "floor kept"));
  ratios.u12_to_floor = ratio(secondsOf(m, "u12", "trephine"), secondsOf(m, "u12", "floor"));
  ratios.u12_to_floor_kept =
      ratio(secondsOf(m, "u12", "trephine"), secondsOf(m, "u12", "floor kept"));
  ratios.command_to_dcm2niix =
      ratio(secondsOf(m, "int16", "trephine command"), secondsOf(m, "int16", "dcm2niix"));
  std::optional<double> ours, peer;
  for (const ScanRow& row : m.scan) {
    (row.loader == "trephine" ? ours : peer) = row.seconds_median;
  }
  ratios.scan_to_gdcmscanner = ratio(ours, peer);
  for (const char* series : {"deflated", "rle", "jpegls", "jpegll", "j2k"}) {
    ratios.compressed.emplace_back(
        series, ratio(secondsOf(m, series, "trephine command"), fastestPeer(m, series)));
  }
  return ratios;
}

Result<ImportMeasurement> measureImport(const ImportOptions& options, const fs::path& out,
                                        const Progress& progress) {
  if (Status good = check(options); !good) return good.error();
  if (Status made = makeFolder(out); !made) return made.error();
  Result<TemporaryFolder> folder = TemporaryFolder::in(out);
  if (!folder) return folder.error();
  std::vector<SeriesSyntax> syntaxes = options.syntaxes;
  if (syntaxes.empty()) {
    for (const auto& [name, syntax] : kSeriesSyntaxes) syntaxes.push_back(syntax);
  }

  const double part = kMakingShare / double(syntaxes.size() + 2);
  KnownVolume known;
  ImportMeasurement result;
  {
    Result<Volume> volume = makeNoisyCt(options.size, {progress, 0.0, part});
    if (!volume) return volume.error();
    known = {volume->geometry, volumeSha256(*volume)};
    result.volume_mb = double(volume->hu.size() * sizeof(std::int16_t)) / kMb;
    double from = part;
    for (const SeriesSyntax syntax : syntaxes) {
      const Status written = writeSeries(*volume, syntax, *folder / nameOf(kSeriesSyntaxes, syntax),
                                         {progress, from, from + part});
      if (!written) return written.error();
      from += part;
    }
  }
  const Status written = writeManySeries(options.scan_series, options.scan_slices, *folder / "scan",
                                         {progress, kMakingShare - part, kMakingShare});
  if (!written) return written.error();
  ::sync();  // what is still on its way to the disk would be timed with the first runs

  const LoaderPlaces places{options.program, *folder / "scratch", options.limit_s};
  std::vector<Loader> loaders = ownLoaders(places), scanners{ownScanner(places)};
  if (options.peers) {
    std::vector<Loader> others = peerLoaders(places);
    std::move(others.begin(), others.end(), std::back_inserter(loaders));
    scanners.push_back(peerScanner(places));
  }
  const double run_part = (1.0 - kMakingShare) / double(syntaxes.size() + 1);
  double from = kMakingShare;
  for (const SeriesSyntax syntax : syntaxes) {
    const std::string name = nameOf(kSeriesSyntaxes, syntax);
    Result<std::vector<Gathered>> gathered =
        takeTurns(loaders, *folder / name, &known, options.repetitions, name,
                  {progress, from, from + run_part});
    if (!gathered) return gathered.error();
    for (const Gathered& g : *gathered) result.rows.push_back(summarizeImport(g.row, g.samples));
    from += run_part;
  }
  Result<std::vector<Gathered>> scans = takeTurns(
      scanners, *folder / "scan", nullptr, options.repetitions, "scan", {progress, from, 1.0});
  if (!scans) return scans.error();
  for (const Gathered& g : *scans) {
    const ImportRow row = summarizeImport(g.row, g.samples);
    result.scan.push_back({options.scan_series * options.scan_slices, row.loader,
                           row.seconds_median, row.peak_rss_mb, row.skipped_reason});
  }
  if (Status table = writeTextFile(out / "import.csv", toCsv(result)); !table) {
    return table.error();
  }
  progress.at(1.0, "done");
  return result;
}

Json toJson(const ImportMeasurement& measurement) {
  Json rows = Json::array(), scan = Json::array(), compressed = Json::object();
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
  const ImportRatios ratios = ratiosOf(measurement);
  for (const auto& [series, value] : ratios.compressed) compressed[series] = orNull(value);
  return {{"volume_mb", measurement.volume_mb},
          {"rows", rows},
          {"scan", scan},
          {"ratios",
           {{"int16_to_floor", orNull(ratios.int16_to_floor)},
            {"int16_to_floor_kept", orNull(ratios.int16_to_floor_kept)},
            {"u12_to_floor", orNull(ratios.u12_to_floor)},
            {"u12_to_floor_kept", orNull(ratios.u12_to_floor_kept)},
            {"command_to_dcm2niix", orNull(ratios.command_to_dcm2niix)},
            {"scan_to_gdcmscanner", orNull(ratios.scan_to_gdcmscanner)},
            {"compressed", compressed}}}};
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
  const ImportRatios ratios = ratiosOf(measurement);
  const auto put = [&](const std::string& name, const std::optional<double>& value) {
    std::snprintf(line, sizeof line, "%-56s %6s\n", name.c_str(), cell(value, 2).c_str());
    text += line;
  };
  std::snprintf(line, sizeof line, "the volume has %.1f MB\n", measurement.volume_mb);
  text += line;
  put("int16: scan and read / plain read", ratios.int16_to_floor);
  put("int16: scan and read / plain read that keeps all", ratios.int16_to_floor_kept);
  put("u12: scan and read / plain read", ratios.u12_to_floor);
  put("u12: scan and read / plain read that keeps all", ratios.u12_to_floor_kept);
  put("int16: command without hash / dcm2niix", ratios.command_to_dcm2niix);
  put("scan / gdcmscanner", ratios.scan_to_gdcmscanner);
  for (const auto& [series, value] : ratios.compressed) {
    put(series + ": command without hash / fastest peer that is right", value);
  }
  return text;
}

}  // namespace trephine
