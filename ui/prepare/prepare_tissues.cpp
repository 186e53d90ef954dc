// The tissue panel: what it says of the arms, and edits that would be lost; tissues and structures
// in the 3-D view.
#include <QFileDialog>
#include <QMessageBox>
#include <algorithm>

#include "exercise/arm_limits.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/work/arms_of_place.h"
#include "ui/prepare/prepare_workspace.h"

namespace trephine {

void PrepareWorkspace::connectTissues() {
  connect(tissues_, &TissuePanel::tissuesChanged, this,
          &PrepareWorkspace::tissuesEdited);
  connect(tissues_, &TissuePanel::looksChanged, this, [this](const TissueLooks& looks) {
    workstation_.setLooks(looks);
    views_->setTissues(workstation_.placedTissues(), looks);
    showSeen();
  });
  app_.setGuard(AppContext::UnsavedWork::tissues,
                  [this](AppContext::Next go_on) { unlessTissuesStay(std::move(go_on)); });
  connect(&workstation_, &Workstation::exerciseChanged, this, &PrepareWorkspace::showExercise);
  for (const auto changed : {&Workstation::controllerChanged, &Workstation::armsAnswered}) {
    connect(&workstation_, changed, this, [this] {
      if (workstation_.exercise()) showRenderable(workstation_.controllerInForce());
    });
  }
  connect(&workstation_, &Workstation::locksChanged, this, [this] {
    tissues_->setLocked(
        workstation_.isLocked(Lock::tissues)
            ? tr("The tissues are locked. %1.").arg(unlockWords(workstation_.policy()))
            : QString());
  });
  connect(tissues_, &TissuePanel::editEnded, this, [this] { workstation_.closeEdit(); });
  // They may be about to go.
  connect(&workstation_, &Workstation::openingProgressed, this, [this] {
    if (!workstation_.isPlacing()) tissues_->setEnabled(false);
  });
  connect(&workstation_, &Workstation::openingEnded, this, [this] { tissues_->setEnabled(true); });
}

void PrepareWorkspace::showExercise() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) return;
  const TissueSet& placed = workstation_.placedTissues();
  tissues_->setTissues(workstation_.tissues(), workstation_.declaredTissues());
  structures_->setWanted(exercise->structures);
  showRenderable(exercise->controller);
  tissues_->setLooks(workstation_.looks());
  editor_.setTissues(placed);
  views_->setTissues(placed, workstation_.looks());
  showSeen();
  views_->setAnatomy(exercise->anatomy);
  showHistogram();
  showHistory();
}

// What lies below the views is the tissues'.
void PrepareWorkspace::showTab() {
  histogram_->setVisible(tabs_->currentIndex() == kTissueTab);
  showPoke();
  arms_->show(here_ && tabs_->currentIndex() == kToolTab);
  exercise_->show(here_ && tabs_->currentIndex() == kExerciseTab);
}

void PrepareWorkspace::showRenderable(ControllerKind in_force) {
  const Exercise& exercise = *workstation_.exercise();
  tissues_->setRenderable(
      armsLimit(withForceLimit(exercise, armSettings().most_N), workstation_.rig()),
      [exercise](const Tissue& tissue) { return demandedOf(exercise, tissue); }, exercise.laws,
      exercise.removal, in_force);
}

// The views show what the panel of structures lists while it is in front, else what the exercise
// runs on, with the shells that its tissues asked for.
void PrepareWorkspace::showLabelsInUse() {
  const Case* of = workstation_.currentCase();
  if (!of || !(views_->mirror().volume().geometry == of->volume->geometry)) return;
  const bool practising = workstation_.phase() != Workstation::Phase::ready;
  const std::shared_ptr<const LabelMap> wanted =
      structuresShown() && !practising ? editor_.map() : workstation_.placed()->labels;
  if (wanted != views_->mirror().labels()) views_->showLabels(wanted);
  showSeen();
}

