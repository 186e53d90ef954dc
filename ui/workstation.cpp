#include "ui/workstation.h"

#include <QDateTime>

#include "base/file.h"
#include "base/system.h"
#include "session/case_source.h"
#include "ui/words.h"

namespace trephine {

struct Workstation::Opened {
  Scene scene;
  std::filesystem::path scene_file;
  std::shared_ptr<const Volume> volume;
  std::vector<PlacedLandmark> landmarks;
  std::optional<Error> misfit;  // the case has not what the scene looks for
  bool own_case = false;
};

namespace {

constexpr double kVolumeShare = 0.9;  // of the work of opening; the rest is finding landmarks

// Places the landmarks of `scene`; a case without them can be looked at all the same.
template <class Opened>
void place(Opened& opened, const Progress& progress) {
  progress.at(kVolumeShare, "Finding landmarks");
  if (auto placed = placeLandmarks(opened.scene, *opened.volume)) {
    opened.landmarks = *std::move(placed);
  } else {
    opened.misfit = placed.error();
  }
}

}  // namespace

std::filesystem::path defaultScene(const std::string& anatomy) {
  return resourceFolder() / "scenes" / (anatomy == "abdomen" ? "liver.json" : "cranium.json");
}

Workstation::Workstation(QObject* parent) : QObject(parent) {
  connect(&opening_, &BackgroundTask::progressed, this, &Workstation::openingProgressed);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::openingEnded);
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

void Workstation::openPath(const std::filesystem::path& path) {
  if (!mayOpen()) return;
  if (path.extension() == ".json") {
    std::optional<Scene> scene = readSceneOrFail(path);
    if (!scene) return;
    const std::string source = scene->case_source;
    openSource(*std::move(scene), path, source);
    return;
  }
  std::error_code ec;
  const std::string name = path.filename().string();
  for (const char* ending : {".mha", ".mhd", ".nii", ".nii.gz"}) {
    if (!name.ends_with(ending) || std::filesystem::is_directory(path, ec)) continue;
    const std::filesystem::path file = scene_ ? scene_file_ : defaultScene("cranium");
    std::optional<Scene> scene = readSceneOrFail(file);
    if (scene) openSource(*std::move(scene), file, path.string());
    return;
  }
  openFolder(path);
}

void Workstation::openPhantom(const std::string& name) {
  if (!mayOpen()) return;
  const bool fits = scene_ && scene_->anatomy == name;
  const std::filesystem::path file = fits ? scene_file_ : defaultScene(name);
  std::optional<Scene> scene = readSceneOrFail(file);
  if (scene) openSource(*std::move(scene), file, "phantom:" + name);
}

void Workstation::useScene(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (volume_ && (own_case_ || scene->case_source.empty())) {
    opening_.run(
        [scene = *scene, file, volume = volume_,
         own = own_case_](const Progress& progress) -> Result<Opened> {
          Opened out{scene, file, volume, {}, {}, own};
          place(out, progress);
          return out;
        },
        [this](Result<Opened> outcome) { opened(std::move(outcome)); });
  } else {
    const std::string source = scene->case_source;
    openSource(*std::move(scene), file, source);
  }
}

void Workstation::openSource(Scene scene, const std::filesystem::path& scene_file,
                             const std::string& source) {
  if (source.empty()) {  // the scene waits for a case of the user's
    scene_ = std::move(scene);
    scene_file_ = scene_file;
    emit sceneChanged();
    return;
  }
  opening_.run(
      [scene = std::move(scene), scene_file, source](const Progress& progress) -> Result<Opened> {
        Result<Volume> volume = openCase(source, progress);
        if (!volume) return volume.error();
        Opened out{scene, scene_file, std::make_shared<const Volume>(*std::move(volume)),
                   {},    {},         !isPhantom(source)};
        place(out, progress);
        return out;
      },
      [this](Result<Opened> outcome) { opened(std::move(outcome)); });
}

void Workstation::openFolder(const std::filesystem::path& folder) {
  opening_.run([folder](const Progress& progress) { return CtFolder::scan(folder, progress); },
               [this](Result<CtFolder> scanned) {
                 if (!scanned) return fail(scanned.error());
                 folder_ = std::make_shared<CtFolder>(*std::move(scanned));
                 emit seriesFound(folder_->report());
                 const std::optional<std::string> best = folder_->bestSeries();
                 if (best) {
                   openSeries(*best);
                 } else {
                   fail(folder_->report().error.value_or(
                       Error{"ALL_REFUSED", "No series in the folder can be used", "the folder",
                             "The list of series says why for each"}));
                 }
               });
}

void Workstation::openSeries(const std::string& uid) {
  if (!folder_ || !mayOpen()) return;
  const std::filesystem::path file = scene_ ? scene_file_ : defaultScene("cranium");
  std::optional<Scene> scene = readSceneOrFail(file);
  if (!scene) return;
  if (scene_) scene->tissues = scene_->tissues;
  emit seriesChosen(toQt(uid));
  opening_.run(
      [folder = folder_, uid, scene = *std::move(scene),
       file](const Progress& progress) -> Result<Opened> {
        Result<Volume> volume = folder->read(uid, {}, progress);
        if (!volume) return volume.error();
        Opened out{scene, file, std::make_shared<const Volume>(*std::move(volume)), {}, {}, true};
        place(out, progress);
        return out;
      },
      [this](Result<Opened> outcome) {
        emit seriesFound(folder_->report());
        opened(std::move(outcome));
      });
}

void Workstation::opened(Result<Opened> outcome) {
  if (!outcome) return fail(outcome.error());
  scene_ = std::move(outcome->scene);
  scene_file_ = std::move(outcome->scene_file);
  volume_ = std::move(outcome->volume);
  landmarks_ = std::move(outcome->landmarks);
  own_case_ = outcome->own_case;
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
      [scene = *scene_, volume = volume_, recordings, stem,
       script = std::move(script)](const Progress&) -> Result<std::unique_ptr<Session>> {
        if (Status made = makeFolder(recordings); !made) return made.error();
        SessionOptions options{freshFile(recordings, stem, ".h5"), script};
        return Session::create(scene, Volume(*volume), options);
      },
      [this, seconds](Result<std::unique_ptr<Session>> created) {
        if (!created) {
          setPhase(Phase::ready);
          return fail(created.error());
        }
        session_ = *std::move(created);
        if (Status started = session_->start(seconds); !started) {
          session_.reset();
          setPhase(Phase::ready);
          return fail(started.error());
        }
        setPhase(Phase::running);
        emit sessionStarted();
      });
}

void Workstation::stop() {
  if (phase_ != Phase::running) return;
  setPhase(Phase::ending);  // from here to the outcome the session is the background thread's
  running_.run([session = session_.get()](const Progress&) { return session->stop(); },
               [this](Status stopped) {
                 emit sessionEnded(*session_);
                 session_.reset();
                 setPhase(Phase::ready);
                 if (!stopped) fail(stopped.error());
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

void Workstation::save(const QString& what, std::function<Status()> write) {
  const bool begun = saving_.run([write = std::move(write)](const Progress&) { return write(); },
                                 [this, what](Status status) {
                                   if (status) {
                                     emit saved(what);
                                   } else {
                                     fail(status.error());
                                   }
                                 });
  if (!begun) fail({"BUSY", "Another file is being saved", "", "Try again in a moment"});
}

}  // namespace trephine
