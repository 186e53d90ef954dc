// The other way round than the plugin goes: which counts a tip has, and which force some currents
// make. For the emulated arm and the tests of its geometry.
#pragma once

#include "woodenhaptics/kinematics.h"

namespace trephine::test {

// The angles at which the tip is there [m], the elbow as the arm is built. False out of its reach.
bool anglesAt(const woodenhaptics::Vector& tip_m, woodenhaptics::Vector& angles);
woodenhaptics::Vector countsAt(const woodenhaptics::Vector& angles);
woodenhaptics::Vector torquesOf(const woodenhaptics::Vector& currents_A);
// At the tip; zero where the arm is stretched.
woodenhaptics::Vector forceOf(const woodenhaptics::Vector& angles,
                              const woodenhaptics::Vector& torques_Nm);
// Of the links, U = g (m_b l_b cos tB + m_c (L_b cos tB - l_c cos tC)).
double potential_J(const woodenhaptics::Vector& angles);

}  // namespace trephine::test
