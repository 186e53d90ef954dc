#include "render/level_of_detail.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// Quarter steps: every new level makes VTK allocate its images again.
double level(double step) {
  return std::clamp(std::ceil(step * 4.0) / 4.0, 1.0, LevelOfDetail::kCoarsest);
}

}  // namespace

double LevelOfDetail::rayStepAt(double pixel_step) {
  return std::min(pixel_step, 2.0);
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

int nextStripRows(int rows, double took_ms, double left_ms) {
  constexpr int kFewest = 8;
  if (!(took_ms > 0.0) || !(left_ms > 0.0)) return kFewest;
  return int(std::clamp(rows * left_ms / took_ms, double(kFewest), std::max(8.0, rows * 1.5)));
}

}  // namespace trephine
