// Runs a recording through the core again, without hardware, and compares every bit: of the arms,
// the removed voxels and the events.
#pragma once

#include <optional>
#include <string>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "training/session_reader.h"
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

struct ReplayResult {
  std::uint64_t ticks = 0;
  bool identical = false;
  std::optional<ReplayDifference> first_difference;
  std::string volume_sha256;  // after the last replayed tick
  std::vector<CutStructure> structures_cut;  // by then; empty without a label map
  bool cut_short = false;     // the recording has no end: it was killed
};

// `volume` is the case before the first tick, of which a copy is cut; `sha256` is of its voxels, or
// empty: then it is taken here; `labels` the label map that the session had, as it was read, or
// null. Errors: OUT_OF_MEMORY, WRONG_CASE (another sha256 than recorded), WRONG_LABELS (another
// label map, one too many, or none), those of fitTo, NOT_REPLAYABLE (the recorder dropped
// something), BAD_RECORDING, NO_TEMPORARY_FOLDER, those of JournalFile, CANCELLED.
Result<ReplayResult> replay(const SessionReader& recording, const Volume& volume,
                            const LabelMap* labels = nullptr, const Progress& progress = Progress(),
                            const std::string& sha256 = "");

}  // namespace trephine
