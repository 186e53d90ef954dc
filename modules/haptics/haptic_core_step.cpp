// The tick of one arm, from its sample to the force that it is sent.
#include <algorithm>

#include "device/trephine_device.h"
#include "haptics/arm_tick.h"

namespace trephine {

namespace {

constexpr double kLeastShare = 1e-6;  // of a stiffness: less counts as this

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

// |rendered| / |demanded|. Not above 1: where a friction turns round, the stiffer model does so
// before its rendering. Not below the smaller share of the impedance: the operator's work is
// divided by it.
double shareOf(const Vec3& rendered_N, const Vec3& model_N, const Impedance& share) {
  if (rendered_N == model_N || model_N == Vec3(0.0)) return 1.0;
  const double least = std::min({share.damping, share.stiffness, 1.0});
  return std::clamp(glm::length(rendered_N) / glm::length(model_N), least, 1.0);
}

// Energy [J] that the springs can give back, in the model's units. A friction that is rendered
// softer is stretched farther. A spring that demands more than the arm can show was stretched by no
// more than the arm's force `most_N`.
double givenBack_J(const ContactForce& model, const ContactForce& rendered, double share,
                   double most_N) {
  const double stored_J =
      std::max(model.stored_J, rendered.stored_J / std::max(share, kLeastShare));
  const double beyond_N = glm::length(model.elastic_N) - most_N;
  if (!(beyond_N > 0.0) || !(model.stiffest() > 0.0)) return stored_J;
  return std::max(0.0, stored_J - beyond_N * beyond_N / (2.0 * model.stiffest()));
}

// The same force at the device: a tissue's b and k are g s b and g s k there, energy is g / s times
// what it is in the model.
ContactForce atDevice(const ContactForce& patient, const WorkspaceMap& map) {
  const double at_arm = map.motion_scale * map.force_scale;
  ContactForce device = patient;
  device.elastic_N = map.forceToDevice(patient.elastic_N);
  device.damped_rotation_N = map.forceToDevice(patient.damped_rotation_N);
  device.stored_J = patient.stored_J * (map.force_scale / map.motion_scale);
  device.stiffness = at_arm * patient.stiffest();
  device.damping = patient.damping * at_arm;
  return device;
}

}  // namespace

void HapticCore::moveArm(std::size_t index, const TickInput& input, ArmRecord& out) {
  ArmTick now{input, index, arms_[index], parameters_.arms[index], out};
  out = ArmRecord{};
  if (!sample(now)) return;
  changeTool(now);
  moveProxy(now);
  touch(now);
  if (!now.arm.clutched) {
    demand(now);
    render(now);
    bound(now);
  }
  checkFinite(now);
  send(now);
  if (!now.arm.clutched) giveWork(now);
  record(now);
}

// What the device says of the arm itself.
void HapticCore::followDevice(ArmTick& now) {
  Arm& arm = now.arm;
  const std::uint32_t flags = now.out.flags;
  if (flags & TREPHINE_ARM_LOST) latch(now.index, kFaultDeviceLost, now.input.tick);
  const bool was_away = arm.errors.away();
  arm.errors.tick(flags & TREPHINE_ARM_ERROR, parameters_.period_s);
  if (arm.errors.kept()) latch(now.index, kFaultDeviceOften, now.input.tick);
  if (arm.errors.away()) {
    latch(now.index, kFaultDevice, now.input.tick);
  } else if (was_away) {
    arm.faults &= ~std::uint32_t(kFaultDevice);
    arm.limiter.rampIn();
  }
}

// What the device says, and how the arm moved since the tick before. False where it is no pose:
// then the arm has no force and nothing more is known of it.
bool HapticCore::sample(ArmTick& now) {
  Arm& arm = now.arm;
  ArmRecord& out = now.out;
  const ArmSample& sample = now.input.arms[now.index];
  const WorkspaceMap& map = now.parameters.map;
  const double T = parameters_.period_s;
  out.device_position_m = sample.position_m;
  out.device_orientation = sample.orientation;
  out.buttons = sample.buttons;
  out.flags = sample.flags;
  arm.cuts = false;
  followDevice(now);
  if (!isPose(sample)) {
    ++nonfinite_;
    latch(now.index, kFaultNonFinite, now.input.tick);
    arm.limiter.zero();
    arm.tool().contact.forget();
    arm.last_pose.reset();
    recordWork(arm, out);
    out.faults = arm.faults;
    return false;
  }

  const Pose pose{sample.position_m, sample.orientation};
  if (arm.remap == CommandKind::clutch_off) engageArm(now, pose);
  if (arm.remap == CommandKind::recentre) recentreArm(now, pose);
  const Pose before = arm.last_pose.value_or(pose);
  const Vec3 moved_m = pose.position - before.position;
  arm.energy_out_J += arm.limiter.sent_N() * moved_m;  // by the force held since the last tick
  now.velocity_m_s = moved_m / T;
  Motion& motion = now.motion;
  if (arm.clutched) {  // for the tool its arm stands still
    motion.arm_mm = arm.tool_mm;
  } else {
    motion.arm_mm = map.toPatient_mm(pose);
    motion.velocity_m_s = map.velocityToPatient(now.velocity_m_s);
    motion.angular_velocity_rad_s =
        map.rotation * (smallTurn(before.orientation, pose.orientation) / T);
  }
  now.jumped = glm::length(motion.velocity_m_s) > Removal::kFastest_m_s;
  if (!now.jumped) {
    arm.work.addDeviceWork(arm.limiter.sent_N(), moved_m, map.force_scale / map.motion_scale);
  }
  arm.last_pose = pose;
  return true;
}

// The force that the tissue demands.
void HapticCore::demand(ArmTick& now) {
  for (Law& law : now.arm.tool().laws) addDemanded(law, now.contact, now.model);
  now.model_N = now.model.at(now.motion.velocity_m_s);
  now.out.demanded_N = now.parameters.map.forceToDevice(now.model_N);
  now.out.demanded_torque_Nm = now.parameters.map.torqueToDevice(now.model.torque_Nm);
}

// The same contact once more, with the impedance that the controller lets this arm show.
void HapticCore::render(ArmTick& now) {
  const WorkspaceMap& map = now.parameters.map;
  const double at_arm = map.motion_scale * map.force_scale;
  const Impedance demanded{at_arm * now.model.damping, at_arm * now.model.stiffest()};
  const Impedance limited = limitImpedance(now.arm.controller, demanded);
  Impedance& share = now.contact.share;
  share = {shareOf(limited.damping, demanded.damping),
           shareOf(limited.stiffness, demanded.stiffness)};
  for (Law& law : now.arm.tool().laws) addRendered(law, now.contact, now.rendered);
  now.out.rendered_share = shareOf(now.rendered.at(now.motion.velocity_m_s), now.model_N, share);
  now.stored_J = givenBack_J(now.model, now.rendered, share.stiffness,
                             now.parameters.max_force_N / map.force_scale / now.out.rendered_share);
}

// What the controller makes of it, at the device.
void HapticCore::bound(ArmTick& now) {
  Arm& arm = now.arm;
  const WorkspaceMap& map = now.parameters.map;
  const double T = parameters_.period_s;
  now.in_contact = now.contact.touching() || now.model.stiffest() > 0.0;
  ControllerInput in;
  in.demanded_N = now.out.demanded_N;
  in.rendered = atDevice(now.rendered, map);
  in.touching = now.in_contact;
  in.position_m = now.out.device_position_m;
  in.velocity_m_s = now.velocity_m_s;
  in.last_sent_N = arm.limiter.sent_N();
  // No arm here shows a torque, but turning the tool stretches its springs: -torque . turn, the
  // torque as the mean of both ends of the period.
  in.rotation_work_J = -0.5 * T * (map.force_scale / map.motion_scale) *
                       glm::dot(arm.last_elastic_Nm + now.rendered.elastic_torque_Nm,
                                now.motion.angular_velocity_rad_s);
  arm.last_elastic_Nm = now.rendered.elastic_torque_Nm;
  in.period_s = T;
  now.out.bounded_N = boundForce(arm.controller, in);
  const ControllerReport report = reportOf(arm.controller);
  now.out.observer_J = report.observer_J;
  now.out.alpha = report.alpha;
  now.out.credit_J = report.credit_J;
  now.out.learnt_scale = report.learnt_scale;
  now.out.controller_parts = report.parts;
}

// One value that is no number takes the arm's force away, and every state that may hold it begins
// anew.
void HapticCore::checkFinite(ArmTick& now) {
  Arm& arm = now.arm;
  ArmRecord& out = now.out;
  const Motion& motion = now.motion;
  now.finite = (tissues_finite_ || !now.contact.touching()) && isFinite(now.contact.share.damping) &&
               isFinite(now.contact.share.stiffness) && isFinite(now.model.stiffest()) &&
               isFinite(now.model.damping) && isFinite(out.demanded_N) &&
               isFinite(out.demanded_torque_Nm) && isFinite(out.bounded_N) &&
               isFinite(now.velocity_m_s) && isFinite(motion.velocity_m_s) &&
               isFinite(motion.angular_velocity_rad_s) && isFinite(motion.arm_mm) &&
               isFinite(motion.pose_mm) && isFinite(out.observer_J) && isFinite(out.alpha) &&
               isFinite(out.credit_J) && isFinite(out.learnt_scale) && isFinite(arm.energy_out_J);
  if (now.finite) return;
  ++nonfinite_;
  latch(now.index, kFaultNonFinite, now.input.tick);
  forgetLaws(arm);
  forgetController(arm.controller);
  arm.work.forget();
  placeTool(arm.tool(), motion.arm_mm);
  arm.last_elastic_Nm = Vec3(0.0);
  if (!isFinite(arm.energy_out_J)) arm.energy_out_J = Vec3(0.0);
  out.velocity_m_s = out.demanded_N = out.demanded_torque_Nm = out.bounded_N = Vec3(0.0);
  out.observer_J = out.alpha = out.credit_J = out.learnt_scale = 0.0;
  out.rendered_share = 1.0;
}

// Within the arm's greatest force and what ramps, pauses, faults and lateness leave of it.
void HapticCore::send(ArmTick& now) {
  Arm& arm = now.arm;
  ArmRecord& out = now.out;
  const double limit_N = arm.warmth.limit_N(
      now.parameters.max_force_N, out.flags & TREPHINE_ARM_WARM, glm::length(arm.limiter.sent_N()),
      now.parameters.dynamics, parameters_.period_s);
  out.clamped_N = clampForce(out.bounded_N, limit_N);
  const bool held = !(out.flags & TREPHINE_ARM_NO_HAND);
  const bool open = !paused_ && arm.faults == 0 && held;
  // While voxels come back in slices, tissue may yet fill in around the tool.
  if (arm.clutched) now.in_contact = now.contact.touching();
  const bool in_tissue = (arm.tool().proxy ? arm.waiting : now.in_contact) || journal_.busy();
  if (arm.waiting && !arm.limiter.waitingForAir()) arm.limiter.restored();
  out.sent_N =
      arm.limiter.limit(out.clamped_N, in_tissue, open, now.input.late_ns, parameters_.period_s);
  arm.not_as_stated = arm.not_as_stated || (out.controller_parts & kPartArmNotAsStated);
  if (arm.not_as_stated) out.controller_parts |= kPartArmNotAsStated;
  if (out.clamped_N != out.bounded_N) out.controller_parts |= kPartClamp;
  if (out.sent_N != out.clamped_N) out.controller_parts |= kPartLimiter;
  arm.cuts = open && !arm.clutched && arm.tool().cutting != Cutting::nothing && !journal_.busy() &&
             !arm.limiter.waitingForAir() && !motorIsOff(arm, out.buttons);
}

// A tool with a motor, and the pedal up.
bool HapticCore::motorIsOff(const Arm& arm, std::uint32_t buttons) {
  const bool there = buttons & kPedalThere, down = buttons & kPedalMiddle;
  return arm.tool().cutting == Cutting::driven && there && !down;
}

// The work of this tick that may pay for cutting.
void HapticCore::giveWork(ArmTick& now) {
  Arm& arm = now.arm;
  const double T = parameters_.period_s;
  const bool at_work = atWork(arm);
  const double motor_J = at_work ? T * arm.tool().made.made_from.motor_W : 0.0;
  if (now.finite && !now.jumped) {
    // By the model's own force, the mean of both ends of the period.
    arm.work.addModelWork(-0.5 * T *
                          glm::dot(arm.last_model_N + now.model_N, now.motion.velocity_m_s));
  }
  arm.last_model_N = now.finite ? now.model_N : Vec3(0.0);
  const double more_J =
      now.finite ? arm.work.endTick(now.stored_J, now.out.rendered_share, motor_J) : 0.0;
  if (paysByCutting()) {
    // What parted tissue pays, and no friction; at the model's own force, whatever the arm shows.
    const double paid_J = at_work && now.finite ? arm.tool().soft->cut_J() + motor_J : 0.0;
    arm.cut_J += paid_J;
    arm.tool().removal.giveWork(paid_J, arm.cut_J, tissue_);
    return;
  }
  arm.tool().removal.giveWork(at_work && !now.jumped ? more_J : 0.0, arm.work.lost_J(),
                              tissue_);
}

void HapticCore::record(ArmTick& now) {
  const Arm& arm = now.arm;
  ArmRecord& out = now.out;
  if (arm.waiting || arm.limiter.waitingForAir()) out.tool_state |= kToolWaits;
  if (arm.tool().proxy && arm.tool().proxy->held()) out.tool_state |= kToolHeld;
  if (arm.let_go_share > 0.0) out.tool_state |= kToolLetGo;
  if (arm.clutched) out.tool_state |= kToolClutched;
  if (arm.wanted != arm.in_hand) out.tool_state |= kToolToCome;
  if (arm.warmth.limits()) out.tool_state |= kToolArmWarm;
  if (out.flags & TREPHINE_ARM_NO_HAND) out.tool_state |= kToolNoHand;
  if (motorIsOff(arm, out.buttons)) out.tool_state |= kToolOff;
  recordWork(arm, out);
  out.faults = arm.faults;
}

// As it is before this tick removes anything.
void HapticCore::recordWork(const Arm& arm, ArmRecord& out) {
  const Removal& removal = arm.tool().removal;
  out.energy_out_J = arm.energy_out_J;
  out.hand_work_J = arm.work.done_J();
  out.model_work_J = arm.work.taken_J();
  out.motor_work_J = arm.work.motor_J();
  out.stored_J = arm.work.stored_J();
  out.cutting_credit_J = removal.credit_J();
  out.removal_work_J = removal.spent_J();
  out.heat_J = arm.work.lost_J() - removal.spent_J() - removal.credit_J();
}

}  // namespace trephine
