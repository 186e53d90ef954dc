// Cameras that turn.
#include <algorithm>

#include "machine/drawing/drawing_parts.h"

namespace trephine {

Result<TurningFigures> measureTurning(const RenderSubject& subject, const DrawingOptions& options,
                                      const Progress& progress) {
  constexpr double kStep_deg = 3.0;
  constexpr double kStrip_ms = 50.0;  // of a still picture in the window
  constexpr int kSettling = 5;        // frames in which the level finds its place
  auto made = SceneRenderer::offscreen(options.size[0], options.size[1]);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  renderer.setSampleDistance(options.sample_distance);
  show(subject, true, renderer);
  for (int n = 0; n < 2; ++n) renderer.paint(0);  // the first one sends the volume

  std::vector<double> ms, levels;
  renderer.setMoving(true);
  const auto begin = RenderClock::now();
  while (msSince(begin) < 1000.0 * options.rotate_s || int(ms.size()) <= kSettling) {
    if (progress.cancelled()) return drawingCancelled();
    progress.at(std::min(1.0, msSince(begin) / (1000.0 * options.rotate_s)), "turning");
    renderer.orbit(kStep_deg, 0.0);
    const auto start = RenderClock::now();
    renderer.paint(0, kStrip_ms);
    ms.push_back(msSince(start));
    levels.push_back(UploadProbe::level(renderer));
  }
  const Picture moving = UploadProbe::painted(renderer);

  renderer.setMoving(false);
  const auto stopped = RenderClock::now();
  TurningFigures figures;
  // As the window does: a finer picture is made in strips between frames, and painted when whole.
  const double coarse = UploadProbe::level(renderer);
  while (!renderer.complete()) {
    if (progress.cancelled()) return drawingCancelled();
    if (renderer.refine(kStrip_ms)) renderer.paint(0, kStrip_ms);
    if (figures.first_ms == 0.0 && UploadProbe::level(renderer) < coarse) {
      figures.first_ms = msSince(stopped);
    }
  }
  figures.full_ms = msSince(stopped);

  renderer.setSampleDistance(kReferenceDistance);
  const Picture reference = renderer.picture();
  figures.ms_median = medianOf({ms.begin() + kSettling, ms.end()});
  figures.level = medianOf({levels.begin() + kSettling, levels.end()});
  figures.psnr_dB = std::min(kEqual_dB, psnr_dB(reference, moving));
  figures.ssim = ssim(reference, moving);
  return figures;
}

}  // namespace trephine
