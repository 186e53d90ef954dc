#include "training/replay.h"

#include <algorithm>
#include <cstring>

#include "base/codes.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/tr.h"
#include "exercise/exercise.h"
#include "exercise/exercise_structures.h"
#include "haptics/haptic_core.h"
#include "training/codes.h"
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

// Of the fields that a recording of this version has.
template <class Record>
std::optional<ReplayDifference> compare(std::span<const RecordField> fields, const Record& recorded,
                                        const Record& replayed, std::uint64_t tick, int arm,
                                        int version = kRecordingVersion) {
  const auto* a = reinterpret_cast<const unsigned char*>(&recorded);
  const auto* b = reinterpret_cast<const unsigned char*>(&replayed);
  for (const RecordField& field : fields) {
    if (field.since > version) continue;
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
  const TissueTable *of_a = a.command.tissues, *of_b = b.command.tissues;
  const bool tissues = of_a == of_b || (of_a && of_b && *of_a == *of_b);
  return tissues && !compare(eventFields(), a, b, a.tick, a.arm);
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
      return Error{
          code::kNotReplayable,
          tr("The recording's tick {} tells of a journal ({}) that the replay cannot come to", tick,
             recorded),
          "ticks: journal",
          tr("Replay the recording as it was made: this one is damaged or was changed")};
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
  const auto wrong = [](const std::string& what, const std::string& next) {
    return Error{code::kWrongLabels, what, "--labels", next};
  };
  const bool had = !header.labels_sha256.empty();
  if (had && !given) {
    return wrong(tr("The session was recorded with a label map, and none was given"),
                 tr("Give the label map that the session was run with"));
  }
  if (!had && given) {
    return wrong(tr("The session was recorded without a label map"), tr("Leave the label map out"));
  }
  if (!given) return RecordedLabels();
  Result<LabelMap> fitted = fitTo(*given, header.geometry);
  if (!fitted) return fitted.error();
  // As they were placed: with the shells that its tissues asked for.
  const auto structures = std::make_shared<const LabelMap>(*std::move(fitted));
  auto labels = withShells(tissues, structures);
  if (labelsSha256(*labels) != header.labels_sha256) {
    return wrong(tr("The label map is not the one that was recorded: its labels differ"),
                 tr("Give the label map that the session was run with"));
  }
  return RecordedLabels{structures, std::move(labels)};
}

// What the core was made of that the recording was made with.
HapticParameters recordedParameters(const Exercise& exercise, const Rig& rig, int version) {
  HapticParameters parameters = hapticParameters(exercise, rig);
  parameters.touch_version = std::min(version, kTouchVersion);
  return parameters;
}

}  // namespace

struct ReplayedSession::Run {
  Run(const SessionReader& of, const RecordedExercise& recorded, RecordedLabels fitted,
      const Volume& volume)
      : recording(of),
        exercise(recorded.exercise),
        labels(std::move(fitted)),
        // The same voxels may come from a file that rounds their place.
        grid(Volume{of.header().geometry, volume.hu}, labels.placed),
        core(recordedParameters(exercise, recorded.rig, of.header().version), *grid.takeWriter()) {}

  const SessionReader& recording;
  Exercise exercise;
  RecordedLabels labels;
  Grid grid;
  HapticCore core;
  std::unique_ptr<JournalFile> journal_file;
  std::vector<Event> events;
  std::vector<CarveRecord> carves;
  std::vector<TickRecord> block;  // ticks of the recording from block_first on
  std::uint64_t block_first = 0, ticks = 0;
  std::size_t next_event = 0, next_carve = 0;
  std::vector<Command> commands;  // of a tick
  TickRecord replayed;
  LoopState state;
  std::optional<ReplayDifference> first_difference;
  bool failed = false;  // a step ended in an error

  Status readBlock();
  Status tick(RecordSink* sink);
  TickInput inputOf(const TickRecord& recorded);
  void compareTick(const TickRecord& recorded, std::size_t first_event);
};

// The tick that comes next is in it afterwards.
Status ReplayedSession::Run::readBlock() {
  constexpr std::uint64_t kBlock = 4096;
  if (ticks < block_first + block.size()) return {};
  auto read = recording.ticks(ticks, std::min(kBlock, recording.tickCount() - ticks));
  if (!read) return read.error();
  block = *std::move(read);
  block_first = ticks;
  return {};
}

