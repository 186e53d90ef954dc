#include "lab/touch/extremes_measurement.h"

#include <algorithm>
#include <iterator>

#include "base/codes.h"
#include "base/file.h"
#include "base/formatted.h"
#include "lab/touch/extremes_rows.h"
#include "lab/touch/extremes_touch.h"

namespace trephine {

namespace {

using namespace extremes;

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto group : {motionCases, clockCases, notFiniteCases, shapeCases, endureCases}) {
    std::vector<Case> more = group();
    std::move(more.begin(), more.end(), std::back_inserter(all));
  }
  return all;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '"';
}

std::string toCsv(const ExtremesMeasurement& measurement) {
  std::string text = "name,input,expected,got,pass\n";
  for (const ExtremeRow& row : measurement.rows) {
    text += quoted(row.name) + ',' + quoted(row.input) + ',' + quoted(row.expected) + ',' +
            quoted(row.got) + ',' + (row.pass ? "true" : "false") + '\n';
  }
  return text;
}

}  // namespace

bool ExtremesMeasurement::all_pass() const {
  return std::all_of(rows.begin(), rows.end(), [](const ExtremeRow& row) { return row.pass; });
}

Result<ExtremesMeasurement> measureExtremes(const std::filesystem::path& out,
                                            const Progress& progress,
                                            const ExtremesOptions& options) {
  if (!out.empty()) {
    if (Status made = makeFolder(out); !made) return made.error();
  }
  ExtremesMeasurement measurement;
  const std::vector<Case> all = cases();
  for (const Case& c : all) {
    const double share = options.touch ? 0.1 : 1.0;
    progress.at(share * double(measurement.rows.size()) / double(all.size()), c.name);
    if (progress.cancelled()) {
      return Error{code::kCancelled, "The measurement was cancelled", "measure extremes", ""};
    }
    const Outcome outcome = c.measure();
    measurement.rows.push_back({c.name, c.input, c.expected, outcome.got, outcome.pass});
  }
  if (options.touch) {
    Result<std::vector<ExtremeRow>> touch =
        measureTouchExtremes(options.case_source, Progress(progress, 0.1, 1.0));
    if (!touch) return touch.error();
    std::move(touch->begin(), touch->end(), std::back_inserter(measurement.rows));
  }
  if (!out.empty()) {
    if (Status written = writeTextFile(out / "extremes.csv", toCsv(measurement)); !written) {
      return written.error();
    }
  }
  progress.at(1.0, "done");
  return measurement;
}

Json toJson(const ExtremesMeasurement& measurement) {
  Json rows = Json::array();
  for (const ExtremeRow& row : measurement.rows) {
    rows.push_back({{"name", row.name},
                    {"input", row.input},
                    {"expected", row.expected},
                    {"got", row.got},
                    {"pass", row.pass}});
  }
  return {{"rows", rows}};
}

std::string toText(const ExtremesMeasurement& measurement) {
  std::string text;
  std::size_t passed = 0;
  for (const ExtremeRow& row : measurement.rows) {
    passed += row.pass;
    text += (row.pass ? "ok     " : "FAILS  ") + row.name + ": " + row.input + "\n";
    if (!row.pass) text += "       expected: " + row.expected + "\n";
    text += "       got: " + row.got + "\n";
  }
  return text + formatted("%zu of %zu as expected\n", passed, measurement.rows.size());
}

}  // namespace trephine
