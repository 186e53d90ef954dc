// The part of a tick that moves an arm: where its tool can be, what the laws say of that place, what
// of it the arm is sent.
#include <algorithm>

#include "device/trephine_device.h"
#include "haptics/haptic_core.h"

namespace trephine {

namespace {

// A tool that its arm has left so far behind, the arm free for so long, is hooked and let go.
constexpr double kHooked_mm = 15.0, kHooked_s = 0.5, kLetGo_s = 0.2;
constexpr double kLeastShare = 1e-6;  // of a stiffness: less is none

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

// What of a force is rendered, by size: where a friction turns round, the stiffer model does so
// before its rendering. Never less than the smaller share of the impedance, or next to nothing of
// work at the device would count as any amount.
double shareOf(const Vec3& rendered_N, const Vec3& model_N, const Impedance& share) {
  if (rendered_N == model_N || model_N == Vec3(0.0)) return 1.0;
  const double least = std::min({share.damping, share.stiffness, 1.0});
  return std::clamp(glm::length(rendered_N) / glm::length(model_N), least, 1.0);
}

// What the springs can give back, in the model's units. A friction that is shown softer is
// stretched farther; and a spring that pulls with more than the arm can show took no more than that
// to stretch.
double givenBack_J(const ContactForce& model, const ContactForce& rendered, double share,
                   double most_N) {
  const double stored_J =
      std::max(model.stored_J, rendered.stored_J / std::max(share, kLeastShare));
  const double beyond_N = glm::length(model.elastic_N) - most_N;
  if (!(beyond_N > 0.0) || !(model.stiffest() > 0.0)) return stored_J;
  return std::max(0.0, stored_J - beyond_N * beyond_N / (2.0 * model.stiffest()));
}

}  // namespace

bool HapticCore::wouldTouch(const Arm& arm, const Pose& pose_mm) const {
  return arm.contact.wouldTouch(writer_.grid(), *bricks_, lookup_, pose_mm);
}

// The tool's pose in this tick. Where the scene has no elastic law it is the arm's. In a pause or a
// fault it only moves through air.
void HapticCore::moveTool(std::size_t index, bool may_cut, std::uint64_t tick, Motion& motion) {
  Arm& arm = arms_[index];
  motion.pose_mm = motion.arm_mm;
  const TissueAround tissue{writer_.grid(), *bricks_, lookup_, parameters_.tissues};
  // The tool at its arm; its body is looked at only where none of its points tells.
  const auto inTissue = [&] {
    const bool touches = wouldTouch(arm, motion.arm_mm);
    if (!arm.proxy) return touches;
    if (touches) arm.proxy->place(motion.arm_mm);
    return touches || arm.proxy->standsInSolid(tissue, motion.arm_mm);
  };
  const bool first = !arm.placed;
  arm.placed = true;
  if (first) {
    if (arm.proxy) arm.proxy->place(motion.arm_mm);
    if (inTissue()) {
      arm.waiting = arm.proxy.has_value();
      events_.push_back({tick, EventKind::starts_in_tissue, std::int32_t(index), 0, {}});
    }
  }
  if (!arm.proxy) return;
  Proxy& proxy = *arm.proxy;
  if (arm.waiting) {
    if (journal_.busy()) {
      proxy.place(motion.arm_mm);
    } else if (!first) {
      arm.waiting = inTissue();
    }
    return;
  }
  const bool still = paused_ || arm.faults != 0;
  const Pose before = proxy.pose_mm();
  proxy.follow(tissue, motion.arm_mm, may_cut ? arm.cutting : Cutting::nothing);
  if (still) {
    if (wouldTouch(arm, proxy.pose_mm())) proxy.hold(before);
  } else {
    letGoOfHook(index, tick, motion);
  }
  motion.pose_mm = proxy.pose_mm();
}

void HapticCore::letGoOfHook(std::size_t index, std::uint64_t tick, const Motion& motion) {
  Arm& arm = arms_[index];
  const double T = parameters_.period_s;
  if (arm.letting_go == 0.0) {
    const bool far = arm.proxy->held() && glm::length(arm.proxy->pull().shift_mm) > kHooked_mm;
    arm.free_s = far && !wouldTouch(arm, motion.arm_mm) ? arm.free_s + T : 0.0;
    if (arm.free_s < kHooked_s) return;
    events_.push_back({tick, EventKind::let_go, std::int32_t(index), 0, {}});
  }
  arm.letting_go += T / kLetGo_s;
  arm.proxy->fade(std::max(0.0, 1.0 - arm.letting_go));
  if (arm.letting_go < 1.0 && arm.proxy->held()) return;
  if (!wouldTouch(arm, motion.arm_mm)) arm.proxy->place(motion.arm_mm);
  arm.letting_go = arm.free_s = 0.0;
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
  in.ball_radius_m = tool.ball_radius_m;
  if (arm.proxy) {
    in.pull = arm.proxy->pull();
    const int c = in.tip_class >= 0 ? in.tip_class : contact.tissue_class;
    in.parts = !tool.blunt &&
               (c < 0 || parameters_.tissues.classes[std::size_t(c)].cuttable != 0);
    in.ball_m = -tool.ball_radius_m * in.into_m;
    if (soft_push_) {
      in.push = arm.ball->push(writer_.grid(), *bricks_, stiffness_,
                               motion.pose_mm.position + 1000.0 * in.ball_m);
    }
  }
  return in;
}

// Whether the tool is at something that it may cut: its motor works on it, and what is lost there
// pays for cutting.
bool HapticCore::atWork(const Arm& arm, const Tool& tool) const {
  if (!arm.cuts) return false;
  if (arm.proxy && !arm.proxy->blockers().empty()) return true;
  const auto classes = arm.contact.classes().first(tool.cutting_points);
  return std::any_of(classes.begin(), classes.end(), [this](std::int8_t c) {
    return c >= 0 && parameters_.tissues.classes[std::size_t(c)].cuttable;
  });
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
  arm.energy_out_J += arm.gate.sent_N() * moved_m;  // the force held since the last tick
  const Vec3 velocity_m_s = moved_m / T;

  Motion motion;
  motion.arm_mm = parameters.map.toPatient_mm({sample.position_m, sample.orientation});
  motion.velocity_m_s = parameters.map.velocityToPatient(velocity_m_s);
  motion.turning_rad_s =
      parameters.map.rotation * (smallTurn(before.orientation, sample.orientation) / T);
  const bool jumped = glm::length(motion.velocity_m_s) > Removal::kFastest_m_s;
  if (!jumped) {
    arm.work.move(arm.gate.sent_N(), moved_m,
                  parameters.map.force_scale / parameters.map.motion_scale);
  }
  const bool may_cut = !paused_ && arm.faults == 0 && !journal_.busy();
  moveTool(index, may_cut, input.tick, motion);
  arm.last_pose = Pose{sample.position_m, sample.orientation};
  out.patient_position_mm = motion.arm_mm.position;
  out.patient_orientation = motion.arm_mm.orientation;
  out.proxy_position_mm = motion.pose_mm.position;
  out.proxy_orientation = motion.pose_mm.orientation;
  out.velocity_m_s = motion.velocity_m_s;

  LawInput law_input = touch(arm, parameters.tool, motion);
  out.tissue_class = arm.contact.contact().tissue_class;
  if (arm.proxy && firmer(parameters_.tissues, arm.proxy->heldBy(), out.tissue_class)) {
    out.tissue_class = arm.proxy->heldBy();
  }
  out.points_in_tissue = arm.contact.contact().points;

  ContactForce model;
  for (Law& law : arm.laws) addLaw(law, law_input, model);
  const Vec3 model_N = model.at(motion.velocity_m_s);
  out.demanded_N = parameters.map.forceToDevice(model_N);
  out.demanded_torque_Nm = parameters.map.torqueToDevice(model.torque_Nm);

  // The same contact once more, with the impedance that the controller lets this arm show.
  const double at_arm = parameters.map.motion_scale * parameters.map.force_scale;
  const Impedance demanded{at_arm * model.damping, at_arm * model.stiffest()};
  const Impedance limited = limitImpedance(arm.controller, demanded);
  law_input.share = {shareOf(limited.damping, demanded.damping),
                     shareOf(limited.stiffness, demanded.stiffness)};
  ControllerInput to_controller;
  ContactForce& rendered = to_controller.rendered;
  for (Law& law : arm.rendered_laws) addLaw(law, law_input, rendered);
  out.rendered_share = shareOf(rendered.at(motion.velocity_m_s), model_N, law_input.share);
  const double stored_J =
      givenBack_J(model, rendered, law_input.share.stiffness,
                  parameters.max_force_N / parameters.map.force_scale / out.rendered_share);
  // No arm here turns a hand. What the hand puts into a spring by turning, it puts in all the same.
  const double device_per_model = parameters.map.force_scale / parameters.map.motion_scale;
  to_controller.turned_J = -0.5 * T * device_per_model *
                           glm::dot(arm.last_elastic_Nm + rendered.elastic_torque_Nm,
                                    motion.turning_rad_s);
  arm.last_elastic_Nm = rendered.elastic_torque_Nm;
  rendered.elastic_N = parameters.map.forceToDevice(rendered.elastic_N);
  rendered.damped_turning_N = parameters.map.forceToDevice(rendered.damped_turning_N);
  rendered.stored_J *= device_per_model;
  rendered.stiffness = at_arm * rendered.stiffest();
  rendered.damping *= at_arm;
  const bool in_contact = law_input.touching || model.stiffest() > 0.0;
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
                      isFinite(model.stiffest()) && isFinite(model.damping) &&
                      isFinite(out.demanded_N) && isFinite(out.demanded_torque_Nm) &&
                      isFinite(out.bounded_N) && isFinite(velocity_m_s) &&
                      isFinite(out.velocity_m_s) && isFinite(motion.turning_rad_s) &&
                      isFinite(motion.arm_mm) && isFinite(motion.pose_mm) &&
                      isFinite(out.observer_J) && isFinite(out.alpha) && isFinite(arm.energy_out_J);
  if (!finite) {
    ++nonfinite_;
    latch(index, kFaultNonFinite, input.tick);
    for (Law& law : arm.laws) forgetLaw(law);
    for (Law& law : arm.rendered_laws) forgetLaw(law);
    forgetController(arm.controller);
    arm.work.forget();
    if (arm.proxy) arm.proxy->place(motion.arm_mm);
    arm.last_elastic_Nm = Vec3(0.0);
    if (!isFinite(arm.energy_out_J)) arm.energy_out_J = Vec3(0.0);
    out.velocity_m_s = out.demanded_N = out.demanded_torque_Nm = out.bounded_N = Vec3(0.0);
    out.observer_J = out.alpha = 0.0;
    out.rendered_share = 1.0;
  }
  out.clamped_N = clampForce(out.bounded_N, parameters.max_force_N);
  const bool open = !paused_ && arm.faults == 0;
  // While voxels come back in slices, tissue may yet fill in around the tool.
  const bool in_tissue = (arm.proxy ? arm.waiting : in_contact) || journal_.busy();
  if (arm.waiting && !arm.gate.waitingForAir()) arm.gate.restored();
  out.sent_N = arm.gate.pass(out.clamped_N, in_tissue, open, input.late_ns, T);
  out.energy_out_J = arm.energy_out_J;
  arm.not_as_stated = arm.not_as_stated || (out.controller_parts & kPartArmNotAsStated);
  if (arm.not_as_stated) out.controller_parts |= kPartArmNotAsStated;
  if (out.clamped_N != out.bounded_N) out.controller_parts |= kPartClamp;
  if (out.sent_N != out.clamped_N) out.controller_parts |= kPartLimiter;

  arm.cuts = open && arm.cutting != Cutting::nothing && !journal_.busy() && !arm.gate.waitingForAir();
  const bool at_work = atWork(arm, parameters.tool);
  const double motor_J = at_work ? T * parameters.tool.made_from.motor_W : 0.0;
  if (finite && !jumped) {
    arm.work.take(-0.5 * T * glm::dot(arm.last_model_N + model_N, motion.velocity_m_s));
  }
  arm.last_model_N = finite ? model_N : Vec3(0.0);
  const double more_J = finite ? arm.work.hold(stored_J, out.rendered_share, motor_J) : 0.0;
  arm.removal.earn(at_work && !jumped ? more_J : 0.0, arm.work.lost_J(), parameters_.tissues);
  if (arm.waiting || arm.gate.waitingForAir()) out.tool_state |= kToolWaits;
  if (arm.proxy && arm.proxy->held()) out.tool_state |= kToolHeld;
  if (arm.letting_go > 0.0) out.tool_state |= kToolLetGo;
  out.hand_work_J = arm.work.done_J();
  out.stored_J = arm.work.stored_J();
  out.cutting_credit_J = arm.removal.credit_J();
  out.faults = arm.faults;
}

}  // namespace trephine
