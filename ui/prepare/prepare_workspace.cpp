#include "ui/prepare/prepare_workspace.h"

#include <QFileDialog>
#include <QHBoxLayout>
#include <QMessageBox>
#include <QTabBar>

#include "ui/common/actions.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/question.h"
#include "ui/common/words.h"

namespace trephine {

PrepareWorkspace::PrepareWorkspace(AppContext& app)
    : Workspace(&app),
      app_(app),
      workstation_(app.workstation()),
      views_(&app.caseViews().views()) {
  save_in_case_ = makeAction(*app.messages().window(), Symbol::save, "saveInCase",
                             tr("Save in the case"), Qt::CTRL | Qt::SHIFT | Qt::Key_S,
                             tr("Keep changed structures and tissues in the case"));
  makePanels();
  Messages& messages = app_.messages();
  WorkGuards& guards = app_.guards();
  CaseViews& case_views = app_.caseViews();
  picture_ =
      new TissuePicture(workstation_, *views_, *tissue_panel_, *structure_panel_, editor_, &app_);
  tissues_ = new TissueTab(workstation_, *views_, messages, app_.storage(), *app_.undoAction(),
                           *app_.redoAction(), *tissue_panel_, editor_, *picture_, &app_);
  thresholds_ =
      new ThresholdTab(workstation_, case_views, *histogram_, *tissue_panel_, *picture_, &app_);
  poke_ =
      new PokeTab(workstation_, messages, guards, case_views, *tissue_panel_, *poke_plot_, &app_);
  arms_ = new ArmsTab(workstation_, *views_, messages, *tools_panel_, &app_);
  exercise_ = new ExerciseTab(workstation_, messages, guards, views_->toolbox(), app_.storage(),
                              *form_, &app_);
  // Before the structures' own: what is open comes before what is made of it.
  const auto labels = [this] {
    tissue_panel_->setLabelsOpen(workstation_.placed()->labels != nullptr);
  };
  connect(&app_.caseViews(), &CaseViews::caseShown, this, labels);
  connect(&workstation_, &Workstation::structuresChanged, this, labels);
  structures_ = new StructureTab(workstation_, messages, guards, case_views, app_.library(),
                                 app_.storage(), *structure_panel_, editor_, *picture_, &app_);
  connectTabs();
  connectUndo();
  showTab();
}

void PrepareWorkspace::makePanels() {
  tissue_panel_ = new TissuePanel;
  structure_panel_ = new StructurePanel(editor_);
  tools_panel_ = new ToolsPanel;
  form_ = new ExerciseForm;
  tabs_ = named(new QTabWidget, "prepareTabs");
  tabs_->setDocumentMode(true);
  tabs_->insertTab(kTissueTab, scrolled(tissue_panel_, "tissuePage"), tr("Tissues"));
  tabs_->insertTab(kStructureTab, scrolled(structure_panel_, "structurePage"), tr("Structures"));
  tabs_->insertTab(kToolTab, scrolled(tools_panel_, "toolPage"), tr("Tools"));
  tabs_->insertTab(kExerciseTab, scrolled(form_, "exercisePage"), tr("Exercise"));
  tabs_->setMinimumWidth(275);
  // Four names beside each other in a narrow column.
  tabs_->tabBar()->setStyleSheet("QTabBar::tab { padding: 5px 4px; min-width: 0; }");
  below_ = named(new QWidget, "prepareBelow");
  histogram_ = new HistogramView(below_);
  auto* beside = tight(new QHBoxLayout(below_));
  beside->addWidget(histogram_, 1);
  poke_plot_ = new PokePlot(below_);
  beside->addWidget(poke_plot_, 1);
}

void PrepareWorkspace::connectTabs() {
  connect(&workstation_, &Workstation::exerciseChanged, this, &PrepareWorkspace::showExercise);
  connect(tissues_, &TissueTab::edited, this, [this] {
    structures_->noteTissues(true);
    thresholds_->follow();
    poke_->renewForecast();
  });
  connect(tissues_, &TissueTab::setTaken, this, [this] {
    structures_->noteTissues(true);
    showExercise();
  });
  connect(thresholds_, &ThresholdTab::structuresNamed, form_, &ExerciseForm::setStructures);
  form_->sets = [this] { return tissues_->setsOfWorkstation(); };
  connect(poke_, &PokeTab::frontWanted, tabs_, [this] {
    app_.go(Place::prepare);
    tabs_->setCurrentIndex(kTissueTab);
  });
  connect(structures_, &StructureTab::frontWanted, tabs_,
          [this] { tabs_->setCurrentIndex(kStructureTab); });
  connect(exercise_, &ExerciseTab::placeWanted, &structures_->entry(), &EntryTool::useOnce);
  exercise_->exercises = [this] { return app_.exercises(); };
  connect(exercise_, &ExerciseTab::exercisesChanged, &app_, &AppContext::tellExercises);
  connect(exercise_, &ExerciseTab::takeInWanted, this, [this](const std::filesystem::path& folder) {
    app_.takeInExercise(folder, Place::prepare);
  });
  connect(exercise_, &ExerciseTab::tryWanted, this, [this] {
    app_.go(Place::train);
    app_.setTrying(true);
  });
  exercise_->structuresInCase = [this] { return structures_->inCase(); };
  exercise_->saveInCase = [this](WorkGuards::Next then) {
    structures_->saveInCase(std::move(then));
  };
  connect(exercise_, &ExerciseTab::saved, this, [this] { structures_->noteTissues(false); });
  connect(exercise_, &ExerciseTab::labelsWanted, structures_, &StructureTab::askForLabels);
  connect(save_in_case_, &QAction::triggered, this, [this] { structures_->saveInCase({}); });
  connect(tabs_, &QTabWidget::currentChanged, this, &PrepareWorkspace::showTab);
  app_.guards().setGuard(UnsavedWork::tissues,
                         [this](WorkGuards::Next go_on) { unlessTissuesStay(std::move(go_on)); });
}

void PrepareWorkspace::connectUndo() {
  connect(&workstation_, &Workstation::editsChanged, this,
          [this] { tissues_->showHistory(editsServe()); });
  connect(structures_, &StructureTab::undoChanged, this, &PrepareWorkspace::showUndo);
  connect(&app_.caseViews(), &CaseViews::cutsChanged, this, &PrepareWorkspace::showUndo);
  connect(app_.undoAction(), &QAction::triggered, this, [this] {
    if (editsServe()) return workstation_.undoEdit();
    if (!workstation_.session()) editor_.undo();
  });
  connect(app_.redoAction(), &QAction::triggered, this, [this] {
    if (editsServe()) return workstation_.redoEdit();
    if (!workstation_.session()) editor_.redo();
  });
}

Workspace::Parts PrepareWorkspace::parts() {
  Parts parts;
  parts.left = tabs_;
  parts.below = below_;
  return parts;
}

void PrepareWorkspace::makeMissing() {
  app_.go(Place::prepare);
  structures_->makeMissing();
}

void PrepareWorkspace::enter() {
  here_ = true;
  app_.setTrying(false);
  showTab();
  (void)structures_->offerMissing();
}

void PrepareWorkspace::leave() {
  here_ = false;
  histogram_->letGo();
  structures_->entry().letGo();
  showTab();
  if (workstation_.isPoke()) workstation_.stop();
}

// What lies below the views is the tissues'.
void PrepareWorkspace::showTab() {
  const int tab = tabs_->currentIndex();
  histogram_->setVisible(tab == kTissueTab);
  poke_->show(here_, tab == kTissueTab);
  arms_->show(here_ && tab == kToolTab);
  exercise_->show(here_ && tab == kExerciseTab);
  structures_->show(here_, tab == kStructureTab);
}

void PrepareWorkspace::showExercise() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) return;
  structure_panel_->setWanted(exercise->structures);
  tissues_->showExercise();
  views_->setAnatomy(exercise->anatomy);
  thresholds_->refresh();
  tissues_->showHistory(editsServe());
}

