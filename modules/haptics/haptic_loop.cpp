#include "haptics/haptic_loop.h"

#include <algorithm>

#include "base/rt/alloc_guard.h"

namespace trephine {

HapticLoop::HapticLoop(HapticCore& core, std::vector<LoopDevice> devices, Operator* oper,
                       std::uint64_t first_tick)
    : core_(core), devices_(std::move(devices)), operator_(oper), tick_(first_tick) {
  arm_states_.resize(kMaxArms);
  arm_commands_.resize(kMaxArms);
}

Status HapticLoop::startDevices() {
  if (Status possible = validate(core_.parameters()); !possible) return possible;
  if (operator_) {  // the arms stand at their first set-point before anything moves
    std::array<OperatorSetPoint, kMaxArms> set_points{};
    operator_->setPoints(0, set_points.data(), core_.parameters().arms.size());
    for (LoopDevice& d : devices_) {
      for (std::size_t i = 0; i < d.arms.size(); ++i) {
        const OperatorSetPoint& at = set_points[d.arms[i]];
        d.device->setTarget(i, at.pose_m, at.stiffness_N_per_m, at.damping_Ns_per_m);
      }
    }
  }
  for (LoopDevice& d : devices_) {
    if (Status started = d.device->start(); !started) return started;
  }
  return {};
}

bool HapticLoop::stopDevices() {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (!calls_.make(i, [&] { devices_[i].device->stop(); })) return false;
  }
  return true;
}

void HapticLoop::silence() {
  calls_.calledLast(devices_.size(), [this](std::size_t i) { devices_[i].device->safeStop(); });
}

void HapticLoop::closeOthers(std::size_t left_behind) {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (i != left_behind) devices_[i].device.reset();
  }
}

bool HapticLoop::step(std::int64_t late_ns) {
  HostClock clock;
  const std::int64_t begin_ns = clock.now_ns();
  {
    rt::NoAllocation guard;
    const std::uint64_t tick = tick_.load(std::memory_order_relaxed);
    TickInput input;
    input.tick = tick;
    input.late_ns = late_ns;
    input.journal = core_.journalState();
    // Of a standstill for which a tick came late, that tick's lateness is counted already, however
    // late the word of it comes.
    const std::uint64_t silenced_at = silenced_at_.exchange(0);
    input.silenced = silenced_at != 0 && !(stalled_ && last_stall_ + 1 >= silenced_at);
    if (late_ns > kStallLate_ns) {
      stalled_ = true;
      last_stall_ = tick;
    }

    // One a tick: a second undo would find the first one still at work.
    Command command;
    const bool commanded =
        core_.acceptsCommands() &&
        (commands_.pop(command) || (operator_ && operator_->command(tick, command)));
    if (commanded) obey(command);
    if (!read(input, begin_ns)) return false;
    TickRecord record;
    core_.tick(input, &command, commanded ? 1 : 0, record);
    arms_at_fault_ = std::ranges::any_of(
        record.arms, [](const ArmRecord& arm) { return (arm.faults & ~kPassingFaults) != 0; });
    if (operator_) operator_->moved(record, core_.parameters());

    // The record last: who finds it finds all that belongs to it. Before the force goes out, so
    // that a device that does not take it leaves a whole recording.
    for (const CarveRecord& carve : core_.carves()) carves_.push(carve);
    for (const Event& event : core_.events()) events_.push(event);
    records_.push(record);
    tick_.store(tick + 1, std::memory_order_release);
    if (!write(record)) return false;
    publish(record);
  }
  durations_.add(clock.now_ns() - begin_ns);
  return true;
}

bool HapticLoop::read(TickInput& input, std::int64_t now_ns) {
  const std::size_t arm_count = core_.parameters().arms.size();
  const double period_s = core_.parameters().period_s;
  std::array<OperatorSetPoint, kMaxArms> set_points{};
  if (operator_) operator_->setPoints(input.tick, set_points.data(), arm_count);
  std::uint32_t pedal = 0;
  for (std::size_t place = 0; place < devices_.size(); ++place) {
    LoopDevice& d = devices_[place];
    for (std::size_t i = 0; operator_ && i < d.arms.size(); ++i) {
      const OperatorSetPoint& at = set_points[d.arms[i]];
      d.device->setTarget(i, at.pose_m, at.stiffness_N_per_m, at.damping_Ns_per_m);
    }
    if (!calls_.make(place, [&] { d.device->read(period_s, arm_states_.data()); })) return false;
    for (std::size_t i = 0; i < d.arms.size(); ++i) {
      take(d.arms[i], arm_states_[i], d.real, now_ns);
    }
    if (!d.arms.empty()) continue;
    pedal_lost_ = arm_states_[0].flags & TREPHINE_ARM_LOST;
    without_pedal_ = without_pedal_ && pedal_lost_;
    constexpr std::uint32_t kPedals = 7, kFirstBit = 8;
    const std::uint32_t down = (arm_states_[0].buttons & kPedals) << kFirstBit;
    if (!without_pedal_) pedal = kPedalThere | (pedal_lost_ ? kPedalLost : down);
  }
  input.arms = last_samples_;
  for (std::size_t i = 0; i < arm_count; ++i) input.arms[i].buttons |= pedal;
  return true;
}

