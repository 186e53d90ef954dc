#include "session/pointer_path.h"

#include <algorithm>

namespace trephine {

namespace {
constexpr double kCatchUp_ns = 1e8;  // time constant of what it is behind

Vec3 onRay(const PointerSample& sample, double depth_mm) {
  return sample.origin_mm + depth_mm * sample.direction;
}
}  // namespace

bool PointerPath::take() {
  if (next_) return true;
  PointerInput input;
  if (!waiting_.pop(input)) return false;
  next_ = input;
  if (!started_) return true;
  // Late: it takes the time that it took, from now.
  const std::int64_t took_ns =
      std::clamp<std::int64_t>(input.at.time_ns - last_time_ns_, 0, kDelay_ns);
  at_.at.time_ns = std::min(at_.at.time_ns, input.at.time_ns - took_ns);
  return true;
}

// Never backwards.
void PointerPath::rest(std::int64_t until_ns) {
  at_.at.time_ns = std::max(at_.at.time_ns, until_ns);
}

void PointerPath::move(double share) {
  PointerSample& at = at_.at;
  const PointerSample& to = next_->at;
  if (share >= 1.0) {
    last_time_ns_ = to.time_ns;
    at_ = *next_;
    next_.reset();
    return;
  }
  at.time_ns += std::int64_t(share * double(to.time_ns - at.time_ns));
  at.origin_mm += share * (to.origin_mm - at.origin_mm);
  at.direction = glm::normalize(at.direction + share * (to.direction - at.direction));
  if (at.depth_mm && to.depth_mm) *at.depth_mm += share * (*to.depth_mm - *at.depth_mm);
}

void PointerPath::advance(std::int64_t now_ns, std::int64_t period_ns, double depth_mm) {
  const std::int64_t due_ns = now_ns - kDelay_ns;
  if (!started_) {
    if (!take() || next_->at.time_ns > due_ns) return;
    started_ = true;
    move(1.0);
  }
  const double behind_ns = double(std::max<std::int64_t>(0, due_ns - at_.at.time_ns - period_ns));
  std::int64_t left_ns =
      period_ns + std::int64_t(behind_ns * std::min(1.0, double(period_ns) / kCatchUp_ns));
  double left_mm = kFastest_mm_s * 1e-9 * double(period_ns);
  while (take()) {
    const std::int64_t to_ns = next_->at.time_ns;
    rest(std::min(due_ns, to_ns - kDelay_ns));
    const std::int64_t span_ns = std::max<std::int64_t>(0, to_ns - at_.at.time_ns);
    const std::int64_t play_ns = std::min(left_ns, due_ns - at_.at.time_ns);
    if (play_ns < 0) return;
    double share = span_ns > play_ns ? double(play_ns) / double(span_ns) : 1.0;
    const double length_mm = glm::distance(onRay(at_.at, depth_mm), onRay(next_->at, depth_mm));
    if (share * length_mm > left_mm) share = left_mm / length_mm;
    left_mm -= share * length_mm;
    left_ns -= std::int64_t(share * double(span_ns));
    move(share);
    if (share < 1.0) return;
  }
  rest(due_ns);
}

void PointerPath::forget() {
  PointerInput dropped;
  while (waiting_.pop(dropped)) continue;
  next_.reset();
  started_ = false;
}

}  // namespace trephine
