// What a person works on at this workstation: the case and the exercise that are open, the exercise
// that runs, and everything that can be done with them. No window and no event loop; programs with
// one and without work on the same desk.
//
// A desk belongs to one thread, its owner's. Long work (reading, placing, starting, stopping,
// saving) goes on elsewhere; take() brings its outcome. What happens is said to DeskEvents, on the
// owner's thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/job.h"
#include "case/placement.h"
#include "desk/arms_here.h"
#include "desk/desk_events.h"
#include "desk/opening.h"
#include "exercise/arms_file.h"
#include "exercise/exercise_edits.h"
#include "exercise/policy.h"
#include "session/session.h"

namespace trephine {

class Desk {
 public:
  // empty: no case is open, perhaps an exercise that waits for one.
  enum class Phase { empty, ready, starting, running, ending };

  // `policy`: what the workstation locks. `settings`: what it says of arms, asked on the owner's
  // thread whenever that is needed. `wake`: take() has something to do; called on any thread, it
  // returns at once.
  Desk(const Policy& policy, DeskEvents& events, std::function<ArmSettings()> settings,
       std::function<void()> wake);
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  // What came of long work since the last call.
  void take();
  // Something waits for the haptic thread, which wakes nobody: take() is to be called every 10 ms.
  bool waits() const { return waiting_save_.has_value(); }

  // --- Opening (desk_opening.cpp). While another case is being opened, or an exercise runs: BUSY.

  // Whether a path is an exercise: a .json that is no sidecar of a .raw.
  static bool isExercise(const std::filesystem::path& path);
  // An exercise with the case that it names.
  void openExercise(const std::filesystem::path& file);
  // An exercise with the case of the library that it was made on.
  void openExercise(const std::filesystem::path& file, LoadCase load);
  // One of the built-in cases, with the exercise in use where that fits the anatomy.
  void openPhantom(const std::string& name);
  // What an import has read, with the label map of this file where there is one. A label map that
  // cannot be had is said; the case opens without it.
  void openImported(const Case& read, const std::filesystem::path& labels = {});
  // One that the library has: `load` runs in the background. Its own tissues are used where the
  // exercise has the same ones. The exercise changes where it is for another region of the body.
  void openStored(LoadCase load);
  // The library has the open case now, as that id and under that name, or no longer.
  void setStored(const std::string& id, const std::string& name = {});
  // Another exercise: a case of the user's own stays open, a built-in one changes with it.
  void useExercise(const std::filesystem::path& file);
  // The structures of the open case from a file. What a person has to decide comes as
  // DeskEvents::onQuestion(); until it is answered, the case stays as it is.
  void useLabels(const std::filesystem::path& file, const Answers& answers = {});
  // The option of the question that was asked last, or the words that its kind takes. The file is
  // not read again. Where nothing is asked any more: NOT_ASKED.
  void answer(const std::string& option);
  // Nobody answers.
  void dropQuestion() { question_.reset(); }
  // Structures that were made or changed here, on the case's grid: the exercise is placed in them.
  // False: not now (something is being opened or runs).
  bool useStructures(const std::shared_ptr<const LabelMap>& structures);
  // A person has opened or chosen the exercise; else it came with a case.
  bool exerciseChosen() const { return exercise_chosen_; }
  bool exerciseFits(const std::string& anatomy) const {
    return exercise_ && exercise_->anatomy == anatomy;
  }
  // False, and said, where nothing can be opened now.
  bool mayOpen();
  bool isOpening() const { return std::holds_alternative<Opening>(activity_); }
  // While structures that were made here are being placed: the case itself stays as it is.
  bool isPlacing() const { return isOpening() && std::get<Opening>(activity_).placing; }
  // Not structures or places alone, of the open one.
  bool opensAnotherCase() const {
    return isOpening() && !std::get<Opening>(activity_).structures_alone;
  }
  void cancelOpening() { opening_.cancel(); }

