// What the steps of an arm's tick hand on, each to those after it. Inside the core.
#pragma once

#include "haptics/haptic_core.h"

namespace trephine {

struct HapticCore::ArmTick {
  const TickInput& input;
  const std::size_t index;
  Arm& arm;
  const ArmParameters& parameters;
  ArmRecord& out;

  // sample
  Vec3 velocity_m_s{0.0};  // device axes, backward difference
  bool jumped = false;     // faster than any hand: no work was done on the way
  Motion motion{};
  bool drags = false;  // dry friction of solid tissue holds the proxy back
  // contact and proxy
  LawInput contact{};
  // demanded: by the tissue, patient axes
  ContactForce model{};
  Vec3 model_N{0.0};
  // rendered: with the impedance that the controller allows, patient axes
  ContactForce rendered{};
  double stored_J = 0.0;  // energy that the springs can give back, in the model's units
  // bounded
  bool in_contact = false;
  bool finite = true;
};

}  // namespace trephine
