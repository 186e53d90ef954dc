#include "ui/work/workstation.h"

#include <QDateTime>
#include <QTimer>
#include <algorithm>
#include <map>
#include <new>

#include "base/file.h"
#include "base/memory.h"
#include "base/rt/thread.h"
#include "base/system.h"
#include "imaging/structure_importer.h"
#include "scene/scene_structures.h"
#include "session/arm_devices.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

struct Workstation::Opened {
  Scene scene;
  std::filesystem::path scene_file;
  std::optional<Case> of;   // none: the scene's own is read
  bool same_scene = false;  // its tissues stay as they are edited
  std::string labels_file{};  // instead of what the case has; empty: that stays
  Answers answers{};          // about them
  bool structures_alone = false;     // the open case with others of them
  bool any_scene = false;            // nobody chose the scene: one that fits what the case shows
  std::optional<Error> no_labels{};  // why the case opened without them
  // The case comes from there, and its own tissues with it.
  std::function<Result<Stored>(const Progress&)> load{};
  std::optional<TissueSet> tissues{};
  Volume mirror{};
};

namespace {

// While a save waits for the haptic thread to stand still.
constexpr int kLookAgain_ms = 10;

bool sameIds(const TissueSet& a, const TissueSet& b) {
  return std::ranges::equal(a.tissues, b.tissues, {}, &Tissue::id, &Tissue::id);
}

Error busySaving() {
  return {"BUSY", "Another file is being saved", "", "Try again in a moment"};
}

}  // namespace

std::filesystem::path defaultScene(const std::string& anatomy) {
  return resourceFolder() / "scenes" / (anatomy == "abdomen" ? "liver.json" : "cranium.json");
}

Workstation::Workstation(const Policy& policy, QObject* parent)
    : QObject(parent), policy_(policy) {
  connect(&opening_, &BackgroundTask::progressed, this, &Workstation::openingProgressed);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::openingEnded);
  connect(&opening_, &BackgroundTask::began, this, &Workstation::phaseChanged);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::phaseChanged);
  connect(&import_, &ImportTask::failed, this, &Workstation::failed);
  connect(&saving_, &BackgroundTask::progressed, this, &Workstation::savingProgressed);
  connect(&saving_, &BackgroundTask::ended, this, &Workstation::savingEnded);
}

Workstation::~Workstation() = default;

void Workstation::setPhase(Phase phase) {
  phase_ = phase;
  emit phaseChanged();
}

void Workstation::fail(const Error& error) {
  if (error.code != "CANCELLED") emit failed(error);
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

std::optional<Scene> Workstation::readSceneOrFail(const std::filesystem::path& file) {
  Result<Scene> scene = readScene(file);
  if (!scene) {
    fail(scene.error());
    return {};
  }
  if (Status may = unlocked_ ? Status() : checkScene(policy_, *scene, file); !may) {
    fail(may.error());
    return {};
  }
  // An arm that is not there now may be when the exercise starts, which then asks again.
  (void)readArmDynamics(*scene);
  return *std::move(scene);
}

// --- Locks ---

bool Workstation::isLocked(Lock lock) const {
  if (unlocked_) return false;
  return scene_ ? locksOf(policy_, *scene_).contains(lock) : policy_.isLocked(lock);
}

bool Workstation::anyLocked() const {
  return isLocked(Lock::controller) || isLocked(Lock::tissues) || isLocked(Lock::rate);
}

void Workstation::unlock() {
  unlocked_ = true;
  emit locksChanged();
}

bool Workstation::refuseLocked(Lock lock, const char* what) {
  if (!isLocked(lock)) return false;
  fail({"LOCKED", std::string(what) + " locked on this workstation or by this exercise", "",
        "Ask an educator, who can unlock it with a PIN (menu File)"});
  return true;
}

// --- Opening ---

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
  useCase(*scene, phantomSource(name));
  openSource(*std::move(scene), file, phantomSource(name), fits);
}

