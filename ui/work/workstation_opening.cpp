// Opening: a scene, a case, its structures, and what of it is kept for the next.
#include <algorithm>
#include <map>
#include <new>

#include "base/memory.h"
#include "base/system.h"
#include "imaging/structure_importer.h"
#include "library/name_words.h"
#include "scene/scene_structures.h"
#include "session/arm_devices.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/work/workstation.h"
#include "volume/case_memory.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

struct Workstation::Opened {
  Scene scene;
  std::filesystem::path scene_file;
  std::optional<Case> of;            // none: the scene's own is read
  bool same_scene = false;           // its tissues stay as they are edited
  std::string labels_file{};         // instead of what the case has; empty: that stays
  Answers answers{};                 // about them
  bool structures_alone = false;     // the open case with others of them
  bool any_scene = false;            // nobody chose the scene: one that fits what the case shows
  std::optional<Error> no_labels{};  // why the case opened without them
  // The case comes from there, and its own tissues with it.
  std::function<Result<Stored>(const Progress&)> load{};
  std::optional<TissueSet> tissues{};
  std::optional<Error> no_tissues{}, no_structures{};
  Volume mirror{};
};

namespace {

bool sameIds(const TissueSet& a, const TissueSet& b) {
  return std::ranges::equal(a.tissues, b.tissues, {}, &Tissue::id, &Tissue::id);
}

}  // namespace

std::filesystem::path defaultScene(const std::string& anatomy) {
  return resourceFolder() / "scenes" / (anatomy == "abdomen" ? "liver.json" : "cranium.json");
}

bool Workstation::mayOpen() {
  if (phase_ != Phase::empty && phase_ != Phase::ready) {
    fail({"BUSY", "An exercise is running", "", "Stop it, then open the other case"});
    return false;
  }
  if (isOpening()) {
    fail({"BUSY", "Another case is being opened", "", "Wait for it or cancel it first"});
    return false;
  }
  return true;
}

// The only way to a scene: what is locked is asked each time, since its file may have changed.
Result<Scene> Workstation::allowedScene(const std::filesystem::path& file, const Policy* policy) {
  Result<Scene> scene = readScene(file);
  if (!scene) return scene;
  if (Status may = policy ? checkScene(*policy, *scene, file) : Status(); !may) return may.error();
  return scene;
}

std::optional<Scene> Workstation::readSceneOrFail(const std::filesystem::path& file) {
  Result<Scene> scene = allowedScene(file, unlocked_ ? nullptr : &policy_);
  if (scene) return *std::move(scene);
  fail(scene.error());
  return {};
}

bool Workstation::isScene(const std::filesystem::path& path) {
  const auto isSidecar = [&] { return isVolumeFile(path) && !readScene(path); };  // of a .raw
  return path.extension() == ".json" && !isSidecar();
}

void Workstation::openPath(const std::filesystem::path& path) {
  if (!mayOpen()) return;
  if (isScene(path)) {
    std::optional<Scene> scene = readSceneOrFail(path);
    if (!scene) return;
    scene_chosen_ = true;
    const std::string source = scene->case_source;
    openSource(*std::move(scene), path, source);
    return;
  }
  import_.scan(path);
}

void Workstation::openPhantom(const std::string& name) {
  if (!mayOpen()) return;
  const bool fits = sceneFits(name);
  const std::filesystem::path file = fits ? scene_file_ : defaultScene(name);
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (fits) scene = asEdited(*std::move(scene), true);
  useCase(*scene, phantomSource(name));
  openSource(*std::move(scene), file, phantomSource(name), fits);
}

void Workstation::useScene(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  scene_chosen_ = true;
  // One that was made on a case of its own is for that.
  const bool any_case = scene->case_source.empty() || phantomNamed(scene->case_source);
  if (case_ && any_case && (!case_->built_in || scene->case_source.empty())) {
    useCase(*scene, scene_->case_source);
    openInBackground({*std::move(scene), file, case_});
  } else {
    const std::string source = scene->case_source;
    openSource(*std::move(scene), file, source);
  }
}

