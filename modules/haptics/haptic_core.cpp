#include "haptics/haptic_core.h"

#include <algorithm>
#include <utility>

namespace trephine {

namespace {

// Undo, redo and rewind move at most this many voxels a tick.
constexpr std::size_t kVoxelsPerSlice = 4096;
constexpr std::size_t kMaxEventsPerTick = 64;

}  // namespace

HapticCore::ArmTool::ArmTool(const Tool& tool, const HapticParameters& all,
                             const GridGeometry& geometry)
    : made(tool),
      contact(tool, geometry, all.touch_by_points),
      removal(tool, geometry, all.removal, all.period_s),
      points(all.force_at == ForceAt::tip ? 1 : tool.points_m.size()) {
  for (LawKind kind : all.laws) laws.push_back(makeLaw(kind, points.size(), tool, geometry));
  if (stopAtSolid(all.laws)) proxy.emplace(tool, geometry, all.touch_version);
  const SoftLaws soft_laws{names(all.laws, LawKind::membrane), names(all.laws, LawKind::cutting),
                           names(all.laws, LawKind::friction),
                           names(all.laws, LawKind::relaxation)};
  if (soft_laws.any()) soft.emplace(tool, geometry, soft_laws, all.period_s);
  const bool driven = tool.made_from.motor_W > 0.0;
  cutting = driven ? Cutting::driven : Cutting::by_hand;
  // A burr without a motor cuts nothing, but where there is no barrier: there it cuts as the seed
  // paper's tools do.
  if (proxy && !driven && tool.made_from.kind == ToolKind::burr) cutting = Cutting::nothing;
}

HapticCore::Arm::Arm(const ArmParameters& arm, const HapticParameters& all,
                     const GridGeometry& geometry) {
  tools.reserve(1 + arm.other_tools.size());
  tools.emplace_back(arm.tool, all, geometry);
  for (const Tool& other : arm.other_tools) tools.emplace_back(other, all, geometry);
  for (const auto& [name, kind] : kControllerNames) {
    controllers.push_back(makeController(kind, arm.dynamics, all.period_s, all.touch_version));
  }
  controller = controllers[std::size_t(all.controller)];
  exercise_map = arm.map;
  removed.reserve(Removal::kMostVoxels);
  removed_indices.reserve(Removal::kMostVoxels);
}

HapticCore::HapticCore(const HapticParameters& parameters, Grid::Writer writer)
    : parameters_(parameters),
      writer_(std::move(writer)),
      journal_(parameters.journal_voxels, parameters.journal_strokes, parameters.journal_seconds),
      tissue_(writer_.grid(), parameters_.tissues),
      stroke_gap_ticks_(std::uint64_t(parameters.stroke_gap_s / parameters.period_s)),
      second_ticks_(std::uint64_t(1.0 / parameters.period_s + 0.5)) {
  for (const ArmParameters& arm : parameters_.arms) {
    arms_.emplace_back(arm, parameters_, writer_.grid().geometry());
  }
  useTissues();
  carves_.reserve(arms_.size() * Removal::kMostVoxels);
  went_.reserve(carves_.capacity());
  events_.reserve(kMaxEventsPerTick);
  changed_.reserve(kVoxelsPerSlice);
}

// Makes anew what the tick derives from the tissues.
void HapticCore::useTissues() {
  const TissueTable& now = parameters_.tissues;
  tissues_finite_ = true;
  any_cuttable_ = false;
  for (int c = 0; c < now.count; ++c) {
    const TissueClass& t = now.classes[std::size_t(c)];
    for (const TissueNumber& number : kTissueNumbers) {
      tissues_finite_ = tissues_finite_ && isFinite(t.*number.in_tick);
    }
    any_cuttable_ = any_cuttable_ || t.cuttable;
  }
  law_tissues_.use(now, parameters_.laws);
}

// Other HU ranges or labels make every brick unknown, and those or another `cuttable` make removal
// begin its pass anew; other numbers keep both.
void HapticCore::changeTissues(const TissueTable& tissues) {
  parameters_.tissues = tissues;
  const bool same_cuts = tissue_.use(tissues) == TissueField::Change::numbers;
  useTissues();
  for (Arm& arm : arms_) {
    if (!same_cuts) arm.tool().removal.forget();
    for (ArmTool& tool : arm.tools) {
      if (tool.proxy) tool.proxy->changed();
    }
  }
}

CarveJournal::Credits HapticCore::credits() const {
  CarveJournal::Credits out{};
  for (std::size_t i = 0; i < arms_.size(); ++i) out[i] = arms_[i].tool().removal.credit_J();
  return out;
}

std::uint32_t HapticCore::journalState() {
  std::uint32_t state = 0;
  if (journal_.hasRoom(arms_.size() * Removal::kMostVoxels)) state |= kJournalRoom;
  if (!journal_.busy() || journal_.canStep(kVoxelsPerSlice)) state |= kJournalReady;
  return state;
}

void HapticCore::tick(const TickInput& input, const Command* commands, std::size_t command_count,
                      TickRecord& record) {
  carves_.clear();
  events_.clear();
  if (journal_.busy() && (input.journal & kJournalReady)) {
    changed_.clear();
    journal_.step(writer_, kVoxelsPerSlice, &changed_);
    for (std::uint32_t voxel : changed_) tissue_.changed(voxel);
    if (!journal_.busy()) finishRestore();
  }
  if (!journal_.busy()) tissue_.recount();
  if (!paused_ && ++ticks_ % second_ticks_ == 0) journal_.mark(credits());
  // The journal lets as many voxels be erased in this tick as it is asked for here.
  may_remove_ = parameters_.removes && (input.journal & kJournalRoom) &&
                journal_.hasRoom(arms_.size() * Removal::kMostVoxels);
  for (std::size_t i = 0; i < command_count; ++i) apply(commands[i], input.tick);

  followLateness(input);

  record.tick = input.tick;
  record.late_ns = input.late_ns;
  record.journal = input.journal;
  for (std::size_t i = 0; i < arms_.size(); ++i) moveArm(i, input, record.arms[i]);
  removeVoxels(input.tick, record);

  const bool full = !(input.journal & kJournalRoom);
  if (full && !reported_full_) events_.push_back({input.tick, EventKind::journal_full, -1, 0, {}});
  reported_full_ = full;
}

void HapticCore::apply(const Command& command, std::uint64_t tick) {
  events_.push_back({tick, EventKind::command, -1, 0, command});
  switch (command.kind) {
    case CommandKind::none:
      break;
    case CommandKind::undo:
      if (journal_.startUndo(credits())) forgetForces(true);
      break;
    case CommandKind::redo:
      if (journal_.startRedo(credits())) forgetForces(true);
      break;
    case CommandKind::reset: {
      const bool restores = journal_.startReset(credits());
      for (std::size_t i = 0; i < arms_.size(); ++i) {
        arms_[i].wanted = 0;  // the exercise's, at once where the tool waits for air anyhow
        if (restores && arms_[i].in_hand != 0) takeTool(i, tick);
      }
      if (restores) forgetForces(true);
      break;
    }
    case CommandKind::rewind:
      if (command.value >= 0 && journal_.startRewind(std::size_t(command.value), credits())) {
        forgetForces(true);
      }
      break;
    case CommandKind::pause:
      paused_ = true;
      break;
    case CommandKind::resume:
      paused_ = false;  // the laws went on feeling where the tools are
      forgetForces(false);
      break;
    case CommandKind::clear_faults:
      for (Arm& arm : arms_) {
        arm.faults = 0;
        arm.errors.clear();
      }
      lateness_.clear();
      for (Arm& arm : arms_) forgetLaws(arm);
      forgetForces(false);
      break;
    case CommandKind::controller:
      if (command.value < 0 || std::size_t(command.value) >= kControllerNames.size()) break;
      parameters_.controller = ControllerKind(command.value);
      for (Arm& arm : arms_) {
        arm.controller = arm.controllers[std::size_t(parameters_.controller)];
        arm.limiter.change();
      }
      break;
    case CommandKind::tissues:
      if (!command.tissues || *command.tissues == parameters_.tissues) break;
      changeTissues(*command.tissues);
      for (Arm& arm : arms_) {
        forgetController(arm.controller);  // it may be holding the force of the tissue before
        arm.limiter.change();
      }
      break;
    case CommandKind::clutch_on:
    case CommandKind::clutch_off:
    case CommandKind::recentre:
      if (command.arm >= 0 && std::size_t(command.arm) < arms_.size()) releaseArm(command);
      break;
    case CommandKind::tool: {
      if (command.arm < 0 || std::size_t(command.arm) >= arms_.size()) break;
      Arm& arm = arms_[std::size_t(command.arm)];
      const bool known = command.value >= 0 && std::size_t(command.value) < arm.tools.size();
      if (known) arm.wanted = std::size_t(command.value);
      break;
    }
    case CommandKind::device_lost:
    case CommandKind::device_back:
      break;
  }
}

void HapticCore::forgetLaws(Arm& arm) {
  for (Law& law : arm.tool().laws) forgetLaw(law);
  if (arm.tool().soft) arm.tool().soft->forget();
}

// The controller begins without credit. After voxels were put back (`restored`), the laws begin
// anew too, and there is no force until the tool is out of tissue.
void HapticCore::forgetForces(bool restored) {
  for (Arm& arm : arms_) forgetForce(arm, restored);
}

void HapticCore::forgetForce(Arm& arm, bool restored) {
  forgetController(arm.controller);
  arm.tool().contact.forget();
  arm.tool().removal.forget();
  arm.work.forget();
  for (ArmTool& tool : arm.tools) {
    if (tool.proxy) tool.proxy->changed();
  }
  if (!restored) return arm.limiter.change();
  forgetLaws(arm);
  arm.limiter.restored();
  arm.waiting = arm.tool().proxy.has_value();
  arm.let_go_share = arm.hooked_s = 0.0;
}

void HapticCore::finishRestore() {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    arms_[i].tool().removal.setCredit(journal_.credits()[i]);
    arms_[i].tool().removal.forget();
    for (ArmTool& tool : arms_[i].tools) {
      if (tool.proxy) tool.proxy->changed();
      if (tool.soft) tool.soft->restored(tissue_);
    }
  }
}

void HapticCore::followLateness(const TickInput& input) {
  if (input.silenced) events_.push_back({input.tick, EventKind::silenced, -1, 0, {}});
  const bool was_away = lateness_.away();
  lateness_.tick(input.late_ns, input.silenced, parameters_.period_s);
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    if (lateness_.kept()) latch(i, kFaultStalled, input.tick);
    if (lateness_.away()) {
      latch(i, kFaultLate, input.tick);
    } else if (was_away) {
      arms_[i].faults &= ~std::uint32_t(kFaultLate);
      arms_[i].limiter.rampIn();
    }
  }
}

void HapticCore::latch(std::size_t index, std::uint32_t fault, std::uint64_t tick) {
  if (arms_[index].faults & fault) return;
  arms_[index].faults |= fault;
  if (events_.size() < kMaxEventsPerTick) {
    events_.push_back({tick, EventKind::fault, std::int32_t(index), fault, {}});
  }
}

}  // namespace trephine
