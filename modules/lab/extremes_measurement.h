// What the loop, the core, the controller and the gate do with values that no one should give them.
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

// Writes extremes.csv into the folder `out` unless that is empty. Errors: CANCELLED, CANNOT_WRITE.
Result<ExtremesMeasurement> measureExtremes(const std::filesystem::path& out = {},
                                            const Progress& progress = Progress());

// {rows:[{name, input, expected, got, pass}]}
Json toJson(const ExtremesMeasurement& measurement);
std::string toText(const ExtremesMeasurement& measurement);

}  // namespace trephine
