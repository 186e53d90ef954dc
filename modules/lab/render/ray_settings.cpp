#include "lab/render/ray_settings.h"

#include <cmath>

#include "lab/render/render_parts.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// The bone of the cranium, each setting timed in turns.
Status addPictures(const Volume& cranium, const RaySettingOptions& options,
                   const Progress& progress, std::vector<RaySettingFigures>& figures) {
  const Result<TissueSet> tissues = shippedTissues("cranium");
  if (!tissues) return tissues.error();
  auto made = SceneRenderer::offscreen(options.size[0], options.size[1]);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  renderer.setTissues(*tissues, presetLooks(*tissues, ViewPreset::bone).value_or(TissueLooks()));
  renderer.setVolume(Grid(Volume(cranium)));
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  std::vector<std::vector<double>> ms(figures.size());
  for (int turn = 0; turn <= options.repeats; ++turn) {  // the first is not timed
    for (std::size_t n = 0; n < figures.size(); ++n) {
      if (progress.cancelled()) return renderCancelled();
      progress.at(double(turn) / (options.repeats + 1), "pictures");
      const RaySetting& setting = figures[n].setting;
      const bool truth = !setting.plain;
      renderer.setTruth({truth, truth});
      if (turn == 0) {
        renderer.setSampleDistance(kReferenceDistance);
        const Picture reference = renderer.picture();
        renderer.setSampleDistance(setting.distance_voxels);
        const double psnr = psnr_dB(reference, renderer.picture());
        figures[n].picture_rms_percent = 100.0 * std::pow(10.0, -psnr / 20.0);
        continue;
      }
      renderer.setSampleDistance(setting.distance_voxels);
      renderer.picture();                                   // shaders come and go with the truths
      renderer.setSampleDistance(setting.distance_voxels);  // all rays anew
      const auto start = RenderClock::now();
      renderer.picture();
      ms[n].push_back(msSince(start));
    }
  }
  for (std::size_t n = 0; n < figures.size(); ++n) figures[n].ms = medianOf(ms[n]);
  return {};
}

}  // namespace

Result<std::vector<RaySettingFigures>> measureRaySettings(const std::vector<RaySetting>& settings,
                                                          const RaySettingOptions& options,
                                                          const Progress& progress) {
  if (auto display = SceneRenderer::offscreen(16, 16); !display) return display.error();
  std::vector<RaySettingFigures> figures;
  for (const RaySetting& setting : settings) figures.push_back({setting, 0.0, 0.0, 0.0, 0.0});
  Result<Volume> made = makePhantom("cranium", Progress(progress, 0.0, 0.1));
  if (!made) return made.error();
  const auto cranium = std::make_shared<const Volume>(*std::move(made));
  const Progress pictures(progress, 0.1, 0.4);
  if (Status drawn = addPictures(*cranium, options, pictures, figures); !drawn) {
    return drawn.error();
  }
  RenderOptions of_truth;
  of_truth.truth_edge = options.truth_edge;
  of_truth.truth_step = options.truth_step;
  of_truth.surface_edge = options.surface_edge;
  const auto classes =
      craniumWrongPercent(cranium, settings, of_truth, Progress(progress, 0.4, 0.8));
  if (!classes) return classes.error();
  const auto luminance = shellLuminancePercent(settings, of_truth, Progress(progress, 0.8, 1.0));
  if (!luminance) return luminance.error();
  for (std::size_t n = 0; n < figures.size(); ++n) {
    figures[n].wrong_class_percent = (*classes)[n];
    figures[n].luminance_error_percent = (*luminance)[n];
  }
  return figures;
}

}  // namespace trephine
