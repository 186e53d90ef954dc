// What the window works on: the case that is open, the scene, and the exercise that runs. No
// widget. Long work (scan, read, place landmarks, start, stop, save) goes to background threads;
// every method is called, and every signal sent, on the window's thread.
#pragma once

#include <QObject>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "scene/arms_file.h"
#include "scene/policy.h"
#include "scene/scene_edits.h"
#include "session/session.h"
#include "ui/common/background_task.h"
#include "ui/work/arms_of_place.h"
#include "ui/work/import_task.h"

namespace trephine {

class Workstation : public QObject {
  Q_OBJECT
 public:
  static constexpr const char* kThreshold = "THRESHOLD";  // an answer of useLabels()
  enum class Phase { empty, ready, starting, running, ending };

  // What the workstation locks for who practises at it.
  explicit Workstation(const Policy& policy = {}, QObject* parent = nullptr);
  ~Workstation() override;

  // A scene (.json, unless it is the sidecar of a .raw) brings its own case; any other folder or
  // file is scanned for import().
  void openPath(const std::filesystem::path& path);
  // Whether openPath() takes it for a scene.
  static bool isScene(const std::filesystem::path& path);
  // One of the built-in cases, with the scene in use where that fits the anatomy.
  void openPhantom(const std::string& name);
  bool sceneFits(const std::string& anatomy) const { return scene_ && scene_->anatomy == anatomy; }
  // What an import has read, with the label map of this file where there is one. A label map that
  // cannot be had is said; the case opens without it.
  void openImported(const Case& read, const std::filesystem::path& labels = {});
  // One that the library has: `load` runs in the background. Its own tissues are used where the
  // exercise has the same ones. The exercise changes where it is for another region of the body.
  struct Stored {
    Case of;
    std::optional<TissueSet> tissues;
    std::optional<Error> no_tissues{}, no_structures{};  // why none: said once it is open
  };
  void openStored(std::function<Result<Stored>(const Progress&)> load);
  // An exercise with the case of the library that it was made on.
  void openExercise(const std::filesystem::path& scene,
                    std::function<Result<Stored>(const Progress&)> load);
  // The library has the open case now, as that id and under that name, or no longer.
  void setStored(const std::string& id, const std::string& name = {});
  // Another exercise: a case of the user's own stays open, a built-in one changes with the scene.
  void useScene(const std::filesystem::path& file);
  // The structures of the open case from a file; what a person has to decide comes as
  // structuresAsked(), overlapAsked() or thresholdAsked(), to be called again with the answer.
  // Another case has none until they are given.
  void useLabels(const std::filesystem::path& file, const Answers& answers = {});
  // Structures that were made or changed here, on the case's grid: the scene is placed in them.
  // False: not now (something is being opened or runs).
  bool useStructures(const std::shared_ptr<const LabelMap>& structures);
  // Where the exercise enters: at a place that was clicked, from the direction `outward`, or, for
  // nothing, where the scene's file says. An edit, for this case in this exercise. False: not now.
  bool placeEntry(const std::optional<Landmark>& entry);
  // Null: where the file says.
  const Landmark* entry() const;
  // While that is being done: the case itself stays as it is.
  bool isPlacing() const { return placing_; }
  void cancelOpening() { opening_.cancel(); }
  void cancelSaving() { saving_.cancel(); }
  bool isOpening() const { return opening_.busy(); }
  ImportTask& import() { return import_; }

  // What may not be changed now: by the workstation or by the exercise, until an educator's PIN
  // takes the locks off, for this session of the program or until they are put on again. What is
  // locked and tried all the same is refused here: LOCKED.
  const Policy& policy() const { return policy_; }
  bool isLocked(Lock lock) const;
  bool anyLocked() const;
  bool isUnlocked() const { return unlocked_; }
  // Locked again, what is locked is as it is prescribed, or as the exercise brings it.
  void setUnlocked(bool unlocked);
  // Edited, and taken back when it is locked again.
  bool tissuesWouldGo() const;
  // Whether this scene of this file may be opened now: checkScene().
  Status mayPractise(const Scene& scene, const std::filesystem::path& file) const {
    return unlocked_ ? Status() : checkScene(policy_, scene, file);
  }

