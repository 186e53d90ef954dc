#include "haptics/safety.h"

#include <algorithm>

namespace trephine {

namespace {
constexpr double kRampIn_s = 0.2;
constexpr double kCalm_s = 1.0;           // without a late tick, before force comes back
constexpr double kStallsWithin_s = 30.0;  // three stalls within it keep the force away
constexpr std::int64_t kLongStall_ns = 2'000'000'000;
}  // namespace

Vec3 clampForce(const Vec3& force_N, double max_N) {
  if (!isFinite(force_N) || !(max_N > 0.0)) return Vec3(0.0);
  // Scaled by the largest part first: the square of a huge but finite force is infinite.
  const double largest =
      std::max({std::abs(force_N.x), std::abs(force_N.y), std::abs(force_N.z)});
  if (largest == 0.0) return force_N;
  const Vec3 unit = force_N / largest;
  const double length = glm::length(unit);
  constexpr double kRoundedDown = 1.0 - 1e-15;  // or a length taken another way may exceed the limit
  if (largest * length <= max_N * kRoundedDown) return force_N;
  return unit * (max_N / length * kRoundedDown);
}

Vec3 slewTowards(const Vec3& sent_before_N, const Vec3& target_N, double step_N) {
  const double size = glm::length(target_N);
  if (size == 0.0) return Vec3(0.0);
  const Vec3 along = target_N / size;
  const double before = std::max(0.0, glm::dot(sent_before_N, along));
  return size <= before + step_N ? target_N : along * (before + step_N);
}

double lateGain(std::int64_t late_ns) {
  if (late_ns <= kHoldLate_ns) return 1.0;
  if (late_ns >= kStallLate_ns) return 0.0;
  return double(kStallLate_ns - late_ns) / double(kStallLate_ns - kHoldLate_ns);
}

void LatenessRule::tick(std::int64_t late_ns, bool silenced, double period_s) {
  // A tick that is late by a period or more moves all that follow (TickSchedule).
  const double late_s = 1e-9 * double(std::max<std::int64_t>(late_ns, 0));
  const double passed_s = period_s + (late_s >= period_s ? late_s : 0.0);
  last_stall_s_ += passed_s;
  stall_before_s_ += passed_s;
  since_late_s_ = late_ns > kHoldLate_ns ? 0.0 : since_late_s_ + passed_s;
  if (silenced || late_ns > kStallLate_ns) {
    kept_ = kept_ || stall_before_s_ <= kStallsWithin_s || late_ns > kLongStall_ns;
    stall_before_s_ = last_stall_s_;
    last_stall_s_ = 0.0;
    since_late_s_ = 0.0;
    away_ = true;
  } else if (since_late_s_ >= kCalm_s) {
    away_ = false;
  }
}

Vec3 OutputLimiter::limit(const Vec3& clamped_N, bool touching, bool open, std::int64_t late_ns,
                          double period_s) {
  if (!open) {
    change();
    fading_ = 0.0;
    return sent_N_ = Vec3(0.0);
  }
  if (released_ && !waiting_for_air_) {
    fading_ = std::max(0.0, fading_ - period_s / kFade_s);
    return sent_N_ = (fading_ * lateGain(late_ns)) * fading_N_;
  }
  if (late_ns > kHoldLate_ns) {
    change();
    return sent_N_ *= lateGain(late_ns);
  }
  if (waiting_for_air_) {
    waiting_for_air_ = touching;
    return sent_N_ = Vec3(0.0);
  }
  gain_ = std::min(1.0, gain_ + period_s / kRampIn_s);
  const Vec3 target = gain_ * clamped_N;
  if (catch_up_s_ <= 0.0) return sent_N_ = target;
  sent_N_ = slewTowards(sent_N_, target, kSlew_N_per_s * period_s);
  const double left_s = catch_up_s_ - period_s;
  catch_up_s_ = sent_N_ == target ? left_s : std::max(left_s, period_s);
  return sent_N_;
}

}  // namespace trephine
