// What all workspaces share: the case and exercise at work, the views of it, how something is said
// or asked, and what is asked before work is lost. Window's thread.
#pragma once

#include <QFileDialog>
#include <QMainWindow>
#include <QObject>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <vector>

#include "library/case_library.h"
#include "ui/views/four_up.h"
#include "ui/work/workspace.h"
#include "ui/work/workstation.h"

namespace trephine {

class AppContext : public QObject {
  Q_OBJECT
 public:
  using Next = std::function<void()>;
  // What can be lost while no file has it.
  enum class UnsavedWork { structures, cuts, tissues };

  // `recordings`: where they go; empty: into the storage folder, which the policy, a person's
  // settings or the user's own data folder say.
  AppContext(QMainWindow& window, std::filesystem::path recordings, const Policy& policy);

  Workstation& workstation() { return workstation_; }
  FourUp& views() { return *views_; }
  ViewWidget& view() { return views_->threeD(); }
  QWidget* window() const { return &window_; }
  const std::filesystem::path& recordings() const { return recordings_; }
  const std::filesystem::path& storage() const { return storage_; }
  // For work in the background.
  const std::shared_ptr<CaseLibrary>& library() const { return library_; }
  // An exercise of a file; one that was made on a case of the library opens that as well.
  void openExercise(const std::filesystem::path& exercise, Place then);
  // Those of the workstation, then those that were made or imported here.
  std::vector<std::filesystem::path> exercises() const;
  // Of the storage folder: there is another one, or one is called otherwise.
  void tellExercises() { emit exercisesChanged(); }
  // An exercise is tried from Prepare, and one comes back there.
  void setTrying(bool trying);
  bool trying() const { return trying_; }

  // Of the exercise while one runs, else of what is prepared: who serves them enables them.
  QAction* undoAction() const { return undo_; }
  QAction* redoAction() const { return redo_; }

  // One line that goes by itself; one that stays, of what mouse and keys do; an error as a dialog.
  void say(const QString& text) { emit said(text); }
  void hint(const QString& text) { emit hinted(text); }
  void report(const Error& error);
  void go(Place place) { emit placeWanted(place); }
  // To the recordings of a case (ListedRecording::caseKey()).
  void review(const std::string& of) {
    review_of_ = of;
    go(Place::review);
  }
  std::string takeReviewed() { return std::exchange(review_of_, {}); }
  // Where one goes once the case that is being opened is there; Prepare, where nobody says.
  void goOnceOpen(Place place) { once_open_ = place; }

  // A dialog over the window that goes away by itself and leaves no names on disk.
  QFileDialog* fileDialog(const char* name, const QString& title, const QString& filter = {});
  // Asks for a file of that kind; nothing comes where a person gives none.
  using GotPath = std::function<void(const std::filesystem::path&)>;
  void askForFile(const char* name, const QString& title, const QString& filter, GotPath then);
  // The same for a folder that will be made.
  void askForNewFolder(const char* name, const QString& title, const QString& suggestion,
                       GotPath then);
  QWidget* asking() const;
  QFileDialog* saveDialog(const QString& title, const QString& suggestion, const QString& filter);

  // --- What would be lost ---

  // Goes on at once, or once a person has decided.
  using Guard = std::function<void(Next)>;
  void setGuard(UnsavedWork loss, Guard guard) { guards_[std::size_t(loss)] = std::move(guard); }
  // What is being typed counts as entered.
  void takeTyped();
  void unlessLost(const std::vector<UnsavedWork>& losses, Next go_on);
  // What has to be settled before an exercise starts.
  void setBeforeStart(Guard guard) { before_start_ = std::move(guard); }
  void beforeStart(Next go_on) { before_start_ ? before_start_(std::move(go_on)) : go_on(); }
  // False, and said, where writing there would take a file of the case.
  bool keepsTheCase(const std::filesystem::path& target);
  // Of the case that is open, as far as it was read by this window.
  const std::filesystem::path& caseSource() const { return case_source_; }
  void setCaseSource(const std::filesystem::path& source) { case_source_ = source; }

  // --- The case in the views ---

  // The views show what an exercise cuts or has cut; and some of it is in no file.
  bool carved() const { return carved_; }
  bool cutsUnsaved() const { return cuts_unsaved_; }
  void exerciseBegan();
  void exerciseEnded(bool anything_cut);
  void showWholeCase();
  void lookAtCase();
  // As a PNG; the voxels as they are now. Errors become dialogs.
  void savePicture(const QString& file);
  void saveVolume(const QString& file, Next then = {});
  void askToSavePicture();
  void askToSaveVolume(Next then);

 signals:
  void said(const QString& text);
  void hinted(const QString& text);
  void failed(const trephine::Error& error);  // beside the dialog that is shown
  void placeWanted(trephine::Place place);
  void caseShown();    // another one, or another exercise on it, in the views
  void cutsChanged();  // carved(), cutsUnsaved()
  void exercisesChanged();
  void tryingChanged();

 private:
  void showCase();
  void unlessCutsAreLost(Next go_on);
  void setCuts(bool carved, bool unsaved);

  QMainWindow& window_;
  std::filesystem::path storage_, recordings_;
  std::shared_ptr<CaseLibrary> library_;
  FourUp* views_;
  Workstation workstation_;
  std::array<Guard, 3> guards_;
  Place once_open_ = Place::prepare;
  std::string review_of_;
  std::map<QString, QString> folders_;  // by kind of dialog; in memory alone
  Guard before_start_;
  QAction *undo_, *redo_;
  std::filesystem::path case_source_;
  bool carved_ = false, cuts_unsaved_ = false;
  bool trying_ = false;
};

}  // namespace trephine
