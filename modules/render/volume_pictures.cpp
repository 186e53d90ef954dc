#include "render/volume_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trephine {

namespace {

// While cuts follow each other what was sketched of them stays: rays that are cast twice a frame
// would let it flicker.
constexpr std::chrono::milliseconds kPause(150);
constexpr double kFirstStrip = 12000.0;  // pixels, before any was measured
constexpr double kTelling = 4000.0, kTelling_ms = 10.0;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kWary = 0.4;  // of the first strip: what lies there may be dearer than the last
// Where nothing is known of what a picture takes, or the whole window is put in order with it.
constexpr double kFirstStep = 8.0;
constexpr double kCoarsestSketch = 8.0, kLongestRayStep = 2.0;

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
  resized_ = stale_ = true;
}

void VolumePictures::startAnew() {
  pixels_per_ms_ = 0.0;
  level_ = LevelOfDetail();
  stale_ = true;
  warm_ = false;
}

void VolumePictures::bind(Canvas& canvas, int columns, int rows) {
  using Image = Canvas::Image;
  allocated_ =
      canvas.bind(columns, rows, {Image::colour, Image::depths_mm, Image::colour}) && allocated_;
}

void VolumePictures::start(Picture& picture, double step, double ray_step) {
  const int columns = int(std::ceil(width_ / step)), rows = int(std::ceil(height_ / step));
  bind(picture.canvas, columns, rows);
  picture.plan.setWhole(columns, rows);
  picture.step = step;
  picture.ray_step = ray_step;
  picture.took_ms = picture.strip_pixels = 0.0;
  picture.span.pixels = glm::dvec2(columns, rows) * step;
  picture.span.beyond = 0.5 * (picture.span.pixels - glm::dvec2(width_, height_));
  if (&picture == &next_) missed_.clear();
  if (&picture != &shown_) return;
  fresh_.setNone(columns, rows);
  coarser_ = 1;
}

void VolumePictures::castSome(Picture& picture, double budget_ms, const Cast& cast) {
  const Clock::time_point start = Clock::now();
  // Where the last strip met air alone, this one need not.
  const double most = std::max(kFirstStrip, 1.5 * picture.strip_pixels);
  double pixels = kFirstStrip;
  if (budget_ms == kNoLimit) {
    pixels = kNoLimit;
  } else if (pixels_per_ms_ > 0.0) {
    pixels = std::min(kWary * pixels_per_ms_ * picture.ray_step * budget_ms, most);
  }
  while (const std::optional<PixelRect> strip = picture.plan.next(pixels)) {
    const Clock::time_point begun = Clock::now();
    picture.canvas.bind();
    cast(picture.canvas, picture.span, *strip, picture.ray_step);
    const double took_ms = std::max(msSince(begun), 1e-3);
    picture.took_ms += took_ms;
    picture.strip_pixels = strip->pixels();
    // A small cut's strip is mostly what each strip costs beside its rays.
    if (strip->pixels() >= kTelling || took_ms > kTelling_ms || pixels_per_ms_ == 0.0) {
      pixels_per_ms_ = strip->pixels() / picture.ray_step / took_ms;
    }
    const double left_ms = budget_ms - msSince(start);
    if (left_ms < 0.5 * took_ms) return;
    pixels = nextStripPixels(strip->pixels(), took_ms, left_ms);
  }
}

void VolumePictures::addCut(const PixelRect& part) {
  if (shown_.step == 0.0) return;
  const auto low = [&](int at, double beyond) {
    return int(std::floor((at + beyond) / shown_.step)) - 1;
  };
  const auto high = [&](int at, double beyond) {
    return int(std::ceil((at + beyond) / shown_.step)) + 1;
  };
  const glm::dvec2& beyond = shown_.span.beyond;
  const PixelRect rays{low(part.low_x, beyond.x), low(part.low_y, beyond.y),
                       high(part.high_x, beyond.x), high(part.high_y, beyond.y)};
  shown_.plan.add(rays);
  fresh_.add(rays);
}

void VolumePictures::cut(const PixelRect& part) {
  addCut(part);
  if (next_.step != 0.0) missed_.push_back(part);
  last_cut_ = Clock::now();
}

