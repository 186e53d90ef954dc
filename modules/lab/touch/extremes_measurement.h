// What the loop, the core, the controller and the output limiter do with values that no one should
// give them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

// `expected` and `got` are sentences; `got` and `pass` come from the run. A row passes when what it
// expects came true and no tick broke what holds for all (extremes_rig.h, brokenBy).
struct ExtremeRow {
  std::string name, input, expected, got;
  bool pass = false;
};

struct ExtremesMeasurement {
  std::vector<ExtremeRow> rows;
  bool all_pass() const;
};

struct ExtremesOptions {
  bool touch = false;       // the rows of extremes_touch.h as well: a minute
  std::string case_source;  // of them, a real skull for the barrier; empty: none
};

// Writes extremes.csv into the folder `out` unless that is empty. Errors: CANCELLED, CANNOT_WRITE,
// and with `touch` those of the exercises' files and devices and of the case.
Result<ExtremesMeasurement> measureExtremes(const std::filesystem::path& out = {},
                                            const Progress& progress = Progress(),
                                            const ExtremesOptions& options = {});

// {rows:[{name, input, expected, got, pass}]}
Json toJson(const ExtremesMeasurement& measurement);
std::string toText(const ExtremesMeasurement& measurement);

}  // namespace trephine
