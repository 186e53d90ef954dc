// Opening: a scene, a case, its structures, and what of it is kept for the next.
#include <algorithm>
#include <map>
#include <new>

#include "base/memory.h"
#include "base/system.h"
#include "imaging/structure_importer.h"
#include "library/name_words.h"
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
  std::optional<Case> of;         // none: that of `source` is read
  bool same_scene = false;        // it stays as it is edited
  std::string labels_file{};      // instead of what the case has; empty: that stays
  Answers answers{};              // about them
  bool structures_alone = false;  // the open case with others of them
  bool any_scene = false;         // nobody chose the scene: one that fits what the case shows
  std::string source{};
  std::optional<Error> no_labels{};  // why the case opened without them
  // The case comes from there, and its own tissues with it.
  std::function<Result<Stored>(const Progress&)> load{};
  std::optional<TissueSet> tissues{};
  std::optional<Error> no_tissues{}, no_structures{};
  Placement placed{};
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
  if (sceneFits(name)) {
    return openSource(forAnotherCase(*scene_), scene_file_, phantomSource(name), true);
  }
  const std::filesystem::path file = defaultScene(name);
  std::optional<Scene> scene = readSceneOrFail(file);
  if (scene) openSource(*std::move(scene), file, phantomSource(name));
}

void Workstation::useScene(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  scene_chosen_ = true;
  // One that was made on a case of its own is for that.
  const bool any_case = scene->case_source.empty() || phantomNamed(scene->case_source);
  const Case* open = currentCase();
  if (open && any_case && (!open->built_in || scene->case_source.empty())) {
    openInBackground({*std::move(scene), file, *open});
  } else {
    const std::string source = scene->case_source;
    openSource(*std::move(scene), file, source);
  }
}

void Workstation::useLabels(const std::filesystem::path& file, const Answers& answers) {
  if (!mayOpen()) return;
  if (!placed_) {
    fail({"NO_CASE", "There is no case that a label map could belong to", "",
          "Open the case first, then its label map"});
    return;
  }
  Opened opening{*scene_, scene_file_, placed_->patient, true, file.string(), answers};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
}

bool Workstation::useStructures(const std::shared_ptr<const LabelMap>& structures) {
  if (!placed_ || phase_ != Phase::ready || isOpening()) return false;
  placeAgain(structures);
  return true;
}

// The exercise on the open case with these structures.
void Workstation::placeAgain(const std::shared_ptr<const LabelMap>& structures) {
  const Case& of = placed_->patient;
  const bool same = structures == of.structures;
  Opened opening{*scene_, scene_file_, same ? of : withStructures(of, structures), true};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
}

void Workstation::openSource(Scene scene, const std::filesystem::path& scene_file,
                             const std::string& source, bool same_scene) {
  if (source.empty() && placed_) {  // the open one, with what this scene looks for in it
    return openInBackground({std::move(scene), scene_file, placed_->patient, same_scene});
  }
  if (source.empty()) {  // the scene waits for a case of the user's
    scene_ = std::move(scene);
    scene_file_ = scene_file;
    in_force_ = scene_->controller;
    looks_ = scene_->view.looks;
    opened_scene_ = *scene_;
    history_.begin(*scene_);
    emit sceneChanged();
    emit locksChanged();
    emit editsChanged();
    return;
  }
  Opened opening{std::move(scene), scene_file, {}, same_scene};
  opening.source = source;
  openInBackground(std::move(opening));
}

// For a case that an exercise goes on with: the one in use, else the first of the product's.
std::optional<Workstation::Opened> Workstation::openingOf() {
  if (!mayOpen()) return {};
  if (scene_) return Opened{forAnotherCase(*scene_), scene_file_, {}, true};
  const std::filesystem::path file = defaultScene("cranium");
  std::optional<Scene> scene = readSceneOrFail(file);
  return scene ? std::optional(Opened{*std::move(scene), file, {}}) : std::nullopt;
}

void Workstation::openImported(const Case& read, const std::filesystem::path& labels) {
  std::optional<Opened> opening = openingOf();
  if (!opening) return;
  opening->of = read;
  opening->labels_file = labels.string();
  opening->any_scene = !scene_chosen_;
  openInBackground(*std::move(opening));
}

