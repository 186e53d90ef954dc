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

// How the machine did. Where a run was not in real time no deadline is missed and memory_locked is
// none.
struct MachineHealth {
  std::optional<bool> memory_locked;  // none: not known
  std::string memory_not_locked;      // why not, where it is false
  std::uint64_t missed_deadlines = 0;
  // Times that an arm's pose or force was no number; its force was taken away.
  std::uint64_t nonfinite = 0;
  // Records, carves and events that found a full ring: the recording lacks them.
  std::uint64_t events_dropped = 0;
  double recorder_behind_ms = 0.0;  // the most of the session that was not on disk yet
  DurationSummary tick_ns;          // how long ticks took [ns]
};

// Session::report() fills it, after stop() or freewheel(), but for picture, volume and table, which
// the `run` command adds. `done` names one controller (off, seed, bounded) at least: toJson() and
// toText() need one.
struct RunReport {
  RunMetrics done;
  std::vector<CutStructure> structures_cut;  // of the case; empty where it has none
  std::vector<Warning> warnings;             // of the case and the exercise, then all of `done`'s
  MachineHealth machine;
  // Of the voxels, before the first tick and after the last; the second is empty where memory did
  // not suffice for it.
  std::string volume_sha256_before, volume_sha256;
  // Paths of files; empty: none. table: every tick, as CSV.
  std::string recording, picture, volume, table;
};

// A warning in the form of an Error (MEMORY_NOT_LOCKED): what it means that memory could not be
// locked, and how to allow it. `reason` is memory_not_locked.
Error memoryNotLocked(const std::string& reason);

Json toJson(const RunReport& report);
// The same for a person, a few lines.
std::string toText(const RunReport& report);

}  // namespace trephine
