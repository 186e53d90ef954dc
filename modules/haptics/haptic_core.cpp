#include "haptics/haptic_core.h"

#include <algorithm>
#include <utility>

#include "device/trephine_device.h"

namespace trephine {

namespace {

// Undo, redo and rewind move at most this many voxels a tick.
constexpr std::size_t kVoxelsPerSlice = 4096;
constexpr std::size_t kMaxEventsPerTick = 64;

// How an orientation turned from one to another in a time, small angles: 2 Im(q_now q_before*) / T.
Vec3 turning(const Quat& before, const Quat& now, double period_s) {
  const Quat by = now * glm::conjugate(before);
  const double sign = by.w < 0.0 ? -2.0 : 2.0;
  return Vec3(by.x, by.y, by.z) * (sign / period_s);
}

// False for what no arm can say: not finite, metres away from its workspace, no rotation.
bool isPose(const ArmSample& sample) {
  constexpr double kLooselyUnit = 1e-2;
  bool near = true;
  for (int axis = 0; axis < 3; ++axis) near = near && kPosePlace_m.holds(sample.position_m[axis]);
  const Quat& q = sample.orientation;
  return near && std::abs(glm::dot(q, q) - 1.0) <= kLooselyUnit;
}

// 1 where nothing was limited, so that what was allowed in full stays the same to the last bit.
double shareOf(double limited, double demanded) {
  return demanded > 0.0 ? limited / demanded : 1.0;
}

}  // namespace

HapticCore::Arm::Arm(const ArmParameters& arm, const HapticParameters& all,
                     const GridGeometry& geometry)
    : contact(arm.tool, geometry),
      removal(arm.tool, geometry, all.removal, all.period_s),
      points(all.force_at == ForceAt::tip ? 1 : arm.tool.points_m.size()) {
  for (LawKind kind : all.laws) {
    laws.push_back(makeLaw(kind, points.size()));
    rendered_laws.push_back(makeLaw(kind, points.size()));
    if (kind == LawKind::elastic) {
      ball.emplace(geometry, 1000.0 * arm.tool.ball_radius_m, ballDirections(arm.tool.blunt));
    }
  }
  for (const auto& [name, kind] : kControllerNames) {
    controllers.push_back(makeController(kind, arm.dynamics, all.period_s));
  }
  controller = controllers[std::size_t(all.controller)];
  bites.reserve(Removal::kMostBites);
  taken.reserve(Removal::kMostBites);
}

HapticCore::HapticCore(const HapticParameters& parameters, Grid::Writer writer)
    : parameters_(parameters),
      writer_(std::move(writer)),
      journal_(parameters.journal_voxels, parameters.journal_strokes, parameters.journal_seconds),
      stroke_gap_ticks_(std::uint64_t(parameters.stroke_gap_s / parameters.period_s)),
      second_ticks_(std::uint64_t(1.0 / parameters.period_s + 0.5)) {
  elastic_ = names(parameters_.laws, LawKind::elastic);
  for (const ArmParameters& arm : parameters_.arms) {
    arms_.emplace_back(arm, parameters_, writer_.grid().geometry());
  }
  useTissues(TissueTable{});
  carves_.reserve(arms_.size() * Removal::kMostBites);
  events_.reserve(kMaxEventsPerTick);
  put_back_.reserve(kVoxelsPerSlice);
}

// What the tick keeps of the tissues; of what it knows about the voxels, only what they change
// goes.
void HapticCore::useTissues(const TissueTable& before) {
  const TissueTable& now = parameters_.tissues;
  bool same_voxels = bricks_ && before.count == now.count, same_cuts = same_voxels;
  for (std::size_t c = 0; c < std::size_t(now.count) && same_voxels; ++c) {
    const TissueClass &a = before.classes[c], &b = now.classes[c];
    same_voxels = a.hu_min == b.hu_min && a.hu_max == b.hu_max && a.label == b.label;
    same_cuts = same_cuts && same_voxels && a.cuttable == b.cuttable;
  }
  if (!same_voxels) {
    lookup_.set(now);
    if (bricks_) {
      bricks_->markAll();
    } else {
      bricks_.emplace(writer_.grid(), lookup_);
    }
  }
  tissues_finite_ = true;
  any_cuttable_ = false;
  for (int c = 0; c < now.count; ++c) {
    const TissueClass& t = now.classes[std::size_t(c)];
    tissues_finite_ = tissues_finite_ && isFinite(t.damping_Ns_per_m) &&
                      isFinite(t.stiffness_N_per_m) && isFinite(t.friction_N) &&
                      isFinite(t.rupture_N) && isFinite(t.cutting_J_per_mm3);
    any_cuttable_ = any_cuttable_ || t.cuttable;
  }
  if (elastic_) {
    TissueTable pushing = now;
    // A capsule pushes by the law of its own, where the scene has it.
    const bool ruptures = names(parameters_.laws, LawKind::rupture);
    for (int c = 0; ruptures && c < pushing.count; ++c) {
      TissueClass& tissue = pushing.classes[std::size_t(c)];
      if (tissue.rupture_N > 0.0) tissue.stiffness_N_per_m = 0.0;
    }
    stiffness_.set(pushing);
  }
  for (Arm& arm : arms_) {
    if (!same_cuts) arm.removal.forget();
    arm.gate.change();
  }
}

CarveJournal::Credits HapticCore::credits() const {
  CarveJournal::Credits out{};
  for (std::size_t i = 0; i < arms_.size(); ++i) out[i] = arms_[i].removal.credit_J();
  return out;
}

std::uint32_t HapticCore::journalState() {
  std::uint32_t state = 0;
  if (journal_.hasRoom(arms_.size() * Removal::kMostBites)) state |= kJournalRoom;
  if (!journal_.busy() || journal_.canStep(kVoxelsPerSlice)) state |= kJournalReady;
  return state;
}

void HapticCore::tick(const TickInput& input, const Command* commands, std::size_t command_count,
                      TickRecord& record) {
  carves_.clear();
  events_.clear();
  if (journal_.busy() && (input.journal & kJournalReady)) {
    put_back_.clear();
    journal_.step(writer_, kVoxelsPerSlice, &put_back_);
    for (std::uint32_t voxel : put_back_) bricks_->mark(writer_.grid().brickOf(voxel));
    if (!journal_.busy()) finishRestore();
  }
  if (!journal_.busy()) bricks_->recount(writer_.grid(), lookup_);
  if (!paused_ && ++ticks_ % second_ticks_ == 0) journal_.mark(credits());
  // The journal grants what it was asked for.
  may_remove_ = (input.journal & kJournalRoom) && journal_.hasRoom(arms_.size() * Removal::kMostBites);
  for (std::size_t i = 0; i < command_count; ++i) apply(commands[i], input.tick);

  followLateness(input);

  record.tick = input.tick;
  record.late_ns = input.late_ns;
  record.journal = input.journal;
  for (std::size_t i = 0; i < arms_.size(); ++i) moveArm(i, input, record.arms[i]);
  removeBites(input.tick, record);

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
    case CommandKind::reset:
      if (journal_.startReset(credits())) forgetForces(true);
      break;
    case CommandKind::rewind:
      if (command.value >= 0 && journal_.startRewind(std::size_t(command.value), credits())) {
        forgetForces(true);
      }
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
      lateness_.clear();
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
      if (command.tissues == parameters_.tissues) break;
      useTissues(std::exchange(parameters_.tissues, command.tissues));
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
    arm.contact.forget();
    arm.removal.forget();
    arm.last_demanded_N = arm.last_torque_Nm = Vec3(0.0);
    if (restored) {
      arm.gate.restored();
    } else {
      arm.gate.change();
    }
  }
}

