// An arm that is taken off its tool and put back to it elsewhere in its workspace.
#include <cmath>

#include "haptics/arm_tick.h"

namespace trephine {

namespace {

// A tool in tissue whose arm comes back turned by more would sweep through it.
constexpr double kTurned_rad = 0.035;

bool isRotation(const Quat& q) {
  return isFinite(q) && std::abs(glm::dot(q, q) - 1.0) < 1e-6;
}

}  // namespace

// No more than noted for what needs to know where the arm is.
void HapticCore::releaseArm(const Command& command) {
  Arm& arm = arms_[std::size_t(command.arm)];
  if (command.kind != CommandKind::clutch_on) {
    if (command.kind == CommandKind::clutch_off && !arm.clutched) return;
    arm.remap = command.kind;
    arm.turn_to.reset();
    arm.as_exercise = command.kind == CommandKind::recentre && command.value == 1;
    if (command.value == 1 && isRotation(command.rotation)) arm.turn_to = command.rotation;
    return;
  }
  arm.remap = CommandKind::none;
  if (arm.clutched || !arm.placed) return;
  arm.clutched = true;
  forgetController(arm.controller);
  arm.limiter.release();
}

// The arm is where its tool stayed. What was pressed into the tool's springs as it was clutched is
// lost: it begins without a pull, and friction without a stretch.
void HapticCore::engageArm(ArmTick& now, const Pose& device_m) {
  Arm& arm = now.arm;
  WorkspaceMap& map = parameters_.arms[now.index].map;
  const Pose tool_mm = arm.tool_mm;
  arm.remap = CommandKind::none;
  arm.clutched = false;
  if (arm.turn_to) map.rotation = *arm.turn_to;
  map.centre_mm += tool_mm.position - map.toPatient_mm(device_m).position;
  const Pose arm_mm = map.toPatient_mm(device_m);
  const bool turned = glm::length(smallTurn(tool_mm.orientation, arm_mm.orientation)) > kTurned_rad;
  const bool in_tissue =
      turned && (wouldTouch(arm.tool(), tool_mm) || startsInTissue(arm.tool(), arm_mm));
  arm.limiter.engage();
  forgetForce(arm, in_tissue);
  for (Law& law : arm.tool().laws) engageLaw(law);
  if (arm.tool().soft) arm.tool().soft->forget();
  arm.last_model_N = arm.last_elastic_Nm = Vec3(0.0);
  if (turned && arm.tool().proxy) arm.tool().proxy->place(arm_mm);
}

void HapticCore::recentreArm(ArmTick& now, const Pose& device_m) {
  Arm& arm = now.arm;
  WorkspaceMap& map = parameters_.arms[now.index].map;
  arm.remap = CommandKind::none;
  arm.clutched = false;
  map = arm.exercise_map;
  if (!arm.as_exercise) {
    map.centre_mm += arm.exercise_map.centre_mm - map.toPatient_mm(device_m).position;
  }
  arm.limiter.engage();
  forgetForce(arm, true);
  arm.last_model_N = arm.last_elastic_Nm = Vec3(0.0);
  placeTool(arm.tool(), map.toPatient_mm(device_m));
}

}  // namespace trephine
