#include "haptics/bounded_controller.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// Tuned on the stability grid and checked on cells that the tuning had not seen (CONTROLLERS.md).
constexpr double kDampingPerMassRate = 2.848;     // b_max = this m / tau_b
constexpr double kStiffnessPerMassRate = 0.3259;  // k_max = this m / tau_k^2
constexpr double kCountForce_N = 0.1997;  // a count of the encoder changes the force by this
constexpr double kDelayInDamping = 0.35;  // tau_b = T (1 + this d)
constexpr double kHandInDelay = 4.0;      // N s/m: less damping where such a hand outdoes the mass
constexpr double kLagInStiffness = 0.3088;  // tau_k = T (1 + this' d) + this lag
constexpr double kImpact = 8.0;             // stiffness added to k_max as contact begins, of k_max
constexpr double kImpactTime_s = 0.006219;  // it fades with this
constexpr double kImpactAgain_s = 0.05;     // and is there again after so long in air
constexpr double kCreditAbove_J = 3.53e-4;  // credit beyond what the spring holds
constexpr double kMostDebt_J = 1e-3;        // a pose that jumps must not silence the arm for long
constexpr double kCreditSlack = 0.01;       // of the tolerance may be overdrawn
constexpr double kLossSeen = 2.0;           // tolerances lost before stiffness is lowered
constexpr double kLossStep = 0.9671;        // by this
constexpr double kShaking_N = 0.09076;      // force that comes and goes, per tick
constexpr double kShakingTime_s = 0.06444;
constexpr double kShakingStep = 0.7644;
constexpr double kObeyed = 1e-9;  // of the peak force: rounding of the clamp
constexpr double kLeastDamping = 0.01612;  // of sqrt(k m), always
constexpr double kLearntDamping = 1.316;   // of sqrt(k m), once stiffness was lowered
constexpr double kFloorDamping = 0.008432;
constexpr double kFloorStiffness = 0.05012;
constexpr double kForget_per_s = 0.5062;  // of the lowering, while in air

// What a spring holds that pushes with `force_N`, no more than `peak_N` of which arrives.
double springEnergy(double force_N, double stiffness, double peak_N) {
  if (stiffness <= 0.0) return 0.0;
  const double within = std::min(force_N, peak_N);
  return (0.5 * within * within + peak_N * (force_N - within)) / stiffness;
}

// What this arm renders, at the device: see CONTROLLERS.md, part 1.
Impedance mostOf(const ArmDynamics& arm, double T, double lag_s) {
  const double tau_b = T * (1.0 + kDelayInDamping * arm.delay_ticks);
  const double tau_k = tau_b + kLagInStiffness * lag_s;
  Impedance most{kDampingPerMassRate * arm.apparent_mass_kg / tau_b,
                 kStiffnessPerMassRate * arm.apparent_mass_kg / (tau_k * tau_k)};
  // Over a delay of m / b_hand the hand decides where the arm goes, and the prediction knows no
  // hand.
  const double outdone = kHandInDelay * T * arm.delay_ticks / arm.apparent_mass_kg;
  most.damping /= 1.0 + outdone * outdone * outdone * outdone;
  if (arm.encoder_step_m > 0.0) {
    most.stiffness = std::min(most.stiffness, kCountForce_N / arm.encoder_step_m);
  }
  return most;
}

}  // namespace

Renderable renderable(const ArmDynamics& arm, double rate_hz, int delay_ticks,
                      const WorkspaceMap& map) {
  ArmDynamics delayed = arm;
  delayed.delay_ticks = std::clamp(delay_ticks, 0, kMaxDelayTicks);
  const double T = 1.0 / rate_hz;
  const Impedance most = mostOf(delayed, T, ArmEstimator(delayed, T).lag_s());
  const double at_arm = map.motion_scale * map.force_scale;
  return {most.damping / at_arm, most.stiffness / at_arm};
}

BoundedController::BoundedController(const ArmDynamics& arm, double period_s)
    : T_(period_s), arm_(arm), estimator_(arm, period_s) {
  arm_.delay_ticks = std::clamp(arm_.delay_ticks, 0, kMaxDelayTicks);
  most_ = mostOf(arm_, T_, estimator_.lag_s());
  tolerance_J_ = std::max(5e-5, 1.0 * arm_.encoder_step_m);  // 0.05 mJ, 1 N times a step
}

