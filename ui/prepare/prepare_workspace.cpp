#include "ui/prepare/prepare_workspace.h"

#include <QHBoxLayout>
#include <QTabBar>

#include "ui/common/actions.h"
#include "ui/common/placing.h"

namespace trephine {

PrepareWorkspace::PrepareWorkspace(AppContext& bench)
    : Workspace(&bench),
      app_(bench),
      workstation_(bench.workstation()),
      views_(&bench.views()),
      view_(&bench.view()) {
  save_in_case_ = makeAction(*bench.window(), Symbol::save, "saveInCase", tr("Save in the case"),
                             QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_S),
                             tr("Keep changed structures and tissues in the case"));
  connect(save_in_case_, &QAction::triggered, this, [this] { saveInCase({}); });
  tissues_ = new TissuePanel;
  structures_ = new StructurePanel(editor_);
  tabs_ = new QTabWidget;
  tabs_->setObjectName("prepareTabs");
  tabs_->setDocumentMode(true);
  tabs_->insertTab(kTissueTab, scrolled(tissues_, "tissuePage"), tr("Tissues"));
  tabs_->insertTab(kStructureTab, scrolled(structures_, "structurePage"), tr("Structures"));
  auto* tools = new ToolsPanel;
  form_ = new ExerciseForm;
  tabs_->insertTab(kToolTab, scrolled(tools, "toolPage"), tr("Tools"));
  tabs_->insertTab(kExerciseTab, scrolled(form_, "exercisePage"), tr("Exercise"));
  tabs_->setMinimumWidth(275);
  // Four names beside each other in a narrow column.
  tabs_->tabBar()->setStyleSheet("QTabBar::tab { padding: 5px 4px; min-width: 0; }");
  below_ = new QWidget;
  below_->setObjectName("prepareBelow");
  histogram_ = new HistogramView(below_);
  auto* beside = new QHBoxLayout(below_);
  beside->setContentsMargins(0, 0, 0, 0);
  beside->addWidget(histogram_, 1);
  poke_plot_ = new PokePlot(below_);
  beside->addWidget(poke_plot_, 1);
  connectTissues();
  connectThresholds();
  connectSets();
  connectPoke();
  arms_ = new ArmsTab(app_, *tools);
  exercise_ = new ExerciseTab(app_, *form_);
  exercise_->structuresInCase = [this] { return in_case_ == editor_.changes(); };
  exercise_->saveInCase = [this](AppContext::Next then) { saveInCase(std::move(then)); };
  connect(exercise_, &ExerciseTab::saved, this, [this] { tissues_touched_ = false; });
  connect(exercise_, &ExerciseTab::labelsWanted, this, &PrepareWorkspace::askForLabels);
  connectStructures();
  connectExports();
  showUndo();
}

Workspace::Parts PrepareWorkspace::parts() {
  Parts parts;
  parts.left = tabs_;
  parts.below = below_;
  return parts;
}

void PrepareWorkspace::enter() {
  here_ = true;
  app_.setTrying(false);
  showTab();
  showStructureTab();
  (void)offerMissing();
}

void PrepareWorkspace::leave() {
  here_ = false;
  histogram_->letGo();
  if (workstation_.isPoke()) workstation_.stop();
  showTab();
  showStructureTab();
}

}  // namespace trephine
