#include "ui/prepare/tissue_tab.h"

#include <QFileDialog>
#include <algorithm>

#include "base/file.h"
#include "base/system.h"
#include "exercise/arm_limits.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/prepare/edit_words.h"
#include "ui/work/arms_of_place.h"

namespace trephine {

namespace {

// A file name that nobody has to escape.
QString setFileName(const std::string& set) {
  QString name;
  for (const QChar c : toQt(set)) name += c.isLetterOrNumber() ? c.toLower() : QChar('-');
  return (name.isEmpty() ? QStringLiteral("tissues") : name) + ".json";
}

}  // namespace

TissueTab::TissueTab(Workstation& workstation, FourUp& views, Messages& messages,
                     const std::filesystem::path& storage, QAction& undo, QAction& redo,
                     TissuePanel& tissues, StructureEditor& editor, TissuePicture& picture,
                     QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      messages_(messages),
      storage_(storage),
      undo_(undo),
      redo_(redo),
      views_(&views),
      tissues_(tissues),
      editor_(editor),
      picture_(picture) {
  connect(&tissues_, &TissuePanel::tissuesChanged, this, &TissueTab::edit);
  connect(&tissues_, &TissuePanel::looksChanged, this, [this](const TissueLooks& looks) {
    workstation_.setLooks(looks);
    views_->setTissues(workstation_.placedTissues(), looks);
    picture_.show();
  });
  for (const auto changed : {&Workstation::controllerChanged, &Workstation::armsAnswered}) {
    connect(&workstation_, changed, this, [this] {
      if (workstation_.exercise()) showRenderable(workstation_.controllerInForce());
    });
  }
  connect(&workstation_, &Workstation::locksChanged, this, [this] {
    tissues_.setLocked(workstation_.isLocked(Lock::tissues)
                           ? tr("The tissues are locked. %1.")
                                 .arg(lockedWords(workstation_.policy(),
                                                  workstation_.policy().isLocked(Lock::tissues)))
                           : QString());
  });
  connect(&tissues_, &TissuePanel::editEnded, this, [this] { workstation_.closeEdit(); });
  // They may be about to go.
  connect(&workstation_, &Workstation::openingProgressed, this, [this] {
    if (!workstation_.isPlacing()) tissues_.setEnabled(false);
  });
  connect(&workstation_, &Workstation::openingEnded, this, [this] { tissues_.setEnabled(true); });
  connectSets();
}

void TissueTab::showExercise() {
  const TissueSet& placed = workstation_.placedTissues();
  tissues_.setTissues(workstation_.tissues(), workstation_.declaredTissues());
  showRenderable(workstation_.exercise()->controller);
  tissues_.setLooks(workstation_.looks());
  editor_.setTissues(placed);
  views_->setTissues(placed, workstation_.looks());
  picture_.show();
}

void TissueTab::edit(const TissueSet& set, const QString& what) {
  if (!workstation_.exercise()) return;  // there is no exercise yet that they could be of
  picture_.yieldTo(set);
  NewTissues wanted = workstation_.withTissues(set);
  if (Status done = workstation_.edit(wanted.exercise, what.toStdString()); !done) {
    tissues_.setTissues(workstation_.tissues(), workstation_.declaredTissues());
    return messages_.report(done.error());
  }
  if (!wanted.notes.empty()) messages_.say(toQt(wanted.notes.front()) + '.');
  const TissueSet& placed = workstation_.placedTissues();
  editor_.setTissues(placed);
  views_->setTissues(placed, workstation_.looks());
  emit edited();
}

void TissueTab::showHistory(bool serve) {
  const ExerciseHistory& edits = workstation_.edits();
  const QString undo = edits.canUndo() ? editWords(edits.undoWhat()) : QString();
  const QString redo = edits.canRedo() ? editWords(edits.redoWhat()) : QString();
  tissues_.sets().showHistory(undo, redo);
  if (!serve) return;
  undo_.setEnabled(!undo.isEmpty());
  redo_.setEnabled(!redo.isEmpty());
  undo_.setToolTip(undo.isEmpty() ? tr("Takes back the last change; there is none")
                                  : tr("Undo: %1").arg(undo));
  redo_.setToolTip(redo.isEmpty() ? tr("Brings back what was taken back; there is nothing")
                                  : tr("Redo: %1").arg(redo));
}

// --- Sets ---

void TissueTab::connectSets() {
  TissueSetRow* sets = &tissues_.sets();
  connect(sets, &TissueSetRow::newSetWanted, this, &TissueTab::newSet);
  connect(sets, &TissueSetRow::duplicateWanted, this, &TissueTab::duplicateSet);
  connect(sets, &TissueSetRow::importWanted, this, &TissueTab::askForSet);
  connect(sets, &TissueSetRow::exportWanted, this, &TissueTab::askToExportSet);
  connect(sets, &TissueSetRow::revertWanted, this, &TissueTab::revertSet);
  connect(sets, &TissueSetRow::setWanted, this, &TissueTab::useSet);
  connect(sets, &TissueSetRow::undoWanted, this, [this] { workstation_.undoEdit(); });
  connect(sets, &TissueSetRow::redoWanted, this, [this] { workstation_.redoEdit(); });
  connect(sets, &TissueSetRow::setsWanted, this,
          [this, sets] { sets->setSets(setsOfWorkstation()); });
}

// The product's, then a person's own, each by name.
std::vector<std::pair<QString, std::filesystem::path>> TissueTab::setsOfWorkstation() const {
  std::vector<std::pair<QString, std::filesystem::path>> sets;
  for (const auto& folder : {resourceFolder() / "tissues", ownSets()}) {
    const std::size_t first = sets.size();
    std::error_code ec;
    for (std::filesystem::directory_iterator at(folder, ec), end; !ec && at != end;
         at.increment(ec)) {
      if (at->path().extension() != ".json") continue;
      const Result<TissueSet> set = readTissueSet(at->path());
      if (set) sets.emplace_back(shownName(set->name), at->path());
    }
    std::sort(sets.begin() + std::ptrdiff_t(first), sets.end());
  }
  return sets;
}

// In the place of the exercise's: what landmarks lose by it is said.
void TissueTab::takeSet(const TissueSet& set, const char* what) {
  if (!workstation_.exercise()) return;
  TissueSet own = set;
  own.elsewhere_file.clear();
  NewTissues wanted = workstation_.withTissues(own);
  workstation_.closeEdit();
  if (Status done = workstation_.edit(wanted.exercise, what); !done) {
    return messages_.report(done.error());
  }
  workstation_.closeEdit();
  emit setTaken();
  QStringList said{tr("The exercise has the tissues \"%1\" now.").arg(shownName(set.name))};
  for (const std::string& note : wanted.notes) said << toQt(note) + '.';
  messages_.say(said.join(' '));
}

void TissueTab::newSet() {
  takeSet(startingSet(tr("My tissues").toStdString()), "set");
}

void TissueTab::duplicateSet() {
  if (!workstation_.exercise()) return;
  TissueSet set = workstation_.tissues();
  set.name = tr("Copy of %1").arg(toQt(set.name)).left(60).toStdString();
  takeSet(set, "set");
}

void TissueTab::askForSet() {
  messages_.askForFile("importSetDialog", tr("Import tissues"), tr("Tissues (*.json)"),
                       [this](const auto& file) { useSet(file); });
}

void TissueTab::useSet(const std::filesystem::path& file) {
  const Result<TissueSet> set = readTissueSet(file);
  if (!set) return messages_.report(set.error());
  takeSet(*set, "set");
}

// Among the sets of this workstation, unless another place is chosen.
void TissueTab::askToExportSet() {
  if (!workstation_.exercise()) return;
  (void)makeFolder(ownSets());
  QFileDialog* dialog = messages_.saveDialog(
      tr("Export tissues"), setFileName(workstation_.tissues().name), tr("Tissues (*.json)"));
  dialog->setDirectory(toQt(ownSets()));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { workstation_.saveTissues(toPath(file), [] {}); });
  dialog->open();
}

void TissueTab::revertSet() {
  if (!workstation_.exercise()) return;
  if (!workstation_.tissuesEdited()) return messages_.say(tr("The set is as its file has it."));
  takeSet(workstation_.declaredTissues(), "revert");
}

void TissueTab::showRenderable(ControllerKind in_force) {
  const Exercise& exercise = *workstation_.exercise();
  tissues_.setRenderable(
      armsLimit(withForceLimit(exercise, armSettings().most_N), workstation_.rig()),
      [exercise](const Tissue& tissue) { return demandedOf(exercise, tissue); }, exercise.laws,
      exercise.removal, in_force);
}

}  // namespace trephine
