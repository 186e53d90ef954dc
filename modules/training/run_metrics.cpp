#include "training/run_metrics.h"

#include <algorithm>
#include <cmath>

#include "base/codes.h"
#include "base/tr.h"
#include "exercise/exercise_fields.h"
#include "exercise/names.h"
#include "haptics/laws.h"
#include "training/codes.h"

namespace trephine {

namespace {
constexpr std::size_t kMostFaults = 1000, kMostStrokes = 10'000;
}

bool operator==(const RunMetrics& a, const RunMetrics& b) {
  const auto same = [](const Warning& one, const Warning& other) {
    return one.code == other.code && one.text == other.text;
  };
  return a.rate_hz == b.rate_hz && a.ticks == b.ticks && a.arms == b.arms &&
         a.controllers == b.controllers && a.strokes == b.strokes && a.faults == b.faults &&
         std::ranges::equal(a.warnings, b.warnings, same) && a.removed_mm3 == b.removed_mm3 &&
         a.removed_unnamed_mm3 == b.removed_unnamed_mm3 && a.removed_voxels == b.removed_voxels &&
         a.undos == b.undos && a.rewinds == b.rewinds && a.brought_back_mm3 == b.brought_back_mm3;
}

Warning startsInTissue(const std::string& arm, bool barrier) {
  return {code::kStartsInTissue,
          tr("The tool of the {} arm starts in tissue: {}", arm,
             (barrier ? tr("it has no force and cuts nothing until it has been moved out")
                      : tr("without the elastic law it feels and cuts it from the first moment")))};
}

RunMeter::RunMeter(const Exercise& exercise)
    : tips_mm_(exercise.arms.size()), barrier_(stopAtSolid(exercise.laws)) {
  metrics_.rate_hz = exercise.rate_hz;
  for (const ExerciseArm& arm : exercise.arms) metrics_.arms.push_back({arm.name});
  metrics_.controllers.emplace_back(controllerName(exercise.controller));
}

void RunMeter::tick(const TickRecord& record) {
  ++metrics_.ticks;
  for (std::size_t i = 0; i < metrics_.arms.size(); ++i) {
    const ArmRecord& now = record.arms[i];
    RunMetrics::Arm& arm = metrics_.arms[i];
    arm.max_force_N = std::max(arm.max_force_N, glm::length(now.sent_N));
    if (now.tissue_class >= 0) ++arm.contact_ticks;
    const Vec3& e = now.energy_out_J;
    arm.energy_out_J = std::max(arm.energy_out_J, e.x + e.y + e.z);
    if (!isFinite(now.proxy_position_mm)) continue;
    if (tips_mm_[i]) arm.path_mm += glm::distance(now.proxy_position_mm, *tips_mm_[i]);
    tips_mm_[i] = now.proxy_position_mm;
  }
}

void RunMeter::event(const Event& event) {
  const Command& command = event.command;
  if (event.kind == EventKind::command && command.kind == CommandKind::controller &&
      metrics_.controllers.size() < kMostFaults) {
    const std::string name(controllerName(ControllerKind(command.value)));
    if (name != metrics_.controllers.back()) metrics_.controllers.push_back(name);
  }
  if (event.kind == EventKind::command && !metrics_.strokes.empty()) {
    metrics_.undos += command.kind == CommandKind::undo;
    metrics_.rewinds += command.kind == CommandKind::rewind || command.kind == CommandKind::reset;
  }
  paused_.add(event);
  if (event.arm < 0 || std::size_t(event.arm) >= metrics_.arms.size()) return;
  const std::string& arm = metrics_.arms[std::size_t(event.arm)].name;
  switch (event.kind) {
    case EventKind::stroke_began:
      if (metrics_.strokes.size() >= kMostStrokes) break;
      metrics_.strokes.push_back(
          {double(event.tick - paused_.ended()) / metrics_.rate_hz, event.arm});
      break;
    case EventKind::starts_in_tissue:
      warn(startsInTissue(arm, barrier_));
      break;
    case EventKind::let_go:
      warn({code::kLetGo,
            tr("The tool of the {} arm was hooked behind solid tissue {} s after the start, while "
               "the arm was free: it was let go",
               arm, plainNumber(std::round(double(event.tick) / metrics_.rate_hz * 10.0) / 10.0))});
      break;
    case EventKind::fault:
      if (metrics_.faults.size() >= kMostFaults) break;
      metrics_.faults.push_back({event.tick, event.arm, event.value});
      break;
    default:
      break;
  }
}

void RunMeter::warn(Warning warning) {
  if (metrics_.warnings.size() < kMostFaults) metrics_.warnings.push_back(std::move(warning));
}

void setRemoved(RunMetrics& metrics, const Exercise& exercise, const CarveJournal& journal,
                const CutVoxels& cut, const GridGeometry& geometry) {
  const double voxel_mm3 = geometry.voxelVolume_mm3();
  const std::vector<Tissue>& tissues = exercise.tissues.tissues;
  metrics.removed_mm3.clear();
  for (std::size_t t = 0; t < tissues.size(); ++t) {
    metrics.removed_mm3.emplace_back(tissues[t].id, double(cut.of_tissue[t]) * voxel_mm3);
  }
  metrics.removed_unnamed_mm3 = double(cut.unnamed) * voxel_mm3;
  metrics.removed_voxels = 0;
  for (std::size_t i = 0; i < metrics.arms.size(); ++i) {
    for (std::size_t t = 0; t < tissues.size(); ++t) {
      metrics.removed_voxels += journal.removed(int(i), int(t));
    }
    metrics.arms[i].removed_mm3 = double(journal.paid(int(i))) * voxel_mm3 / kVoxelShares;
  }
  metrics.brought_back_mm3 = double(journal.entryCount() - metrics.removed_voxels) * voxel_mm3;
}

Result<RunMetrics> metricsOf(const SessionReader& recording, const Progress& progress) {
  const auto recorded = parseRecordedExercise(recording.header().exercise, tr("the recording"));
  if (!recorded) return recorded.error();
  RunMeter meter(recorded->exercise);
  const auto events = recording.events();
  if (!events) return events.error();
  constexpr std::uint64_t kBlock = 4096;
  const std::uint64_t total = recording.tickCount();
  for (std::uint64_t first = 0; first < total; first += kBlock) {
    progress.at(double(first) / double(total), tr("Reading the recording"));
    if (progress.cancelled())
      return Error{code::kCancelled, tr("Reading it was cancelled"), "", ""};
    const auto block = recording.ticks(first, std::min(kBlock, total - first));
    if (!block) return block.error();
    for (const TickRecord& record : *block) meter.tick(record);
  }
  for (const Event& event : *events) meter.event(event);
  return meter.metrics();
}

}  // namespace trephine
