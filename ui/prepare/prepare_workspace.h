// Prepare: what tissue is felt and cut, and where it is: tissues, structures, the entry point, and
// the ways out for other programs. Between its panels, the editor of structures, the views and the
// workstation. Tools and exercise have a tab of their own (arms_tab.h, exercise_tab.h);
// prepare_tissues.cpp, prepare_thresholds.cpp, prepare_sets.cpp, prepare_poke.cpp,
// prepare_structures.cpp and prepare_exports.cpp are what it does with the rest.
#pragma once

#include <QTabWidget>
#include <QTimer>
#include <optional>

#include "ui/prepare/arms_tab.h"
#include "ui/prepare/exercise_tab.h"
#include "ui/structures/structure_panel.h"
#include "ui/tissue/histogram_view.h"
#include "ui/tissue/poke_plot.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/work/app_context.h"

namespace trephine {

class PrepareWorkspace : public Workspace {
  Q_OBJECT
 public:
  static constexpr int kTissueTab = 0, kStructureTab = 1, kToolTab = 2, kExerciseTab = 3;

  explicit PrepareWorkspace(AppContext& bench);

  QString title() const override { return tr("Prepare"); }
  Symbol symbol() const override { return Symbol::prepare; }
  Parts parts() override;
  void enter() override;
  void leave() override;

  // The structure that the exercise needs and the case lacks: with the tool that makes it.
  void makeMissing();
  bool structuresEdited() const { return editor_.edited(); }
  QAction* saveInCaseAction() const { return save_in_case_; }
  QAction* pokeAction() const { return poke_; }

 private:
  void connectTissues();
  void connectStructures();
  void connectExports();

  // Tissues (prepare_tissues.cpp).
  void showExercise();
  void showTab();
  void showRenderable(ControllerKind in_force);
  void showLabelsInUse();
  void showSeen();
  void tissuesEdited(const TissueSet& set, const QString& what);
  void structureLookWanted(int label, TissueLook look);
  // Goes on with what takes the place of the tissues; where they have been edited it asks first.
  void unlessTissuesStay(AppContext::Next go_on);

  // Thresholds over the histogram (prepare_thresholds.cpp).
  void connectThresholds();
  void countVoxels();
  void showHistogram();
  void thresholdBegan();
  void thresholdMoved(std::size_t tissue, RangeEnd end, int hu, bool alone);
  void thresholdEnded();
  void markMoving(int tissue);
  // In 3-D: that tissue alone, the others as ghosts.
  void showMoving(const std::vector<Structure>& rows, const TissueLooks& looks);

  // Sets of tissues, and the history of edits (prepare_sets.cpp).
  void connectSets();
  void showHistory();
  void takeSet(const TissueSet& set, const char* what);
  void newSet();
  void duplicateSet();
  void askForSet();
  void useSet(const std::filesystem::path& file);
  void askToExportSet();
  void revertSet();
  std::filesystem::path ownSets() const;
  std::vector<std::pair<QString, std::filesystem::path>> setsOfWorkstation() const;
  bool editsServe() const;

  // Poking: what was set is felt, and nothing is cut (prepare_poke.cpp).
  void connectPoke();
  void showPoke();
  void togglePoke();
  void showPokesOf(Session& session);

  // Structures (prepare_structures.cpp).
  bool structuresShown() const;
  bool takeStructures();
  void beforeStart(AppContext::Next go_on);
  void openStructures();
  void showStructures();
  void placingFailed();
  void showStructureReport();
  void showStructureTab();
  void structureToolChanged(SliceTool tool);
  void structureKey(int key);
  void showUndo();
  bool offerMissing();
  void askForLabels();
  void askAboutStructures(const StructureQuestion& question);
  void askForOption(const Choice& choice);
  void askForOrder(const std::vector<std::string>& names);
  void askForThreshold();
  void askAboutPreview(AppContext::Next go_on);
  void askToSaveStructures();
  void saveStructuresThen(AppContext::Next then);
  void unlessStructuresAreLost(AppContext::Next go_on);
  // Structures and tissues, where they have been changed, into the case of the library.
  bool isStored() const;
  void saveInCase(AppContext::Next then);
  // Where the exercise enters; from nowhere: out of what was clicked.
  void placeEntry(const Vec3& at_mm, const Vec3& from_mm);
  void leaveEntry();
  void showEntry();

  // As other programs read them (prepare_exports.cpp).
  bool sourceAtHand() const;
  void askToSaveDicom(bool for_source);
  void saveDicom(const std::filesystem::path& folder, bool for_source);
  void askToSaveSurface();

  AppContext& app_;
  Workstation& workstation_;
  FourUp* views_;
  ViewWidget* view_;
  StructureEditor editor_;
  QAction* save_in_case_;
  QTabWidget* tabs_;
  TissuePanel* tissues_;
  QWidget* below_;
  HistogramView* histogram_;
  QAction* poke_;
  PokePlot* poke_plot_;
  QTimer poke_timer_;
  std::optional<ViewLayout> layout_before_;  // the poke
  BackgroundTask counting_;
  struct Counted {  // of which the histogram is, or is being counted
    std::weak_ptr<const Volume> voxels;
    std::weak_ptr<const LabelMap> labels;
    bool labelled = false;
  };
  Counted counted_;
  // A threshold is being moved, of this tissue, since the set was this one.
  struct Moving {
    TissueTable before;
    std::string tissue;
  };
  std::optional<Moving> moving_;
  QTimer seen_later_;
  StructurePanel* structures_;
  ExerciseForm* form_;
  ArmsTab* arms_;
  ExerciseTab* exercise_;
  std::shared_ptr<const LabelMap> own_structures_;  // of the case, as the editor gave or got them
  // What the library's case has, whatever was saved to files: the editor's changes() then, nothing
  // for structures of another file; and whether tissues have been edited since.
  std::optional<std::uint64_t> in_case_ = 0;
  bool tissues_touched_ = false;
  QTimer settled_;
  AppContext::Next start_when_placed_;  // an exercise waits for its structures
  bool entry_asked_ = false;            // and the case is being placed with it
  bool here_ = false;                   // this workspace is the one that is shown
  StructureLooks structure_looks_;      // of the view alone
  std::optional<SeenTissues> seen_;     // what the 3-D view was told last
};

}  // namespace trephine