// Casts what was cut with fewer rays, as many as the time allows, and spreads them into the shown
// picture. Each pixel of the sketch covers as many whole pixels of that; where the two sizes differ
// by an odd number, half a pixel aside.
void VolumePictures::sketchCuts(double budget_ms, const Cast& cast) {
  const double ms = expected_ms(fresh_);
  coarser_ = 1;
  while (ms > budget_ms * coarser_ * coarser_ && shown_.step * (coarser_ + 1) <= kCoarsestSketch) {
    ++coarser_;
  }
  const int by = coarser_;
  const glm::ivec2 size(shown_.canvas.width(), shown_.canvas.height());
  const glm::ivec2 fewer = (size + by - 1) / by, beyond = (fewer * by - size) / 2;
  Span span{glm::dvec2(fewer * by) * shown_.step, {}};
  span.beyond = 0.5 * (span.pixels - glm::dvec2(width_, height_));
  if (by > 1) bind(sketch_, fewer.x, fewer.y);
  for (const PixelRect& rays : fresh_.left()) {
    if (by == 1) {
      shown_.canvas.bind();
      cast(shown_.canvas, shown_.span, rays, shown_.ray_step);
      continue;
    }
    const auto low = [&](int at, int aside) { return (at + aside) / by; };
    const auto high = [&](int at, int aside) { return (at + aside + by - 1) / by; };
    const PixelRect part{low(rays.low_x, beyond.x), low(rays.low_y, beyond.y),
                         high(rays.high_x, beyond.x), high(rays.high_y, beyond.y)};
    sketch_.bind();
    cast(sketch_, span, part, std::min(shown_.ray_step * by, kLongestRayStep));
    const PixelRect spread{part.low_x * by - beyond.x, part.low_y * by - beyond.y,
                           part.high_x * by - beyond.x, part.high_y * by - beyond.y};
    shown_.canvas.take(sketch_, part, spread);
    shown_.plan.add(spread);
  }
  fresh_.setNone(size.x, size.y);
}

void VolumePictures::warmUp(const Cast& cast) {
  bind(sketch_, 2, 2);
  cast(sketch_, {glm::dvec2(width_, height_), {}}, {0, 0, 1, 1}, 1.0);
  warm_ = true;
}

// Software OpenGL takes some 70 ms to get ready for the first: here no cut waits for them.
void VolumePictures::readySketches() {
  if (std::exchange(sketches_ready_, true)) return;
  bind(sketch_, 2, 2);
  sketch_.take(shown_.canvas, {0, 0, 1, 1}, {0, 0, 2, 2});
}

void VolumePictures::finishNext() {
  if (next_.step == 1.0) level_.stillFrameTook(next_.took_ms);
  std::swap(shown_, next_);
  next_.step = 0.0;
  coarser_ = 1;
  fresh_.setNone(shown_.canvas.width(), shown_.canvas.height());
  for (const PixelRect& part : std::exchange(missed_, {})) addCut(part);
}

double VolumePictures::expected_ms(const CastPlan& plan) const {
  if (!(pixels_per_ms_ > 0.0)) return 0.0;
  return plan.pixels() / (pixels_per_ms_ * shown_.ray_step);
}

bool VolumePictures::work(double budget_ms, bool moving, const Cast& cast) {
  const Clock::time_point begun = Clock::now();
  bool changed = false;
  const bool unknown = pixels_per_ms_ == 0.0 && budget_ms < kNoLimit;
  if (budget_ms < kNoLimit && cold()) return false;
  if (std::exchange(stale_, false)) {
    next_.step = 0.0;
    const bool resized = std::exchange(resized_, false) && budget_ms < kNoLimit;
    const bool whole = !moving && !unknown && level_.stillFrame_ms() <= budget_ms;
    if (whole) {
      start(shown_, 1.0, 1.0);
    } else {
      const double step = std::max(level_.pixelStep(), unknown || resized ? kFirstStep : 1.0);
      start(shown_, step, LevelOfDetail::rayStepAt(step));
    }
    castSome(shown_, kNoLimit, cast);
    changed = true;
    if (whole) {
      level_.stillFrameTook(shown_.took_ms);
    } else if (unknown) {
      level_.stillFrameTook(double(width_) * double(height_) / pixels_per_ms_);
    } else if (!resized) {
      level_.movingFrameTook(msSince(begun));
    }
  } else if (expected_ms(shown_.plan) > budget_ms && !fresh_.done()) {
    sketchCuts(budget_ms, cast);
    changed = true;
  } else if (!fresh_.done() || budget_ms == kNoLimit || begun - last_cut_ > kPause) {
    changed = !shown_.plan.done();
    castSome(shown_, fresh_.done() ? budget_ms : kNoLimit, cast);
    fresh_.setNone(shown_.canvas.width(), shown_.canvas.height());
  }
  if (moving || !shown_.plan.done()) return changed;
  while (shown_.step != 1.0 && shown_.plan.done() && msSince(begun) < budget_ms) {
    if (next_.step == 0.0) {
      const double step = budget_ms < kNoLimit ? level_.finerThan(shown_.step) : 1.0;
      start(next_, step, step == 1.0 ? 1.0 : level_.rayStep());
    }
    castSome(next_, budget_ms - msSince(begun), cast);
    if (!next_.plan.done()) break;
    finishNext();
    sketchCuts(budget_ms, cast);  // or what was cut meanwhile would be back for a moment
    changed = true;
  }
  if (!changed && complete()) readySketches();
  return changed;
}

void VolumePictures::castAt(double step, double ray_step, const Cast& cast) {
  next_.step = 0.0;
  start(shown_, step, ray_step);
  castSome(shown_, kNoLimit, cast);
  stale_ = true;
}

void VolumePictures::release() {
  for (Picture* picture : {&shown_, &next_}) {
    picture->canvas.release();
    picture->step = 0.0;
    picture->plan.setNone(0, 0);
  }
  sketch_.release();
  sketches_ready_ = false;
  allocated_ = true;
  startAnew();
}

}  // namespace trephine
