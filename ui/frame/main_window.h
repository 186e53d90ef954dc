// The workstation's window: the rail of workspaces, one of which is shown, and what is around them:
// menus, bar, status. It knows the workspaces, not their panels; what they share is the shared
// context.
#pragma once

#include <QMainWindow>
#include <QSplitter>
#include <QStackedWidget>
#include <QToolBar>
#include <filesystem>

#include "ui/cases/cases_workspace.h"
#include "ui/common/slip_guard.h"
#include "ui/frame/rail.h"
#include "ui/frame/status_line.h"
#include "ui/frame/window_dialogs.h"
#include "ui/prepare/prepare_workspace.h"
#include "ui/review/review_workspace.h"
#include "ui/train/train_workspace.h"

namespace trephine {

class HeadsetView;
class StereoView;

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  // Recordings go into `recordings`, cases beside it; empty: into the storage folder. `policy`:
  // what the workstation locks.
  explicit MainWindow(std::filesystem::path recordings = {}, const Policy& policy = {},
                      QWidget* parent = nullptr);

  ~MainWindow() override;

  Workstation& workstation() { return app_.workstation(); }
  FourUp& views() { return app_.caseViews().views(); }
  ViewWidget& view() { return app_.caseViews().view(); }  // 3-D

  void show(Place place);
  Place place() const { return place_; }
  // A folder, file or exercise, once the window has its place on the screen: what opens over it
  // then knows where that is.
  void openOnceShown(const std::filesystem::path& path);
  void open(const std::filesystem::path& path);
  // What a program that crashed has left: said, with its report, and its recording offered.
  void offerLeftBehind(const LeftBehind& left) {
    dialogs_->offerLeftBehind(left, [this](const std::filesystem::path& file) { open(file); });
  }
  // Whether the machine is as it was commissioned, once what begins with the window has had its
  // time.
  void checkAtStart();
  // Why everything is locked, where the workstation's settings are wrong.
  void sayProblem();
  void startExercise(std::optional<OperatorScript> script = {},
                     double seconds = TrainWorkspace::kNoEnd_s);
  // Shows the exercise that runs as it is now, all of it, without waiting for the next frame:
  // whoever moves the session's time (Workstation::setStepped) shows it so.
  void showExercise() { train_->showAll(); }
  void savePicture(const QString& file) { app_.caseViews().savePicture(file); }
  void saveVolume(const QString& file) { app_.caseViews().saveVolume(file); }
  void saveReport(const QString& file) { cases_->saveReport(file); }
  using QMainWindow::show;

 signals:
  // Once: the workspace stands on the screen, in Cases with its cards, and answers.
  void usable();
  // Beside the dialog that is shown.
  void failed(const trephine::Error& error);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  struct Room {
    Place place;
    const char* name;  // in the settings
    Workspace* workspace;
    ViewLayout layout;  // until a person chooses another
    Workspace::Parts parts;
  };

  void buildWorkspaces();
  void buildActions();
  void buildBars();
  void buildMenus();
  void connectParts();
  const Room& room(Place place) const { return rooms_[std::size_t(place)]; }
  void showTitle();
  void showPanels();
  void keepColumns();
  void restoreColumns();
  void restore();
  void keep();
  void showHelp();

  SlipGuard slip_guard_;
  AppContext app_;
  CasesWorkspace* cases_;
  PrepareWorkspace* prepare_;
  TrainWorkspace* train_;
  ReviewWorkspace* review_;
  HeadsetView* headset_;
  StereoView* stereo_;
  std::array<Room, 4> rooms_;  // by place
  Place place_ = Place::cases;
  Rail* rail_;
  QStackedWidget* pages_;
  QWidget *left_, *below_, *right_;  // each holds one part a workspace
  QSplitter* columns_;               // the views and what is beside them
  QToolBar* bar_;
  QAction *picture_, *volume_, *look_, *left_panel_, *right_panel_, *full_screen_;
  StatusLine* status_;
  WindowDialogs* dialogs_;
  bool close_when_saved_ = false;
  bool may_close_ = false;  // nothing unsaved is left to ask about
  bool entered_ = false;    // a workspace
};

}  // namespace trephine