void Workstation::useLabels(const std::filesystem::path& file, const Answers& answers) {
  if (!mayOpen()) return;
  if (!case_) {
    fail({"NO_CASE", "There is no case that a label map could belong to", "",
          "Open the case first, then its label map"});
    return;
  }
  // As its file has it: with structures it may have other tissues.
  std::optional<Scene> scene = readSceneOrFail(scene_file_);
  if (!scene) return;
  scene = asEdited(*std::move(scene));
  useCase(*scene, scene_->case_source);
  Opened opening{*std::move(scene), scene_file_, case_, true, file.string(), answers};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
}

bool Workstation::useStructures(const std::shared_ptr<const LabelMap>& structures) {
  return case_ && phase_ == Phase::ready && !isOpening() && placeAgain(structures).ok();
}

// The open case in its scene, as that is on disk.
Status Workstation::placeAgain(const std::shared_ptr<const LabelMap>& structures) {
  Result<Scene> scene = allowedScene(scene_file_, unlocked_ ? nullptr : &policy_);
  if (!scene) return scene.error();
  scene = asEdited(*std::move(scene));
  useCase(*scene, scene_->case_source);
  const bool same = structures == case_->structures;
  Opened opening{*std::move(scene), scene_file_, same ? *case_ : withStructures(*case_, structures),
                 true};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
  return {};
}

void Workstation::openSource(Scene scene, const std::filesystem::path& scene_file,
                             const std::string& source, bool same_scene) {
  if (source.empty() && case_) {  // the open one, with what this scene looks for in it
    useCase(scene, scene_->case_source);
    return openInBackground({std::move(scene), scene_file, case_, same_scene});
  }
  if (source.empty()) {  // the scene waits for a case of the user's
    scene_ = std::move(scene);
    scene_file_ = scene_file;
    in_force_ = scene_->controller;
    declared_tissues_ = scene_->tissues;
    looks_ = scene_->view.looks;
    opened_scene_ = *scene_;
    history_.begin(*scene_);
    one_set_ = false;
    elsewhere_.reset();
    emit sceneChanged();
    emit locksChanged();
    emit editsChanged();
    return;
  }
  useCase(scene, source);
  openInBackground({std::move(scene), scene_file, {}, same_scene});
}

void Workstation::openImported(const Case& read, const std::filesystem::path& labels) {
  if (!mayOpen()) return;
  const std::filesystem::path file = scene_ ? scene_file_ : defaultScene("cranium");
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (scene_) scene = asEdited(*std::move(scene), true);
  useCase(*scene, "");
  Opened opening{*std::move(scene), file, read, scene_.has_value(), labels.string()};
  opening.any_scene = !scene_chosen_;
  openInBackground(std::move(opening));
}

void Workstation::openStored(std::function<Result<Stored>(const Progress&)> load) {
  if (!mayOpen()) return;
  const std::filesystem::path file = scene_ ? scene_file_ : defaultScene("cranium");
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (scene_) scene = asEdited(*std::move(scene), true);
  useCase(*scene, "");
  Opened opening{*std::move(scene), file, {}, scene_.has_value()};
  opening.any_scene = true;
  opening.load = std::move(load);
  openInBackground(std::move(opening));
}

void Workstation::openExercise(const std::filesystem::path& file,
                               std::function<Result<Stored>(const Progress&)> load) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  scene_chosen_ = true;
  Opened opening{*std::move(scene), file, {}};
  opening.load = std::move(load);
  openInBackground(std::move(opening));
}

void Workstation::setStored(const std::string& id, const std::string& name) {
  if (!case_) return;
  case_->stored = id;
  if (!name.empty()) case_->name = name;  // what its series was called may name somebody
  emit caseNamed();
}

// What a person is asked of a file that could be used as it is; the file is then not used yet.
struct Workstation::Asked {
  std::vector<std::string> overlapping;
  std::vector<std::string> forms;  // in which a NIfTI says how it lies (volume_files.h)
  bool threshold = false;
  bool any() const { return threshold || !overlapping.empty(); }
};

