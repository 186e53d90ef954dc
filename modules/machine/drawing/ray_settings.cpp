#include "machine/drawing/ray_settings.h"

#include <algorithm>
#include <cmath>

#include "machine/drawing/drawing_parts.h"

namespace trephine {

namespace {

struct Side {
  Vec3 towards, up;
};
// Ahead of the eye, in the patient's frame: from the front, from behind, from both sides, from
// above.
const std::vector<Side> kSides{{Vec3(0, 1, 0), Vec3(0, 0, 1)},
                               {Vec3(0, -1, 0), Vec3(0, 0, 1)},
                               {Vec3(1, 0, 0), Vec3(0, 0, 1)},
                               {Vec3(-1, 0, 0), Vec3(0, 0, 1)},
                               {Vec3(0, 0, -1), Vec3(0, 1, 0)}};

// A picture's time is its own, from all rays anew.
Picture pictureWith(const RaySetting& setting, SceneRenderer& renderer, double* ms = nullptr) {
  renderer.setSampleDistance(setting.distance_voxels);
  const auto start = RenderClock::now();
  Picture picture = renderer.picture();
  if (ms) *ms = msSince(start);
  return picture;
}

// Of settings with the truths that are on, as the renderer stands: how far each is from the finest.
void addErrors(bool plain, SceneRenderer& renderer, std::vector<RaySettingFigures>& figures) {
  const Picture finest = pictureWith({kReferenceDistance, plain}, renderer);
  for (RaySettingFigures& f : figures) {
    if (f.setting.plain != plain) continue;
    const double dB = psnr_dB(finest, pictureWith(f.setting, renderer));
    f.picture_rms_percent = std::max(f.picture_rms_percent, 100.0 * std::pow(10.0, -dB / 20.0));
  }
}

// The settings of a subject in turns, shaders changing as seldom as may be; `ms` is of its own
// view.
Status addPictures(const RenderSubject& subject, const RaySettingOptions& options,
                   const Progress& progress, std::vector<RaySettingFigures>& figures) {
  auto made = SceneRenderer::offscreen(options.size[0], options.size[1]);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  show(subject, true, renderer);
  for (const bool plain : {false, true}) {
    renderer.setShading({!plain, !plain});
    placeCamera(subject, renderer);
    addErrors(plain, renderer, figures);
    std::vector<std::vector<double>> ms(figures.size());
    for (int turn = 0; turn < options.repeats; ++turn) {
      if (progress.cancelled()) return drawingCancelled();
      for (std::size_t n = 0; n < figures.size(); ++n) {
        if (figures[n].setting.plain != plain) continue;
        pictureWith(figures[n].setting, renderer, &ms[n].emplace_back());
      }
    }
    for (std::size_t n = 0; n < figures.size(); ++n) {
      if (figures[n].setting.plain == plain) figures[n].ms += medianOf(ms[n]);
    }
    // Without a place of its own, a subject was just seen from the front.
    for (std::size_t n = subject.at ? 0 : 1; n < kSides.size(); ++n) {
      if (progress.cancelled()) return drawingCancelled();
      progress.at(0.5 * ((plain ? 1.0 : 0.0) + double(n) / double(kSides.size())), "pictures");
      renderer.resetCamera(kSides[n].towards, kSides[n].up);
      addErrors(plain, renderer, figures);
    }
  }
  return {};
}

}  // namespace

Result<std::vector<RaySettingFigures>> measureRaySettings(const std::vector<RaySetting>& settings,
                                                          const RaySettingOptions& options,
                                                          const Progress& progress) {
  if (auto display = SceneRenderer::offscreen(16, 16); !display) return display.error();
  std::vector<RaySettingFigures> figures;
  for (const RaySetting& setting : settings) figures.push_back({setting, 0.0, 0.0, 0.0, 0.0});
  const auto subjects = renderSubjects("", Progress(progress, 0.0, 0.1));
  if (!subjects) return subjects.error();
  for (std::size_t n = 0; n < subjects->size(); ++n) {
    const double count = double(subjects->size());
    const Progress part(progress, 0.1 + 0.5 * double(n) / count, 0.1 + 0.5 * double(n + 1) / count);
    const Status drawn = addPictures((*subjects)[n], options, part, figures);
    if (!drawn) return drawn.error();
  }
  for (RaySettingFigures& f : figures) f.ms /= double(subjects->size());
  const auto classes =
      wrongClassPercent("cranium", subjects->front().volume, false, settings, kTruthEdge,
                        options.truth_step, Progress(progress, 0.6, 0.9));
  if (!classes) return classes.error();
  const auto surfaces = shellSurface(settings, kSurfaceEdge, Progress(progress, 0.9, 1.0));
  if (!surfaces) return surfaces.error();
  for (std::size_t n = 0; n < figures.size(); ++n) {
    figures[n].wrong_class_percent = (*classes)[n];
    figures[n].luminance_error_percent = (*surfaces)[n].luminance_error_percent;
  }
  return figures;
}

}  // namespace trephine
