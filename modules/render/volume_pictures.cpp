#include "render/volume_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trephine {

namespace {

// A cut that takes longer than this at the shown level makes the whole picture coarse instead, and
// while cuts follow each other no finer picture is made at which the next would take as long.
constexpr double kCut_ms = 60.0;
constexpr std::chrono::milliseconds kCutting(1000);
constexpr double kCoarserWhenCut = 1.25;  // than when turned: the hand waits for it
constexpr double kFirstStrip = 12000.0;  // pixels, before any was measured
constexpr double kTelling = 4000.0;
constexpr double kFirstStep = 4.0;  // of a volume of which nothing is known

double msSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

void VolumePictures::resize(int width, int height) {
  // The first picture at the new size is to take no longer than those before it.
  level_.pixelsChanged(double(width) * height / (double(width_) * height_));
  width_ = width;
  height_ = height;
  stale_ = true;
}

void VolumePictures::startAnew() {
  pixels_per_ms_ = 0.0;
  level_ = LevelOfDetail();
  stale_ = true;
}

void VolumePictures::start(Picture& picture, double step, double ray_step) {
  const int columns = int(std::ceil(width_ / step)), rows = int(std::ceil(height_ / step));
  using Image = Canvas::Image;
  allocated_ =
      picture.canvas.bind(columns, rows, {Image::colour, Image::depths_mm, Image::colour}) &&
      allocated_;
  picture.plan.setWhole(columns, rows);
  picture.step = step;
  picture.ray_step = ray_step;
  picture.took_ms = 0.0;
  picture.span.pixels = glm::dvec2(columns, rows) * step;
  picture.span.beyond = 0.5 * (picture.span.pixels - glm::dvec2(width_, height_));
}

void VolumePictures::castSome(Picture& picture, double budget_ms, const Cast& cast) {
  const Clock::time_point start = Clock::now();
  double pixels =
      pixels_per_ms_ > 0.0 ? pixels_per_ms_ * picture.ray_step * budget_ms : kFirstStrip;
  while (const std::optional<PixelRect> strip = picture.plan.next(pixels)) {
    const Clock::time_point begun = Clock::now();
    picture.canvas.bind();
    cast(picture.canvas, picture.span, *strip, picture.ray_step);
    const double took_ms = std::max(msSince(begun), 1e-3);
    picture.took_ms += took_ms;
    // A small cut's strip is mostly what each strip costs beside its rays.
    if (strip->pixels() >= kTelling || pixels_per_ms_ == 0.0) {
      pixels_per_ms_ = strip->pixels() / picture.ray_step / took_ms;
    }
    const double left_ms = budget_ms - msSince(start);
    if (left_ms < 0.5 * took_ms) return;
    pixels = nextStripPixels(strip->pixels(), took_ms, left_ms);
  }
}

void VolumePictures::add(Picture& picture, const PixelRect& part) {
  if (picture.step == 0.0) return;
  const auto low = [&](int at, double beyond) {
    return int(std::floor((at + beyond) / picture.step)) - 1;
  };
  const auto high = [&](int at, double beyond) {
    return int(std::ceil((at + beyond) / picture.step)) + 1;
  };
  const glm::dvec2& beyond = picture.span.beyond;
  picture.plan.add({low(part.low_x, beyond.x), low(part.low_y, beyond.y),
                    high(part.high_x, beyond.x), high(part.high_y, beyond.y)});
}

void VolumePictures::cut(const PixelRect& part) {
  add(shown_, part);
  add(next_, part);
  cut_pixels_ = std::max(0.9 * cut_pixels_, part.pixels());
  last_cut_ = Clock::now();
}

double VolumePictures::expected_ms(const Picture& picture) const {
  if (!(pixels_per_ms_ > 0.0)) return 0.0;
  return picture.plan.pixels() / (pixels_per_ms_ * picture.ray_step);
}

bool VolumePictures::work(double budget_ms, bool moving, const Cast& cast) {
  const Clock::time_point begun = Clock::now();
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  bool changed = false;
  const bool unknown = pixels_per_ms_ == 0.0 && budget_ms < kNoLimit;
  const bool whole = !moving && !unknown && level_.stillFrame_ms() <= budget_ms;
  const double cut_step = std::ceil(4.0 * kCoarserWhenCut * level_.pixelStep()) / 4.0;
  const bool costly =
      !stale_ && expected_ms(shown_) > kCut_ms && shown_.step < cut_step && budget_ms < kNoLimit;
  if (stale_ || costly) {
    next_.step = 0.0;
    const bool turned = std::exchange(stale_, false), full = turned && whole;
    if (full) {
      start(shown_, 1.0, 1.0);
    } else if (turned) {
      start(shown_, std::max(level_.pixelStep(), unknown ? kFirstStep : 1.0), level_.rayStep());
    } else {
      start(shown_, cut_step, LevelOfDetail::rayStepAt(cut_step));
    }
    castSome(shown_, kNoLimit, cast);
    changed = true;
    if (full) {
      level_.stillFrameTook(shown_.took_ms);
    } else if (turned && unknown) {
      level_.stillFrameTook(double(width_) * double(height_) / pixels_per_ms_);
    } else if (turned) {  // a cut's level is another
      level_.movingFrameTook(msSince(begun));
    }
  } else if (!shown_.plan.done()) {
    castSome(shown_, budget_ms, cast);
    changed = true;
  }
  if (moving || !shown_.plan.done()) return changed;
  const bool cutting = begun - last_cut_ < kCutting && budget_ms < kNoLimit;
  while (shown_.step != 1.0 && msSince(begun) < budget_ms) {
    if (next_.step == 0.0) {
      const double step = budget_ms < kNoLimit ? level_.finerThan(shown_.step) : 1.0;
      start(next_, step, step == 1.0 ? 1.0 : level_.rayStep());
    }
    const double cut_ms = cut_pixels_ / (next_.step * next_.step * pixels_per_ms_ * next_.ray_step);
    if (cutting && cut_ms > kCut_ms) break;
    castSome(next_, budget_ms - msSince(begun), cast);
    if (!next_.plan.done()) break;
    if (next_.step == 1.0) level_.stillFrameTook(next_.took_ms);
    std::swap(shown_, next_);
    next_.step = 0.0;
    changed = true;
  }
  return changed;
}

void VolumePictures::castAt(double step, double ray_step, const Cast& cast) {
  next_.step = 0.0;
  start(shown_, step, ray_step);
  castSome(shown_, std::numeric_limits<double>::infinity(), cast);
  stale_ = true;
}

void VolumePictures::release() {
  for (Picture* picture : {&shown_, &next_}) {
    picture->canvas.release();
    picture->step = 0.0;
    picture->plan.setNone(0, 0);
  }
  stale_ = true;
  allocated_ = true;
}

}  // namespace trephine
