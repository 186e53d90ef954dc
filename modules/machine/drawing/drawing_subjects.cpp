#include <algorithm>
#include <array>

#include "base/system.h"
#include "machine/drawing/drawing_parts.h"
#include "tissue/tissue_look.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// What the abdomen's organs are by HU alone.
struct OrganHu {
  const char* id;
  int low, high;
};
constexpr std::array<OrganHu, 3> kByHu{
    {{"liver", 26, 62}, {"capsule", 85, 107}, {"vessel", 135, 200}}};

Result<Case> builtIn(const std::string& name, const Progress& progress) {
  return readCase(phantomSource(name), progress);
}

RenderSubject subjectOf(const Case& of, const std::string& name, ViewPreset preset,
                        const char* preset_name, const TissueSet& tissues) {
  RenderSubject subject{name, preset_name, of.volume, nullptr, tissues, {}, {}, 0.0};
  subject.looks = presetLooks(tissues, preset).value_or(TissueLooks());
  return subject;
}

}  // namespace

Result<TissueSet> shippedTissues(const std::string& name) {
  return readTissueSet(resourceFolder() / "tissues" / (name + ".json"));
}

TissueSet byHuAlone(TissueSet tissues) {
  for (Tissue& tissue : tissues.tissues) {
    if (!tissue.label) continue;
    tissue.label.reset();
    for (const OrganHu& organ : kByHu) {
      if (tissue.id != organ.id) continue;
      tissue.hu_min = organ.low;
      tissue.hu_max = organ.high;
    }
  }
  return tissues;
}

Result<std::vector<RenderSubject>> renderSubjects(const std::string& case_source,
                                                  const Progress& progress) {
  std::vector<RenderSubject> subjects;
  const Result<TissueSet> tissues = shippedTissues("cranium");
  if (!tissues) return tissues.error();
  const Result<Case> cranium = builtIn("cranium", Progress(progress, 0.0, 0.3));
  if (!cranium) return cranium.error();
  const std::string name = phantomSource("cranium");
  subjects.push_back(subjectOf(*cranium, name, ViewPreset::bone, "bone", *tissues));
  subjects.push_back(subjectOf(*cranium, name, ViewPreset::skin, "skin", *tissues));

  Result<Exercise> liver = readExercise(resourceFolder() / "scenes" / "liver.json");
  if (!liver) return liver.error();
  const Result<Placement> abdomen = openCase(*liver, Progress(progress, 0.3, 0.8));
  if (!abdomen) return abdomen.error();
  if (abdomen->error) return *abdomen->error;
  RenderSubject subject{liver->case_source,
                        "liver",
                        abdomen->patient.volume,
                        abdomen->labels,
                        abdomen->exercise.tissues,
                        liver->view.looks,
                        std::nullopt,
                        liver->view.distance_mm};
  for (const PlacedLandmark& landmark : abdomen->landmarks) {
    if (landmark.id == liver->view.landmark) subject.at = landmark.frame;
  }
  subjects.push_back(std::move(subject));

  if (!case_source.empty()) {
    const Result<Case> own = readCase(case_source, Progress(progress, 0.8, 1.0));
    if (!own) return own.error();
    subjects.push_back(
        subjectOf(*own, own->built_in ? case_source : "case", ViewPreset::bone, "bone", *tissues));
  }
  return subjects;
}

void show(const RenderSubject& subject, bool with_labels, SceneRenderer& renderer) {
  const bool labelled = with_labels && subject.labels;
  renderer.setTissues(labelled ? subject.tissues : byHuAlone(subject.tissues), subject.looks);
  renderer.setVolume(Grid(Volume(*subject.volume), labelled ? subject.labels : nullptr));
  placeCamera(subject, renderer);
}

void placeCamera(const RenderSubject& subject, SceneRenderer& renderer) {
  if (subject.at) {
    renderer.lookAt(subject.at->position_mm, subject.at->viewDirection(), subject.at->viewUp(),
                    subject.distance_mm);
  } else {
    renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  }
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace trephine
