// What a run comes to, as `run --json` answers and as words: what was done, how the machine did
// meanwhile, and the files that it left.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "haptics/duration_histogram.h"
#include "training/run_metrics.h"
#include "volume/cut_structures.h"

namespace trephine {

// Of the machine on which a session ran in real time.
struct MachineHealth {
  std::optional<bool> memory_locked;  // none: not known
  std::string memory_not_locked;      // why not, where it is not
  std::uint64_t missed_deadlines = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t events_dropped = 0;
  double recorder_behind_ms = 0.0;  // the most of the session that was not on disk yet
  DurationSummary tick_ns;
};

// Session::report() fills it; `done` names one controller at least.
struct RunReport {
  RunMetrics done;
  std::vector<CutStructure> structures_cut;  // of the case; empty where it has none
  std::vector<Warning> warnings;             // of the case and the exercise, then `done`'s
  MachineHealth machine;
  std::string volume_sha256_before, volume_sha256;
  std::string recording, picture, volume, table;  // files; empty: none
};

// What it means that memory could not be locked, and how it is allowed.
Error memoryNotLocked(const std::string& reason);

Json toJson(const RunReport& report);
// The same for a person, a few lines.
std::string toText(const RunReport& report);

}  // namespace trephine
