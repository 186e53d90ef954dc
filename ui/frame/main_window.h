// The workstation's window: case and tissues at the left, the 3-D view, the arms at the right. It
// connects the widgets with the workstation; neither knows the other. (main_window_layout.cpp
// builds it, main_window_tissues.cpp and main_window_structures.cpp are what it does with those,
// main_window_losses.cpp what it asks before work is lost, main_window.cpp the rest.)
#pragma once

#include <QComboBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QMainWindow>
#include <QTabWidget>
#include <QTimer>
#include <filesystem>
#include <functional>

#include "ui/cases/case_panel.h"
#include "ui/cases/import_dialog.h"
#include "ui/common/icons.h"
#include "ui/common/slip_guard.h"
#include "ui/frame/workstation.h"
#include "ui/structures/structure_panel.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/training/arms_panel.h"
#include "ui/training/rewind_bar.h"
#include "ui/training/state_notice.h"
#include "ui/views/four_up.h"

class QFileDialog;

namespace trephine {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  // Recordings go into `recordings`; empty: the user's own folder of sessions.
  explicit MainWindow(std::filesystem::path recordings = {}, QWidget* parent = nullptr);

  Workstation& workstation() { return workstation_; }
  FourUp& views() { return *views_; }
  ViewWidget& view() { return *view_; }  // 3-D

  // As Workstation::openPath, once the window has its place on the screen: what opens over it then
  // knows where that is.
  void openOnceShown(const std::filesystem::path& path);
  // `script` plays until the mouse takes a hand; after `seconds` the exercise stops by itself.
  void startExercise(std::optional<OperatorScript> script = {}, double seconds = kNoEnd_s);
  // The 3-D view as a PNG, and the voxels as they are now; errors become dialogs.
  void savePicture(const QString& file);
  void saveVolume(const QString& file);
  void saveReport(const QString& file);  // of the folder scanned last: PDF or HTML

 signals:
  // Beside the dialog that is shown.
  void failed(const trephine::Error& error);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  static constexpr double kNoEnd_s = 1e9;
  static constexpr int kCaseTab = 0, kStructureTab = 2;

  void buildActions();
  void buildBars();
  void buildPanels();
  void connectParts();
  void connectStructures();
  QAction* makeAction(Symbol symbol, const char* name, const QString& text, const QKeySequence& key,
                      const QString& tip);
  void fillScenes();