Result<Case> Workstation::withAnswered(const Case& of, const Opened& opening, Asked& asked,
                                       const Progress& progress) {
  StructureRequest request = requestOf(of, hideNamesOf);
  request.answers = opening.answers;
  if (const auto share = request.answers.find(kThreshold); share != request.answers.end()) {
    request.threshold = toQt(share->second).toDouble();
  }
  request.ask_threshold = !request.answers.contains(kThreshold);
  Result<StructureFit> fit = importStructures(opening.labels_file, *of.volume, request, progress);
  asked.threshold = !fit && fit.error().code == "THRESHOLD";
  if (!fit && fit.error().code == "FORMS_DIFFER") {
    const Result<VolumeFileHeader> header = readVolumeFileHeader(opening.labels_file);
    if (!header) return header.error();
    for (const VolumeFileHeader::Form& form : header->forms) asked.forms.push_back(form.name);
  }
  if (!fit) return fit.error();
  if (!request.answers.contains("OVERLAP")) asked.overlapping = fit->overlapping;
  if (asked.any()) return Error{"ASKED", "A person is asked about the structures", "", ""};
  return withFit(of, *std::move(fit));
}

void Workstation::openInBackground(Opened opening) {
  if (!opening.same_scene) emit sceneOpening(opening.scene, opening.scene_file);
  placing_ = opening.structures_alone && opening.labels_file.empty();
  const std::filesystem::path labels = opening.labels_file;
  const Answers answers = opening.answers;
  const std::shared_ptr<const Volume> shown = case_ ? case_->volume : nullptr;
  const auto asked = std::make_shared<Asked>();
  opening_.run(
      [opening = std::move(opening), shown, asked,
       policy = unlocked_ ? std::optional<Policy>()
                          : policy_](const Progress& all) mutable -> Result<Opened> {
        constexpr double kLoaded = 0.7;  // of the work
        if (opening.load) {
          Result<Stored> stored = opening.load(Progress(all, 0.0, kLoaded));
          if (!stored) return stored.error();
          opening.of = std::move(stored->of);
          opening.tissues = std::move(stored->tissues);
          opening.no_tissues = std::move(stored->no_tissues);
          opening.no_structures = std::move(stored->no_structures);
        }
        const Progress progress(all, opening.load ? kLoaded : 0.0, 1.0);
        opening.load = nullptr;
        if (opening.of && !opening.labels_file.empty()) {
          Result<Case> labelled =
              opening.structures_alone
                  ? withAnswered(*opening.of, opening, *asked, progress)
                  : withLabels(*opening.of, opening.labels_file, progress, hideNamesOf);
          if (!labelled && opening.of->volume == shown) return labelled.error();
          if (labelled) {
            opening.of = *std::move(labelled);
          } else {
            opening.no_labels = labelled.error();
          }
        }
        if (opening.of && !opening.of->anatomy) {
          opening.of->anatomy = anatomyOf(*opening.of->volume, progress);
        }
        const std::string fits =
            opening.any_scene ? exerciseAnatomy(opening.of->anatomy->region) : "";
        if (!fits.empty() && fits != opening.scene.anatomy) {
          const std::filesystem::path file = defaultScene(fits);
          if (Result<Scene> other = allowedScene(file, policy ? &*policy : nullptr)) {
            useCase(*other, "");
            opening.scene = *std::move(other);
            opening.scene_file = file;
            opening.same_scene = false;
          }
        }
        Result<Case> placed = opening.of
                                  ? placedIn(opening.scene, *opening.of, progress, hideNamesOf)
                                  : openCase(opening.scene, progress, hideNamesOf);
        if (!placed) return placed.error();
        opening.of = *std::move(placed);
        if (opening.of->volume == shown) return std::move(opening);
        const std::size_t voxels = opening.of->volume->geometry.voxelCount();
        const double needed_mb = shownMb(voxels) + (opening.of->labels ? labelsMb(voxels) : 0.0);
        if (Status enough = enoughMemory(needed_mb, "Showing the case", "the case"); !enough) {
          return enough.error();
        }
        try {
          opening.mirror = copyOf(*opening.of->volume);
        } catch (const std::bad_alloc&) {
          return outOfMemory("to show the case", "the case");
        }
        return std::move(opening);
      },
      [this, labels, answers, asked](Result<Opened> outcome) {
        placing_ = false;
        if (!outcome && asked->threshold) return thresholdAsked(labels, answers);
        if (!outcome && asked->any()) return overlapAsked(asked->overlapping, labels, answers);
        // A choice that has an option beside refusing is a question.
        std::map<std::string, std::vector<std::string>> questions{{"HU_NOT_TISSUE", {"keep"}},
                                                                  {"MIRRORED", {"keep"}},
                                                                  {"OTHER_FRAME", {"keep"}},
                                                                  {"NO_AFFINE", {"ct"}}};
        if (!asked->forms.empty()) questions["FORMS_DIFFER"] = asked->forms;
        if (!outcome && questions.contains(outcome.error().code)) {
          const Error& error = outcome.error();
          return structuresAsked(error, labels, answers, questions.at(error.code));
        }
        opened(std::move(outcome));
      });
}