  // --- What may not be changed (desk_edits.cpp): by the workstation always, by the exercise as it
  // was saved while a person practises, until an educator's PIN takes the locks off, for this
  // session of the program or until they are put on again. What is locked and tried all the same is
  // refused here: LOCKED.

  const Policy& policy() const { return policy_; }
  bool isLocked(Lock lock) const;
  bool anyLocked() const;
  // Whether the exercise is practised (at first it is) or prepared, by who made it or who makes
  // another of it. What it keeps is not practised with another value than the saved one: LOCKED.
  void setPractising(bool practising);
  bool isUnlocked() const { return unlocked_; }
  // Locked again, what is locked is as it is prescribed, or as the exercise brings it: what the
  // exercise keeps, where it is practised.
  void setUnlocked(bool unlocked);
  // Edited, and taken back when it is locked again.
  bool tissuesWouldGo() const;
  // Whether this exercise of this file may be opened now: checkExercise().
  Status mayPractise(const Exercise& exercise, const std::filesystem::path& file) const {
    return unlocked_ ? Status() : checkExercise(policy_, exercise, file);
  }

  // --- Arms.

  // From the next exercise on these devices move its arms, and the settings say nothing of them:
  // for an exercise that nobody watches.
  void setArms(std::vector<NamedDevice> arms) { arms_ = std::move(arms); }
  // From the next exercise on its time is what its owner makes of it (Session::advance): a test's.
  void setStepped(bool stepped) { stepped_ = stepped; }
  // Somebody else has the arms of this workstation: they are not asked for. Back again, what they
  // can show is asked in the background, as another may have been chosen.
  void lendArms(bool lent);
  // Held while arms are opened.
  const std::shared_ptr<std::timed_mutex>& opensArms() const { return arms_here_.opens(); }
  // What moves the arms of exercise() here, as far as it has been asked.
  const Rig& rig() const { return arms_here_.rig(); }
  // How far each arm of exercise() reaches, device axes, mm; empty where an arm is not there.
  const std::vector<Vec3>& workspaces_mm() const { return arms_here_.workspaces_mm(); }

  // --- What is open.

  Phase phase() const;
  // The exercise as it is made, whatever the case.
  const std::optional<Exercise>& exercise() const { return exercise_; }
  const std::filesystem::path& exerciseFile() const { return exercise_file_; }
  // The exercise on the case that is open; empty: none is.
  const std::optional<Placement>& placed() const { return placed_; }
  const Case* currentCase() const { return placed_ ? &placed_->patient : nullptr; }
  // A copy of its voxels for the view, made in the background; empty once it was taken, or where
  // the view has one already.
  Volume takeMirror() { return std::exchange(mirror_, {}); }
  // Where the exercise wants to be looked at, when the case has that landmark.
  std::optional<LandmarkFrame> viewLandmark() const;
  // Memory that goes when another case is opened, and what need not be taken again, MB.
  double givenBack_mb() const;

  // --- The exercise that runs (desk.cpp).

  // Starts from the case as it was opened. `script` moves the hands until the mouse does; after
  // `seconds` the session is finished() and waits for stop().
  void start(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
             double seconds);
  // Without a recording, and nothing is cut: to feel what was set. Else a session as any.
  void poke();
  bool isPoke() const { return heldSession() && heldSession()->isPoke(); }
  void stop();
  // Says once when the running exercise can no longer be recorded. To be asked again and again.
  void checkRecording();
  // Only while the phase is running.
  Session* session() const {
    const auto* running = std::get_if<Running>(&activity_);
    return running ? running->session.get() : nullptr;
  }

  // --- Edits of the exercise by a person (desk_edits.cpp).

