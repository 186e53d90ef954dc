#include "haptics/arm_check.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace trephine {

namespace {

constexpr double kWindow_s = 0.0125;   // of a contact; later the hand's answer is in the motion
constexpr double kPriorSpread = 0.4;   // standard deviation of g before any sample
constexpr double kMostLighter = 5.0;
// Another delay must lower the sum of squares by so many variances of a surprise, and by so much of
// sum a^2; less delay by more of it, since a hand's damping looks like less delay.
constexpr double kSureOfDelay = 20.0;
constexpr double kMoreDelay = 0.2;
constexpr double kLessDelay = 0.5;
constexpr double kUnexplained = 0.3;  // of sum y^2 at most; more is a hand or a blow
// The mass is not as stated where g less two standard deviations is above kMassAlarm, with a
// standard deviation below kMassSure: the noise of an encoder's counts is not white.
constexpr double kMassAlarm = 1.35;
constexpr double kMassSure = 0.06;
constexpr double kFaded = 1e-9;       // of the noise's variance: an answer this small is over
constexpr double kAirTime_s = 0.005;  // time constant of the mean square surprise in air
constexpr double kHandNoise = 8.0;    // factor on that mean square, beyond the encoder's noise
constexpr int kMostShift = 1;         // samples

}  // namespace

ArmCheck::ArmCheck(const ArmDynamics& stated, const ArmEstimator& estimator, double period_s)
    : T_(period_s),
      stated_kg_(stated.apparent_mass_kg),
      variance_m2_(estimator.surpriseVariance_m2()),
      stated_samples_(std::min(trephine::delaySamples(stated, period_s), double(kMaxDelayTicks))) {}

double ArmCheck::delaySamples() const {
  return std::clamp(stated_samples_ + more_samples_, 0.0, double(kMaxDelayTicks));
}

void ArmCheck::forget() {
  x_ = v_ = a_ = last_answer_m_ = last_y_m_ = Vec3(0.0);
  since_air_s_ = 1e9;
}

bool ArmCheck::look(const ArmEstimator& estimator, const Vec3& held_N, bool touching,
                    const Vec3& skew_N) {
  const bool looks = since_air_s_ < kWindow_s;
  since_air_s_ = touching ? since_air_s_ + T_ : 0.0;
  if (!looks) return false;

  const Vec3& surprise_m = estimator.surprise_m();
  if (!touching) {
    const double beyond_m2 = glm::dot(surprise_m, surprise_m) - 2.0 * variance_m2_;
    in_air_m2_ += std::min(1.0, T_ / kAirTime_s) * (beyond_m2 - in_air_m2_);
    // No force, and the answer to the last one is over: nothing to learn from.
    if (held_N == Vec3(0.0) && glm::dot(x_, x_) < kFaded * variance_m2_) {
      x_ = v_ = a_ = last_answer_m_ = last_y_m_ = Vec3(0.0);
      return false;
    }
  }

  const Vec3 acceleration = held_N / stated_kg_ + a_;
  x_ += T_ * v_ + (0.5 * T_ * T_) * (acceleration + skew_N / stated_kg_);
  v_ += T_ * acceleration;
  const Vec3 answer_m = x_;
  x_ -= estimator.gain()[0] * answer_m;
  v_ -= estimator.gain()[1] * answer_m;
  a_ -= estimator.gain()[2] * answer_m;

  const double per_noise = 1.0 / std::max(variance_m2_, kHandNoise * in_air_m2_);
  const Vec3 y_m = surprise_m + lighter_ * answer_m;
  const double answer2 = glm::dot(answer_m, answer_m);
  if (answer2 > 0.0) {
    yy_ += per_noise * glm::dot(y_m, y_m);
    noise_ += 1.0;
  }
  aa_ += per_noise * answer2;
  aa_before_ += per_noise * glm::dot(last_answer_m_, last_answer_m_);
  ya_ += per_noise * glm::dot(y_m, answer_m);
  ya_before_ += per_noise * glm::dot(y_m, last_answer_m_);
  ya_after_ += per_noise * glm::dot(last_y_m_, answer_m);
  last_answer_m_ = answer_m;
  last_y_m_ = y_m;

  judgeDelay();
  constexpr double kPrior = 1.0 / (kPriorSpread * kPriorSpread);
  const double lighter = (ya_ + kPrior) / (aa_ + kPrior);
  lighter_ = std::clamp(lighter, 1.0, kMostLighter);
  hand_share_ = std::clamp(1.0 - lighter, 0.0, 1.0);
  const double unsure = 1.0 / std::sqrt(aa_ + kPrior);
  const double left = yy_ - 2.0 * lighter * ya_ + lighter * lighter * aa_ - noise_;
  if (unsure < kMassSure && lighter - 2.0 * unsure > kMassAlarm && left < kUnexplained * yy_) {
    not_as_stated_ = true;
  }
  return true;
}

void ArmCheck::judgeDelay() {
  const double later = 2.0 * (ya_before_ - ya_) + aa_ - aa_before_;
  const double earlier = 2.0 * (ya_after_ - ya_);
  int shift = 0;
  if (later > std::max(kSureOfDelay, kMoreDelay * aa_) && later > earlier &&
      yy_ - 2.0 * ya_before_ + aa_before_ - noise_ < kUnexplained * yy_) {
    shift = 1;
  } else if (earlier > std::max(kSureOfDelay, kLessDelay * aa_) &&
             yy_ - 2.0 * ya_after_ + aa_ - noise_ < kUnexplained * yy_) {
    shift = -1;
  }
  const int more = more_samples_ + shift;
  const double found = stated_samples_ + more;
  if (shift == 0 || std::abs(more) > kMostShift || found <= -1.0 || found > kMaxDelayTicks) return;
  more_samples_ = more;
  not_as_stated_ = true;
  // From now on the forces act in other ticks than those in which the sums took them to act.
  aa_ = aa_before_ = yy_ = ya_ = ya_before_ = ya_after_ = noise_ = 0.0;
  x_ = v_ = a_ = last_answer_m_ = last_y_m_ = Vec3(0.0);
}

}  // namespace trephine
