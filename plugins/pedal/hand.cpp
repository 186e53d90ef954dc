#include "hand.h"

#include <algorithm>
#include <cmath>

namespace trephine::pedal {

namespace {

constexpr double kEnd = 350.0;     // what a cap counts at its end
constexpr double kMostPull = 0.9;  // of the arm's peak force

double share(double count, double dead_zone) {
  const double along = std::clamp(count / kEnd, -1.0, 1.0);
  const double size = std::abs(along);
  if (size <= dead_zone) return 0.0;
  return std::copysign((size - dead_zone) / (1.0 - dead_zone), along);
}

Vector inDeviceFrame(const std::array<std::int16_t, 3>& counts, double dead_zone, double most) {
  return {most * share(counts[0], dead_zone), most * share(-double(counts[2]), dead_zone),
          most * share(counts[1], dead_zone)};
}

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

Vector speedOf(const HandConfig& config, const Cap& cap) {
  return inDeviceFrame(cap.push, config.dead_zone, config.speed_m_s);
}

Vector turnOf(const HandConfig& config, const Cap& cap) {
  return inDeviceFrame(cap.turn, config.dead_zone, config.turn_rad_s);
}

void advance(VirtualArm& arm, const Vector& speed_m_s, const Vector& turn_rad_s,
             const Vector& force_N, double dt_s) {
  const Vector& at = arm.motion.position_m;
  Vector& rest = arm.hand.rest_m;
  // A rest pose that is ahead already, since something has pushed the arm away, need not come back.
  const double ahead = std::max(
      kMostPull * arm.parameters.peak_force_N / arm.hand.stiffness_N_per_m, distance(rest, at));
  for (std::size_t axis = 0; axis < 3; ++axis) rest[axis] += speed_m_s[axis] * dt_s;
  const double wanted = distance(rest, at);
  if (wanted > ahead) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rest[axis] = at[axis] + (rest[axis] - at[axis]) * (ahead / wanted);
    }
  }
  const Vector inside = insideWorkspace(arm.parameters, rest);
  const bool at_limit = inside != rest;
  rest = inside;
  arm.motion = simulated::advance(arm.parameters, arm.hand, arm.motion, force_N, dt_s);
  arm.motion.at_limit = arm.motion.at_limit || at_limit;

  // q' = 1/2 (0, turn) q, about the axes of the device.
  const std::array<double, 4> q = arm.orientation;
  const Vector half{0.5 * dt_s * turn_rad_s[0], 0.5 * dt_s * turn_rad_s[1],
                    0.5 * dt_s * turn_rad_s[2]};
  arm.orientation = {q[0] - half[0] * q[1] - half[1] * q[2] - half[2] * q[3],
                     q[1] + half[0] * q[0] + half[1] * q[3] - half[2] * q[2],
                     q[2] + half[1] * q[0] + half[2] * q[1] - half[0] * q[3],
                     q[3] + half[2] * q[0] + half[0] * q[2] - half[1] * q[1]};
  double square = 0.0;
  for (double part : arm.orientation) square += part * part;
  for (double& part : arm.orientation) part /= std::sqrt(square);
}

}  // namespace trephine::pedal