void PrepareWorkspace::showSeen() {
  if (!workstation_.exercise()) return;
  const std::shared_ptr<const LabelMap>& map = views_->mirror().labels();
  std::vector<Structure> rows;
  for (const Structure& s : map ? map->structures : std::vector<Structure>{}) {
    // One that has no voxel needs no room, unless it is about to be painted.
    const bool any = map != editor_.map() || editor_.millilitres(s.label) > 0.0;
    if (any || s.label == editor_.current()) rows.push_back(s);
  }
  const TissueSet& set = workstation_.placedTissues();
  // A label of the exercise's map may be another structure's: a shell has what the wall gave up.
  const std::shared_ptr<const LabelMap> own = editor_.map();
  std::erase_if(structure_looks_, [&](const auto& of) { return own && !own->find(of.first); });
  if (map != own) {
    std::erase_if(rows, [&](const Structure& s) {
      const Structure* there = own ? own->find(s.label) : nullptr;
      return structure_looks_.contains(s.label) && !(there && sameName(there->name, s.name));
    });
  }
  TissueLooks looks = workstation_.looks();
  if (moving_) return showMoving(rows, looks);
  handToTissues(structure_looks_, looks, set, rows);
  if (looks != workstation_.looks()) {
    workstation_.setLooks(looks);
    tissues_->setLooks(looks);
    views_->setTissues(set, looks);
  }
  SeenTissues seen = withStructures(set, looks, rows, structure_looks_);
  structures_->showLooks(seen.structures);
  if (seen_ && seen_->tissues == seen.tissues && seen_->looks == seen.looks) return;
  seen_ = std::move(seen);
  view_->setTissues(seen_->tissues, seen_->looks);
}

// An opacity or colour that was set for a tissue goes before one that was set for its structure.
void PrepareWorkspace::tissuesEdited(const TissueSet& set, const QString& what) {
  if (!workstation_.exercise()) return;  // there is no exercise yet that they could be of
  const std::shared_ptr<const LabelMap> map = editor_.map();
  for (auto& [label, look] : structure_looks_) {
    const Structure* of = map ? map->find(label) : nullptr;
    if (!of) continue;
    for (const std::string& id : tissuesOf(set, *of)) {
      const Tissue* before = workstation_.tissues().find(id);
      if (!before) continue;
      if (before->opacity != set.find(id)->opacity) look.opacity.reset();
      if (before->colour != set.find(id)->colour) look.colour.reset();
    }
  }
  NewTissues wanted = workstation_.withTissues(set);
  if (Status done = workstation_.edit(wanted.exercise, what.toStdString()); !done) {
    tissues_->setTissues(workstation_.tissues(), workstation_.declaredTissues());
    return app_.report(done.error());
  }
  if (!wanted.notes.empty()) app_.say(toQt(wanted.notes.front()) + '.');
  tissues_touched_ = true;
  const TissueSet& placed = workstation_.placedTissues();
  editor_.setTissues(placed);
  views_->setTissues(placed, workstation_.looks());
  if (moving_) {
    const auto& all = placed.tissues;
    const auto at = std::ranges::find(all, moving_->tissue, &Tissue::id);
    if (at != all.end()) markMoving(int(at - all.begin()));
  }
  showHistogram();
  // A moved threshold is seen in slices and histogram first: the 3-D picture takes its time.
  if (moving_) return seen_later_.start();
  showSeen();
}

void PrepareWorkspace::structureLookWanted(int label, TissueLook look) {
  structure_looks_[label].look = look;
  showSeen();  // which hands it to a tissue of the exercise, where one is of it
}

void PrepareWorkspace::unlessTissuesStay(AppContext::Next go_on) {
  const bool exercise = workstation_.exerciseEdited();
  if (!exercise && !workstation_.tissuesEdited()) return go_on();
  auto* box = new QMessageBox(QMessageBox::Question, tr("Trephine"),
                              exercise ? tr("The exercise has been changed and not saved.")
                                    : tr("The tissues have been changed and not saved."),
                              QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel,
                              app_.window());
  box->setObjectName("unsavedTissues");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setInformativeText(exercise ? tr("Save it? Discarded changes cannot be had back.")
                          : isStored()
                              ? tr("Save them in the case? Discarded changes cannot be had back.")
                              : tr("Save them to a file? Discarded changes cannot be had back."));
  box->setDefaultButton(QMessageBox::Save);
  connect(box, &QMessageBox::finished, this, [this, exercise, go_on = std::move(go_on)](int answer) {
    if (answer == QMessageBox::Discard) return go_on();
    if (answer != QMessageBox::Save) return;
    // And what is changed while that is written.
    if (exercise) return exercise_->save(false, [this, go_on] { unlessTissuesStay(go_on); });
    if (isStored()) return saveInCase(go_on);
    QFileDialog* dialog =
        app_.saveDialog(tr("Save tissues"), "tissues.json", tr("Tissues (*.json)"));
    connect(dialog, &QFileDialog::fileSelected, this,
            [this, go_on](const QString& file) { workstation_.saveTissues(toPath(file), go_on); });
    dialog->open();
  });
  box->open();
}

}  // namespace trephine
