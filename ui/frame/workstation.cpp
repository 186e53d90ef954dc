#include "ui/frame/workstation.h"

#include <QDateTime>

#include "base/file.h"
#include "base/system.h"
#include "session/case_source.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "volume/volume_files.h"

namespace trephine {

struct Workstation::Opened {
  Scene scene;
  std::filesystem::path scene_file;
  std::shared_ptr<const Volume> volume;
  std::vector<PlacedLandmark> landmarks;
  std::optional<Error> misfit;  // the case has not what the scene looks for
  bool own_case = false;
  QString case_name;
  std::shared_ptr<const LabelMap> labels{};
  bool same_scene = false;  // its tissues stay as they are edited
};

namespace {

constexpr double kVolumeShare = 0.9;  // of the work of opening; the rest is finding landmarks

// Reads the label map that `scene` names, unless there is one, and places the landmarks; a case
// without them can be looked at all the same. Error: CANCELLED.
template <class Opened>
Status place(Opened& opened, const Progress& progress) {
  progress.at(kVolumeShare, "Finding landmarks");
  if (!opened.labels) {
    auto labels = openLabels(opened.scene.labels_file, opened.volume->geometry);
    if (!labels) {
      opened.misfit = labels.error();
      return {};
    }
    opened.labels = *std::move(labels);
  }
  const Progress finding(progress, kVolumeShare, 1.0);
  auto placed = placeLandmarks(opened.scene, *opened.volume, opened.labels.get(), finding);
  if (placed) {
    opened.landmarks = *std::move(placed);
  } else if (placed.error().code == "CANCELLED") {
    return placed.error();
  } else {
    opened.misfit = placed.error();
  }
  return {};
}

}  // namespace

std::filesystem::path defaultScene(const std::string& anatomy) {
  return resourceFolder() / "scenes" / (anatomy == "abdomen" ? "liver.json" : "cranium.json");
}

Workstation::Workstation(QObject* parent) : QObject(parent) {
  connect(&opening_, &BackgroundTask::progressed, this, &Workstation::openingProgressed);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::openingEnded);
  connect(&opening_, &BackgroundTask::began, this, &Workstation::phaseChanged);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::phaseChanged);
  connect(&import_, &ImportTask::failed, this, &Workstation::failed);
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
  // An arm that is not there now may be when the exercise starts, which then asks again.
  (void)readArmDynamics(*scene);
  return *std::move(scene);
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
  if (scene && fits) scene->tissues = scene_->tissues;
  if (scene) openSource(*std::move(scene), file, "phantom:" + name, fits);
}

void Workstation::useScene(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (volume_ && (own_case_ || scene->case_source.empty())) {
    placeAndOpen({*std::move(scene), file, volume_, {}, {}, own_case_, case_name_, labels_});
  } else {
    const std::string source = scene->case_source;
    openSource(*std::move(scene), file, source);
  }
}

void Workstation::useLabels(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  if (!volume_) {
    fail({"NO_CASE", "There is no case that a label map could belong to", "",
          "Open the case first, then its label map"});
    return;
  }
  opening_.run(
      [scene = *scene_, scene_file = scene_file_, volume = volume_, own = own_case_,
       name = case_name_, file](const Progress& progress) -> Result<Opened> {
        auto labels = openLabels(file.string(), volume->geometry);
        if (!labels) return labels.error();
        Opened out{scene, scene_file, volume, {}, {}, own, name, *std::move(labels), true};
        if (Status status = place(out, progress); !status) return status.error();
        return out;
      },
      [this](Result<Opened> outcome) { opened(std::move(outcome)); });
}

void Workstation::openSource(Scene scene, const std::filesystem::path& scene_file,
                             const std::string& source, bool same_scene) {
  if (source.empty()) {  // the scene waits for a case of the user's
    scene_ = std::move(scene);
    scene_file_ = scene_file;
    declared_tissues_ = scene_->tissues;
    emit sceneChanged();
    return;
  }
  if (!scene.case_source.empty() && source != scene.case_source) scene.labels_file.clear();
  if (!same_scene) emit sceneOpening(scene, scene_file);
  opening_.run(
      [scene = std::move(scene), scene_file, source,
       same_scene](const Progress& progress) -> Result<Opened> {
        Result<Volume> volume = openCase(source, progress);
        if (!volume) return volume.error();
        Opened out{scene, scene_file, std::make_shared<const Volume>(*std::move(volume)),
                   {},    {},         !isPhantom(source),
                   {},    {},         same_scene};
        if (Status status = place(out, progress); !status) return status.error();
        return out;
      },
      [this](Result<Opened> outcome) { opened(std::move(outcome)); });
}

