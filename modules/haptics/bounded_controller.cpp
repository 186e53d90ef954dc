#include "haptics/bounded_controller.h"

#include <algorithm>
#include <cmath>

#include "haptics/unseen_energy.h"

namespace trephine {

namespace {

// Tuned on the stability grid and checked on cells that the tuning had not seen (CONTROLLERS.md).
constexpr double kDampingPerMassRate = 3.5;       // b_max = this m / tau_b
constexpr double kStiffnessPerMassRate = 0.2032;  // k_max = this m / tau_k^2
constexpr double kCountForce_N = 0.20161;         // k_max = this / encoder step
constexpr double kDelayInDamping = 0.4159;  // tau_b = T (1 + this d)
constexpr double kLagInStiffness = 0.27;    // tau_k = tau_b + this lag
// Less is rendered where a hand of this damping or stiffness, held against the mass, moves the arm
// more within the delay than the mass lets the force do. `Any`: of every hand; `Firm`: what a hand
// adds that was found to hold the arm back, by the share `held`.
constexpr double kAnyHandDamping = 5.6, kFirmHandDamping = 6.0106;          // N s/m
constexpr double kFirmHandStiffness = 1500.0, kFirmHandInDamping = 495.62;  // N/m
constexpr double kAnyHandShare = 0.10247;   // of a firm hand's stiffness, of every hand
constexpr double kFirmHandInCount = 0.14;   // how much of that lowers the encoder's bound
constexpr double kImpact = 9.6;             // stiffness added to k_max as contact begins, of k_max
constexpr double kImpactTime_s = 0.00525;   // time constant with which it fades in contact
constexpr double kImpactAgain_s = 0.05;     // time constant with which it comes back in air
constexpr double kCreditAbove_J = 3.5707e-4;  // credit beyond what the spring holds
// The tolerance is the energy that an encoder cannot see (unseen_energy.h).
constexpr double kMostDebt_J = 1e-3;        // credit is never less than minus this
constexpr double kCreditAtRest_s = 0.5;     // in which one tolerance of credit comes back
constexpr double kCreditSlack = 0.01;       // tolerances by which credit may be overdrawn
constexpr double kLossSeen = 0.39885;       // tolerances lost before stiffness is lowered
constexpr double kLossStep = 0.94;          // to this share of itself
constexpr double kOwed = 0.6;       // tolerances of overdrawn credit before both scales are lowered
constexpr double kOwedStep = 0.6;   // to this share of themselves
constexpr double kShaking_N = 0.1;  // mean |change of force| less |mean change|, per tick
constexpr double kShakingTime_s = 0.062929;  // time constant of these means
constexpr double kShakingStep = 0.95;        // to this share of itself
constexpr double kObeyed = 1e-9;           // of the peak force: rounding of the clamp
constexpr double kLeastDamping = 0.018;  // of sqrt(k m), always
constexpr double kLearntDamping = 1.4433;  // of sqrt(k m), once stiffness was lowered
// A scale that fell where the tissue is softer than it leaves the arm is not felt: the share of
// that damping then, all of it once stiffness has fallen by kAllLearnt.
constexpr double kUnfeltLearnt = 0.3, kAllLearnt = 0.1;
constexpr double kFloorDamping = 0.008432;
constexpr double kFloorStiffness = 0.2;
constexpr double kForget_per_s = 0.5062;  // growth of a scale in air, of itself
constexpr double kForgetAtRest = 0.5;     // of that, at rest in contact
constexpr double kQuiet_s = 1.2;          // in contact since it was lowered, before a scale grows
constexpr double kComesBack_per_s = 2.6;  // growth then, of itself,
constexpr double kBelowTried = 0.92;      // up to this share of where it was lowered last,
constexpr double kCreeps_per_s = 0.01;    // and growth beyond that
constexpr double kSameEvent_s = 0.3;      // lowerings so near each other count as one
constexpr double kWorthSaying_N = 1e-6;   // a change of the force by less is none
constexpr double kPartOfIt_N = 1e-7;      // nor is one by less of a single part

// Energy of a spring whose force is `force_N`, stretched by an arm that shows no more than
// `peak_N`.
double springEnergy(double force_N, double stiffness, double peak_N) {
  if (stiffness <= 0.0) return 0.0;
  const double within = std::min(force_N, peak_N);
  return (0.5 * within * within + peak_N * (force_N - within)) / stiffness;
}

// The greatest impedance that this arm renders, at the device. `held`: share of a firm hand, 0 to
// 1, that was found to hold the arm back. CONTROLLERS.md, part 1.
Impedance mostOf(const ArmDynamics& arm, double T, double lag_s, double held) {
  const double m = arm.apparent_mass_kg, delay_s = arm.delay_s;
  const double tau_b = T + kDelayInDamping * delay_s;
  const double tau_k = tau_b + kLagInStiffness * lag_s;
  const double damper = (kAnyHandDamping + held * kFirmHandDamping) * delay_s / m;
  const double spring = held * kFirmHandInDamping * delay_s * delay_s / m;
  const double stiffer = (kAnyHandShare + held) * kFirmHandStiffness * delay_s * delay_s / m;
  Impedance most;
  most.damping = kDampingPerMassRate * m / tau_b / (1.0 + damper * damper * damper * damper) /
                 (1.0 + spring * spring);
  most.stiffness = kStiffnessPerMassRate * m / (tau_k * tau_k) / (1.0 + stiffer * stiffer);
  if (arm.encoder_step_m > 0.0) {
    most.stiffness = std::min(most.stiffness, kCountForce_N / arm.encoder_step_m /
                                                  (1.0 + kFirmHandInCount * stiffer * stiffer));
  }
  return most;
}

}  // namespace

Renderable renderable(const ArmDynamics& arm, double rate_hz, double delay_samples,
                      const WorkspaceMap& map) {
  ArmDynamics delayed = arm;
  const double T = 1.0 / rate_hz;
  delayed.delay_s = T * delay_samples;
  const Impedance most = mostOf(delayed, T, ArmEstimator(delayed, T).lag_s(), 0.0);
  const double at_arm = map.motion_scale * map.force_scale;
  return {most.damping / at_arm, most.stiffness / at_arm};
}

void LearntScale::lower(double by, double floor) {
  if (quiet_s_ > kSameEvent_s) tried_ = value;
  quiet_s_ = 0.0;
  value = std::max(floor, value * by);
}

void LearntScale::inContact(double period_s) {
  quiet_s_ += period_s;
  if (value >= 1.0 || quiet_s_ < kQuiet_s) return;
  const double soon = kBelowTried * tried_;
  if (value < soon) {
    value = std::min(soon, value * (1.0 + period_s * kComesBack_per_s));
  } else {
    value = std::min(1.0, value * (1.0 + period_s * kCreeps_per_s));
    tried_ = std::min(1.0, std::max(tried_, value / kBelowTried));
  }
}

void LearntScale::inAir(double period_s) {
  const double growth = 1.0 + period_s * kForget_per_s;
  value = std::min(1.0, value * growth);
  tried_ = std::min(1.0, tried_ * growth);
}

BoundedController::BoundedController(const ArmDynamics& arm, double period_s, int touch_version)
    : T_(period_s),
      before_11_(touch_version < 11),
      arm_(arm),
      tolerance_J_(unseenEnergy_J(arm.encoder_step_m)),
      estimator_(arm_, period_s),
      check_(arm_, estimator_, period_s),
      hold_(arm_.encoder_step_m, period_s),
      counts_(arm_.encoder_step_m, period_s),
      owed_J_(kOwed * tolerance_J_) {
  most_ = mostOf(arm_, T_, estimator_.lag_s(), 0.0);
}

Impedance BoundedController::limit(const Impedance& tissue) {
  const Impedance arm{most_.damping, most_.stiffness * (1.0 + kImpact * impact_)};
  const Impedance learnt{damping_.value * arm.damping, stiffness_.value * arm.stiffness};
  const Impedance limited{std::min(tissue.damping, learnt.damping),
                          std::min(tissue.stiffness, learnt.stiffness)};
  tissue_stiffness_ = tissue.stiffness;
  parts_ = 0;
  if (tissue.damping > arm.damping || tissue.stiffness > arm.stiffness) parts_ |= kPartArmBound;
  if (limited.damping < std::min(tissue.damping, arm.damping) ||
      limited.stiffness < std::min(tissue.stiffness, arm.stiffness)) {
    parts_ |= kPartLearned;
  }
  return limited;
}

void BoundedController::forget() {
  started_ = was_touching_ = false;
  estimator_.forget();
  check_.forget();
  hold_.forget();
  sent_N_.fill(Vec3(0.0));
  credit_J_ = stored_as_seen_J_ = dissipated_J_ = most_dissipated_J_ = 0.0;
  owed_J_ = kOwed * tolerance_J_;
  last_stiffness_ = variation_N_ = 0.0;
  last_force_N_ = drift_N_ = Vec3(0.0);
}

// The mean of the force that acted since the last sample: with a delay of d ticks the one sent d
// ticks before the last, and for a share f of the period, where d is f more than a whole number,
// the one before that.
BoundedController::Held BoundedController::heldForce(const Vec3& last_sent_N) {
  const auto [whole, share] = delay();
  const int oldest = whole + (share > 0.0 ? 1 : 0);
  std::copy_backward(sent_N_.begin(), sent_N_.begin() + oldest + 1, sent_N_.begin() + oldest + 2);
  sent_N_[0] = last_sent_N;
  const Vec3& newer_N = sent_N_[std::size_t(whole)];
  if (share == 0.0) return {newer_N};
  const Vec3& older_N = sent_N_[std::size_t(whole) + 1];
  return {(1.0 - share) * newer_N + share * older_N, share * (1.0 - share) * (older_N - newer_N)};
}

BoundedController::Delay BoundedController::delay() const {
  const int whole = int(check_.delaySamples());
  return {whole, check_.delaySamples() - whole};
}

// By a force that is F1 for a share f of the period and F2 after it, over a motion s of a constant
// push beside it: F1 s1 + F2 (s - s1), where s1 - f s = -f (1 - f) T^2 / 2 times the mean
// acceleration.
double BoundedController::workOf(const Held& held, const Vec3& moved_m) const {
  const double work_J = glm::dot(held.mean_N, moved_m);
  if (held.skew_N == Vec3(0.0)) return work_J;
  const Vec3 mean_m_s2 = held.mean_N / mass_kg() + estimator_.handAcceleration_m_s2();
  return work_J - 0.5 * T_ * T_ * glm::dot(held.skew_N, mean_m_s2);
}

// Credit: the energy that the held force took from the arm over the last period, exact for any
// motion in between. Loss: what of it the rendered spring neither holds nor has given back.
void BoundedController::account(const ControllerInput& in, const Held& held) {
  const Vec3& x = estimator_.position_m();
  const double k = in.rendered.stiffness;
  Vec3 spring_N = in.rendered.elastic_N - k * (x - in.position_m);
  if (glm::dot(spring_N, in.rendered.elastic_N) <= 0.0) spring_N = Vec3(0.0);
  // Energy of all springs at the sample, less that of the one spring that is their sum, plus that
  // of the sum where the arm is.
  const double sum_N = glm::length(in.rendered.elastic_N);
  const double beside_J =
      k > 0.0 ? std::max(0.0, in.rendered.stored_J - sum_N * sum_N / (2.0 * k)) : 0.0;
  const double stored_J = beside_J + springEnergy(glm::length(spring_N), k, arm_.peak_force_N);
  if (started_) {
    credit_J_ += in.rotation_work_J - workOf(held, x - last_estimate_m_);
  } else if (in.touching) {
    credit_J_ = stored_J;  // begins in contact: what the spring holds counts as put in
  }
  // In a ramp the spring is stretched already but its force is not yet sent, so that no work
  // against it is seen: what it holds counts as put in.
  if (in.touching && not_obeyed_ticks_ > 0) credit_J_ = std::max(credit_J_, stored_J);
  owe();
  // A force that is held gives out nothing over a cycle, but the counts between which an arm rests
  // are counted as work: what they used up comes back, no faster than an encoder hides it.
  if (!before_11_ && in.touching && hold_.rests() && credit_J_ < stored_J) {
    credit_J_ += std::min(stored_J - credit_J_, T_ / kCreditAtRest_s * tolerance_J_);
  }
  credit_J_ = std::clamp(credit_J_, -kMostDebt_J, stored_J + kCreditAbove_J);

  // Losses are counted on the samples: the forces follow the estimate, so that counted on the
  // estimate a limit cycle between two counts loses nothing. Beside a spring, samples that
  // alternate between two counts stand for the middle of the two (count_pair.h).
  const Vec3 pair_m = counts_.look(in.position_m);
  const Vec3 seen_m = k > 0.0 ? pair_m : in.position_m;
  Vec3 seen_N = in.rendered.elastic_N - k * (seen_m - in.position_m);
  if (glm::dot(seen_N, in.rendered.elastic_N) <= 0.0) seen_N = Vec3(0.0);
  const double as_seen_J = beside_J + springEnergy(glm::length(seen_N), k, arm_.peak_force_N);
  if (!in.touching || not_obeyed_ticks_ > 0) {
    dissipated_J_ = most_dissipated_J_ = 0.0;
  } else if (was_touching_ && k <= last_stiffness_) {
    // Not where the spring became stiffer: its energy rises then without any motion.
    const double put_in_J = in.rotation_work_J - workOf(held, seen_m - last_seen_m_);
    dissipated_J_ += put_in_J - (as_seen_J - stored_as_seen_J_);
    most_dissipated_J_ = std::max(most_dissipated_J_, dissipated_J_);
  }
  stored_as_seen_J_ = as_seen_J;
  last_stiffness_ = k;
  last_estimate_m_ = x;
  last_seen_m_ = seen_m;
  was_touching_ = in.touching;
  started_ = true;
}

// Both scales fall each time that credit is overdrawn by another 0.6 tolerances: late forces then
// do work that no sample shows in time.
void BoundedController::owe() {
  if (credit_J_ > 0.0) owed_J_ = kOwed * tolerance_J_;
  if (!(credit_J_ < -owed_J_) || !started_ || not_obeyed_ticks_ > 0) return;
  owed_J_ = kOwed * tolerance_J_ - credit_J_;
  stiffness_.lower(kOwedStep, kFloorStiffness);
  damping_.lower(kOwedStep, kFloorDamping);
}

// Lowers the scales where energy was lost or the force shakes; else lets them come back.
void BoundedController::learn(bool touching) {
  impact_ += touching ? -impact_ * std::min(1.0, T_ / kImpactTime_s)
                      : (1.0 - impact_) * std::min(1.0, T_ / kImpactAgain_s);
  const bool elastic = last_stiffness_ > 0.0;
  if (most_dissipated_J_ - dissipated_J_ > kLossSeen * tolerance_J_) {
    most_dissipated_J_ = dissipated_J_;
    if (!elastic || stiffness_.value <= kFloorStiffness) damping_.lower(kLossStep, kFloorDamping);
    if (elastic) stiffness_.lower(kLossStep, kFloorStiffness);
  }
  if (variation_N_ - glm::length(drift_N_) > kShaking_N) {
    damping_.lower(kShakingStep, kFloorDamping);
    if (elastic) stiffness_.lower(kShakingStep, kFloorStiffness);
    variation_N_ = 0.0;
    drift_N_ = Vec3(0.0);
  }
  if (!touching || (hold_.rests() && not_obeyed_ticks_ == 0)) {
    const double period_s = touching ? kForgetAtRest * T_ : T_;
    damping_.inAir(period_s);
    stiffness_.inAir(period_s);
  } else if (not_obeyed_ticks_ == 0) {
    damping_.inContact(T_);
    stiffness_.inContact(T_);
  }
}

BoundedController::Ahead BoundedController::ahead() const {
  Ahead at{estimator_.position_m(), estimator_.velocity_m_s(),
           credit_J_ + kCreditSlack * tolerance_J_};
  const double per_kg = 1.0 / mass_kg();
  const auto [whole, share] = delay();
  const auto act = [&](const Vec3& pending_N, double for_s) {
    const Vec3 a = pending_N * per_kg + estimator_.handAcceleration_m_s2();
    const Vec3 step = for_s * at.velocity_m_s + (0.5 * for_s * for_s) * a;
    at.credit_J -= glm::dot(pending_N, step);
    at.position_m += step;
    at.velocity_m_s += for_s * a;
  };
  if (share > 0.0) act(sent_N_[std::size_t(whole)], share * T_);
  for (int i = whole - 1; i >= 0; --i) act(sent_N_[std::size_t(i)], T_);
  return at;
}

void BoundedController::flag(ControllerPart part, const Vec3& difference_N) {
  if (glm::dot(difference_N, difference_N) > kPartOfIt_N * kPartOfIt_N) parts_ |= part;
}

// The mean force of a spring and damper over the period, solved for the motion that it causes: the
// spring by the implicit midpoint, the damper by a rational form of the exponential
// (CONTROLLERS.md, part 5).
Vec3 BoundedController::render(const ControllerInput& in, const Ahead& at) {
  const double m = mass_kg(), k = in.rendered.stiffness;
  double b = in.rendered.damping;
  if (k > 0.0) {
    const double critical = std::sqrt(k * m);
    b = std::max(b, kLeastDamping * critical);
    double share = 1.0;
    if (!(parts_ & kPartLearned)) {
      share =
          before_11_ ? 0.0 : kUnfeltLearnt * std::min(1.0, (1.0 - stiffness_.value) / kAllLearnt);
    }
    b = std::max(b, share * std::min(damping_.value * most_.damping, kLearntDamping * critical));
  }
  const Vec3& elastic_N = in.rendered.elastic_N;
  const Vec3& hand = estimator_.handAcceleration_m_s2();
  const Vec3 spring_N =
      elastic_N - k * (at.position_m - in.position_m + (0.5 * T_) * at.velocity_m_s);
  const bool leaves = elastic_N != Vec3(0.0) && glm::dot(spring_N, elastic_N) <= 0.0;
  Vec3 force_N(0.0);
  if (!leaves) {
    const double beta = b * T_ / m;
    const double theta = (3.0 + beta) / (6.0 + beta);
    force_N = (spring_N - b * at.velocity_m_s - in.rendered.damped_rotation_N -
               (0.25 * k * T_ * T_ + b * theta * T_) * hand) /
              (1.0 + 0.25 * k * T_ * T_ / m + theta * beta);
  }
  // Flags each part that changed the force: from the sampled state to the estimated, to more
  // damping, to the moment at which the force acts.
  const Vec3& v = estimator_.velocity_m_s();
  const Vec3 as_estimated_N =
      elastic_N - k * (estimator_.position_m() - in.position_m) - in.rendered.damping * v;
  const Vec3 more_N = (b - in.rendered.damping) * v;
  flag(kPartEstimate, as_estimated_N - elastic_N + in.rendered.damping * in.velocity_m_s);
  flag(kPartDamping, more_N);
  flag(kPartPrediction, force_N - (as_estimated_N - more_N - in.rendered.damped_rotation_N));
  return force_N;
}

// Scales a force down until the work it will do on the arm in its period is within the credit:
// F . (v T + (a + F/m) T^2/2) <= credit.
Vec3 BoundedController::limitToCredit(const Vec3& force_N, const Ahead& at) {
  const double size_N = glm::length(force_N);
  if (!(size_N > 0.0)) return force_N;
  const double credit_J = std::max(0.0, at.credit_J);
  const double per_N = T_ * T_ / (2.0 * mass_kg());
  const Vec3 unforced_m =
      T_ * at.velocity_m_s + (0.5 * T_ * T_) * estimator_.handAcceleration_m_s2();
  const double way_m = glm::dot(force_N, unforced_m) / size_N;
  if (size_N * (way_m + size_N * per_N) <= credit_J) return force_N;
  const double most_N = (std::sqrt(way_m * way_m + 4.0 * per_N * credit_J) - way_m) / (2.0 * per_N);
  return force_N * (std::min(size_N, std::max(0.0, most_N)) / size_N);
}

// The leaky means by which learn() tells shaking in the next tick.
void BoundedController::watchForce(const Vec3& force_N, bool touching) {
  const double leak = T_ / kShakingTime_s;
  const bool both = touching && not_obeyed_ticks_ == 0 && last_force_N_ != Vec3(0.0);
  const Vec3 change = both ? force_N - last_force_N_ : Vec3(0.0);
  variation_N_ += leak * (glm::length(change) - variation_N_);
  drift_N_ += leak * (change - drift_N_);
  last_force_N_ = force_N;
}

Vec3 BoundedController::bound(const ControllerInput& in) {
  const Held held = heldForce(in.last_sent_N);
  estimator_.update(in.position_m, held.mean_N, check_.lighter(), held.skew_N);
  if (check_.look(estimator_, held.mean_N, in.touching, held.skew_N)) {
    ArmDynamics found = arm_;
    found.apparent_mass_kg = mass_kg();
    found.delay_s = T_ * check_.delaySamples();
    most_ = mostOf(found, T_, estimator_.lag_s(), check_.handShare());
  }
  // In a pause, a fault or a ramp other forces are sent than were computed here. Nothing is learnt
  // until the forces computed here act again, a delay and a tick later.
  if (glm::length(in.last_sent_N - last_force_N_) > kObeyed * arm_.peak_force_N) {
    not_obeyed_ticks_ = int(std::ceil(check_.delaySamples())) + 1;
  } else if (not_obeyed_ticks_ > 0) {
    --not_obeyed_ticks_;
  }
  account(in, held);
  learn(in.touching);

  Vec3 force_N(0.0);
  if (in.touching) {
    const Ahead at = ahead();
    force_N = render(in, at);
    const double size_N = glm::length(force_N);
    if (size_N > arm_.peak_force_N) {
      force_N *= arm_.peak_force_N / size_N;
      parts_ |= kPartClamp;
    }
    const Vec3 affordable_N = limitToCredit(force_N, at);
    flag(kPartCredit, affordable_N - force_N);
    // Rest is judged by the tissue's own force: the rendered one changes as the scales change.
    const double k = in.rendered.stiffness;
    const Vec3 elastic_N = k > 0.0 ? in.rendered.elastic_N * (tissue_stiffness_ / k) : Vec3(0.0);
    force_N = hold_.hold(elastic_N, tissue_stiffness_, in.position_m, affordable_N);
    flag(kPartHold, force_N - affordable_N);
    if (!hold_.rests()) held_with_ = parts_ & kPartLearned;
    parts_ |= held_with_;
    const Vec3 changed_N = force_N - in.demanded_N;
    if (glm::dot(changed_N, changed_N) <= kWorthSaying_N * kWorthSaying_N) {
      parts_ = 0;
      force_N = in.demanded_N;
    }
  } else {
    hold_.forget();
  }
  if (check_.notAsStated()) parts_ |= kPartArmNotAsStated;
  watchForce(force_N, in.touching);
  return force_N;
}

}  // namespace trephine