void Workstation::useScene(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  scene_chosen_ = true;
  if (case_ && (!case_->built_in || scene->case_source.empty())) {
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
  useCase(*scene, scene_->case_source);
  enterAt(*scene);
  Opened opening{*std::move(scene), scene_file_, case_, true, file.string(), answers};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
}

bool Workstation::useStructures(const std::shared_ptr<const LabelMap>& structures) {
  return case_ && phase_ == Phase::ready && !isOpening() && placeAgain(structures);
}

bool Workstation::placeEntry(const std::optional<Landmark>& entry) {
  if (!case_ || phase_ != Phase::ready || isOpening()) return false;
  entry_ = entry;
  if (placeAgain(case_->structures)) return true;
  entry_ = entry_before_;
  return false;
}

void Workstation::enterAt(Scene& scene) const {
  for (Landmark& landmark : scene.landmarks) {
    if (entry_ && landmark.id == entry_->id) landmark = *entry_;
  }
}

// The open case in its scene, as that is on disk.
bool Workstation::placeAgain(const std::shared_ptr<const LabelMap>& structures) {
  Result<Scene> scene = readScene(scene_file_);
  if (!scene) return false;
  (void)readArmDynamics(*scene);
  useCase(*scene, scene_->case_source);
  enterAt(*scene);
  const bool same = structures == case_->structures;
  Opened opening{*std::move(scene), scene_file_, same ? *case_ : withStructures(*case_, structures),
                 true};
  opening.structures_alone = true;
  openInBackground(std::move(opening));
  return true;
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
    emit sceneChanged();
    emit locksChanged();
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
  useCase(*scene, "");
  Opened opening{*std::move(scene), file, {}, scene_.has_value()};
  opening.any_scene = true;
  opening.load = std::move(load);
  openInBackground(std::move(opening));
}

void Workstation::setStored(const std::string& id, const std::string& name) {
  if (!case_) return;
  case_->stored = id;
  if (!name.empty()) case_->name = name;  // what its series was called may name somebody
}

// What a person is asked of a file that could be used as it is; the file is then not used yet.
struct Workstation::Asked {
  std::vector<std::string> overlapping;
  bool threshold = false;
  bool any() const { return threshold || !overlapping.empty(); }
};

Result<Case> Workstation::withAnswered(const Case& of, const Opened& opening, Asked& asked,
                                       const Progress& progress) {
  StructureRequest request{opening.answers, true, sourceOf(of)};
  if (const auto share = request.answers.find(kThreshold); share != request.answers.end()) {
    request.threshold = toQt(share->second).toDouble();
  }
  request.ask_threshold = !request.answers.contains(kThreshold);
  Result<StructureFit> fit = importStructures(opening.labels_file, *of.volume, request, progress);
  asked.threshold = !fit && fit.error().code == "THRESHOLD";
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
      [opening = std::move(opening), shown,
       asked](const Progress& all) mutable -> Result<Opened> {
        constexpr double kLoaded = 0.7;  // of the work
        if (opening.load) {
          Result<Stored> stored = opening.load(Progress(all, 0.0, kLoaded));
          if (!stored) return stored.error();
          opening.of = std::move(stored->of);
          opening.tissues = std::move(stored->tissues);
        }
        const Progress progress(all, opening.load ? kLoaded : 0.0, 1.0);
        opening.load = nullptr;
        if (opening.of && !opening.labels_file.empty()) {
          Result<Case> labelled = opening.structures_alone
                                      ? withAnswered(*opening.of, opening, *asked, progress)
                                      : withLabels(*opening.of, opening.labels_file, progress);
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
          if (Result<Scene> other = readScene(file)) {
            (void)readArmDynamics(*other);
            useCase(*other, "");
            opening.scene = *std::move(other);
            opening.scene_file = file;
            opening.same_scene = false;
          }
        }
        Result<Case> placed = opening.of ? placedIn(opening.scene, *opening.of, progress)
                                         : openCase(opening.scene, progress);
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
        static const std::map<std::string, std::string> kQuestions{
            {"HU_NOT_TISSUE", "keep"}, {"MIRRORED", "keep"}, {"OTHER_FRAME", "keep"}};
        if (!outcome && kQuestions.contains(outcome.error().code)) {
          emit structuresAsked(outcome.error(), labels, answers,
                               kQuestions.at(outcome.error().code));
          return;
        }
        opened(std::move(outcome));
      });
}