Impedance BoundedController::limit(const Impedance& tissue) {
  const Impedance arm{most_.damping, most_.stiffness * (1.0 + kImpact * impact_)};
  const Impedance learnt{scale_.damping * arm.damping, scale_.stiffness * arm.stiffness};
  const Impedance limited{std::min(tissue.damping, learnt.damping),
                          std::min(tissue.stiffness, learnt.stiffness)};
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
  pending_.fill(Vec3(0.0));
  energy_J_ = stored_J_ = dissipated_J_ = most_dissipated_J_ = 0.0;
  last_stiffness_ = variation_N_ = 0.0;
  last_force_N_ = drift_N_ = Vec3(0.0);
}

// Energy that the held force exchanged over the last period, exact for any motion in between, and
// what of it the rendered spring neither holds nor has given back.
void BoundedController::account(const ControllerInput& in, const Vec3& held_N) {
  const Vec3& x = estimator_.position_m();
  const double put_in_J = started_ ? -glm::dot(held_N, x - last_estimate_m_) : 0.0;
  started_ = true;
  last_estimate_m_ = x;

  const double k = in.rendered.stiffness;
  Vec3 spring_N = in.rendered.elastic_N - k * (x - in.position_m);
  if (glm::dot(spring_N, in.rendered.elastic_N) <= 0.0) spring_N = Vec3(0.0);
  // What the springs hold at the sample, less their one sum there, plus that sum where the arm is.
  const double sum_N = glm::length(in.rendered.elastic_N);
  const double beside_J = k > 0.0 ? in.rendered.stored_J - sum_N * sum_N / (2.0 * k) : 0.0;
  const double stored_J =
      std::max(0.0, beside_J) + springEnergy(glm::length(spring_N), k, arm_.peak_force_N);
  energy_J_ = std::clamp(energy_J_ + put_in_J, -kMostDebt_J, stored_J + kCreditAbove_J);

  if (!in.touching || not_obeyed_ticks_ > 0) {
    dissipated_J_ = most_dissipated_J_ = 0.0;
  } else if (was_touching_ && k <= last_stiffness_) {
    // A spring that turns stiffer under the hand holds energy that nobody put in.
    dissipated_J_ += put_in_J - (stored_J - stored_J_);
    most_dissipated_J_ = std::max(most_dissipated_J_, dissipated_J_);
  }
  stored_J_ = stored_J;
  last_stiffness_ = k;
  was_touching_ = in.touching;
}

// From what the observer and the force show, never from the hand itself.
void BoundedController::learn(bool touching) {
  impact_ += touching ? -impact_ * std::min(1.0, T_ / kImpactTime_s)
                      : (1.0 - impact_) * std::min(1.0, T_ / kImpactAgain_s);
  const bool elastic = last_stiffness_ > 0.0;
  if (most_dissipated_J_ - dissipated_J_ > kLossSeen * tolerance_J_) {
    most_dissipated_J_ = dissipated_J_;
    double& scale = elastic ? scale_.stiffness : scale_.damping;
    scale = std::max(elastic ? kFloorStiffness : kFloorDamping, scale * kLossStep);
  }
  if (variation_N_ - glm::length(drift_N_) > kShaking_N) {
    scale_.damping = std::max(kFloorDamping, scale_.damping * kShakingStep);
    if (elastic) scale_.stiffness = std::max(kFloorStiffness, scale_.stiffness * kShakingStep);
    variation_N_ = 0.0;
    drift_N_ = Vec3(0.0);
  }
  if (!touching) {
    const double growth = 1.0 + T_ * kForget_per_s;
    scale_.damping = std::min(1.0, scale_.damping * growth);
    scale_.stiffness = std::min(1.0, scale_.stiffness * growth);
  }
}

