// The controller `bounded`: stable on any arm at any setting, and silent where nothing is wrong.
// Its parts, in the order of a tick, with equations, sources and what each gave: CONTROLLERS.md.
#pragma once

#include <cstdint>

#include "haptics/arm_estimator.h"
#include "haptics/contact_force.h"

namespace trephine {

// Which parts of the controller changed the force of a tick.
enum ControllerPart : std::uint32_t {
  kPartArmBound = 1u << 0,  // the tissue is firmer than this arm renders
  kPartLearned = 1u << 1,   // less is rendered than the arm could: this hand made it shake
  kPartDamping = 1u << 2,   // damping was added, since stiffness was learnt to be too high
  kPartCredit = 1u << 3,    // the force would have given out more energy than was put in
};

class BoundedController {
 public:
  // Everything in device metres and newtons.
  BoundedController(const ArmDynamics& arm, double period_s);

  // What the laws shall render of a tissue with this impedance at the arm.
  Impedance limit(const Impedance& tissue);
  // The force for the next period. `in.rendered` is of the impedance that limit() gave.
  Vec3 bound(const ControllerInput& in);
  // After an undo or reset: no credit. What was learnt of the hand and the arm stays.
  void forget();

  double energy_J() const { return energy_J_; }
  // The smaller of the learnt scales: 1 where nothing was learnt.
  double alpha() const {
    return scale_.stiffness < scale_.damping ? scale_.stiffness : scale_.damping;
  }
  std::uint32_t parts() const { return parts_; }

 private:
  void account(const ControllerInput& in, const Vec3& held_N);
  void learn(bool touching);
  Vec3 limitToCredit(const Vec3& force_N, const Vec3& velocity_m_s, const Vec3& hand_m_s2,
                     double credit_J);

  double T_;
  ArmDynamics arm_;
  Impedance most_;      // what this arm renders
  double tolerance_J_;  // energy that an encoder cannot see
  ArmEstimator estimator_;
  std::array<Vec3, kMaxDelayTicks> pending_{};  // sent, not yet at the arm; the oldest first

  Impedance scale_{1.0, 1.0};  // learnt, of most_
  double impact_ = 1.0;        // 1 as contact begins, fading
  Vec3 last_estimate_m_{0.0};
  bool started_ = false;
  bool was_touching_ = false;
  double last_stiffness_ = 0.0;
  double energy_J_ = 0.0;  // put into the environment and not given back, capped
  double stored_J_ = 0.0;  // in the rendered spring
  double dissipated_J_ = 0.0, most_dissipated_J_ = 0.0;  // of this contact
  Vec3 last_force_N_{0.0};
  double variation_N_ = 0.0;  // mean |change of force| per tick, leaky
  Vec3 drift_N_{0.0};         // mean change of force per tick, leaky
  int not_obeyed_ticks_ = 0;  // above 0: other forces act than this controller computed
  std::uint32_t parts_ = 0;
};

}  // namespace trephine