// What was edited holds on the next case too. Where the scene has other tissues there, it waits for
// a case on which these hold again.
void Workstation::keepEdits(Opened& opened) {
  const LabelMap* labels = opened.of->labels.get();
  const bool same_set = opened.same_scene && scene_->tissues_elsewhere.has_value() ==
                                                 opened.scene.tissues_elsewhere.has_value();
  if (same_set) {
    opened.scene.tissues = scene_->tissues;  // edited while the case was read, perhaps
    for (TissueSet* set : {&opened.scene.tissues, &declared_tissues_}) placeTissues(*set, labels);
    return;
  }
  std::optional<TissueSet> edited;
  if (opened.same_scene && tissuesEdited()) edited = scene_->tissues;
  declared_tissues_ = opened.scene.tissues;
  if (!opened.same_scene) {
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
  if (!outcome) {
    entry_ = entry_before_;
    if (case_) emit placingFailed();
    return fail(outcome.error());
  }
  entry_before_ = entry_;
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
  scene_ = std::move(outcome->scene);
  scene_file_ = std::move(outcome->scene_file);
  in_force_ = scene_->controller;
  case_ = std::move(outcome->of);
  if (structures_alone) {
    emit sceneChanged();
    emit structuresChanged();
    return;
  }
  mirror_ = std::move(outcome->mirror);
  entry_.reset();
  entry_before_.reset();
  carved_.reset();
  tellGivenBack();
  emit sceneChanged();
  emit locksChanged();
  emit caseOpened();
  setPhase(Phase::ready);
  if (outcome->no_labels) fail(*outcome->no_labels);
  if (case_->misfit) fail(*case_->misfit);
}

std::optional<LandmarkFrame> Workstation::viewLandmark() const {
  if (!case_) return {};
  for (const PlacedLandmark& landmark : case_->landmarks) {
    if (scene_ && landmark.id == scene_->view.landmark) return landmark.frame;
  }
  return {};
}

void Workstation::start(const std::filesystem::path& recordings,
                        std::optional<OperatorScript> script, double seconds) {
  if (phase_ != Phase::ready || isOpening()) return;
  setPhase(Phase::starting);
  // The name is the time: nothing of the patient, nothing of the folder.
  const std::string stem =
      QDateTime::currentDateTime().toString("'session'-yyyyMMdd-HHmmss").toStdString();
  carved_.reset();  // its memory is the next one's
  // What was found in tissues that have been edited since lies elsewhere now, or is found now.
  const TissueTable tissues = tissueTable(scene_->tissues);
  const bool again = case_->misfit || !(placed_with_ == tissues);
  running_.run(
      [scene = *scene_, of = *case_, again, recordings, stem, script = std::move(script)](
          const Progress& progress) mutable -> Result<std::unique_ptr<Session>> {
        if (Status made = makeFolder(recordings); !made) return made.error();
        const Result<Case> placed = again ? placedIn(scene, of, progress) : of;
        if (!placed) return placed.error();
        return Session::create(scene, *placed, {freshFile(recordings, stem, ".h5"), script, true});
      },
      [this, seconds, tissues](Result<std::unique_ptr<Session>> created) {
        if (!created) return notStarted(created.error());
        case_->landmarks = (*created)->landmarks();
        case_->misfit.reset();
        placed_with_ = tissues;
        started(*std::move(created), seconds);
      });
}

void Workstation::started(std::unique_ptr<Session> session, double seconds) {
  // What was changed while the session was made is the first thing that it is told.
  Status told = session->setTissues(scene_->tissues);
  if (session->scene().controller != scene_->controller) {
    (void)session->setController(scene_->controller);  // nothing else waits yet
  }
  Status started = told ? session->start(seconds) : told;
  if (!started) return notStarted(started.error());
  session_ = std::move(session);
  recording_failure_.reset();
  setPhase(Phase::running);
  emit sessionStarted();
}

void Workstation::notStarted(const Error& error) {
  setPhase(Phase::ready);
  tellGivenBack();
  emit startFailed();
  fail(error);
}

// What the case that is open leaves to the next, and what need not be taken again.
void Workstation::tellGivenBack() {
  if (!case_) return;
  const std::size_t voxels = case_->volume->geometry.voxelCount();
  import_.setGivenBack(voxelsMb(voxels) * (carved_ ? 2.0 : 1.0) + shownMb(voxels) +
                       (rt::LockedMemory::wasHeld() ? kHeld_mb : 0.0));
}

void Workstation::checkRecording() {
  if (!session() || recording_failure_) return;
  const Status recording = session_->recordingStatus();
  if (recording) return;
  recording_failure_ = recording.error();
  emit recordingFailed(*recording_failure_);
}

void Workstation::stop() {
  if (phase_ != Phase::running) return;
  setPhase(Phase::ending);  // from here to the outcome the session is the background thread's
  running_.run([session = session_.get()](const Progress&) { return session->stop(); },
               [this](Status stopped) {
                 carved_ = session_->carved();
                 tellGivenBack();
                 emit sessionEnded(*session_);
                 emit exerciseReported(session_->report());
                 const std::optional<Error> stuck = session_->leftBehind();
                 session_.reset();
                 noteController(scene_->controller);
                 setPhase(Phase::ready);
                 const bool said = !stopped && recording_failure_ &&
                                   recording_failure_->what == stopped.error().what;
                 if (!stopped && !said) fail(stopped.error());
                 if (stuck) fail(*stuck);
               });
}

void Workstation::setTissues(const TissueSet& tissues) {
  if (!scene_) return;
  if (refuseLocked(Lock::tissues, "The tissues are")) return emit sceneChanged();  // as they were
  scene_->tissues = tissues;
  if (!session()) return;
  if (Status set = session_->setTissues(tissues); !set) fail(set.error());
}

void Workstation::noteController(ControllerKind in_force) {
  if (std::exchange(in_force_, in_force) != in_force) emit controllerChanged();
}

void Workstation::setController(ControllerKind kind) {
  if (!scene_) return;
  if (kind != scene_->controller && refuseLocked(Lock::controller, "The controller is")) {
    return emit controllerChanged();
  }
  scene_->controller = kind;
  if (!session()) noteController(kind);
  if (session() && !session_->setController(kind)) {
    fail({"BUSY", "Too many changes are waiting", "the haptic loop", "Try again"});
  }
}

bool Workstation::tissuesEdited() const {
  return scene_ && !sameSet(scene_->tissues, declared_tissues_);
}

void Workstation::saveTissues(const std::filesystem::path& file, std::function<void()> then) {
  save(
      tr("The tissues are saved. A scene uses them where it names that file under 'tissues'."),
      [text = toJson(unplaced(scene_->tissues)).dump(1) + '\n', file](const Progress&) {
        return writeTextFile(file, text);
      },
      [this, tissues = scene_->tissues, then = std::move(then)] {
        declared_tissues_ = tissues;
        then();
      });
}

void Workstation::saveVolume(const std::filesystem::path& file, std::function<void()> then) {
  if (isSaving()) return fail(busySaving());
  if (phase_ == Phase::starting) {  // the view still shows the cuts before, which are gone
    return fail({"BUSY", "An exercise is being started", "", "Save once it runs, or has ended"});
  }
  if (session_) return saveOnceStill(file, std::move(then));
  save(
      tr("The volume is saved."),
      [carved = carved_, whole = case_->volume, file](const Progress& progress) {
        return writeVolume(carved ? slabsOf(*carved) : slabsOf(*whole), file, progress);
      },
      std::move(then));
}

// The grid is read where its writer stands still: in a pause, or once the exercise has ended.
void Workstation::saveOnceStill(const std::filesystem::path& file, std::function<void()> then) {
  save_waits_ = false;
  if (!session_) return saveVolume(file, std::move(then));
  if (phase_ == Phase::ending || !session_->freeze()) {
    save_waits_ = true;
    QTimer::singleShot(kLookAgain_ms, this,
                       [this, file, then = std::move(then)] { saveOnceStill(file, then); });
    return;
  }
  save(
      tr("The volume is saved."),
      [grid = session_->carved(), file](const Progress& progress) {
        return writeVolume(slabsOf(*grid), file, progress);
      },
      std::move(then),
      [this] {
        if (session()) session_->thaw();
      });
}

void Workstation::save(const QString& what, std::function<Status(const Progress&)> write,
                       std::function<void()> then, std::function<void()> afterwards) {
  const bool begun = !save_waits_ && saving_.run(std::move(write), [=, this](Status status) {
    if (afterwards) afterwards();
    if (!status) return fail(status.error());
    emit saved(what);
    if (then) then();
  });
  if (!begun) fail(busySaving());
}

}  // namespace trephine
