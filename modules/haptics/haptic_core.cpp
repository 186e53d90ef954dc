#include "haptics/haptic_core.h"

#include <algorithm>

#include "device/trephine_device.h"

namespace trephine {

namespace {
// Undo, redo and reset move at most this many voxels a tick.
constexpr std::size_t kVoxelsPerSlice = 1024;
constexpr std::size_t kMaxEventsPerTick = 64;
}  // namespace

HapticCore::HapticCore(const HapticParameters& parameters, Grid::Writer writer)
    : parameters_(parameters),
      writer_(std::move(writer)),
      journal_(parameters.journal_voxels, parameters.journal_strokes),
      patient_to_voxel_(writer_.grid().geometry().patientToVoxel()),
      stroke_gap_ticks_(std::uint64_t(parameters.stroke_gap_s / parameters.period_s)) {
  std::size_t points = 0;
  for (const ArmParameters& arm : parameters_.arms) {
    Arm state;
    for (LawKind kind : parameters_.laws) {
      state.laws.push_back(makeLaw(kind));
      state.rendered_laws.push_back(makeLaw(kind));
    }
    for (const auto& [name, kind] : kControllerNames) {
      state.controllers.push_back(makeController(kind, arm.dynamics, parameters_.period_s));
    }
    state.controller = state.controllers[std::size_t(parameters_.controller)];
    state.hits.reserve(arm.tool.points_m.size());
    points += arm.tool.points_m.size();
    arms_.push_back(std::move(state));
  }
  carves_.reserve(points);
  events_.reserve(kMaxEventsPerTick);
}

void HapticCore::tick(const TickInput& input, const Command* commands, std::size_t command_count,
                      TickRecord& record) {
  carves_.clear();
  events_.clear();
  for (std::size_t i = 0; i < command_count; ++i) apply(commands[i], input.tick);
  journal_.step(writer_, kVoxelsPerSlice);

  record.tick = input.tick;
  record.late_ns = input.late_ns;
  for (std::size_t i = 0; i < arms_.size(); ++i) moveArm(i, input, record.arms[i]);

  const bool full = journal_.full();
  if (full && !reported_full_) events_.push_back({input.tick, EventKind::journal_full, -1, 0, {}});
  reported_full_ = full;
}

void HapticCore::apply(const Command& command, std::uint64_t tick) {
  events_.push_back({tick, EventKind::command, -1, 0, command});
  switch (command.kind) {
    case CommandKind::none:
      break;
    case CommandKind::undo:
      if (journal_.startUndo()) forgetForces(true);
      break;
    case CommandKind::redo:
      if (journal_.startRedo()) forgetForces(true);
      break;
    case CommandKind::reset:
      if (journal_.startReset()) forgetForces(true);
      break;
    case CommandKind::pause:
      paused_ = true;
      break;
    case CommandKind::resume:
      paused_ = false;
      forgetForces(false);
      break;
    case CommandKind::clear_faults:
      for (Arm& arm : arms_) arm.faults = 0;
      forgetForces(false);
      break;
    case CommandKind::controller:
      if (command.value < 0 || std::size_t(command.value) >= kControllerNames.size()) break;
      parameters_.controller = ControllerKind(command.value);
      for (Arm& arm : arms_) {
        arm.controller = arm.controllers[std::size_t(parameters_.controller)];
        arm.gate.change();
      }
      break;
    case CommandKind::tissues:
      parameters_.tissues = command.tissues;
      for (Arm& arm : arms_) arm.gate.change();
      break;
  }
}

// Law states go back and the controller's credit is zero; after voxels were put back, force also
// waits until the tool is out of tissue.
void HapticCore::forgetForces(bool restored) {
  for (Arm& arm : arms_) {
    for (Law& law : arm.laws) forgetLaw(law);
    for (Law& law : arm.rendered_laws) forgetLaw(law);
    forgetController(arm.controller);
    arm.contact = Contact{};
    if (restored) {
      arm.gate.restored();
    } else {
      arm.gate.change();
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

void HapticCore::moveArm(std::size_t index, const TickInput& input, ArmRecord& out) {
  Arm& arm = arms_[index];
  const ArmParameters& parameters = parameters_.arms[index];
  const ArmSample& sample = input.arms[index];
  const double T = parameters_.period_s;

  out = ArmRecord{};
  out.device_position_m = sample.position_m;
  out.device_orientation = sample.orientation;
  out.buttons = sample.buttons;
  out.flags = sample.flags;

  if (sample.flags & TREPHINE_ARM_LOST) latch(index, kFaultDeviceLost, input.tick);
  if (input.late_ns >= kFaultLate_ns) latch(index, kFaultLate, input.tick);
  const bool known = isFinite(sample.position_m) && isFinite(sample.orientation);
  if (!known) {
    ++nonfinite_;
    latch(index, kFaultNonFinite, input.tick);
    arm.gate.zero();
    arm.contact = Contact{};
    arm.last_position_m.reset();
    out.energy_out_J = arm.energy_out_J;
    out.faults = arm.faults;
    return;
  }

  const Vec3 moved_m = arm.last_position_m ? sample.position_m - *arm.last_position_m : Vec3(0.0);
  arm.last_position_m = sample.position_m;
  arm.energy_out_J += arm.gate.sent_N() * moved_m;  // the force held since the last tick
  const Vec3 velocity_m_s = moved_m / T;

  const Pose pose_mm = parameters.map.toPatient_mm({sample.position_m, sample.orientation});
  out.patient_position_mm = pose_mm.position;
  out.patient_orientation = pose_mm.orientation;
  out.velocity_m_s = parameters.map.velocityToPatient(velocity_m_s);

  arm.contact = findContact(writer_.grid(), patient_to_voxel_, parameters_.tissues, parameters.tool,
                            pose_mm, arm.contact, parameters_.contact_hold_mm, arm.hits);
  out.tissue_class = arm.contact.tissue_class;
  out.points_in_tissue = arm.contact.points;

  LawInput law_input{0.001 * pose_mm.position, arm.contact, {}};
  if (arm.contact.touching()) {
    law_input.tissue = parameters_.tissues.classes[std::size_t(arm.contact.tissue_class)];
  }
  ContactForce model;
  for (Law& law : arm.laws) addLaw(law, law_input, model);
  out.demanded_N = parameters.map.forceToDevice(model.at(out.velocity_m_s));

  // The same contact once more, with the impedance that the controller lets this arm show.
  const double at_arm = parameters.map.motion_scale * parameters.map.force_scale;
  const Impedance limited =
      limitImpedance(arm.controller, {at_arm * law_input.tissue.damping_Ns_per_m,
                                      at_arm * law_input.tissue.stiffness_N_per_m});
  law_input.tissue.damping_Ns_per_m = limited.damping / at_arm;
  law_input.tissue.stiffness_N_per_m = limited.stiffness / at_arm;
  ControllerInput to_controller;
  for (Law& law : arm.rendered_laws) addLaw(law, law_input, to_controller.rendered);
  to_controller.rendered.elastic_N = parameters.map.forceToDevice(to_controller.rendered.elastic_N);
  to_controller.rendered.stiffness *= at_arm;
  to_controller.rendered.damping *= at_arm;
  to_controller.demanded_N = out.demanded_N;
  to_controller.touching = arm.contact.touching();
  to_controller.position_m = sample.position_m;
  to_controller.velocity_m_s = velocity_m_s;
  to_controller.last_sent_N = arm.gate.sent_N();
  to_controller.period_s = T;
  out.bounded_N = boundForce(arm.controller, to_controller);
  std::visit(
      [&](const auto& c) {
        out.observer_J = c.energy_J();
        out.alpha = c.alpha();
        out.controller_parts = c.parts();
      },
      arm.controller);

  const TissueClass& numbers = law_input.tissue;
  const bool finite = isFinite(numbers.damping_Ns_per_m) &&
                      isFinite(numbers.stiffness_N_per_m) && isFinite(numbers.yield_N) &&
                      isFinite(out.demanded_N) && isFinite(out.bounded_N) &&
                      isFinite(velocity_m_s) && isFinite(out.velocity_m_s) &&
                      isFinite(pose_mm) && isFinite(out.observer_J) && isFinite(out.alpha) &&
                      isFinite(arm.energy_out_J);
  if (!finite) {
    ++nonfinite_;
    latch(index, kFaultNonFinite, input.tick);
    for (Law& law : arm.laws) forgetLaw(law);
    for (Law& law : arm.rendered_laws) forgetLaw(law);
    forgetController(arm.controller);
    if (!isFinite(arm.energy_out_J)) arm.energy_out_J = Vec3(0.0);
    out.velocity_m_s = out.demanded_N = out.bounded_N = Vec3(0.0);
    out.observer_J = out.alpha = 0.0;
  }
  out.clamped_N = clampForce(out.bounded_N, parameters.max_force_N);
  const bool open = !paused_ && arm.faults == 0;
  // While voxels come back in slices, tissue may yet fill in around the tool.
  const bool in_tissue = arm.contact.touching() || journal_.busy();
  out.sent_N = arm.gate.pass(out.clamped_N, in_tissue, open, input.late_ns, T);
  out.energy_out_J = arm.energy_out_J;

  const bool cuts = open && !journal_.busy() && !arm.gate.waitingForAir();
  if (cuts) removeHits(index, input.tick, out);
  out.faults = arm.faults;
}

// Removal on contact, the seed paper's rule: every point in tissue erases its voxel.
void HapticCore::removeHits(std::size_t index, std::uint64_t tick, ArmRecord& out) {
  Arm& arm = arms_[index];
  const int arm_number = int(index);
  for (const Hit& hit : arm.hits) {
    if (!parameters_.tissues.classes[std::size_t(hit.tissue_class)].cuttable) continue;
    // Two points may share a voxel, and a tissue may include the HU of air.
    const std::int16_t old_hu = writer_.grid().hu(hit.voxel);
    if (old_hu == kAirHu) continue;
    if (!journal_.inStroke(arm_number)) {
      if (!journal_.beginStroke(arm_number)) return;
      events_.push_back({tick, EventKind::stroke_began, std::int32_t(index), 0, {}});
    }
    if (!journal_.erase(writer_, arm_number, hit.voxel, hit.tissue_class)) return;
    carves_.push_back({tick, std::uint32_t(hit.voxel), old_hu, std::int8_t(index),
                       std::int8_t(hit.tissue_class)});
    ++out.removed_voxels;
  }
  arm.air_ticks = arm.contact.touching() ? 0 : arm.air_ticks + 1;
  if (journal_.inStroke(arm_number) && arm.air_ticks > stroke_gap_ticks_) {
    journal_.endStroke(arm_number);
  }
}

}  // namespace trephine