// What was edited holds on the next case too. Where the scene has other tissues there, it waits for
// a case on which these hold again.
void Workstation::keepEdits(Opened& opened) {
  const LabelMap* labels = opened.of->labels.get();
  const bool same_set =
      opened.same_scene && (one_set_ || scene_->tissues_elsewhere.has_value() ==
                                            opened.scene.tissues_elsewhere.has_value());
  if (!same_set) history_.begin(opened.scene);
  if (same_set) {
    // Edited while the case was read, perhaps.
    if (opened.structures_alone) opened.scene = asEdited(std::move(opened.scene));
    opened.scene.tissues = scene_->tissues;
    for (TissueSet* set : {&opened.scene.tissues, &declared_tissues_}) placeTissues(*set, labels);
    return;
  }
  std::optional<TissueSet> edited;
  if (opened.same_scene && tissuesEdited()) edited = scene_->tissues;
  declared_tissues_ = opened.scene.tissues;
  if (!opened.same_scene) {
    one_set_ = false;
    elsewhere_.reset();
    looks_ = opened.scene.view.looks;
    edited_other_.reset();
    return;
  }
  if (edited_other_) {
    opened.scene.tissues = *edited_other_;
    placeTissues(opened.scene.tissues, labels);
  }
  edited_other_ = std::move(edited);
}

void Workstation::opened(Result<Opened> outcome) {
  const bool of_edit = std::exchange(placing_edit_, false);
  if (!outcome) {
    if (of_edit && history_.canUndo()) goTo(history_.undo());
    placing_edit_ = false;
    if (case_) emit placingFailed();
    return fail(outcome.error());
  }
  const bool structures_alone = outcome->structures_alone;
  const bool may_edit = !isLocked(Lock::tissues);
  placed_with_ = tissueTable(outcome->scene.tissues);
  keepEdits(*outcome);
  // The case's own, where they are of the same kinds: what was felt on it is felt again.
  if (outcome->tissues && may_edit && sameIds(*outcome->tissues, outcome->scene.tissues)) {
    outcome->scene.tissues = *outcome->tissues;
    placeTissues(outcome->scene.tissues, outcome->of->labels.get());
    declared_tissues_ = outcome->scene.tissues;
  }
  const bool same_scene = outcome->same_scene;
  const bool as_opened = !same_scene || !sceneEdited();
  scene_ = std::move(outcome->scene);
  if (as_opened) {
    Scene fresh = *scene_;
    for (Landmark& landmark : fresh.landmarks) {  // a place that was clicked is no part of it
      if (same_scene && isEntry(landmark)) {
        landmark = *opened_scene_.findLandmarkById(landmark.id);
      }
    }
    opened_scene_ = std::move(fresh);
  }
  history_.settle(*scene_);
  scene_file_ = std::move(outcome->scene_file);
  in_force_ = scene_->controller;
  case_ = std::move(outcome->of);
  if (structures_alone) {
    emit sceneChanged();
    emit editsChanged();
    emit structuresChanged();
    return;
  }
  mirror_ = std::move(outcome->mirror);
  carved_.reset();
  tellGivenBack();
  emit sceneChanged();
  emit editsChanged();
  emit locksChanged();
  emit caseOpened();
  setPhase(Phase::ready);
  if (outcome->no_labels) fail(*outcome->no_labels);
  if (outcome->no_structures) fail(*outcome->no_structures);
  if (outcome->no_tissues && may_edit) fail(*outcome->no_tissues);
  if (case_->misfit) fail(*case_->misfit);
  readArms();
}

std::optional<LandmarkFrame> Workstation::viewLandmark() const {
  if (!case_) return {};
  for (const PlacedLandmark& landmark : case_->landmarks) {
    if (scene_ && landmark.id == scene_->view.landmark) return landmark.frame;
  }
  return {};
}

}  // namespace trephine
