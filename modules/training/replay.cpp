#include "training/replay.h"

#include <algorithm>
#include <cstring>

#include "base/file.h"
#include "base/memory.h"
#include "haptics/haptic_core.h"
#include "exercise/exercise.h"
#include "exercise/exercise_structures.h"
#include "training/recording_layout.h"
#include "volume/case_memory.h"
#include "volume/journal_file.h"
#include "volume/voxel_slabs.h"

namespace trephine {

namespace {

Json fieldJson(const RecordField& field, const void* record) {
  const auto* at = static_cast<const unsigned char*>(record) + field.offset;
  Json values = Json::array();
  for (std::size_t i = 0; i < field.count; ++i) {
    const unsigned char* element = at + i * field.bytes() / field.count;
    const auto take = [&](auto value) {
      std::memcpy(&value, element, sizeof(value));
      values.push_back(value);
    };
    switch (field.type) {
      case RecordField::Type::f64: take(double{}); break;
      case RecordField::Type::i64: take(std::int64_t{}); break;
      case RecordField::Type::u64: take(std::uint64_t{}); break;
      case RecordField::Type::i32: take(std::int32_t{}); break;
      case RecordField::Type::u32: take(std::uint32_t{}); break;
      case RecordField::Type::i16: take(std::int16_t{}); break;
      case RecordField::Type::i8: take(std::int8_t{}); break;
    }
  }
  return field.count == 1 ? values[0] : values;
}

template <class Record>
std::optional<ReplayDifference> compare(std::span<const RecordField> fields, const Record& recorded,
                                        const Record& replayed, std::uint64_t tick, int arm) {
  const auto* a = reinterpret_cast<const unsigned char*>(&recorded);
  const auto* b = reinterpret_cast<const unsigned char*>(&replayed);
  for (const RecordField& field : fields) {
    if (std::memcmp(a + field.offset, b + field.offset, field.bytes()) != 0) {
      return ReplayDifference{tick, arm, field.name, fieldJson(field, &recorded),
                              fieldJson(field, &replayed)};
    }
  }
  return {};
}

// The recorded voxels of this tick against those the core has just removed; `next` moves on.
std::optional<ReplayDifference> compareCarves(const std::vector<CarveRecord>& recorded,
                                              std::size_t& next,
                                              const std::vector<CarveRecord>& replayed,
                                              std::uint64_t tick) {
  for (const CarveRecord& carve : replayed) {
    if (next == recorded.size()) {
      return ReplayDifference{tick, carve.arm, "removed_voxels", nullptr, carve.voxel};
    }
    if (auto d = compare(carveFields(), recorded[next], carve, tick, carve.arm)) return d;
    ++next;
  }
  if (next < recorded.size() && recorded[next].tick <= tick) {
    const CarveRecord& missed = recorded[next];
    return ReplayDifference{tick, missed.arm, "removed_voxels", missed.voxel, nullptr};
  }
  return {};
}

Json eventJson(const Event& event) {
  Json json = Json::object();
  for (const RecordField& field : eventFields()) json[field.name] = fieldJson(field, &event);
  return json;
}

bool same(const Event& a, const Event& b) {
  return !compare(eventFields(), a, b, a.tick, a.arm) && a.command.tissues == b.command.tissues;
}

// The recorded events of this tick against those of the core: strokes, faults, what was let go.
std::optional<ReplayDifference> compareEvents(std::span<const Event> recorded,
                                              const std::vector<Event>& replayed,
                                              std::uint64_t tick) {
  for (std::size_t i = 0; i < std::max(recorded.size(), replayed.size()); ++i) {
    const Event* was = i < recorded.size() ? &recorded[i] : nullptr;
    const Event* is = i < replayed.size() ? &replayed[i] : nullptr;
    if (was && is && same(*was, *is)) continue;
    return ReplayDifference{tick, (was ? was : is)->arm, "events",
                            was ? eventJson(*was) : Json(nullptr),
                            is ? eventJson(*is) : Json(nullptr)};
  }
  return {};
}

// What a recording that ended in order holds beyond its last tick: of an arm that was left behind
// alone, in the tick that did not come.
std::optional<ReplayDifference> whatIsLeft(std::span<const Event> events,
                                           std::span<const CarveRecord> carves,
                                           std::uint64_t ticks) {
  for (const Event& event : events) {
    const bool stuck = event.kind == EventKind::fault && event.value == kFaultStuck;
    if (event.tick == ticks && (stuck || event.kind == EventKind::silenced)) continue;
    return ReplayDifference{event.tick, event.arm, "events", eventJson(event), nullptr};
  }
  if (carves.empty()) return {};
  const CarveRecord& carve = carves.front();
  return ReplayDifference{carve.tick, carve.arm, "removed_voxels", carve.voxel, nullptr};
}

// Gets the journal to where it allows at least what it allowed when this was recorded.
Status serveJournal(HapticCore& core, JournalFile& journal_file, std::uint64_t tick,
                    std::uint32_t recorded) {
  constexpr int kTries = 1000;
  for (int tries = 0; (core.journalState() & recorded) != recorded; ++tries) {
    if (Status served = journal_file.service(core.journal()); !served) return served;
    if (tries == kTries) {
      return Error{"NOT_REPLAYABLE",
                   "The recording's tick " + std::to_string(tick) + " tells of a journal (" +
                       std::to_string(recorded) + ") that the replay cannot come to",
                   "ticks: journal",
                   "Replay the recording as it was made: this one is damaged or was changed"};
    }
  }
  return {};
}

// Null where the session had none.
struct RecordedLabels {
  std::shared_ptr<const LabelMap> structures;  // of the case
  std::shared_ptr<const LabelMap> placed;      // as the session had them
};

Result<RecordedLabels> recordedLabels(const RecordingHeader& header, const TissueSet& tissues,
                                      const LabelMap* given) {
  const auto wrong = [](const char* what, const char* next) {
    return Error{"WRONG_LABELS", what, "--labels", next};
  };
  const bool had = !header.labels_sha256.empty();
  if (had && !given) {
    return wrong("The session was recorded with a label map, and none was given",
                 "Give the label map that the session was run with");
  }
  if (!had && given) {
    return wrong("The session was recorded without a label map", "Leave the label map out");
  }
  if (!given) return RecordedLabels();
  Result<LabelMap> fitted = fitTo(*given, header.geometry);
  if (!fitted) return fitted.error();
  // As they were placed: with the shells that its tissues asked for.
  const auto structures = std::make_shared<const LabelMap>(*std::move(fitted));
  auto labels = withShells(tissues, structures);
  if (labelsSha256(*labels) != header.labels_sha256) {
    return wrong("The label map is not the one that was recorded: its labels differ",
                 "Give the label map that the session was run with");
  }
  return RecordedLabels{structures, std::move(labels)};
}

}  // namespace

Result<ReplayResult> replay(const SessionReader& recording, const Volume& volume,
                            const LabelMap* labels, const Progress& progress,
                            const std::string& sha256) {
  const RecordingHeader& header = recording.header();
  if (volume.geometry.size != header.geometry.size ||
      (sha256.empty() ? volumeSha256(volume) : sha256) != header.volume_sha256) {
    return Error{"WRONG_CASE", "The case is not the one that was recorded: its voxels differ", "--case",
                 "Give the folder that the session was run on"};
  }
  if (recording.end() && recording.end()->dropped > 0) {
    return Error{"NOT_REPLAYABLE",
                 "The recorder fell behind and dropped " +
                     std::to_string(recording.end()->dropped) + " entries",
                 "the recording", "Record again on a machine with less load"};
  }
  const Result<RecordedExercise> recorded = parseRecordedExercise(header.exercise, "the recording");
  if (!recorded) return recorded.error();
  const Exercise& exercise = recorded->exercise;
  Result<std::vector<Event>> events = recording.events();
  if (!events) return events.error();
  Result<std::vector<CarveRecord>> carves = recording.carves();
  if (!carves) return carves.error();

  Result<RecordedLabels> fitted = recordedLabels(header, exercise.tissues, labels);
  if (!fitted) return fitted.error();

  const double needed_mb = exerciseMb(volume.geometry.voxelCount());
  if (Status enough = enoughMemory(needed_mb, "The replay", "the case"); !enough) {
    return enough.error();
  }
  // The same voxels may come from a file that rounds their place.
  Grid grid(Volume{header.geometry, volume.hu}, fitted->placed);
  HapticCore core(hapticParameters(exercise, recorded->rig), *grid.takeWriter());
  const Result<std::filesystem::path> temporary = temporaryFolder();
  if (!temporary) return temporary.error();
  Result<std::unique_ptr<JournalFile>> journal_file = JournalFile::create(*temporary);
  if (!journal_file) return journal_file.error();
  ReplayResult result;
  result.cut_short = !recording.end();
  std::size_t next_event = 0, next_carve = 0;
  std::vector<Command> commands;
  constexpr std::uint64_t kBlock = 4096;
  const std::uint64_t total = recording.tickCount();
  for (std::uint64_t first = 0; first < total && !result.first_difference; first += kBlock) {
    progress.at(double(first) / double(total), "Replaying");
    if (progress.cancelled()) return Error{"CANCELLED", "The replay was cancelled", "", ""};
    Result<std::vector<TickRecord>> block = recording.ticks(first, std::min(kBlock, total - first));
    if (!block) return block.error();
    for (const TickRecord& recorded : *block) {
      if (recorded.tick != result.ticks) {
        return Error{"NOT_REPLAYABLE",
                     "The recorder fell behind: tick " + std::to_string(result.ticks) + " is missing",
                     "the recording", "Record again on a machine with less load"};
      }
      TickInput input{recorded.tick, recorded.late_ns, recorded.journal, false, {}};
      for (std::size_t i = 0; i < recording.armCount(); ++i) {
        const ArmRecord& arm = recorded.arms[i];
        input.arms[i] = {arm.device_position_m, arm.device_orientation, arm.buttons, arm.flags};
      }
      commands.clear();
      const std::size_t first_event = next_event;
      for (; next_event < events->size() && (*events)[next_event].tick <= recorded.tick; ++next_event) {
        const Event& event = (*events)[next_event];
        if (event.kind == EventKind::command) commands.push_back(event.command);
        if (event.kind == EventKind::silenced) input.silenced = true;
      }
      if (Status served = serveJournal(core, **journal_file, recorded.tick, recorded.journal);
          !served) {
        return served.error();
      }
      TickRecord replayed;
      core.tick(input, commands.data(), commands.size(), replayed);
      ++result.ticks;
      auto& difference = result.first_difference;
      for (std::size_t i = 0; !difference && i < recording.armCount(); ++i) {
        difference =
            compare(armFields(), recorded.arms[i], replayed.arms[i], recorded.tick, int(i));
      }
      if (!difference) difference = compareCarves(*carves, next_carve, core.carves(), recorded.tick);
      if (!difference) {
        const std::span all(*events);
        difference = compareEvents(all.subspan(first_event, next_event - first_event),
                                   core.events(), recorded.tick);
      }
      if (difference) break;
    }
  }
  // A recording that was cut short may know of more than of its last whole tick.
  if (!result.first_difference && !result.cut_short) {
    result.first_difference = whatIsLeft(std::span(*events).subspan(next_event),
                                         std::span(*carves).subspan(next_carve), result.ticks);
  }
  result.volume_sha256 = slabsSha256(slabsOf(grid));
  if (fitted->structures) {
    result.structures_cut = cutStructures(*fitted->structures, volume, grid);
  }
  if (!result.first_difference && recording.end() &&
      recording.end()->volume_sha256 != result.volume_sha256) {
    result.first_difference = ReplayDifference{result.ticks, -1, "volume_sha256",
                                               recording.end()->volume_sha256, result.volume_sha256};
  }
  result.identical = !result.first_difference;
  return result;
}

}  // namespace trephine