void HapticCore::finishRestore() {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    arms_[i].removal.setCredit(journal_.credits()[i]);
    arms_[i].removal.forget();
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
      arms_[i].gate.rampIn();
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

// What the laws are told: which points lie in which tissue, and how they move.
LawInput HapticCore::touch(Arm& arm, const Tool& tool, const Motion& motion) {
  const Contact& contact =
      arm.contact.update(writer_.grid(), *bricks_, lookup_, parameters_.tissues, motion.pose_mm);
  const std::span<const std::int8_t> classes = arm.contact.classes();
  if (parameters_.force_at == ForceAt::tip) {
    arm.points[0].tissue_class = contact.tissue_class;
  } else {
    for (std::size_t i = 0; i < classes.size(); ++i) {
      TouchPoint& p = arm.points[i];
      p.tissue_class = classes[i];
      if (classes[i] < 0) continue;
      p.weight = tool.weights[i];
      p.arm_m = motion.pose_mm.orientation * tool.points_m[i];
      p.turning_m_s = glm::cross(motion.turning_rad_s, p.arm_m);
    }
  }
  LawInput in;
  in.tip_m = 0.001 * motion.pose_mm.position;
  in.velocity_m_s = motion.velocity_m_s;
  in.into_m = motion.pose_mm.orientation * Vec3(0.0, 0.0, -1.0);
  in.points = arm.points;
  in.touching = contact.touching();
  in.tip_class = classes[0];
  in.tissues = &parameters_.tissues;
  in.blunt = tool.blunt;
  in.ball_radius_m = tool.ball_radius_m;
  if (arm.ball) {
    in.ball_m = -tool.ball_radius_m * in.into_m;
    in.push = arm.ball->push(writer_.grid(), *bricks_, stiffness_,
                             motion.pose_mm.position + 1000.0 * in.ball_m);
  }
  return in;
}

// The work of the demanded force, by the trapezoidal rule, and of the motor while the tool is in
// tissue that may be cut.
void HapticCore::earn(Arm& arm, const Tool& tool, const Motion& motion, const ContactForce& model) {
  const Vec3 force_N = model.at(motion.velocity_m_s);
  bool cutting = false;
  for (std::int8_t c : arm.contact.classes().first(tool.cutting_points)) {
    cutting = cutting || (c >= 0 && parameters_.tissues.classes[std::size_t(c)].cuttable);
  }
  const bool jumped = glm::length(motion.velocity_m_s) > Removal::kFastest_m_s;
  double work_J = 0.0;
  if (cutting && arm.cuts && !jumped) {
    const double by_hand_W =
        -0.5 * (glm::dot(force_N + arm.last_demanded_N, motion.velocity_m_s) +
                glm::dot(model.torque_Nm + arm.last_torque_Nm, motion.turning_rad_s));
    work_J = parameters_.period_s * (by_hand_W + tool.made_from.motor_W);
  }
  arm.removal.earn(work_J, parameters_.tissues);
  arm.last_demanded_N = force_N;
  arm.last_torque_Nm = model.torque_Nm;
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
  arm.cuts = false;

  if (sample.flags & TREPHINE_ARM_LOST) latch(index, kFaultDeviceLost, input.tick);
  const bool known = isPose(sample);
  if (!known) {
    ++nonfinite_;
    latch(index, kFaultNonFinite, input.tick);
    arm.gate.zero();
    arm.contact.forget();
    arm.last_pose.reset();
    out.energy_out_J = arm.energy_out_J;
    out.cutting_credit_J = arm.removal.credit_J();
    out.faults = arm.faults;
    return;
  }

  const Pose before = arm.last_pose.value_or(Pose{sample.position_m, sample.orientation});
  const Vec3 moved_m = sample.position_m - before.position;
  arm.last_pose = Pose{sample.position_m, sample.orientation};
  arm.energy_out_J += arm.gate.sent_N() * moved_m;  // the force held since the last tick
  const Vec3 velocity_m_s = moved_m / T;

  Motion motion;
  motion.pose_mm = parameters.map.toPatient_mm({sample.position_m, sample.orientation});
  motion.velocity_m_s = parameters.map.velocityToPatient(velocity_m_s);
  motion.turning_rad_s =
      parameters.map.rotation * turning(before.orientation, sample.orientation, T);
  out.patient_position_mm = motion.pose_mm.position;
  out.patient_orientation = motion.pose_mm.orientation;
  out.velocity_m_s = motion.velocity_m_s;

  LawInput law_input = touch(arm, parameters.tool, motion);
  out.tissue_class = arm.contact.contact().tissue_class;
  out.points_in_tissue = arm.contact.contact().points;

  ContactForce model;
  for (Law& law : arm.laws) addLaw(law, law_input, model);
  out.demanded_N = parameters.map.forceToDevice(model.at(motion.velocity_m_s));
  out.demanded_torque_Nm = parameters.map.torqueToDevice(model.torque_Nm);

  // The same contact once more, with the impedance that the controller lets this arm show.
  const double at_arm = parameters.map.motion_scale * parameters.map.force_scale;
  const Impedance demanded{at_arm * model.damping, at_arm * model.stiffness};
  const Impedance limited = limitImpedance(arm.controller, demanded);
  law_input.share = {shareOf(limited.damping, demanded.damping),
                     shareOf(limited.stiffness, demanded.stiffness)};
  ControllerInput to_controller;
  ContactForce& rendered = to_controller.rendered;
  for (Law& law : arm.rendered_laws) addLaw(law, law_input, rendered);
  rendered.elastic_N = parameters.map.forceToDevice(rendered.elastic_N);
  rendered.damped_turning_N = parameters.map.forceToDevice(rendered.damped_turning_N);
  rendered.stored_J *= parameters.map.force_scale / parameters.map.motion_scale;
  rendered.stiffness *= at_arm;
  rendered.damping *= at_arm;
  const bool in_contact = law_input.touching || model.stiffness > 0.0;
  to_controller.demanded_N = out.demanded_N;
  to_controller.touching = in_contact;
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

  const bool finite = (tissues_finite_ || !law_input.touching) &&
                      isFinite(law_input.share.damping) && isFinite(law_input.share.stiffness) &&
                      isFinite(model.stiffness) && isFinite(model.damping) &&
                      isFinite(out.demanded_N) && isFinite(out.demanded_torque_Nm) &&
                      isFinite(out.bounded_N) && isFinite(velocity_m_s) &&
                      isFinite(out.velocity_m_s) && isFinite(motion.turning_rad_s) &&
                      isFinite(motion.pose_mm) &&
                      isFinite(out.observer_J) && isFinite(out.alpha) && isFinite(arm.energy_out_J);
  if (!finite) {
    ++nonfinite_;
    latch(index, kFaultNonFinite, input.tick);
    for (Law& law : arm.laws) forgetLaw(law);
    for (Law& law : arm.rendered_laws) forgetLaw(law);
    forgetController(arm.controller);
    arm.last_demanded_N = arm.last_torque_Nm = Vec3(0.0);
    if (!isFinite(arm.energy_out_J)) arm.energy_out_J = Vec3(0.0);
    out.velocity_m_s = out.demanded_N = out.demanded_torque_Nm = out.bounded_N = Vec3(0.0);
    out.observer_J = out.alpha = 0.0;
  }
  out.clamped_N = clampForce(out.bounded_N, parameters.max_force_N);
  const bool open = !paused_ && arm.faults == 0;
  // While voxels come back in slices, tissue may yet fill in around the tool.
  const bool in_tissue = in_contact || journal_.busy();
  out.sent_N = arm.gate.pass(out.clamped_N, in_tissue, open, input.late_ns, T);
  out.energy_out_J = arm.energy_out_J;

  arm.cuts = open && !journal_.busy() && !arm.gate.waitingForAir();
  if (finite) earn(arm, parameters.tool, motion, model);
  out.cutting_credit_J = arm.removal.credit_J();
  out.faults = arm.faults;
}

}  // namespace trephine