void HapticLoop::take(std::size_t arm, const TrephineArmState& state, bool real,
                      std::int64_t now_ns) {
  ArmSample& sample = last_samples_[arm];
  if (!(state.flags & TREPHINE_ARM_LOST)) {
    sample.position_m = {state.position_m[0], state.position_m[1], state.position_m[2]};
    sample.orientation = Quat(state.orientation[0], state.orientation[1], state.orientation[2],
                              state.orientation[3]);
    sample.buttons = state.buttons & kArmButtons;
  }
  sample.flags = state.flags;
  const auto by_clock = real ? std::optional<std::int64_t>(now_ns) : std::nullopt;
  const bool silent = silences_[arm].tick(state.sequence, core_.parameters().period_s, by_clock);
  if (silent || lost_by_command_[arm]) sample.flags |= TREPHINE_ARM_LOST;
  if (probe_) probe_->sampled(arm, state);
  if (!real) return;
  const bool lost = sample.flags & TREPHINE_ARM_LOST;
  const bool held = hands_[arm].tick({sample.position_m, sample.orientation}, sample.buttons, lost);
  if (!held) sample.flags |= TREPHINE_ARM_NO_HAND;
}

// What a person or a script says of a device.
void HapticLoop::obey(const Command& command) {
  const bool of_pedal = command.kind == CommandKind::clear_faults && pedal_lost_ && !arms_at_fault_;
  without_pedal_ = without_pedal_ || of_pedal;
  const bool lost = command.kind == CommandKind::device_lost;
  if (!lost && command.kind != CommandKind::device_back) return;
  if (command.arm < 0 || command.arm >= kMaxArms) return;
  lost_by_command_[std::size_t(command.arm)] = lost;
}

bool HapticLoop::write(const TickRecord& record) {
  for (std::size_t place = 0; place < devices_.size(); ++place) {
    LoopDevice& d = devices_[place];
    if (d.arms.empty()) continue;  // a pedal
    for (std::size_t i = 0; i < d.arms.size(); ++i) {
      TrephineArmCommand& command = arm_commands_[i];
      command = {sizeof(TrephineArmCommand), TREPHINE_DEVICE_ABI, {}};
      const Vec3& force_N = record.arms[d.arms[i]].sent_N;
      for (int axis = 0; axis < 3; ++axis) command.force_N[axis] = force_N[axis];
    }
    if (!calls_.make(place, [&] { d.device->write(arm_commands_.data()); })) return false;
    for (std::size_t arm : d.arms) {
      if (probe_) probe_->sent(arm, record.arms[arm].sent_N);
    }
  }
  return true;
}

void setState(LoopState& state, const HapticCore& core, const TickRecord& record) {
  state.record = record;
  state.nonfinite = core.nonFinite();
  const CarveJournal& journal = core.journal();
  state.can_undo = journal.canUndo();
  state.can_redo = journal.canRedo();
  state.seconds = std::uint32_t(journal.seconds());
  for (int arm = 0; arm < kMaxArms; ++arm) {
    for (int c = 0; c < kMaxTissues; ++c) state.removed[arm][c] = journal.removed(arm, c);
  }
  const std::vector<ArmParameters>& arms = core.parameters().arms;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    state.maps[i] = arms[i].map;
    state.tools[i] = std::int32_t(core.toolInHand(i));
    state.wanted_tools[i] = std::int32_t(core.toolWanted(i));
  }
  state.controller = core.controller();
  state.paused = core.paused();
  state.busy = journal.busy();
  state.journal_full = core.journalFull();
}

void HapticLoop::publish(const TickRecord& record) {
  LoopState& state = state_.writeSlot();
  setState(state, core_, record);
  state.ticks = tick_;
  state.missed = missed_;
  state.dropped = dropped();
  state_.publish();
}

bool HapticLoop::run(LoopClock& clock, const std::atomic<bool>& stop, std::uint64_t last_tick) {
  const auto period_ns = std::int64_t(core_.parameters().period_s * 1e9 + 0.5);
  TickSchedule host(period_ns);
  SampleSchedule samples(period_ns);
  std::size_t pacing = 0;
  while (pacing < devices_.size() && !devices_[pacing].paces) ++pacing;
  running_ = true;
  bool here = true;
  const auto waitForSample = [&](double seconds) {
    bool came = false;
    here = calls_.make(pacing, [&] { came = devices_[pacing].device->wait(seconds); });
    return came || !here;
  };
  while (here && tick_ < last_tick && !stop.load(std::memory_order_relaxed)) {
    const bool by_samples = pacing < devices_.size();
    const std::int64_t late_ns =
        by_samples ? samples.waitForTick(clock, waitForSample) : host.waitForTick(clock);
    missed_ = by_samples ? samples.missed() : host.missed();
    here = here && step(late_ns);
  }
  running_ = false;
  return here;
}

}  // namespace trephine
