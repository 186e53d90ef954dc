// What the workspaces and the window share: places, exercises, folders, and the parts that whatever
// they make is given. Window's thread.
#pragma once

#include "library/case_library.h"
#include "ui/work/case_views.h"
#include "ui/work/workspace.h"

namespace trephine {

class AppContext : public QObject {
  Q_OBJECT
 public:
  // `recordings`: where they go; empty: into the storage folder, which the policy, a person's
  // settings or the user's own data folder say.
  AppContext(QMainWindow& window, std::filesystem::path recordings, const Policy& policy);

  Workstation& workstation() { return workstation_; }
  Messages& messages() { return messages_; }
  WorkGuards& guards() { return guards_; }
  CaseViews& caseViews() { return case_views_; }
  const std::filesystem::path& recordings() const { return recordings_; }
  const std::filesystem::path& storage() const { return storage_; }
  // For work in the background.
  const std::shared_ptr<CaseLibrary>& library() const { return library_; }
  // An exercise of a file; one that was made on a case of the library opens that as well. Where it
  // names a built-in case or none, the case that is open stays, unless `with_its_case`.
  void openExercise(const std::filesystem::path& exercise, Place then, bool with_its_case = false);
  // Once nobody minds what goes with it: the case too, where that changes.
  void openUnlessLost(const std::filesystem::path& exercise, Place then,
                      bool with_its_case = false);
  // The folder of an exercise that was exported becomes one of this workstation, which is opened.
  void takeInExercise(const std::filesystem::path& folder, Place then);
  // Those of the workstation, then those that were made or imported here.
  std::vector<std::filesystem::path> exercises() const;
  // Of the storage folder: there is another one, or one is called otherwise.
  void tellExercises() { emit exercisesChanged(); }
  // An exercise is tried from Prepare, and one comes back there.
  void setTrying(bool trying) {
    if (std::exchange(trying_, trying) != trying) emit tryingChanged();
  }
  bool trying() const { return trying_; }

  // Of the exercise while one runs, else of what is prepared: who serves them enables them.
  QAction* undoAction() const { return undo_; }
  QAction* redoAction() const { return redo_; }

  void go(Place place) { emit placeWanted(place); }
  // The window shows this one now.
  void noteShown(Place place) { shown_ = place; }
  // To the recordings of a case (ListedRecording::caseKey()).
  void review(const std::string& of) {
    review_of_ = of;
    go(Place::review);
  }
  std::string takeReviewed() { return std::exchange(review_of_, {}); }
  // Where one goes once the case that is being opened is there; Prepare, where nobody says.
  void goOnceOpen(Place place) { once_open_ = place; }

 signals:
  void placeWanted(trephine::Place place);
  void exercisesChanged();
  void tryingChanged();

 private:
  bool changesCase(const std::filesystem::path& exercise_file, bool with_its_case) const;

  std::filesystem::path storage_, recordings_;
  std::shared_ptr<CaseLibrary> library_;
  Messages messages_;
  Workstation workstation_;
  WorkGuards guards_;
  CaseViews case_views_;
  Place once_open_ = Place::prepare;
  Place shown_ = Place::cases, before_opening_ = Place::cases;
  bool came_ = false;  // the case that was being opened, or a question of it
  std::string review_of_;
  QAction *undo_, *redo_;
  bool trying_ = false;
  bool opening_ = false;  // a case is being opened
};

}  // namespace trephine
