// The parts of `measure render`. Each takes what it needs, and ends with CANCELLED where it is
// told.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "case/placement.h"
#include "exercise/landmark.h"
#include "lab/render/ray_settings.h"
#include "lab/render/render_measurement.h"
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
// Nothing of ours on, for a subject that is shown without labels: VTK's shader alone.
void setStock(SceneRenderer& renderer, bool stock);

using RenderClock = std::chrono::steady_clock;
inline double msSince(RenderClock::time_point start) {
  return std::chrono::duration<double, std::milli>(RenderClock::now() - start).count();
}
double medianOf(std::vector<double> values);
inline Error renderCancelled() {
  return {"CANCELLED", "The measurement was cancelled", "measure render", ""};
}

// Still rows of a subject: sample distances by both mappers, levels by ours. Pictures go to `out`.
Status measureStills(const RenderSubject& subject, const RenderOptions& options,
                     const std::filesystem::path& out, const Progress& progress,
                     RenderMeasurement& result);
// The row of a camera that turns, and how long its picture takes to come to rest.
Status measureRotation(const RenderSubject& subject, const RenderOptions& options,
                       const Progress& progress, RenderMeasurement& result);
// Both mappers on the shell of bone.
Status measureSurface(const RenderOptions& options, const Progress& progress,
                      RenderMeasurement& result);
// Both mappers on both phantoms, from six directions.
Status measureClasses(const std::vector<RenderSubject>& subjects, const RenderOptions& options,
                      const Progress& progress, RenderMeasurement& result);
// By setting, of the cranium's own volume and of the shell.
Result<std::vector<double>> craniumWrongPercent(std::shared_ptr<const Volume> cranium,
                                                const std::vector<RaySetting>& settings,
                                                const RenderOptions& options,
                                                const Progress& progress);
Result<std::vector<double>> shellLuminancePercent(const std::vector<RaySetting>& settings,
                                                  const RenderOptions& options,
                                                  const Progress& progress);
// Shipped exercises with their operators, drawn as they run.
Status measureExercises(const std::vector<RenderSubject>& subjects, const RenderOptions& options,
                        const Progress& progress, RenderMeasurement& result);
// The first picture of a series that was imported.
Status measureFirstPicture(const RenderOptions& options, const std::filesystem::path& out,
                           const Progress& progress, RenderMeasurement& result);

}  // namespace trephine
