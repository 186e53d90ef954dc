// An arm that takes another of its tools.
#include "haptics/arm_tick.h"

namespace trephine {

// The tool that is wanted, as soon as it may be taken.
void HapticCore::changeTool(ArmTick& now) {
  Arm& arm = now.arm;
  if (arm.wanted == arm.in_hand || !mayChangeTool(now)) return;
  takeTool(now.index, now.input.tick);
  ArmTool& tool = arm.tool();
  placeTool(tool, now.motion.arm_mm);
}

// Where neither the tool in hand nor the one that is wanted touches anything, and no force is left
// that would be gone at once.
bool HapticCore::mayChangeTool(ArmTick& now) {
  Arm& arm = now.arm;
  if (!arm.placed) return true;  // it starts with the tool that is wanted
  if (glm::length(arm.limiter.sent_N()) > kSlew_N_per_s * parameters_.period_s) return false;
  const ArmTool& tool = arm.tool();
  if ((tool.proxy && tool.proxy->held()) || wouldTouch(tool, arm.tool_mm)) return false;
  return !startsInTissue(arm.tools[arm.wanted], now.motion.arm_mm);
}

// Laws, proxy and controller of the arm begin anew, what it removes is another stroke, and the
// force rises as after any change. The work that the other tool had not spent is heat.
void HapticCore::takeTool(std::size_t index, std::uint64_t tick) {
  Arm& arm = arms_[index];
  arm.tools[arm.wanted].removal.follow(arm.tool().removal);
  arm.in_hand = arm.wanted;
  forgetForce(arm, false);
  forgetLaws(arm);
  arm.last_model_N = arm.last_elastic_Nm = Vec3(0.0);
  arm.let_go_share = arm.hooked_s = 0.0;
  journal_.endStroke(int(index));
  events_.push_back(
      {tick, EventKind::tool_changed, std::int32_t(index), std::uint32_t(arm.in_hand), {}});
}

}  // namespace trephine