// While Prepare is shown without an exercise of Train, and not the structures.
bool PrepareWorkspace::editsServe() const {
  const bool practising = workstation_.session() && !workstation_.isPoke();
  return here_ && !practising && !structures_->shown();
}

// Without an exercise they are the structures', while those are in front. Cuts that an exercise
// left in the view are no step of theirs: there the panel's own buttons serve.
void PrepareWorkspace::showUndo() {
  if (editsServe()) return tissues_->showHistory(true);
  if (workstation_.phase() == Workstation::Phase::running) return;
  const bool serve = structures_->shown() && !app_.caseViews().cutsUnsaved();
  const auto undo = serve ? editor_.undoText() : std::nullopt;
  const auto redo = serve ? editor_.redoText() : std::nullopt;
  QAction *undo_action = app_.undoAction(), *redo_action = app_.redoAction();
  undo_action->setEnabled(undo.has_value());
  redo_action->setEnabled(redo.has_value());
  undo_action->setToolTip(undo ? tr("Undo: %1").arg(*undo)
                          : app_.caseViews().cutsUnsaved()
                              ? tr("The exercise has ended: its cuts stay until Reset")
                              : tr("Takes back the last change; there is none"));
  redo_action->setToolTip(redo ? tr("Redo: %1").arg(*redo)
                               : tr("Brings back what was taken back; there is nothing"));
}