// Scales a force down until the work it will do on the arm in its period is within the credit:
// F . (v T + (a + F/m) T^2/2) <= credit.
Vec3 BoundedController::limitToCredit(const Vec3& force_N, const Vec3& velocity_m_s,
                                      const Vec3& hand_m_s2, double credit_J) {
  const double size_N = glm::length(force_N);
  if (!(size_N > 0.0)) return force_N;
  const double per_N = T_ * T_ / (2.0 * arm_.apparent_mass_kg);
  const double way_m = glm::dot(force_N, T_ * velocity_m_s + (0.5 * T_ * T_) * hand_m_s2) / size_N;
  if (size_N * (way_m + size_N * per_N) <= credit_J) return force_N;
  parts_ |= kPartCredit;
  const double most_N = (std::sqrt(way_m * way_m + 4.0 * per_N * credit_J) - way_m) / (2.0 * per_N);
  return force_N * (std::min(size_N, std::max(0.0, most_N)) / size_N);
}

Vec3 BoundedController::bound(const ControllerInput& in) {
  // The force that acted since the last sample is the one sent `delay` ticks before the last.
  Vec3 held_N = in.last_sent_N;
  if (arm_.delay_ticks > 0) {
    held_N = pending_[0];
    std::copy(pending_.begin() + 1, pending_.begin() + arm_.delay_ticks, pending_.begin());
    pending_[std::size_t(arm_.delay_ticks - 1)] = in.last_sent_N;
  }
  estimator_.update(in.position_m, held_N);
  // In a pause, a fault or a ramp other forces are sent than were computed here: what the hand does
  // meanwhile says nothing of this controller, until forces of its own act again.
  if (glm::length(in.last_sent_N - last_force_N_) > kObeyed * arm_.peak_force_N) {
    not_obeyed_ticks_ = arm_.delay_ticks + 1;
  } else if (not_obeyed_ticks_ > 0) {
    --not_obeyed_ticks_;
  }
  account(in, held_N);
  learn(in.touching);

  // Where the arm will be when this tick's force begins to act.
  const double m = arm_.apparent_mass_kg;
  Vec3 x = estimator_.position_m(), v = estimator_.velocity_m_s();
  const Vec3& hand = estimator_.handAcceleration_m_s2();
  double credit_J = energy_J_ + kCreditSlack * tolerance_J_;
  for (int i = 0; i < arm_.delay_ticks; ++i) {
    const Vec3 a = pending_[std::size_t(i)] / m + hand;
    const Vec3 step = T_ * v + (0.5 * T_ * T_) * a;
    credit_J -= glm::dot(pending_[std::size_t(i)], step);
    x += step;
    v += T_ * a;
  }

  Vec3 force_N(0.0);
  if (in.touching) {
    const double k = in.rendered.stiffness;
    double b = in.rendered.damping;
    if (k > 0.0) {
      const double critical = std::sqrt(k * m);
      b = std::max(b, kLeastDamping * critical);
      const double learnt = std::min(most_.damping, kLearntDamping * critical);
      if ((parts_ & kPartLearned) && learnt > b) {
        b = learnt;
        parts_ |= kPartDamping;
      }
    }
    // The mean force of a spring and damper over the period, solved for the motion that it causes:
    // the spring at mid-way, the damper by the rational stand-in for the exponential.
    const double beta = b * T_ / m;
    const double theta = (3.0 + beta) / (6.0 + beta);
    const Vec3 spring_N = in.rendered.elastic_N - k * (x - in.position_m + (0.5 * T_) * v);
    const bool pushed = in.rendered.elastic_N != Vec3(0.0);
    const bool leaves = pushed && glm::dot(spring_N, in.rendered.elastic_N) <= 0.0;
    if (!leaves) {
      force_N = (spring_N - b * v - in.rendered.damped_turning_N - (0.25 * k * T_ * T_ + b * theta * T_) * hand) /
                (1.0 + 0.25 * k * T_ * T_ / m + theta * beta);
    }
    const double size_N = glm::length(force_N);
    if (size_N > arm_.peak_force_N) force_N *= arm_.peak_force_N / size_N;
    force_N = limitToCredit(force_N, v, hand, std::max(0.0, credit_J));
  }

  const double leak = T_ / kShakingTime_s;
  const bool both = in.touching && not_obeyed_ticks_ == 0 && last_force_N_ != Vec3(0.0);
  const Vec3 change = both ? force_N - last_force_N_ : Vec3(0.0);
  variation_N_ += leak * (glm::length(change) - variation_N_);
  drift_N_ += leak * (change - drift_N_);
  last_force_N_ = force_N;
  return force_N;
}

}  // namespace trephine
