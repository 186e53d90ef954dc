// bench_import: how fast CT is read, in eight transfer syntaxes, against a plain read of the bytes
// and against other programs. `trephine-measure import` is its short form.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/answer.h"
#include "app/signals.h"
#include "base/codes.h"
#include "base/log.h"
#include "bench/import/comparison.h"
#include "bench/import/peers.h"
#include "bench/import/scanner_series.h"

namespace {

constexpr const char* kName = "measure.import";

trephine::Progress progress(trephine::reportToTerminal);

int run(int argc, char** argv) {
  using namespace trephine;
  CLI::App app{"How fast CT is read, against a plain read and other programs"};
  ImportOptions options;
  OwnProgram program;
  std::string lab, out;
  bool peers = false, json = false;
  int edge = options.series.size[0];
  app.add_flag("--peers", peers, "Other programs too, where they are installed");
  app.add_option("--series", options.series.names, "Only these; all unless given");
  app.add_option("--size", edge, "Rows and columns")->capture_default_str();
  app.add_option("--slices", options.series.size[2], "Of each series")->capture_default_str();
  app.add_option("--repetitions", options.repetitions)->capture_default_str();
  app.add_option("--scan-series", options.series.scan_series,
                 "Series in the folder whose headers are read")
      ->capture_default_str();
  app.add_option("--scan-slices", options.series.scan_slices, "Slices of each of them")
      ->capture_default_str();
  app.add_option("--out", out, "Folder for the table; takes up to 1.5 GB while it runs")
      ->required();
  app.add_option("--lab", lab,
                 "The trephine-lab to measure, trephine-measure beside it; those beside this "
                 "program unless given");
  app.add_flag("--json", json, "Answer as JSON on stdout; logs go to stderr");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0 || !wantsJson(argc, argv)) return app.exit(error) == 0 ? 0 : 1;
    return printError(kName, {code::kBadArgument, error.what(), "the command line", "See --help"},
                      true);
  }
  setUpLog(json);
  options.series.size[0] = options.series.size[1] = edge;
  if (!lab.empty()) {
    std::error_code error;
    program.file = std::filesystem::absolute(lab, error);
    program.measure = std::filesystem::path(program.file).replace_filename("trephine-measure");
  }
  ImportSubjects subjects = ownSubjects(program);
  subjects.names = bench::seriesNames();
  subjects.write = bench::writeScannerSeries;
  if (peers) subjects = bench::withPeers(std::move(subjects), program.limit_s);
  const Result<ImportMeasurement> measured = measureImport(options, subjects, out, progress);
  if (!measured) return printError(kName, measured.error(), json);
  if (json) {
    printAnswer(kName, bench::toJson(*measured));
  } else {
    std::printf("%s", bench::toText(*measured).c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  trephine::cancelOnSignals(progress);
  return trephine::guarded("bench_import", trephine::wantsJson(argc, argv),
                           [&] { return run(argc, argv); });
}
