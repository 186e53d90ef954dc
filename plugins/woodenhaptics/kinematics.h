// WoodenHaptics: from motor angles to the tip and from a force there to motor currents. Pure. The
// numbers are those of the published open arm; SI units; the arm's own frame: x towards the user, y
// to the right, z up.
#pragma once

#include <array>

namespace trephine::woodenhaptics {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

constexpr double kCountsPerTurn = 2000.0;
constexpr double kCapstan_m = 0.010;                           // diameter, on each motor
constexpr Vector kDrum_m{0.160, 0.120, 0.120};                 // diameters, of joints a, b and c
constexpr double kLn_m = 0.080, kLb_m = 0.205, kLc_m = 0.245;  // links
constexpr Vector kOrigin_m{0.220, 0.0, 0.080};                 // of the workspace
constexpr double kTorque_Nm_per_A = 0.0259;
constexpr double kMost_A = 3.0;  // the firmware clamps at it
constexpr double kPeak_N = 3.8;  // what 3 A give everywhere in the box, in any direction
// For gravity: masses of links b and c, and how far their centres are along them.
constexpr double kMassB_kg = 0.170, kMassC_kg = 0.110, kCentreB_m = 0.051, kCentreC_m = 0.091;
constexpr double kGravity_m_s2 = 9.82;
// The way a joint turns with its counts, and a motor with its joint's torque.
constexpr Vector kCountSign{-1.0, -1.0, -1.0};
constexpr Vector kTorqueSign{1.0, -1.0, -1.0};

// Angles of the joints [rad] at encoder counts, all counts zero where the arm was switched on:
// link b upright, link c level.
Vector jointAngles(const Vector& counts);

// The tip from the origin [m].
Vector tip(const Vector& angles);
// d tip / d angles [m/rad].
Matrix jacobian(const Vector& angles);

// Torques of the joints [Nm] that make `force_N` at the tip: J^T F.
Vector jointTorques(const Vector& angles, const Vector& force_N);
// What holds the links up: the gradient of their potential
//   U = g (m_b l_b cos tB + m_c (L_b cos tB - l_c cos tC)).
Vector gravityTorques(const Vector& angles);

// Motor currents [A] that make these torques, all shortened alike where one is above the most, so
// that the force keeps its direction.
Vector currents(const Vector& torques_Nm);

}  // namespace trephine::woodenhaptics
