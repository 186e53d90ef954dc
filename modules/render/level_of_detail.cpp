#include "render/level_of_detail.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// A full picture that takes longer has one in between, which takes about the second time.
constexpr double kLongWait_ms = 750.0;
constexpr double kFirstRefined_ms = 350.0;

// Quarter steps: every new level allocates its images again.
double level(double step) {
  return std::clamp(std::ceil(step * 4.0) / 4.0, 1.0, LevelOfDetail::kCoarsest);
}

constexpr double kCoarse = 4.0;

}  // namespace

double LevelOfDetail::unlessTooCoarse(double step, double ms, double at) const {
  return step > kCoarse ? std::max(kCoarse, level(at * std::sqrt(ms / coarse_ms_))) : step;
}

double LevelOfDetail::rayStepAt(double pixel_step) {
  return std::min(pixel_step, 2.0);
}

double LevelOfDetail::finerThan(double pixel_step) const {
  if (still_frame_ms_ <= kLongWait_ms) return 1.0;
  const double between = std::ceil(4.0 * std::sqrt(still_frame_ms_ / kFirstRefined_ms)) / 4.0;
  return between > 1.25 && between <= 0.75 * pixel_step ? between : 1.0;
}

void LevelOfDetail::stillFrameTook(double ms) {
  if (!std::isfinite(ms) || ms <= 0.0) return;
  still_frame_ms_ = ms;
  // Rays fall with the square of the step and samples with up to 2 of it.
  const double ratio = ms / budget_ms_;
  pixel_step_ = level(ratio <= 8.0 ? std::cbrt(ratio) : std::sqrt(ratio / 2.0));
  pixel_step_ = unlessTooCoarse(pixel_step_, 0.5 * ms, 1.0);
  frames_ = 0;
}

void LevelOfDetail::movingFrameTook(double ms) {
  if (!std::isfinite(ms) || ms <= 0.0) return;
  std::rotate(last_ms_.begin(), last_ms_.end() - 1, last_ms_.end());
  last_ms_[0] = ms;
  frames_ = std::min(frames_ + 1, int(last_ms_.size()));
  // One slow frame may be another program's; one quick frame may look where there is little.
  const auto known = last_ms_.begin() + frames_;
  const double slow_ratio = frames_ > 1 ? std::min(last_ms_[0], last_ms_[1]) / budget_ms_ : 0.0;
  const double quick_ratio = *std::max_element(last_ms_.begin(), known) / budget_ms_;
  double step = pixel_step_;
  if (slow_ratio > 1.0) {
    const double slow_ms = slow_ratio * budget_ms_;
    step = unlessTooCoarse(level(pixel_step_ * std::sqrt(slow_ratio)), slow_ms, pixel_step_);
    step = std::max(step, pixel_step_);
  } else if (frames_ == int(last_ms_.size())) {
    // The finest at which it can hardly take longer than it may.
    const auto cost = [](double at) { return 1.0 / (at * at * rayStepAt(at)); };
    const auto allowed = [this](double at) {
      return at >= kCoarse ? coarse_ms_ / budget_ms_ : 1.0;
    };
    while (step > 1.0 &&
           quick_ratio * cost(step - 0.25) / cost(pixel_step_) < 0.95 * allowed(step - 0.25)) {
      step -= 0.25;
    }
  }
  if (step == pixel_step_) return;
  pixel_step_ = step;
  frames_ = 0;
}

void LevelOfDetail::pixelsChanged(double times) {
  if (!std::isfinite(times) || times <= 0.0) return;
  stillFrameTook(times * still_frame_ms_);
}

double nextStripPixels(double pixels, double took_ms, double left_ms) {
  if (!(took_ms > 0.0) || !(left_ms > 0.0)) return 0.0;
  return std::min(pixels * left_ms / took_ms, pixels * 1.5);
}

}  // namespace trephine
