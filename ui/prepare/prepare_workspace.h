// Prepare: what tissue is felt and cut, and where it is. Each of its tabs has a controller beside
// it (tissue_tab.h, structure_tab.h, arms_tab.h, exercise_tab.h), and so has what lies below the
// views (threshold_tab.h, poke_tab.h); here is what they have between them.
#pragma once

#include <QTabWidget>

#include "ui/prepare/arms_tab.h"
#include "ui/prepare/exercise_tab.h"
#include "ui/prepare/poke_tab.h"
#include "ui/prepare/structure_tab.h"
#include "ui/prepare/threshold_tab.h"
#include "ui/prepare/tissue_picture.h"
#include "ui/prepare/tissue_tab.h"
#include "ui/work/app_context.h"

namespace trephine {

class PrepareWorkspace : public Workspace {
  Q_OBJECT
 public:
  static constexpr int kTissueTab = 0, kStructureTab = 1, kToolTab = 2, kExerciseTab = 3;

  explicit PrepareWorkspace(AppContext& app);

  QString title() const override { return tr("Prepare"); }
  Symbol symbol() const override { return Symbol::prepare; }
  Parts parts() override;
  void enter() override;
  void leave() override;

  // The structure that the exercise needs and the case lacks: with the tool that makes it.
  void makeMissing();
  bool structuresUnsaved() const { return structures_->unsaved(); }
  QAction* saveInCaseAction() const { return save_in_case_; }
  QAction* pokeAction() const { return poke_->action(); }

 private:
  void makePanels();
  void connectTabs();
  void connectUndo();
  void showExercise();
  void showTab();
  void showUndo();
  bool editsServe() const;
  // Goes on with what takes the place of the tissues; where they have been edited it asks first.
  void unlessTissuesStay(WorkGuards::Next go_on, bool without_refused = false);

  AppContext& app_;
  Workstation& workstation_;
  FourUp* views_;
  StructureEditor editor_;
  QAction* save_in_case_;
  QTabWidget* tabs_;
  TissuePanel* tissue_panel_;
  StructurePanel* structure_panel_;
  ToolsPanel* tools_panel_;
  ExerciseForm* form_;
  QWidget* below_;
  HistogramView* histogram_;
  PokePlot* poke_plot_;
  TissuePicture* picture_;
  TissueTab* tissues_;
  ThresholdTab* thresholds_;
  PokeTab* poke_;
  ArmsTab* arms_;
  ExerciseTab* exercise_;
  StructureTab* structures_;
  bool here_ = false;  // this workspace is the one that is shown
};

}  // namespace trephine
