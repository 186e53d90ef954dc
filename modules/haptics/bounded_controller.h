// The controller `bounded`: keeps an arm from shaking and from giving out energy, and is silent
// where nothing is wrong. CONTROLLERS.md has its parts, in the order of a tick, with equations,
// sources and what each gave, and on which arms, hands and tissues it does so, and on which not.
#pragma once

#include <cstdint>

#include "haptics/arm_check.h"
#include "haptics/arm_estimator.h"
#include "haptics/contact_force.h"
#include "haptics/count_pair.h"
#include "haptics/rest_hold.h"
#include "haptics/touch_version.h"

namespace trephine {

// Which parts changed the force of a tick: of every difference between the demanded and the bounded
// force, and between that and the sent one, the parts that made it.
enum ControllerPart : std::uint32_t {
  kPartArmBound = 1u << 0,    // the tissue is firmer than this arm renders
  kPartLearned = 1u << 1,     // a learnt scale lowers what the arm could render
  kPartDamping = 1u << 2,     // damping was added: a little beside every spring, more once learnt
  kPartCredit = 1u << 3,      // the force would have given out more energy than was put in
  kPartEstimate = 1u << 4,    // position and velocity are estimated, not as sampled
  kPartPrediction = 1u << 5,  // the force is for when it acts, and for the motion that it causes
  kPartHold = 1u << 6,        // the arm rests: the force is held
  kPartClamp = 1u << 7,       // above the arm's greatest force; of the sent force set by the core
  kPartLimiter = 1u << 8,     // ramps, pauses and faults; set by the core
  // The arm's mass or delay is not what was stated. Once set it stays for the session.
  kPartArmNotAsStated = 1u << 9,
};

// What a controller observed and did in a tick: fields of ArmRecord. Those of another controller
// are 0.
struct ControllerReport {
  double observer_J = 0.0, alpha = 0.0;       // `seed`
  double credit_J = 0.0, learnt_scale = 0.0;  // `bounded`
  std::uint32_t parts = 0;                    // ControllerPart
};

// A factor on the arm's greatest stiffness or damping, 1 at first. Each loss, debt or shaking
// lowers it. In air it comes back by 0.5 per second. In contact it comes back once there was none
// of these for 1.2 s: by 2.6 per second up to 0.92 of the value at which it was lowered last, and
// by 0.01 per second from there on.
struct LearntScale {
  double value = 1.0;

  void lower(double by, double floor);
  void inContact(double period_s);
  void inAir(double period_s);

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.value, self.tried_, self.quiet_s_);
  }

 private:
  double tried_ = 1.0;    // the value at which it was lowered last
  double quiet_s_ = 1e9;  // in contact, since then
};

class BoundedController {
 public:
  // Everything in device metres and newtons. `touch_version` below 11: without credit that comes
  // back at rest and without damping before a learnt scale is felt.
  BoundedController(const ArmDynamics& arm, double period_s, int touch_version = kTouchVersion);

  // What the laws shall render of a tissue with this impedance at the arm.
  Impedance limit(const Impedance& tissue);
  // The force for the next period. `in.rendered` is of the impedance that limit() gave.
  Vec3 bound(const ControllerInput& in);
  // After an undo or reset. What was learnt of the hand and the arm stays. A controller that begins
  // in a contact counts the energy that the spring has then as put in.
  void forget();

  ControllerReport report() const {
    return {.credit_J = credit_J(), .learnt_scale = learntScale(), .parts = parts()};
  }
  double credit_J() const { return credit_J_; }
  // The smaller of the learnt scales: 1 where nothing was learnt.
  double learntScale() const {
    return stiffness_.value < damping_.value ? stiffness_.value : damping_.value;
  }
  std::uint32_t parts() const { return parts_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.most_.damping, self.most_.stiffness);
    archive(self.estimator_, self.check_, self.hold_, self.counts_, self.sent_N_);
    archive(self.damping_, self.stiffness_, self.impact_);
    archive(self.started_, self.was_touching_);
    archive(self.last_estimate_m_, self.last_seen_m_, self.last_stiffness_);
    archive(self.credit_J_, self.owed_J_, self.stored_as_seen_J_);
    archive(self.dissipated_J_, self.most_dissipated_J_);
    archive(self.last_force_N_, self.variation_N_, self.drift_N_);
    archive(self.not_obeyed_ticks_, self.held_with_);
  }

 private:
  // Where the arm will be when the force of this tick begins to act, and the credit then.
  struct Ahead {
    Vec3 position_m, velocity_m_s;
    double credit_J;
  };

  struct Delay {
    int whole;
    double share;  // of a period more, below 1
  };
  Delay delay() const;
  // What acted since the last sample; `skew_N` as the estimator takes it.
  struct Held {
    Vec3 mean_N;
    Vec3 skew_N{0.0};
  };
  Held heldForce(const Vec3& last_sent_N);
  double workOf(const Held& held, const Vec3& moved_m) const;
  void account(const ControllerInput& in, const Held& held);
  void owe();
  void learn(bool touching);
  Ahead ahead() const;
  Vec3 render(const ControllerInput& in, const Ahead& at);
  Vec3 limitToCredit(const Vec3& force_N, const Ahead& at);
  void watchForce(const Vec3& force_N, bool touching);
  double mass_kg() const { return arm_.apparent_mass_kg / check_.lighter(); }
  void flag(ControllerPart part, const Vec3& difference_N);

  double T_;
  bool before_11_;      // of touch
  ArmDynamics arm_;     // as stated
  Impedance most_;      // what this arm renders
  double tolerance_J_;  // energy that an encoder cannot see
  ArmEstimator estimator_;
  ArmCheck check_;
  RestHold hold_;
  CountPair counts_;
  // Forces that were sent, the newest first: one for each tick of the longest delay that may be
  // found, and two more.
  std::array<Vec3, kMaxDelayTicks + 2> sent_N_{};

  LearntScale damping_, stiffness_;  // of most_
  double impact_ = 1.0;  // 1 as contact begins, fading with 5.25 ms: part 1 of CONTROLLERS.md
  bool started_ = false;
  bool was_touching_ = false;
  Vec3 last_estimate_m_{0.0}, last_seen_m_{0.0};
  double last_stiffness_ = 0.0;
  double tissue_stiffness_ = 0.0;    // as demanded
  double credit_J_ = 0.0;            // put into the environment and not given back, capped
  double owed_J_;                    // given out beyond what was put in, before a scale falls
  double stored_as_seen_J_ = 0.0;    // in the rendered spring, at the sample
  double dissipated_J_ = 0.0, most_dissipated_J_ = 0.0;  // of this contact
  Vec3 last_force_N_{0.0};
  double variation_N_ = 0.0;  // mean |change of force| per tick, leaky with 63 ms
  Vec3 drift_N_{0.0};         // mean change of force per tick, leaky with 63 ms
  int not_obeyed_ticks_ = 0;  // above 0: another force acts than this controller computed
  std::uint32_t parts_ = 0;
  std::uint32_t held_with_ = 0;  // kPartLearned where what is held was learnt
};

}  // namespace trephine