  // From the next exercise on these devices move its arms, and the settings say nothing of them:
  // for an exercise that nobody watches.
  void setArms(std::vector<NamedDevice> arms) { arms_ = std::move(arms); }
  // From the next exercise on its time is what its owner makes of it (Session::advance): a test's.
  void setStepped(bool stepped) { stepped_ = stepped; }
  // Somebody else has the arms of this place: they are not asked for. Back again, what they can
  // show is asked in the background, as another may have been chosen.
  void lendArms(bool lent);
  // Held while arms are opened.
  const std::shared_ptr<std::timed_mutex>& opensArms() const { return opens_arms_; }
  // What moves the arms of scene() here, as far as it has been asked.
  const Rig& rig() const { return rig_; }
  // How far each arm of scene() reaches, device axes, mm; empty where an arm is not there.
  const std::vector<Vec3>& workspaces_mm() const { return workspaces_mm_; }

  Phase phase() const { return phase_; }
  // The exercise as it is made, whatever the case.
  const std::optional<Scene>& scene() const { return scene_; }
  const std::filesystem::path& sceneFile() const { return scene_file_; }
  // The exercise on the case that is open; empty: none is.
  const std::optional<Placement>& placed() const { return placed_; }
  const Case* currentCase() const { return placed_ ? &placed_->patient : nullptr; }
  // A copy of its voxels for the view, made in the background; empty once it was taken, or where
  // the view has one already.
  Volume takeMirror() { return std::exchange(mirror_, {}); }
  // Where the scene wants to be looked at, when the case has that landmark.
  std::optional<LandmarkFrame> viewLandmark() const;

  // Starts from the case as it was opened. `script` moves the hands until the mouse does; after
  // `seconds` the session is finished() and waits for stop().
  void start(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
             double seconds);
  // Without a recording, and nothing is cut: to feel what was set. Else a session as any.
  void poke();
  bool isPoke() const { return session_ && session_->isPoke(); }
  void stop();
  // Emits recordingFailed() when the running exercise can no longer be recorded. The window asks
  // with every picture.
  void checkRecording();
  // Only while the phase is running.
  Session* session() const { return phase_ == Phase::running ? session_.get() : nullptr; }
  // --- Edits of the exercise by a person (workstation_edits.cpp) ---

  // The scene is as `wanted` from now on, for the next exercise and, of tissues and controller, for
  // the one that runs or is being started; what else differs waits for its end. It stays as long as
  // the scene does, whatever the case. `what`: edits of the same that follow one another are one
  // step of edits() until closeEdit(). Errors, and nothing has changed: LOCKED, BUSY (what waits
  // for the end of an exercise), those of checkEdited().
  Status edit(const Scene& wanted, const std::string& what);
  // One change of the scene as it is now, as a step of its own.
  Status edit(const std::string& what, const std::function<void(Scene&)>& change);
  void closeEdit() { history_.close(); }
  // The same for the tissues alone, and what is refused is said; another set than the landmarks
  // know is withTissues().
  void setTissues(const TissueSet& tissues, const std::string& what = "tissues");
  const SceneHistory& edits() const { return history_; }
  void undoEdit();
  void redoEdit();
  // Whether anything but the controller and the tissues in force is another than the exercise was
  // opened with, or saved as.
  bool sceneEdited() const;
  // The case lacks a structure that is needed: the exercise runs on its set for such cases.
  bool isElsewhere() const { return placed_ && placed_->elsewhere; }
  // The set of scene() that is in force on the open case; and with the labels of its structures.
  const TissueSet& tissues() const { return tissuesOf(*scene_); }
  const TissueSet& placedTissues() const { return placed_ ? placed_->scene.tissues : tissues(); }
  // scene() with this set in its place (scene_edits.h).
  NewTissues withTissues(const TissueSet& set) const;
  // How tissues look: the scene's until a person chooses. Of the view alone, so neither the scene
  // nor a recording changes with it.
  void setLooks(const TissueLooks& looks) { looks_ = looks; }
  const TissueLooks& looks() const { return looks_; }
  void setController(ControllerKind kind);
  // What the arms are controlled by now: the scene's, or what the running exercise has made of it.
  ControllerKind controllerInForce() const { return in_force_; }
  void noteController(ControllerKind in_force);
  // The tissues as the scene's file has them, or as they were saved last; and whether they have
  // been edited since.
  const TissueSet& declaredTissues() const { return tissuesOf(opened_scene_); }
  bool tissuesEdited() const { return scene_ && tissues() != declaredTissues(); }
  // They are these on disk now.
  void tissuesSaved(const TissueSet& as) { tissuesOf(opened_scene_) = as; }
  // The exercise is on disk now as this scene: that is what it is opened with from here on.
  void exerciseSaved(const std::filesystem::path& scene);
  // As a file that scenes can name; `then` follows once it is written.
  void saveTissues(const std::filesystem::path& file, std::function<void()> then);

