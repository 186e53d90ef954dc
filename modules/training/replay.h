// Runs a recording through the core again, without hardware, and compares every bit: of the arms,
// the removed voxels and the events. At once, or tick by tick to be looked at.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "training/run_metrics.h"
#include "training/session_reader.h"
#include "training/session_view.h"
#include "volume/cut_structures.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct ReplayDifference {
  std::uint64_t tick = 0;
  int arm = -1;
  std::string field;
  Json recorded, replayed;
};

// A recording as a session that goes on by step(). It stops for good at the first difference, and
// at an error.
class ReplayedSession : public SessionView {
 public:
  // `recording` outlives it. `volume` is the case before the first tick, of which a copy is cut;
  // `sha256` is of its voxels, or empty: then it is taken here; `labels` the label map that the
  // session had, as it was read, or null. Errors: OUT_OF_MEMORY, WRONG_CASE (another sha256 than
  // recorded), WRONG_LABELS (another label map, one too many, or none), those of fitTo,
  // NOT_REPLAYABLE (the recorder dropped something), BAD_RECORDING, NO_TEMPORARY_FOLDER, those of
  // JournalFile.
  static Result<std::unique_ptr<ReplayedSession>> open(const SessionReader& recording,
                                                       const Volume& volume,
                                                       const LabelMap* labels = nullptr,
                                                       const std::string& sha256 = "");
  ~ReplayedSession() override;

  const Exercise& exercise() const override;
  LoopState state() override;
  Grid& grid() override;

  // Does the next tick; `sink` takes what it came to, or is null. False at the end, and where this
  // tick came to other bits than were recorded. Errors: BAD_RECORDING, NOT_REPLAYABLE, those of
  // JournalFile.
  Result<bool> step(RecordSink* sink = nullptr);
  // What the recording says of the tick that did not come: that a device was left behind.
  void tellRest(RecordSink& sink) const;
  std::uint64_t ticks() const;  // done
  const std::optional<ReplayDifference>& firstDifference() const;
  // Of the recording, after the last tick: what it holds beyond it, and another volume at its end.
  std::optional<ReplayDifference> differenceAtEnd(const std::string& volume_sha256) const;
  // Of the case, fitted; null: none.
  const std::shared_ptr<const LabelMap>& structures() const;
  // What is removed by now; `before`: the volume that it was opened with.
  void setRemovedIn(RunMetrics& metrics, const Volume& before) const;

 private:
  struct Run;
  explicit ReplayedSession(std::unique_ptr<Run> run);
  std::unique_ptr<Run> run_;
};

struct ReplayResult {
  std::uint64_t ticks = 0;
  bool identical = false;
  std::optional<ReplayDifference> first_difference;
  std::string volume_sha256;  // after the last replayed tick
  std::vector<CutStructure> structures_cut;  // by then; empty without a label map
  bool cut_short = false;     // the recording has no end: it was killed
  RunMetrics metrics;         // of what was replayed
};

// All of it. Errors: those of ReplayedSession, CANCELLED.
Result<ReplayResult> replay(const SessionReader& recording, const Volume& volume,
                            const LabelMap* labels = nullptr, const Progress& progress = Progress(),
                            const std::string& sha256 = "");

}  // namespace trephine