void PrepareWorkspace::unlessTissuesStay(WorkGuards::Next go_on, bool without_refused) {
  if (exercise_->anyRefused() && !without_refused) {
    ask(app_.messages().window(), "textNotApplied",
        tr("A text of the exercise's card is too long and not applied."),
        tr("Going on leaves it out."), tr("&Go on without it"),
        [this, go_on = std::move(go_on)] { unlessTissuesStay(go_on, true); });
    return;
  }
  // One of this workstation's own has its tissues in its own file.
  const bool tissues =
      exercise_->isOwn() ? workstation_.tissuesUnlikeExercise() : workstation_.tissuesEdited();
  if (!workstation_.exerciseEdited() && !tissues) return go_on();
  const bool exercise = workstation_.exerciseEdited() || exercise_->isOwn();
  auto* box =
      named(new QMessageBox(QMessageBox::Question, tr("Trephine"),
                            exercise ? tr("The exercise \"%1\" has been changed and not saved.")
                                           .arg(toQt(workstation_.exercise()->name))
                                     : tr("The tissues have been changed and not saved."),
                            QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel,
                            app_.messages().window()),
            "unsavedTissues");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setInformativeText(exercise ? tr("Save it? Discarded changes cannot be had back.")
                          : structures_->isStored()
                              ? tr("Save them in the case? Discarded changes cannot be had back.")
                              : tr("Save them to a file? Discarded changes cannot be had back."));
  box->setDefaultButton(QMessageBox::Save);
  connect(
      box, &QMessageBox::finished, this,
      [this, exercise, without_refused, go_on = std::move(go_on)](int answer) {
        if (answer == QMessageBox::Discard) return go_on();
        if (answer != QMessageBox::Save) return;
        // And what is changed while that is written.
        const auto again = [this, without_refused, go_on] {
          unlessTissuesStay(go_on, without_refused);
        };
        if (exercise) return exercise_->save(false, again);
        if (structures_->isStored()) return structures_->saveInCase(go_on);
        QFileDialog* dialog =
            app_.messages().saveDialog(tr("Save tissues"), "tissues.json", tr("Tissues (*.json)"));
        connect(dialog, &QFileDialog::fileSelected, this, [this, go_on](const QString& file) {
          workstation_.saveTissues(toPath(file), go_on);
        });
        dialog->open();
      });
  box->open();
}

}  // namespace trephine
