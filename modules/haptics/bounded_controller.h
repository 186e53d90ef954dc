// The controller `bounded`: stable on any arm at any setting, and silent where nothing is wrong.
// Its parts, in the order of a tick, with equations, sources and what each gave: CONTROLLERS.md.
#pragma once

#include <cstdint>

#include "haptics/arm_check.h"
#include "haptics/arm_estimator.h"
#include "haptics/contact_force.h"
#include "haptics/count_pair.h"
#include "haptics/rest_hold.h"

namespace trephine {

// Which parts changed the force of a tick: of every difference between the demanded and the bounded
// force, and between that and the sent one, the parts that made it.
enum ControllerPart : std::uint32_t {
  kPartArmBound = 1u << 0,    // the tissue is firmer than this arm renders
  kPartLearned = 1u << 1,     // less is rendered than the arm could: this hand made it shake
  kPartDamping = 1u << 2,     // damping was added: a little beside every spring, more once learnt
  kPartCredit = 1u << 3,      // the force would have given out more energy than was put in
  kPartEstimate = 1u << 4,    // where the arm is and how fast, estimated and not as sampled
  kPartPrediction = 1u << 5,  // the force is for when it acts, and for the motion that it causes
  kPartHold = 1u << 6,        // the arm rests: the force is held
  kPartClamp = 1u << 7,       // more than the arm gives; of the sent force set by the core
  kPartLimiter = 1u << 8,     // ramps, pauses and faults; set by the core
  // Not of one tick: the arm's mass or delay is not what was stated. Stays for the session.
  kPartArmNotAsStated = 1u << 9,
};

// A scale that is learnt, 1 at first. What was lowered comes back: in air slowly, and in contact once
// nothing happened for a while, quickly up to just below where it was when something happened, and
// beyond that slowly, so that it does not run into the same again and again.
struct LearntScale {
  double value = 1.0;

  void lower(double by, double floor);
  void inContact(double period_s);
  void inAir(double period_s);

 private:
  double tried_ = 1.0;     // where something happened last
  double quiet_s_ = 1e9;   // in contact, since
};

class BoundedController {
 public:
  // Everything in device metres and newtons.
  BoundedController(const ArmDynamics& arm, double period_s);

  // What the laws shall render of a tissue with this impedance at the arm.
  Impedance limit(const Impedance& tissue);
  // The force for the next period. `in.rendered` is of the impedance that limit() gave.
  Vec3 bound(const ControllerInput& in);
  // After an undo or reset. What was learnt of the hand and the arm stays. A controller that begins in
  // a contact takes what the spring holds then for put in.
  void forget();

  double energy_J() const { return energy_J_; }
  // The smaller of the learnt scales: 1 where nothing was learnt.
  double alpha() const {
    return stiffness_.value < damping_.value ? stiffness_.value : damping_.value;
  }
  std::uint32_t parts() const { return parts_; }

 private:
  // Where the arm will be when the force of this tick begins to act, and the credit then.
  struct Ahead {
    Vec3 position_m, velocity_m_s;
    double credit_J;
  };

  Vec3 heldForce(const Vec3& last_sent_N);
  void account(const ControllerInput& in, const Vec3& held_N);
  void owe();
  void learn(bool touching);
  Ahead ahead() const;
  Vec3 render(const ControllerInput& in, const Ahead& at);
  Vec3 limitToCredit(const Vec3& force_N, const Ahead& at);
  void watchForce(const Vec3& force_N, bool touching);
  double mass_kg() const { return arm_.apparent_mass_kg / check_.lighter(); }
  void flag(ControllerPart part, const Vec3& difference_N);

  double T_;
  ArmDynamics arm_;     // as stated
  Impedance most_;      // what this arm renders
  double tolerance_J_;  // energy that an encoder cannot see
  ArmEstimator estimator_;
  ArmCheck check_;
  RestHold hold_;
  CountPair counts_;
  // Forces that were sent, the newest first: as many as the longest delay that may be found, and
  // the one that acted before them.
  std::array<Vec3, kMaxDelayTicks + 2> sent_N_{};

  LearntScale damping_, stiffness_;  // of most_
  double impact_ = 1.0;              // 1 as contact begins, fading
  bool started_ = false;
  bool was_touching_ = false;
  Vec3 last_estimate_m_{0.0}, last_seen_m_{0.0};
  double last_stiffness_ = 0.0;
  double tissue_stiffness_ = 0.0;    // as demanded
  double energy_J_ = 0.0;            // put into the environment and not given back, capped
  double owed_J_;                    // given out beyond what was put in, before a scale falls
  double stored_as_seen_J_ = 0.0;    // in the rendered spring
  double dissipated_J_ = 0.0, most_dissipated_J_ = 0.0;  // of this contact
  Vec3 last_force_N_{0.0};
  double variation_N_ = 0.0;  // mean |change of force| per tick, leaky
  Vec3 drift_N_{0.0};         // mean change of force per tick, leaky
  int not_obeyed_ticks_ = 0;  // above 0: other forces act than this controller computed
  std::uint32_t parts_ = 0;
  std::uint32_t held_with_ = 0;  // kPartLearned where what is held was learnt
};

}  // namespace trephine