void Workstation::openStored(std::function<Result<Stored>(const Progress&)> load) {
  std::optional<Opened> opening = openingOf();
  if (!opening) return;
  opening->any_scene = true;
  opening->load = std::move(load);
  openInBackground(*std::move(opening));
}

void Workstation::openExercise(const std::filesystem::path& file,
                               std::function<Result<Stored>(const Progress&)> load) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  scene_chosen_ = true;
  Opened opening{*std::move(scene), file, {}};
  opening.source = opening.scene.case_source;
  opening.load = std::move(load);
  openInBackground(std::move(opening));
}

void Workstation::setStored(const std::string& id, const std::string& name) {
  if (!placed_) return;
  placed_->patient.stored = id;
  if (!name.empty()) placed_->patient.name = name;  // what its series was called may name somebody
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
  const std::shared_ptr<const Volume> shown = placed_ ? placed_->patient.volume : nullptr;
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
          opening.of->source = opening.source;
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
            opening.scene = *std::move(other);
            opening.scene_file = file;
            opening.same_scene = false;
          }
        }
        constexpr double kRead = 0.9;  // of the work
        const bool at_hand = opening.of.has_value();
        if (!at_hand) {
          Result<Case> read = readCase(opening.source, Progress(progress, 0.0, kRead));
          if (!read) return read.error();
          opening.of = *std::move(read);
        }
        const Scene here = onCase(opening.scene, opening.of->source);
        Result<Placement> placed =
            place(here, *std::exchange(opening.of, {}),
                  Progress(progress, at_hand ? 0.0 : kRead, 1.0), hideNamesOf);
        if (!placed) return placed.error();
        opening.placed = *std::move(placed);
        if (opening.scene.tissues_elsewhere && !here.tissues_elsewhere) {
          opening.placed.elsewhere = true;
        }
        const std::shared_ptr<const Volume>& volume = opening.placed.patient.volume;
        if (volume == shown) return std::move(opening);
        const std::size_t voxels = volume->geometry.voxelCount();
        const double needed_mb = shownMb(voxels) + (opening.placed.labels ? labelsMb(voxels) : 0.0);
        if (Status enough = enoughMemory(needed_mb, "Showing the case", "the case"); !enough) {
          return enough.error();
        }
        try {
          opening.mirror = copyOf(*volume);
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

// What was edited holds on the next case too.
void Workstation::opened(Result<Opened> outcome) {
  const bool of_edit = std::exchange(placing_edit_, false);
  if (!outcome) {
    if (of_edit && history_.canUndo()) goTo(history_.undo());
    placing_edit_ = false;
    if (placed_) emit placingFailed();
    return fail(outcome.error());
  }
  const bool structures_alone = outcome->structures_alone;
  const bool may_edit = !isLocked(Lock::tissues);
  const bool was_elsewhere = isElsewhere();
  placed_ = std::move(outcome->placed);
  placed_with_ = tissueTable(placed_->scene.tissues);
  if (!outcome->same_scene) {
    scene_ = std::move(outcome->scene);
    opened_scene_ = *scene_;
    looks_ = scene_->view.looks;
    history_.begin(*scene_);
  } else if (!structures_alone) {  // tissues and controller were edited while it was read, perhaps
    scene_ = forAnotherCase(*scene_);
  }
  // The case's own, where they are of the same kinds: what was felt on it is felt again.
  if (outcome->tissues && may_edit && sameIds(*outcome->tissues, tissues())) {
    tissuesOf(*scene_) = *outcome->tissues;
    tissuesSaved(*outcome->tissues);
  }
  // What was edited in a set that is not shown any more is not taken back unseen.
  if (was_elsewhere != isElsewhere()) history_.begin(*scene_);
  history_.settle(*scene_);
  history_.close();
  refreshPlaced();
  scene_file_ = std::move(outcome->scene_file);
  in_force_ = scene_->controller;
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
  if (placed_->error) fail(*placed_->error);
  readArms();
}

std::optional<LandmarkFrame> Workstation::viewLandmark() const {
  if (!placed_) return {};
  for (const PlacedLandmark& landmark : placed_->landmarks) {
    if (scene_ && landmark.id == scene_->view.landmark) return landmark.frame;
  }
  return {};
}

}  // namespace trephine