  QWidget* front();  // the window or dialog that a further dialog belongs to
  // A dialog over the front window that goes away by itself and leaves no names on disk.
  QFileDialog* fileDialog(const char* name, const QString& title, const QString& filter = {});
  void askForFolder();
  void askForFile();
  void askForScene();
  void askForLabels();
  QFileDialog* saveDialog(const QString& title, const QString& suggestion, const QString& filter);
  void askWhereToSave(const QString& title, const QString& suggestion, const QString& filter,
                      void (MainWindow::*save)(const QString&));
  void showAbout();
  void showCaseCard(const Case& of);  // in the panel of the case
  void open(const std::filesystem::path& path);
  // Goes on with what takes the place of the tissues; where they have been edited it asks first.
  void unlessTissuesStay(std::function<void()> go_on);
  // The structures that are made (main_window_structures.cpp).
  bool structuresShown() const;
  bool takeStructures();
  void openStructures();
  void showStructures();
  void placingFailed();
  void showStructureReport();
  void showStructureTab();
  void structureToolChanged(SliceTool tool);
  void structureKey(int key);
  void showUndo();
  void sayWhatIsOpen();
  bool keepsTheCase(const std::filesystem::path& target);
  // Where the exercise enters (main_window_structures.cpp); from nowhere: out of what was clicked.
  void placeEntry(const Vec3& at_mm, const Vec3& from_mm);
  void leaveEntry();
  void showEntry();
  void askAboutStructures(const Error& error, const std::filesystem::path& file,
                          const Answers& answers, const std::string& option);
  void askAboutOverlap(const std::vector<std::string>& names, const std::filesystem::path& file,
                       const Answers& answers);
  void askForThreshold(const std::filesystem::path& file, const Answers& answers);
  void askAboutPreview();
  void askToSaveStructures();
  void saveStructuresThen(std::function<void()> then);
  // As other programs read them (main_window_exports.cpp).
  void connectExports();
  bool sourceAtHand() const;
  void askToSaveDicom(bool for_source);
  void saveDicom(const std::filesystem::path& folder, bool for_source);
  void askToSaveSurface();
  void unlessStructuresAreLost(std::function<void()> go_on);
  // Goes on with the exercise; where the case is not what it is for it asks first.
  void unlessItDoesNotFit(std::function<void()> go_on);
  // The structures in 3-D (main_window_tissues.cpp): which labels are shown, and how.
  void showLabelsInUse();
  void showSeen();
  void tissuesEdited(const TissueSet& set);
  void structureLookWanted(int label, TissueLook look);
  void showScene();
  void showInUse();
  void showOpening(const Scene& scene, const std::filesystem::path& file);
  void showRenderable(ControllerKind in_force);
  void showCase();
  void showPhase();
  void lookAtCase();
  // Goes on at once with what takes the cuts from the view; where no file has them it asks first.
  void unlessCutsAreLost(std::function<void()> go_on);
  // The same for another scene, which takes edited tissues too.
  void unlessSceneIsLost(std::function<void()> go_on);
  void askToSaveVolume(std::function<void()> then);
  void saveVolumeThen(const QString& file, std::function<void()> then);
  void start();
  void reset();
  void showWholeCase();
  void command(CommandKind kind);
  void rewind(std::uint32_t second);
  void showRewind(const LoopState& state);
  void moveHand(Hand hand, const Vec3& by_mm);
  void placeHandPoints();
  std::size_t armOf(Hand hand) const;
  void sessionStarted();
  void sessionEnded(Session& session);
  void tick();
  void showTools(const std::vector<ToolView>& tools);
  void showState(Session& session, const LoopState& state);
  void showRates();
  void say(const QString& text);
  void report(const Error& error);
  void askToGoOn(const Error& error);

  SlipGuard slip_guard_;
  Workstation workstation_;
  StructureEditor editor_;
  std::shared_ptr<const LabelMap> own_structures_;  // of the case, as the editor gave or got them
  QTimer settled_;
  bool start_when_placed_ = false;   // an exercise waits for its structures
  bool entry_asked_ = false;         // and the case is being placed with it
  StructureLooks structure_looks_;   // of the view alone
  std::optional<SeenTissues> seen_;  // what the 3-D view was told last
  QString exercise_said_;            // the last one that was open
  std::filesystem::path case_source_;  // that the imported case was read from
  bool warned_ = false;  // of this case in this exercise, and it was gone on
  std::filesystem::path recordings_;
  QAction *open_, *open_file_, *open_scene_, *start_, *stop_, *pause_, *undo_, *redo_, *reset_,
      *picture_, *volume_, *look_;
  QComboBox* scenes_;
  QTabWidget* left_;
  CasePanel* case_;
  ImportDialog* import_;
  StructurePanel* structures_;
  TissuePanel* tissues_;
  ArmsPanel* arms_;
  FourUp* views_;
  ViewWidget* view_;     // of them
  StateNotice* notice_;  // over the views
  RewindBar* rewind_;
  QLabel *hint_, *rates_;
  QTimer frame_timer_;
  QElapsedTimer panel_clock_, rate_clock_;
  std::vector<double> limits_N_;  // of the running session's arms
  struct GoingBack {
    std::uint32_t second;
    std::uint64_t asked_tick;
  };
  std::optional<GoingBack> going_back_;  // until it is said that one is there
  int frames_ = 0;                       // since the rates were shown
  std::uint64_t ticks_shown_ = 0;
  bool carved_ = false;                             // the view shows what an ended exercise left
  bool unsaved_cuts_ = false;                       // and some of it is in no file
  bool close_when_saved_ = false;
  bool may_close_ = false;                          // nothing unsaved is left to ask about
  std::optional<ControllerKind> controller_shown_;  // of which the tissue panel speaks
};

}  // namespace trephine
