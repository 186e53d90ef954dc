// What a run comes to: sums over its ticks, and the answer of `run --json`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "haptics/duration_histogram.h"
#include "haptics/haptic_types.h"
#include "volume/cut_structures.h"

namespace trephine {

struct ArmStatistics {
  double max_force_N = 0.0;       // sent
  std::uint64_t contact_ticks = 0;
  double energy_out_J = 0.0;      // the most that was ever given out, net
  double path_mm = 0.0;           // of the tool's tip
  std::optional<Vec3> tip_mm{};   // where it was last
  void add(const ArmRecord& record);
};

// A fault of an arm (haptic_types.h), or the arm's share in one of all.
struct ArmFault {
  std::uint64_t tick = 0;
  std::int32_t arm = 0;
  std::uint32_t fault = 0;  // a bit of Fault
};

// Of an exercise whose tool begins in tissue.
Warning startsInTissue(const std::string& arm, bool barrier);

struct RunReport {
  std::vector<std::string> controllers;  // one after the other, at least one
  std::uint64_t ticks = 0;
  double rate_hz = 0.0;
  struct Arm {
    std::string name;
    ArmStatistics statistics;
    double removed_mm3 = 0.0;  // of a voxel that it paid with another arm, its share
  };
  std::vector<Arm> arms;
  std::vector<std::pair<std::string, double>> removed_mm3;  // by tissue
  std::vector<CutStructure> structures_cut;                 // of the case; empty where it has none
  std::vector<ArmFault> faults;  // in the order in which they came
  std::vector<Warning> warnings;
  std::optional<bool> memory_locked;  // in real time
  std::string memory_not_locked;      // why not
  std::uint64_t removed_voxels = 0;
  std::uint64_t missed_deadlines = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t events_dropped = 0;
  double recorder_behind_ms = 0.0;  // the most of the session that was not on disk yet
  DurationSummary tick_ns;
  std::string volume_sha256_before, volume_sha256;
  std::string recording, picture, volume, table;  // files; empty: none
};

// What it means that memory could not be locked, and how it is allowed.
Error memoryNotLocked(const std::string& reason);

Json toJson(const RunReport& report);
// The same for a person, a few lines.
std::string toText(const RunReport& report);

}  // namespace trephine