void Workstation::openVolume(const std::shared_ptr<const Volume>& volume, const QString& name) {
  if (!mayOpen()) return;
  const std::filesystem::path file = scene_ ? scene_file_ : defaultScene("cranium");
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (scene_) scene->tissues = scene_->tissues;
  if (!scene->case_source.empty()) scene->labels_file.clear();  // of another case
  placeAndOpen({*std::move(scene), file, volume, {}, {}, true, name, {}, scene_.has_value()});
}

void Workstation::placeAndOpen(Opened opening) {
  if (!opening.same_scene) emit sceneOpening(opening.scene, opening.scene_file);
  opening_.run(
      [opening = std::move(opening)](const Progress& progress) mutable -> Result<Opened> {
        if (Status status = place(opening, progress); !status) return status.error();
        return std::move(opening);
      },
      [this](Result<Opened> outcome) { opened(std::move(outcome)); });
}

void Workstation::opened(Result<Opened> outcome) {
  if (!outcome) return fail(outcome.error());
  if (outcome->same_scene) {
    outcome->scene.tissues = scene_->tissues;  // edited while the case was read, perhaps
  } else {
    declared_tissues_ = outcome->scene.tissues;
  }
  scene_ = std::move(outcome->scene);
  scene_file_ = std::move(outcome->scene_file);
  volume_ = std::move(outcome->volume);
  landmarks_ = std::move(outcome->landmarks);
  own_case_ = outcome->own_case;
  case_name_ = std::move(outcome->case_name);
  labels_ = std::move(outcome->labels);
  emit sceneChanged();
  emit caseOpened();
  setPhase(Phase::ready);
  if (outcome->misfit) fail(*outcome->misfit);
}

std::optional<LandmarkFrame> Workstation::viewLandmark() const {
  for (const PlacedLandmark& landmark : landmarks_) {
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
  running_.run(
      [scene = *scene_, volume = volume_, labels = labels_, recordings, stem,
       script = std::move(script)](const Progress& progress) -> Result<std::unique_ptr<Session>> {
        if (Status made = makeFolder(recordings); !made) return made.error();
        SessionOptions options{freshFile(recordings, stem, ".h5"), script, labels, true};
        return Session::create(scene, Volume(*volume), options, progress);
      },
      [this, seconds](Result<std::unique_ptr<Session>> created) {
        if (!created) {
          setPhase(Phase::ready);
          return fail(created.error());
        }
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
  if (!started) {
    setPhase(Phase::ready);
    return fail(started.error());
  }
  session_ = std::move(session);
  recording_failure_.reset();
  setPhase(Phase::running);
  emit sessionStarted();
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
                 emit sessionEnded(*session_);
                 const std::optional<Error> stuck = session_->leftBehind();
                 session_.reset();
                 setPhase(Phase::ready);
                 const bool said = !stopped && recording_failure_ &&
                                   recording_failure_->what == stopped.error().what;
                 if (!stopped && !said) fail(stopped.error());
                 if (stuck) fail(*stuck);
               });
}

void Workstation::setTissues(const TissueSet& tissues) {
  if (!scene_) return;
  scene_->tissues = tissues;
  if (!session()) return;
  if (Status set = session_->setTissues(tissues); !set) fail(set.error());
}

void Workstation::setController(ControllerKind kind) {
  if (!scene_) return;
  scene_->controller = kind;
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
      [text = toJson(scene_->tissues).dump(1) + '\n', file] { return writeTextFile(file, text); },
      [this, tissues = scene_->tissues, then = std::move(then)] {
        declared_tissues_ = tissues;
        then();
      });
}

void Workstation::save(const QString& what, std::function<Status()> write,
                       std::function<void()> then) {
  const bool begun = saving_.run([write = std::move(write)](const Progress&) { return write(); },
                                 [this, what, then = std::move(then)](Status status) {
                                   if (!status) return fail(status.error());
                                   emit saved(what);
                                   if (then) then();
                                 });
  if (!begun) fail({"BUSY", "Another file is being saved", "", "Try again in a moment"});
}

}  // namespace trephine