  // The exercise is as `wanted` from now on, for the next session and, of tissues and controller,
  // for the one that runs or is being started; what else differs waits for its end. It stays as
  // long as the exercise does, whatever the case. `what`: edits of the same that follow one another
  // are one step of edits() until closeEdit(). Errors, and nothing has changed: LOCKED, BUSY (what
  // waits for the end of a session), those of checkEdited().
  Status edit(const Exercise& wanted, const std::string& what);
  // One change of the exercise as it is now, as a step of its own.
  Status edit(const std::string& what, const std::function<void(Exercise&)>& change);
  void closeEdit() { history_.close(); }
  // The same for the tissues alone, and what is refused is said; another set than the landmarks
  // know is withTissues().
  void setTissues(const TissueSet& tissues, const std::string& what = "tissues");
  const ExerciseHistory& edits() const { return history_; }
  void undoEdit();
  void redoEdit();
  // Where the exercise enters: at a place that was clicked, from the direction `outward`, or, for
  // nothing, where the exercise's file says. An edit, for this case in this exercise. False: not
  // now.
  bool placeEntry(const std::optional<Landmark>& entry);
  // Null: where the file says.
  const Landmark* entry() const;
  // Whether anything but the controller and the tissues in force is another than the exercise was
  // opened with, or saved as; a place that was clicked, too.
  bool exerciseEdited() const;
  // The case lacks a structure that is needed: the exercise runs on its set for such cases.
  bool isElsewhere() const { return placed_ && placed_->elsewhere; }
  // The set of exercise() that is in force on the open case; and with the labels of its structures.
  const TissueSet& tissues() const { return tissuesInForce(*exercise_, isElsewhere()); }
  const TissueSet& placedTissues() const { return placed_ ? placed_->exercise.tissues : tissues(); }
  // exercise() with this set in place of the one in force.
  NewTissues withTissues(const TissueSet& set) const {
    return withTissuesInForce(*exercise_, set, isElsewhere());
  }
  // How tissues look: the exercise's until a person chooses. Of the view alone, so neither the
  // exercise nor a recording changes with it.
  void setLooks(const TissueLooks& looks) { looks_ = looks; }
  const TissueLooks& looks() const { return looks_; }
  void setController(ControllerKind kind);
  // What the arms are controlled by now: the exercise's, or what the running session has made of
  // it.
  ControllerKind controllerInForce() const { return in_force_; }
  void noteController(ControllerKind in_force);
  // The tissues as the exercise's file has them, or as the case or a file of tissues has them
  // since; and whether they have been edited since.
  const TissueSet& declaredTissues() const {
    return saved_tissues_ ? *saved_tissues_ : ofExercise();
  }
  bool tissuesEdited() const { return exercise_ && tissues() != declaredTissues(); }
  // Whether the exercise's own file has other tissues, wherever these are saved; but for those that
  // the open case brought along.
  bool tissuesUnlikeExercise() const {
    return exercise_ && tissues() != ofExercise() && tissues() != brought_tissues_;
  }
  // The case, or a file of tissues, has these now. The exercise's own file has not.
  void tissuesSaved(const TissueSet& as) { saved_tissues_ = as; }
  // The exercise is on disk now as this file: that is what it is opened with from here on.
  void exerciseSaved(const std::filesystem::path& file);

  // --- Saving (desk_saving.cpp), in the background. `said` is what DeskEvents::onSaved() tells a
  // person once it is written; `then` follows.

  // Runs `write`. `afterwards` follows in any case.
  void save(const std::string& said, std::function<Status(const Progress&)> write,
            std::function<void()> then = {}, std::function<void()> afterwards = {});
  // The tissues in force, as a file that exercises can name.
  void saveTissues(const std::filesystem::path& file, const std::string& said,
                   std::function<void()> then);
  // The voxels as they are now: of the running exercise, which pauses for it, of the one that ended
  // last, or of the case.
  void saveVolume(const std::filesystem::path& file, const std::string& said,
                  std::function<void()> then = {});
  void cancelSaving() { saving_.cancel(); }
  bool isWriting() const { return saving_.busy(); }
  // Or waits until the session stands still.
  bool isSaving() const { return saving_.busy() || waiting_save_; }
  // What the exercise that ended last cut; null: the case is whole. makeWhole() lets go of it.
  const std::shared_ptr<const Grid>& carved() const { return carved_; }
  void makeWhole() { carved_.reset(); }

