// The picture of the volume that is shown, and the finer one that is being made behind it. Whatever
// changes but a cut starts anew, coarse first; only whole pictures are shown, so no seam runs
// between coarse and fine. A cut mends the part of the shown one that it falls on: at once, more
// coarsely where its rays would take too long, and as fine as the rest when cuts pause.
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "render/canvas.h"
#include "render/cast_plan.h"
#include "render/composer.h"
#include "render/level_of_detail.h"

namespace trephine {

class VolumePictures {
 public:
  // Casts the rays of this part of a picture, `ray_step` times the usual distance between samples,
  // into the framebuffer that is bound; until it is done.
  using Cast = std::function<void(const Canvas&, const Span&, const PixelRect&, double ray_step)>;

  // Window pixels.
  void resize(int width, int height);
  // The camera, the looks or all voxels changed.
  void spoil() { stale_ = true; }
  // Another volume or other looks: what the last pictures took says nothing of the next.
  void startAnew();
  // Voxels changed whose picture lies in here. Window pixels, from below.
  void cut(const PixelRect& part);

  // Works for about so long on what is to be done: the shown picture first, which comes whole where
  // it is stale; then a finer one, unless things move. True when there is another picture to show.
  bool work(double budget_ms, bool moving, const Cast& cast);
  // The first ray waits until OpenGL has made the caster's shader, which in software takes as long
  // as several frames: until warmUp() has cast that one, a limited work() does nothing.
  bool cold() const { return stale_ && pixels_per_ms_ == 0.0 && !warm_; }
  void warmUp(const Cast& cast);
  // What it cast, which nobody sees.
  const Canvas& warmUpCanvas() const { return sketch_; }
  // A whole picture with so many pixels between two rays, for measurements; the next work() starts
  // anew.
  void castAt(double step, double ray_step, const Cast& cast);
  // The shown one is what is there now, at full quality.
  bool stale() const { return stale_; }
  bool complete() const { return !stale_ && shown_.step == 1.0 && shown_.plan.done(); }

  const Canvas& canvas() const { return shown_.canvas; }
  const Span& span() const { return shown_.span; }
  // Between two rays of the shown picture, of its coarsest part.
  double pixelStep() const { return shown_.step * (shown_.plan.done() ? 1 : coarser_); }
  LevelOfDetail& level() { return level_; }
  // False once the GPU refused a picture.
  bool allocated() const { return allocated_; }
  void release();

 private:
  struct Picture {
    Canvas canvas;
    CastPlan plan;
    Span span;
    double step = 0.0;  // 0: none
    double ray_step = 1.0;
    double took_ms = 0.0;
    double strip_pixels = 0.0;  // of the last strip
  };
  using Clock = std::chrono::steady_clock;

  void bind(Canvas& canvas, int columns, int rows);  // with what a picture holds
  void start(Picture& picture, double step, double ray_step);
  void castSome(Picture& picture, double budget_ms, const Cast& cast);
  void addCut(const PixelRect& part);  // to the shown one
  void sketchCuts(double budget_ms, const Cast& cast);
  void readySketches();
  void finishNext();
  double expected_ms(const CastPlan& plan) const;  // of the shown one

  Picture shown_, next_;
  CastPlan fresh_;                 // of the shown one: cuts that it does not show yet
  std::vector<PixelRect> missed_;  // cuts that may have come behind the rays of the next one
  Canvas sketch_;                  // of cuts, with fewer rays
  int coarser_ = 1;                // by how much, each way
  bool sketches_ready_ = false;
  LevelOfDetail level_;
  int width_ = 1;
  int height_ = 1;
  bool stale_ = true;
  bool warm_ = false;  // the caster has cast what it is to cast now
  bool resized_ = false;
  bool allocated_ = true;
  double pixels_per_ms_ = 0.0;  // of the last strip, at usual steps
  Clock::time_point last_cut_{};
};

}  // namespace trephine