// What the core was given, and with `commands` what it was told; next_event moves on.
TickInput ReplayedSession::Run::inputOf(const TickRecord& recorded) {
  TickInput input{recorded.tick, recorded.late_ns, recorded.journal, false, {}};
  for (std::size_t i = 0; i < recording.armCount(); ++i) {
    const ArmRecord& arm = recorded.arms[i];
    input.arms[i] = {arm.device_position_m, arm.device_orientation, arm.buttons, arm.flags};
  }
  commands.clear();
  for (; next_event < events.size() && events[next_event].tick <= recorded.tick; ++next_event) {
    const Event& event = events[next_event];
    if (event.kind == EventKind::command) commands.push_back(event.command);
    if (event.kind == EventKind::silenced) input.silenced = true;
  }
  return input;
}

void ReplayedSession::Run::compareTick(const TickRecord& recorded, std::size_t first_event) {
  auto& difference = first_difference;
  for (std::size_t i = 0; !difference && i < recording.armCount(); ++i) {
    difference = compare(armFields(), recorded.arms[i], replayed.arms[i], recorded.tick, int(i),
                         recording.header().version);
  }
  if (!difference) difference = compareCarves(carves, next_carve, core.carves(), recorded.tick);
  if (!difference) {
    difference = compareEvents(std::span(events).subspan(first_event, next_event - first_event),
                               core.events(), recorded.tick);
  }
}

ReplayedSession::ReplayedSession(std::unique_ptr<Run> run) : run_(std::move(run)) {}
ReplayedSession::~ReplayedSession() = default;

const Exercise& ReplayedSession::exercise() const {
  return run_->exercise;
}

LoopState ReplayedSession::state() {
  return run_->state;
}

Grid& ReplayedSession::grid() {
  return run_->grid;
}

std::uint64_t ReplayedSession::ticks() const {
  return run_->ticks;
}

const std::optional<ReplayDifference>& ReplayedSession::firstDifference() const {
  return run_->first_difference;
}

const std::shared_ptr<const LabelMap>& ReplayedSession::structures() const {
  return run_->labels.structures;
}

void ReplayedSession::setRemovedIn(RunMetrics& metrics, const Volume& before) const {
  const TrueTissues tissues(run_->exercise.tissues, before, run_->grid.labels().get(),
                            run_->exercise.case_source);
  setRemoved(metrics, run_->exercise, run_->core.journal(), cutVoxels(tissues, before, run_->grid),
             before.geometry);
}

Result<std::unique_ptr<ReplayedSession>> ReplayedSession::open(const SessionReader& recording,
                                                               const Volume& volume,
                                                               const LabelMap* labels,
                                                               const std::string& sha256) {
  const RecordingHeader& header = recording.header();
  if (volume.geometry.size != header.geometry.size ||
      (sha256.empty() ? volumeSha256(volume) : sha256) != header.volume_sha256) {
    return Error{code::kWrongCase,
                 tr("The case is not the one that was recorded: its voxels differ"), "--case",
                 tr("Give the folder that the session was run on")};
  }
  if (recording.end() && recording.end()->dropped > 0) {
    return Error{code::kNotReplayable,
                 tr("The recorder fell behind and dropped {} entries", recording.end()->dropped),
                 tr("the recording"), tr("Record again on a machine with less load")};
  }
  const Result<RecordedExercise> recorded =
      parseRecordedExercise(header.exercise, tr("the recording"));
  if (!recorded) return recorded.error();
  Result<std::vector<Event>> events = recording.events();
  if (!events) return events.error();
  Result<std::vector<CarveRecord>> carves = recording.carves();
  if (!carves) return carves.error();
  Result<RecordedLabels> fitted = recordedLabels(header, recorded->exercise.tissues, labels);
  if (!fitted) return fitted.error();
  const double needed_mb = exerciseMb(volume.geometry.voxelCount());
  if (Status enough = enoughMemory(needed_mb, tr("The replay"), tr("the case")); !enough) {
    return enough.error();
  }
  const Result<std::filesystem::path> temporary = temporaryFolder();
  if (!temporary) return temporary.error();
  Result<std::unique_ptr<JournalFile>> journal_file = JournalFile::create(*temporary);
  if (!journal_file) return journal_file.error();
  auto run = std::make_unique<Run>(recording, *recorded, *std::move(fitted), volume);
  run->journal_file = *std::move(journal_file);
  run->events = *std::move(events);
  run->carves = *std::move(carves);
  return std::unique_ptr<ReplayedSession>(new ReplayedSession(std::move(run)));
}

