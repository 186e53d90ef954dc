// Where the tool of an arm can be, and what it touches there.
#include <algorithm>

#include "haptics/arm_tick.h"

namespace trephine {

namespace {

// A tool is hooked where its arm, itself in air, has been more than 15 mm from it for 0.5 s. Its
// force then fades to nothing within 0.2 s.
constexpr double kHooked_mm = 15.0, kHooked_s = 0.5, kLetGo_s = 0.2;

}  // namespace

bool HapticCore::wouldTouch(const ArmTool& tool, const Pose& pose_mm) const {
  return tool.contact.wouldTouch(tissue_, pose_mm);
}

// The tool's pose in this tick. Where no law stops it at solid tissue it is the arm's. In a pause
// or a fault it only moves through air.
void HapticCore::moveProxy(ArmTick& now) {
  Arm& arm = now.arm;
  ArmTool& tool = arm.tool();
  Motion& motion = now.motion;
  motion.pose_mm = motion.arm_mm;
  const bool first = !arm.placed;
  arm.placed = true;
  if (first) startAtArm(now);
  if (tool.proxy && arm.waiting) {
    if (tool.soft) tool.soft->place(motion.arm_mm);
    if (journal_.busy()) {
      tool.proxy->place(motion.arm_mm);
    } else if (!first) {
      arm.waiting = startsInTissue(tool, motion.arm_mm);
    }
  } else if (tool.proxy || tool.soft) {
    followArm(now);
  }
  arm.tool_mm = motion.pose_mm;
}

void HapticCore::placeTool(ArmTool& tool, const Pose& arm_mm) const {
  if (tool.proxy) tool.proxy->place(arm_mm);
  if (tool.soft) tool.soft->place(arm_mm);
}

// A tool that starts in tissue has no force and cuts nothing until it has been out of it.
void HapticCore::startAtArm(ArmTick& now) {
  Arm& arm = now.arm;
  ArmTool& tool = arm.tool();
  placeTool(tool, now.motion.arm_mm);
  if (!startsInTissue(tool, now.motion.arm_mm)) return;
  arm.waiting = tool.proxy.has_value();
  events_.push_back({now.input.tick, EventKind::starts_in_tissue, std::int32_t(now.index), 0, {}});
}

// The tool at its arm. Its body is looked at only where none of its points is in tissue.
bool HapticCore::startsInTissue(ArmTool& tool, const Pose& arm_mm) {
  const bool touches = wouldTouch(tool, arm_mm);
  if (!tool.proxy) return touches;
  if (touches) tool.proxy->place(arm_mm);
  return touches || tool.proxy->standsInSolid(tissue_, arm_mm);
}

void HapticCore::followArm(ArmTick& now) {
  Arm& arm = now.arm;
  ArmTool& tool = arm.tool();
  const bool still = paused_ || arm.faults != 0;
  const Pose& arm_mm = now.motion.arm_mm;
  const bool stopped = still || (tool.proxy && tool.proxy->held());
  Pose to = arm_mm;
  if (tool.soft) {
    to = tool.soft->follow(tissue_, arm_mm, stopped, motorRuns(arm, now.out.buttons));
  }
  if (tool.proxy) {
    followBy(now, to, still);
    to = tool.proxy->pose_mm();
  }
  now.motion.pose_mm = tool.soft ? tool.soft->moved(tissue_, to, stopped) : to;
}

// The proxy goes towards where the tool would be by its arm and soft tissue.
void HapticCore::followBy(ArmTick& now, const Pose& wanted_mm, bool still) {
  Arm& arm = now.arm;
  ArmTool& tool = arm.tool();
  const Pose before = tool.proxy->pose_mm();
  const bool may_cut = !still && !journal_.busy();
  const Cutting cutting = may_cut ? tool.cutting : Cutting::nothing;
  // What a motor cuts rubs on the arm, and holds the tool by what is left to be cut alone.
  const bool runs = may_cut && motorRuns(arm, now.out.buttons);
  now.drags = !runs && parameters_.touch_version > 9 && names(parameters_.laws, LawKind::coulomb);
  const bool by_push = !runs && names(parameters_.laws, LawKind::friction);
  tool.proxy->follow(tissue_, wanted_mm, cutting, now.drags ? tool.rubs_N : 0.0, by_push);
  if (!still) {
    letGoOfHook(now);
  } else if (wouldTouch(tool, tool.proxy->pose_mm())) {
    tool.proxy->hold(before);
  }
}

void HapticCore::letGoOfHook(ArmTick& now) {
  Arm& arm = now.arm;
  ArmTool& tool = arm.tool();
  const Pose& arm_mm = now.motion.arm_mm;
  const double T = parameters_.period_s;
  if (arm.let_go_share == 0.0) {
    const bool far = tool.proxy->held() && glm::length(tool.proxy->pull().shift_mm) > kHooked_mm;
    arm.hooked_s = far && !wouldTouch(tool, arm_mm) ? arm.hooked_s + T : 0.0;
    if (arm.hooked_s < kHooked_s) return;
    events_.push_back({now.input.tick, EventKind::let_go, std::int32_t(now.index), 0, {}});
  }
  arm.let_go_share += T / kLetGo_s;
  tool.proxy->fade(std::max(0.0, 1.0 - arm.let_go_share));
  if (arm.let_go_share < 1.0 && tool.proxy->held()) return;
  if (!wouldTouch(tool, arm_mm)) placeTool(tool, arm_mm);
  arm.let_go_share = arm.hooked_s = 0.0;
}

// Which of the tool's points lie in which tissue: what the laws are told.
void HapticCore::touch(ArmTick& now) {
  ArmTool& tool = now.arm.tool();
  ArmRecord& out = now.out;
  const Motion& motion = now.motion;
  out.patient_position_mm = motion.arm_mm.position;
  out.patient_orientation = motion.arm_mm.orientation;
  out.proxy_position_mm = motion.pose_mm.position;
  out.proxy_orientation = motion.pose_mm.orientation;
  out.velocity_m_s = motion.velocity_m_s;

  const Contact& contact = tool.contact.update(tissue_, motion.pose_mm);
  touchPoints(tool, motion);
  LawInput& in = now.contact;
  in.tip_m = 0.001 * motion.pose_mm.position;
  in.velocity_m_s = motion.velocity_m_s;
  in.period_s = parameters_.period_s;
  in.tool_direction = motion.pose_mm.orientation * Vec3(0.0, 0.0, -1.0);
  in.points = tool.points;
  in.tissue_class = contact.tissue_class;
  in.tip_class = tool.contact.classes()[0];
  in.tissues = &tissue_.tissues();
  if (tool.proxy) {
    in.pull = tool.proxy->pull();
    in.pull.drags = now.drags && in.pull.stiffness > 0.0;
    tool.rubs_N = in.tissue_class < 0 ? 0.0 : rubbing_N(tool);
  }
  if (tool.soft) in.soft = tool.soft->pull();
  for (Law& law : tool.laws) law_tissues_.ask(law, tissue_, motion.pose_mm, in);

  out.tissue_class = contact.tissue_class;
  if (tool.proxy && tissue_.firmer(tool.proxy->heldBy(), out.tissue_class)) {
    out.tissue_class = tool.proxy->heldBy();
  }
  out.points_in_tissue = contact.points;
}

void HapticCore::touchPoints(ArmTool& tool, const Motion& motion) const {
  if (parameters_.force_at == ForceAt::tip) {
    tool.points[0].tissue_class = tool.contact.contact().tissue_class;
    return;
  }
  const std::span<const std::int8_t> classes = tool.contact.classes();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    TouchPoint& p = tool.points[i];
    p.tissue_class = classes[i];
    if (classes[i] < 0) continue;
    p.weight = tool.made.weights[i];
    p.lever_m = motion.pose_mm.orientation * tool.made.points_m[i];
    p.rotational_m_s = glm::cross(motion.angular_velocity_rad_s, p.lever_m);
  }
}

double HapticCore::rubbing_N(const ArmTool& tool) const {
  double sum_N = 0.0;
  for (const TouchPoint& p : tool.points) {
    if (p.tissue_class < 0 || !tissue_.isSolid(p.tissue_class)) continue;
    sum_N += p.weight * tissue_.ofClass(p.tissue_class).friction_N;
  }
  return sum_N;
}

// Whether the tool is at something that it may cut: its motor works on it, and what is lost there
// pays for cutting.
bool HapticCore::atWork(const Arm& arm) const {
  if (!arm.cuts) return false;
  const ArmTool& tool = arm.tool();
  if (tool.proxy && !tool.proxy->blockers().empty()) return true;
  const auto classes = tool.contact.classes().first(tool.made.cutting_points);
  return std::any_of(classes.begin(), classes.end(), [this](std::int8_t c) {
    return c >= 0 && tissue_.ofClass(c).cuttable;
  });
}

}  // namespace trephine
