// What the laws say of a contact, and what a controller is told in a tick.
#pragma once

#include "base/math.h"

namespace trephine {

// The force on the arm is elastic_N - damping v - damped_rotation_N, v the velocity of the tool's
// tip, which the arm moves; around the sampled position it changes by -stiffness per metre. One
// frame throughout: patient axes from the laws, device axes at the controller.
struct ContactForce {
  Vec3 elastic_N{0.0};
  double stiffness = 0.0;        // N/m, of soft tissue: along any way
  double solid_stiffness = 0.0;  // N/m, of what stops the tool: along the surface there is none
  double damping = 0.0;          // N s/m, the sum over the tool's points
  double stored_J = 0.0;         // energy of the springs behind elastic_N
  Vec3 damped_rotation_N{0.0};   // sum of damping_i (omega x r_i), of the points about the tip
  Vec3 torque_Nm{0.0};           // about the tip, at the sampled position and velocity
  Vec3 elastic_torque_Nm{0.0};   // the springs' part of it

  // In the direction in which it is stiffest: where solid tissue stops a tool, soft tissue acts
  // only across that.
  double stiffest() const { return stiffness > solid_stiffness ? stiffness : solid_stiffness; }
  void addElasticTorque(const Vec3& Nm) {
    torque_Nm += Nm;
    elastic_torque_Nm += Nm;
  }
  Vec3 at(const Vec3& velocity_m_s) const {
    return elastic_N - damping * velocity_m_s - damped_rotation_N;
  }
};

// One spring, deflected by elastic_N / stiffness, and a damper.
inline ContactForce springAndDamper(const Vec3& elastic_N, double stiffness, double damping) {
  ContactForce out;
  out.elastic_N = elastic_N;
  out.stiffness = stiffness;
  out.damping = damping;
  out.stored_J = stiffness > 0.0 ? glm::dot(elastic_N, elastic_N) / (2.0 * stiffness) : 0.0;
  return out;
}

struct ControllerInput {
  Vec3 demanded_N{0.0};    // of the model, on the arm
  ContactForce rendered;   // of the impedance that the controller allowed
  bool touching = false;
  Vec3 position_m{0.0};    // sampled
  Vec3 velocity_m_s{0.0};  // backward difference
  Vec3 last_sent_N{0.0};   // by the tick before
  double rotation_work_J = 0.0;  // done on the springs since then by turning the tool
  double period_s = 0.001;
};

}  // namespace trephine
