// What a run came to: a function of its records, the same while it runs, from its recording, and
// from a replay. How the machine did meanwhile is not part of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "exercise/cut_tally.h"
#include "exercise/exercise.h"
#include "training/paused_ticks.h"
#include "training/record_sink.h"
#include "training/session_reader.h"
#include "volume/carve_journal.h"
#include "volume/grid.h"

namespace trephine {

// A fault of an arm (haptic_types.h), or the arm's share in one of all.
struct ArmFault {
  std::uint64_t tick = 0;
  std::int32_t arm = 0;
  std::uint32_t fault = 0;  // a bit of Fault
  friend bool operator==(const ArmFault&, const ArmFault&) = default;
};

// The begin of a stroke; those undone are among them.
struct StrokeBegin {
  double second = 0.0;  // of the session, without pauses, as LoopState counts them
  std::int32_t arm = 0;
  friend bool operator==(const StrokeBegin&, const StrokeBegin&) = default;
};

struct RunMetrics {
  double rate_hz = 0.0;
  std::uint64_t ticks = 0;  // that were counted
  struct Arm {
    std::string name;
    double max_force_N = 0.0;  // sent
    std::uint64_t contact_ticks = 0;
    double energy_out_J = 0.0;  // the most that was ever given out, net
    double path_mm = 0.0;       // of the tool's tip
    double removed_mm3 = 0.0;   // of a voxel that it paid with another arm, its share
    friend bool operator==(const Arm&, const Arm&) = default;
  };
  std::vector<Arm> arms;
  std::vector<std::string> controllers;  // one after the other, at least one
  std::vector<StrokeBegin> strokes;      // the first 10,000
  std::vector<ArmFault> faults;          // in the order in which they came; the first 1000
  std::vector<Warning> warnings;         // of tools: that began in tissue, that were let go
  // What is removed at the end, by tissue in the exercise's order, as it truly was
  // (exercise/true_tissues.h), and what is of none of them or lies at an edge: setRemoved().
  std::vector<std::pair<std::string, double>> removed_mm3;
  double removed_unnamed_mm3 = 0.0;
  std::uint64_t removed_voxels = 0;
  // Once something had been cut: how often undo was asked for, and a rewind or reset; and how much
  // was cut and put back, cut again by the tool or not, less what a redo took: setRemoved().
  std::uint64_t undos = 0, rewinds = 0;
  double brought_back_mm3 = 0.0;
  friend bool operator==(const RunMetrics& a, const RunMetrics& b);
};

// Counts a run's records; removal is the journal's to say, which knows what was undone.
class RunMeter : public RecordSink {
 public:
  // On its case, with the controller at the start.
  explicit RunMeter(const Exercise& exercise);

  void tick(const TickRecord& record) override;
  void event(const Event& event) override;
  const RunMetrics& metrics() const { return metrics_; }

 private:
  void warn(Warning warning);

  RunMetrics metrics_;
  std::vector<std::optional<Vec3>> tips_mm_;  // where each tool was last
  bool barrier_ = false;                      // solid tissue stops a tool
  PausedTicks paused_;
};

// Of an exercise whose tool begins in tissue; `barrier`: it has the elastic law.
Warning startsInTissue(const std::string& arm, bool barrier);

// What is removed: by arm as the journal counts it, by tissue as `cut` has it.
void setRemoved(RunMetrics& metrics, const Exercise& exercise, const CarveJournal& journal,
                const CutVoxels& cut, const GridGeometry& geometry);

// Of a recording, but for removal, which only a replay can tell (replay.h). Errors: those of
// SessionReader, CANCELLED.
Result<RunMetrics> metricsOf(const SessionReader& recording, const Progress& progress = Progress());

}  // namespace trephine
