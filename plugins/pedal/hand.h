// The hand that a SpaceMouse stands for: how its cap is held is how fast the hand moves and turns.
// Pure: no clock, no device, no allocation.
#pragma once

#include <array>

#include "../simulated/simulated_arm.h"
#include "reports.h"

namespace trephine::pedal {

using simulated::Vector;

struct HandConfig {
  double speed_m_s = 0.1;   // with the cap pushed to its end
  double turn_rad_s = 1.5;  // with the cap turned to its end
  double dead_zone = 0.05;  // of the way to the end: a cap at rest is not quite at zero
};

// The arm in that hand: as resources/devices/omni.json has it but for its friction, which no
// motor shows in a cap, held firmly.
struct VirtualArm {
  simulated::ArmParameters parameters{0.045, 0.05, 0.000055, {0.16, 0.12, 0.07}, 3.3};
  simulated::Hand hand{{}, 600.0, 4.0};
  simulated::ArmMotion motion;
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
};

// Speeds in the device frame (+x right, +y up, +z towards the user) of a cap that counts to the
// right, towards the user and down.
Vector speedOf(const HandConfig& config, const Cap& cap);
Vector turnOf(const HandConfig& config, const Cap& cap);

// Moves the hand's rest pose, and the arm that it holds under the force. The rest pose stays in the
// workspace, and goes no farther ahead of the arm than the hand then pulls with nine tenths of the
// arm's peak force: what holds the arm back would else be overcome by and by, however firm it is.
void advance(VirtualArm& arm, const Vector& speed_m_s, const Vector& turn_rad_s,
             const Vector& force_N, double dt_s);

}  // namespace trephine::pedal
