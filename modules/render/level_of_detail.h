// How coarse a frame may be while something moves, from how long the last ones took. Pure.
#pragma once

#include <array>

namespace trephine {

class LevelOfDetail {
 public:
  // Of rays. Putting the picture together and showing the window takes 25 to 50 ms more where the
  // processors draw, and all of it together keeps the window for less than 100 ms.
  static constexpr double kBudget_ms = 42.0;
  static constexpr double kCoarsest = 8.0;

  // From 4 pixels between two rays on blocks disturb more than frames that take this long.
  static constexpr double kCoarse_ms = 50.0;

  // `first`: pixels between two rays until a frame was timed.
  explicit LevelOfDetail(double budget_ms = kBudget_ms, double first = 1.0,
                         double coarse_ms = kCoarse_ms)
      : budget_ms_(budget_ms), coarse_ms_(coarse_ms), pixel_step_(first) {}

  // Pixels between two rays, each way; 1 is full quality.
  double pixelStep() const { return pixel_step_; }
  // Factor on the distance between two samples of a ray.
  double rayStep() const { return rayStepAt(pixel_step_); }
  static double rayStepAt(double pixel_step);

  // The step of the next picture once things are still: in between where full quality would keep
  // the eye waiting, else 1.
  double finerThan(double pixel_step) const;

  // A frame drawn at full quality, or at the moving level, took this long. The first of a movement
  // takes its level from the still frame before it.
  void stillFrameTook(double ms);
  void movingFrameTook(double ms);

  // The view has so many times as many pixels as before.
  void pixelsChanged(double times);

  // What the last picture at full quality took, or is expected to; 0 while nothing is known.
  double stillFrame_ms() const { return still_frame_ms_; }

 private:
  double unlessTooCoarse(double step, double ms, double at) const;

  double budget_ms_, coarse_ms_;
  double pixel_step_;
  double still_frame_ms_ = 0.0;
  std::array<double, 3> last_ms_{};  // of moving frames at this level, the last one first
  int frames_ = 0;                   // how many of them there are
};

// How many pixels the next strip of a picture may have, so that it takes `left_ms`, when the last
// one's took `took_ms`. At most half as many again, since the next may be dearer.
double nextStripPixels(double pixels, double took_ms, double left_ms);

}  // namespace trephine
