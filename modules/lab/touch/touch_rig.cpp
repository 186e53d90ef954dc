#include "lab/touch/touch_rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trephine {

TouchRig::TouchRig(const HapticParameters& parameters, Volume volume,
                   const std::vector<RigArm>& arms, std::shared_ptr<const LabelMap> labels)
    : grid_(std::move(volume), std::move(labels)),
      core_(parameters, *grid_.takeWriter()),
      period_s_(parameters.period_s) {
  for (const RigArm& arm : arms) {
    arms_.push_back(
        {HeldArm(arm.mass_kg, arm.damping_Ns_per_m, arm.hand, period_s_), arm.encoder_m});
  }
}

void TouchRig::place(std::size_t arm, const Vec3& position_m) {
  arms_[arm].x = arms_[arm].rest_m = arms_[arm].last_rest_m = position_m;
  arms_[arm].v = Vec3(0.0);
}

const TickRecord& TouchRig::step() {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const Arm& arm = arms_[i];
    ArmSample& sample = input_.arms[i];
    sample.position_m =
        arm.encoder_m > 0.0 ? glm::round(arm.x / arm.encoder_m) * arm.encoder_m : arm.x;
    sample.orientation = arm.orientation;
  }
  core_.tick(input_, commands_.data(), commands_.size(), record_);
  commands_.clear();
  ++input_.tick;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    const Vec3& out_J = record_.arms[i].energy_out_J;
    arm.most_out_J = std::max(arm.most_out_J, out_J.x + out_J.y + out_J.z);
    const Vec3& force_N = record_.arms[i].sent_N;
    const Vec3 before_m = arm.x;
    const Vec3 speed_m_s = (arm.rest_m - arm.last_rest_m) / period_s_;
    for (int axis = 0; axis < 3; ++axis) {
      arm.plant.step(arm.x[axis], arm.v[axis], force_N[axis], arm.last_rest_m[axis],
                     speed_m_s[axis]);
    }
    arm.truly_out_J += glm::dot(force_N, arm.x - before_m);
    arm.most_truly_out_J = std::max(arm.most_truly_out_J, arm.truly_out_J);
    arm.last_rest_m = arm.rest_m;
  }
  return record_;
}

}  // namespace trephine