  // The voxels as they are now: of the running exercise, which pauses for it, of the one that ended
  // last, or of the case. Says so in saved().
  void saveVolume(const std::filesystem::path& file, std::function<void()> then = {});
  // What the exercise that ended last cut; null: the case is whole. makeWhole() lets
  // go of it.
  const std::shared_ptr<const Grid>& carved() const { return carved_; }
  void makeWhole() { carved_.reset(); }

  // Runs `write` in the background; `what` names the outcome in saved(). `then` follows where it
  // was written, `afterwards` in any case.
  void save(const QString& what, std::function<Status(const Progress&)> write,
            std::function<void()> then = {}, std::function<void()> afterwards = {});
  bool isWriting() const { return saving_.busy(); }
  // Or waits until the exercise stands still.
  bool isSaving() const { return saving_.busy() || save_waits_; }

 signals:
  void openingProgressed(double fraction, const QString& step);
  void openingEnded();
  // Another scene is being opened; scene() is still the one before.
  void sceneOpening(const trephine::Scene& scene, const std::filesystem::path& file);
  void sceneChanged();
  void caseOpened();
  // The library has it under another name.
  void caseNamed();
  // The case that is open has other structures, from a file or made here; sceneChanged() came
  // before.
  void structuresChanged();
  // It stays as it was; failed() says why.
  void placingFailed();
  // The file was not used: its `error` names a choice, whose options that use it are `options`, at
  // least one.
  void structuresAsked(const trephine::Error& error, const std::filesystem::path& file,
                       const trephine::Answers& answers, const std::vector<std::string>& options);
  // Structures of the file share voxels: `names`, in the order that would be taken; the answer is
  // OVERLAP.
  void overlapAsked(const std::vector<std::string>& names, const std::filesystem::path& file,
                    const trephine::Answers& answers);
  // The file has shares instead of yes and no; the answer is kThreshold, a number from 0 to 1.
  void thresholdAsked(const std::filesystem::path& file, const trephine::Answers& answers);
  void locksChanged();
  void phaseChanged();  // or isOpening()
  void sessionStarted();
  // Once an exercise, which goes on; stop() does not say it again.
  void recordingFailed(const trephine::Error& error);
  // The exercise's last state; `session` goes away after it.
  void sessionEnded(trephine::Session& session);
  // What the view shows of an exercise before is gone; failed() says why none runs.
  void startFailed();
  // After sessionEnded(), what it came to; not of a poke.
  void exerciseReported(const trephine::RunReport& report);
  void controllerChanged();  // controllerInForce()
  void editsChanged();       // edits()
  void armsAnswered();       // what the arms of scene() can show is another
  void savingProgressed(double fraction, const QString& step);
  void savingEnded();
  void saved(const QString& what);
  void failed(const trephine::Error& error);

