// What pictures cost on this machine, and how true they are: the subjects and the parts that
// commissioning, the trade of the rays and `trephine-measure render` put together. Each part needs
// a display and ends with CANCELLED where it is told; other errors are NO_DISPLAY, NO_OPENGL and
// those of the cases.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/codes.h"
#include "base/progress.h"
#include "base/result.h"
#include "base/tr.h"
#include "case/placement.h"
#include "exercise/landmark.h"
#include "machine/drawing/ray_settings.h"
#include "render/scene_renderer.h"

namespace trephine {

// What is drawn, and from where.
struct RenderSubject {
  std::string name;    // of the case, in rows
  std::string preset;  // in rows
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> labels;  // null: none
  TissueSet tissues;
  TissueLooks looks;
  std::optional<LandmarkFrame> at;  // nothing: the whole case from the front
  double distance_mm = 0.0;         // of the eye from the landmark
};

// The built-in subjects, and bone in `case_source` unless that is empty.
Result<std::vector<RenderSubject>> renderSubjects(const std::string& case_source,
                                                  const Progress& progress);
// "cranium" or "abdomen".
Result<TissueSet> shippedTissues(const std::string& name);
// Only what is told by HU: without labels. A tissue that had one keeps what it is by HU alone.
TissueSet byHuAlone(TissueSet tissues);

// Shows it in a renderer, all of ours on.
void show(const RenderSubject& subject, bool with_labels, SceneRenderer& renderer);
void placeCamera(const RenderSubject& subject, SceneRenderer& renderer);

using RenderClock = std::chrono::steady_clock;
inline double msSince(RenderClock::time_point start) {
  return std::chrono::duration<double, std::milli>(RenderClock::now() - start).count();
}
double medianOf(std::vector<double> values);
inline Error drawingCancelled() {
  return {code::kCancelled, tr("The measurement was cancelled"), "pictures", ""};
}

constexpr double kEqual_dB = 100.0;          // stand for equal pictures
constexpr double kReferenceDistance = 0.25;  // voxels between the samples of a reference

struct DrawingOptions {
  std::array<int, 2> size{1280, 800};
  double sample_distance = SceneRenderer::kSampleDistance;  // in the smallest edge of a voxel
  double rotate_s = 4.0;
  double cut_s = 10.0;
};

// A camera that turns, and how long full quality takes after it comes to rest.
struct TurningFigures {
  double ms_median = 0.0, level = 1.0;  // of a picture; pixels between its rays, each way
  double psnr_dB = 0.0, ssim = 0.0;     // of the last one, against kReferenceDistance
  double first_ms = 0.0;                // at rest, to the first refined picture
  double full_ms = 0.0;
};
Result<TurningFigures> measureTurning(const RenderSubject& subject, const DrawingOptions& options,
                                      const Progress& progress);

// Shipped exercises with their operators, drawn as they run.
struct CuttingFigures {
  struct Exercise {
    std::string of_case, preset;
    double ms_median = 0.0, level = 1.0;
  };
  std::vector<Exercise> exercises;
  double removal_median_ms = 0.0, removal_max_ms = 0.0;  // removal to pixel
  double hand_median_ms = 0.0, hand_p99_ms = 0.0;        // hand to the tool's new pixel
  double missed_ticks_percent = 0.0;
};
Result<CuttingFigures> measureCutting(const std::vector<RenderSubject>& subjects,
                                      const DrawingOptions& options, const Progress& progress);

// Of a shell of bone whose normals are known, setting by setting: of the picture's normals, and of
// the Lambert shading that they give with the light at the eye (rms of the mean). `edge`: pixels.
struct ShellSurface {
  double normal_median_deg = 0.0, normal_p99_deg = 0.0, luminance_error_percent = 0.0;
};
constexpr int kSurfaceEdge = 480;
Result<std::vector<ShellSurface>> shellSurface(const std::vector<RaySetting>& settings, int edge,
                                               const Progress& progress);

// Of the pixels in which truth or picture show a tissue of a built-in case ("cranium", "abdomen"),
// those that show another [%], setting by setting. `by_label`: with a label map of its organs.
// `volume`: the case's own. `step`: every so many pixels of a picture of `edge` pixels, which lies
// below where letters are drawn.
constexpr int kTruthEdge = 232;
Result<std::vector<double>> wrongClassPercent(const std::string& name,
                                              std::shared_ptr<const Volume> volume, bool by_label,
                                              const std::vector<RaySetting>& settings, int edge,
                                              int step, const Progress& progress);

}  // namespace trephine
