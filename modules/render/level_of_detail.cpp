#include "render/level_of_detail.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// A full picture that takes longer has one in between, which takes about the second time.
constexpr double kLongWait_ms = 1100.0;
constexpr double kFirstRefined_ms = 350.0;

// Quarter steps: every new level allocates its images again.
double level(double step) {
  return std::clamp(std::ceil(step * 4.0) / 4.0, 1.0, LevelOfDetail::kCoarsest);
}

}  // namespace

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
  const double ratio = ms / kBudget_ms;
  pixel_step_ = level(ratio <= 8.0 ? std::cbrt(ratio) : std::sqrt(ratio / 2.0));
}

void LevelOfDetail::movingFrameTook(double ms) {
  if (!std::isfinite(ms) || ms <= 0.0) return;
  const double ratio = ms / kBudget_ms;
  // Finer only when there is room for a whole level, or the level would change at every frame.
  if (ratio > 1.0) {
    pixel_step_ = level(pixel_step_ * std::sqrt(ratio));
  } else if (ratio < 0.5) {
    pixel_step_ = level(pixel_step_ * std::max(0.7, std::sqrt(ratio * 1.3)) - 0.25);
  }
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