 private:
  // What goes on; one at a time. Whether a case is open is placed_'s to say.
  struct Idle {};
  struct Opening {
    bool placing = false;      // structures that were made here, or places, of the open case
    bool of_edit = false;      // of an edit of places, which goes back where they cannot be had
    bool place_again = false;  // an edit of places waits for its end
    bool structures_alone = false;  // the case stays
  };
  struct Starting {};
  struct Running {
    std::unique_ptr<Session> session;
    std::optional<Error> recording_failure;  // as it was said
  };
  struct Ending {
    std::unique_ptr<Session> session;
    std::optional<Error> recording_failure;
  };
  using Activity = std::variant<Idle, Opening, Starting, Running, Ending>;
  // A save of the voxels that waits until the haptic thread stands still.
  struct WaitingSave {
    std::filesystem::path file;
    std::string said;
    std::function<void()> then;
    std::chrono::steady_clock::time_point again;
  };

  Session* heldSession() const;  // running or ending
  void go(Activity activity);
  void say(DeskChange change) { events_.onChange(change); }
  void fail(const Error& error);

  std::optional<Exercise> readExerciseOrFail(const std::filesystem::path& file);
  std::optional<OpenRequest> requestOfExercise();
  OpenRequest requestOf(Exercise exercise, const std::filesystem::path& file) const;
  void openSource(OpenRequest request, const std::string& source);
  void placeAgain(const std::shared_ptr<const LabelMap>& structures, bool of_edit);
  void open(OpenRequest request, const Opening& as);
  void open(OpenRequest request) { open(std::move(request), Opening()); }
  void endOpening();
  void opened(Result<OpenOutcome> outcome);
  void opened(Opened opened);

  void begin(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
             double seconds, bool poke);
  void startArms(std::unique_ptr<Session> session, double seconds);
  Status tell(Session& session, ControllerKind& told_of) const;
  void stopped(const Status& status);
  void notStarted(const Error& error);

  std::optional<ChosenArms> armsToAsk() const;

  void refreshPlaced();
  Status mayEdit(const Exercise& wanted) const;
  bool put(Exercise wanted);
  bool mayGoTo(const Exercise* step);
  void goTo(Exercise exercise);
  void placeEdited();
  void takeBack();
  void tellTissues();
  void applyController(ControllerKind kind);
  Status notLocked(Lock lock) const;
  bool wouldBeLocked(Lock lock) const;
  const TissueSet& prescribedTissues() const;
  const TissueSet& ofExercise() const { return tissuesInForce(opened_exercise_, isElsewhere()); }
  Status keptAsSaved() const;

  void saveOnceStill(WaitingSave save);

  Policy policy_;
  DeskEvents& events_;
  bool unlocked_ = false;
  bool practising_ = true;
  bool practised_ = false;  // what runs was started so

  std::optional<Exercise> exercise_;
  std::filesystem::path exercise_file_;
  Exercise opened_exercise_;      // as it was opened, or saved
  std::optional<TissueSet> brought_tissues_;  // by the case, as it was opened
  std::optional<TissueSet> saved_tissues_;  // tissues() in the case or in a file of their own
  bool exercise_chosen_ = false;  // by a person
  ExerciseHistory history_;
  ControllerKind in_force_ = ControllerKind::bounded;
  TissueLooks looks_;

  std::optional<Placement> placed_;
  TissueTable placed_with_{};  // its landmarks were found in
  Volume mirror_;
  std::shared_ptr<const Grid> carved_;

  Activity activity_;
  Opening ended_;                              // the one that came to its end last
  std::optional<StructureQuestion> question_;  // that was asked last
  std::optional<WaitingSave> waiting_save_;

  std::function<ArmSettings()> settings_;
  std::optional<std::vector<NamedDevice>> arms_;
  bool arms_lent_ = false;
  bool stepped_ = false;
  ArmsHere arms_here_;
  // Last, so that they are joined before what they work on goes.
  Job opening_, running_, saving_;
};

}  // namespace trephine