Status ReplayedSession::Run::tick(RecordSink* sink) {
  if (Status read = readBlock(); !read) return read;
  const TickRecord& recorded = block[std::size_t(ticks - block_first)];
  if (recorded.tick != ticks) {
    return Error{code::kNotReplayable, tr("The recorder fell behind: tick {} is missing", ticks),
                 tr("the recording"), tr("Record again on a machine with less load")};
  }
  const std::size_t first_event = next_event;
  const TickInput input = inputOf(recorded);
  if (Status served = serveJournal(core, *journal_file, recorded.tick, recorded.journal);
      !served) {
    return served;
  }
  core.tick(input, commands.data(), commands.size(), replayed);
  ++ticks;
  setState(state, core, replayed);
  state.ticks = ticks;
  if (sink) {
    sink->tick(replayed);
    for (const CarveRecord& carve : core.carves()) sink->carve(carve);
    for (const Event& event : core.events()) sink->event(event);
  }
  compareTick(recorded, first_event);
  return {};
}

Result<bool> ReplayedSession::step(RecordSink* sink) {
  Run& run = *run_;
  if (run.failed || run.first_difference || run.ticks == run.recording.tickCount()) return false;
  if (Status done = run.tick(sink); !done) {
    run.failed = true;
    return done.error();
  }
  return !run.first_difference;
}

void ReplayedSession::tellRest(RecordSink& sink) const {
  const Run& run = *run_;
  for (std::size_t n = run.next_event; n < run.events.size(); ++n) sink.event(run.events[n]);
}

std::optional<ReplayDifference> ReplayedSession::differenceAtEnd(
    const std::string& volume_sha256) const {
  const Run& run = *run_;
  if (!run.recording.end()) return {};  // cut short, it may know of more than of its last tick
  if (auto left = whatIsLeft(std::span(run.events).subspan(run.next_event),
                             std::span(run.carves).subspan(run.next_carve), run.ticks)) {
    return left;
  }
  const std::string& recorded = run.recording.end()->volume_sha256;
  if (recorded == volume_sha256) return {};
  return ReplayDifference{run.ticks, -1, "volume_sha256", recorded, volume_sha256};
}

Result<ReplayResult> replay(const SessionReader& recording, const Volume& volume,
                            const LabelMap* labels, const Progress& progress,
                            const std::string& sha256) {
  auto opened = ReplayedSession::open(recording, volume, labels, sha256);
  if (!opened) return opened.error();
  ReplayedSession& session = **opened;
  RunMeter meter(session.exercise());
  constexpr std::uint64_t kLook = 4096;  // ticks
  for (bool more = true; more;) {
    if (session.ticks() % kLook == 0) {
      progress.at(
          double(session.ticks()) / double(std::max<std::uint64_t>(1, recording.tickCount())),
          tr("Replaying"));
      if (progress.cancelled())
        return Error{code::kCancelled, tr("The replay was cancelled"), "", ""};
    }
    const Result<bool> stepped = session.step(&meter);
    if (!stepped) return stepped.error();
    more = *stepped;
  }
  ReplayResult result;
  result.ticks = session.ticks();
  result.cut_short = !recording.end();
  result.volume_sha256 = slabsSha256(slabsOf(session.grid()));
  result.first_difference = session.firstDifference();
  if (!result.first_difference) {
    result.first_difference = session.differenceAtEnd(result.volume_sha256);
  }
  result.identical = !result.first_difference;
  if (session.structures()) {
    result.structures_cut = cutStructures(*session.structures(), volume, session.grid());
  }
  if (result.identical) session.tellRest(meter);
  result.metrics = meter.metrics();
  session.setRemovedIn(result.metrics, volume);
  return result;
}

}  // namespace trephine