 private:
  struct Opened;
  struct Asked;
  const TissueSet& tissuesOf(const Scene& scene) const {
    return isElsewhere() && scene.tissues_elsewhere ? *scene.tissues_elsewhere : scene.tissues;
  }
  TissueSet& tissuesOf(Scene& scene) const {
    return const_cast<TissueSet&>(tissuesOf(std::as_const(scene)));
  }
  void refreshPlaced();
  Scene withLiveOf(Scene scene, const Scene& other) const;
  static Result<Case> withAnswered(const Case& of, const Opened& opening, Asked& asked,
                                   const Progress& progress);
  bool mayOpen();
  std::optional<Opened> openingOf();
  // `policy`: null where nothing is locked any more. Any thread.
  static Result<Scene> allowedScene(const std::filesystem::path& file, const Policy* policy);
  std::optional<Scene> readSceneOrFail(const std::filesystem::path& file);
  void openSource(Scene scene, const std::filesystem::path& scene_file, const std::string& source,
                  bool same_scene = false);
  void placeAgain(const std::shared_ptr<const LabelMap>& structures);
  void openInBackground(Opened opening);
  Scene forAnotherCase(Scene scene) const;
  void opened(Result<Opened> outcome);
  void begin(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
             double seconds, bool poke);
  void startArms(std::unique_ptr<Session> session, double seconds);
  Status tell(Session& session, ControllerKind& told_of) const;
  void started(std::unique_ptr<Session> session);
  void readArms();
  void askArms();
  void notStarted(const Error& error);
  void tellGivenBack();
  void saveOnceStill(const std::filesystem::path& file, std::function<void()> then);
  void setPhase(Phase phase);
  void fail(const Error& error);

  Status mayEdit(const Scene& wanted) const;
  bool take(Scene wanted);
  bool mayGoTo(const Scene* step);
  void goTo(Scene scene);
  void placeEdited();
  bool isEntry(const Landmark& landmark) const;

  void takeBack();
  void tellTissues();
  void applyController(ControllerKind kind);
  bool refuseLocked(Lock lock, const char* what);
  Status notLocked(Lock lock, const char* what) const;

  Policy policy_;
  std::optional<std::vector<NamedDevice>> arms_;
  Rig rig_;
  std::vector<Vec3> workspaces_mm_;
  bool unlocked_ = false;
  Phase phase_ = Phase::empty;
  std::optional<Scene> scene_;
  std::filesystem::path scene_file_;
  ControllerKind in_force_ = ControllerKind::bounded;
  Scene opened_scene_;  // as it was opened, or saved
  SceneHistory history_;
  TissueLooks looks_;
  std::optional<Placement> placed_;
  TissueTable placed_with_{};  // its landmarks were found in
  Volume mirror_;
  std::unique_ptr<Session> session_;
  std::shared_ptr<const Grid> carved_;
  std::optional<Error> recording_failure_;  // said of this exercise
  bool save_waits_ = false;                 // until the haptic thread stands still
  bool scene_chosen_ = false;               // by a person
  bool placing_ = false;                    // structures alone are being opened
  bool place_again_ = false;                // an edit waits for that
  bool placing_edit_ = false;               // and goes back where that fails
  bool ask_again_ = false;                  // once the arms have answered
  bool lent_ = false;                       // the arms are
  bool stepped_ = false;
  // An arm is opened by one at a time.
  const std::shared_ptr<std::timed_mutex> opens_arms_ = std::make_shared<std::timed_mutex>();
  // Last, so that they are joined before what they work on goes.
  ImportTask import_;
  BackgroundTask opening_, running_, saving_, asking_;
};

// The scene that fits a case of this anatomy, among the product's own.
std::filesystem::path defaultScene(const std::string& anatomy);

}  // namespace trephine
