// Sets of tissues: new, another, out and in; and the history of edits.
#include <QFileDialog>
#include <algorithm>

#include "base/file.h"
#include "base/purpose.h"
#include "base/system.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/prepare/prepare_workspace.h"

namespace trephine {

namespace {

// What an edit is called where it can be taken back: by what stands before the colon.
constexpr std::pair<const char*, const char*> kEditWords[] = {
    {"threshold", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "HU of a tissue")},
    {"hu", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "HU of a tissue")},
    {"opacity", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "opacity")},
    {"colour", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "colour")},
    {"name", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the name of a tissue")},
    {"set name", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the name of the set")},
    {"where", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "where a tissue is")},
    {"add tissue", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a new tissue")},
    {"remove tissue", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a tissue removed")},
    {"set", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "another set of tissues")},
    {"elsewhere", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the set for other cases")},
    {"revert", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the set reverted")},
    {"entry", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the entry point")},
    {"landmark", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a landmark")},
    {"add landmark", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a new landmark")},
    {"remove landmark", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a landmark removed")},
    {"tool", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a tool")},
    {"add tool", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a new tool")},
    {"remove tool", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a tool removed")},
    {"arm", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "an arm")},
    {"workspace", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "where an arm is")},
    {"add arm", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "a new arm")},
    {"remove arm", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "an arm removed")},
    {"laws", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "what is felt")},
    {"controller", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the controller")},
    {"force at", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "where the force acts")},
    {"removal", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "how tissue is removed")},
    {"rate_hz", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the rate")},
    {"exercise name", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the name of the exercise")},
    {"anatomy", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the part of the body")},
    {"structures", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the structures it needs")},
    {"operator", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the script")},
    {"view landmark", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "what is looked at")},
    {"distance_mm", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the distance of the eye")},
    {"looks", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the looks it begins with")},
    {"card", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the card")},
    {"card on", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the card")},
    {"outline", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the outline")},
    {"outline off", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the outline")},
    {"outline closed", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the outline")},
    {"width_mm", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "the outline")},
    {"locks", QT_TRANSLATE_NOOP("trephine::PrepareWorkspace", "what stays")},
};

QString editWords(const std::string& what) {
  const std::string of = what.substr(0, what.find(':'));
  for (const auto& [edit, words] : kEditWords) {
    if (of == edit) return PrepareWorkspace::tr(words);
  }
  return PrepareWorkspace::tr("a number of a tissue");
}

// A file name that nobody has to escape.
QString setFileName(const std::string& set) {
  QString name;
  for (const QChar c : toQt(set)) name += c.isLetterOrNumber() ? c.toLower() : QChar('-');
  return (name.isEmpty() ? QStringLiteral("tissues") : name) + ".json";
}

}  // namespace

void PrepareWorkspace::connectSets() {
  connect(tissues_, &TissuePanel::newSetWanted, this, &PrepareWorkspace::newSet);
  connect(tissues_, &TissuePanel::duplicateWanted, this, &PrepareWorkspace::duplicateSet);
  connect(tissues_, &TissuePanel::importWanted, this, &PrepareWorkspace::askForSet);
  connect(tissues_, &TissuePanel::exportWanted, this, &PrepareWorkspace::askToExportSet);
  connect(tissues_, &TissuePanel::revertWanted, this, &PrepareWorkspace::revertSet);
  connect(tissues_, &TissuePanel::setWanted, this, &PrepareWorkspace::useSet);
  connect(tissues_, &TissuePanel::undoWanted, &workstation_, [this] { workstation_.undoEdit(); });
  connect(tissues_, &TissuePanel::redoWanted, &workstation_, [this] { workstation_.redoEdit(); });
  connect(&workstation_, &Workstation::editsChanged, this, &PrepareWorkspace::showHistory);
  connect(tissues_, &TissuePanel::setsWanted, this,
          [this] { tissues_->setSets(setsOfWorkstation()); });
  form_->sets = [this] { return setsOfWorkstation(); };
}

// The product's, then a person's own, each by name.
std::vector<std::pair<QString, std::filesystem::path>> PrepareWorkspace::setsOfWorkstation() const {
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

std::filesystem::path PrepareWorkspace::ownSets() const {
  return app_.storage() / "tissues";
}

// While Prepare is shown without an exercise of Train, and not the structures.
bool PrepareWorkspace::editsServe() const {
  const bool practising = workstation_.session() && !workstation_.isPoke();
  return here_ && !practising && !structuresShown();
}

void PrepareWorkspace::showHistory() {
  const ExerciseHistory& edits = workstation_.edits();
  const QString undo = edits.canUndo() ? editWords(edits.undoWhat()) : QString();
  const QString redo = edits.canRedo() ? editWords(edits.redoWhat()) : QString();
  tissues_->showHistory(undo, redo);
  if (!editsServe()) return;
  QAction *undo_action = app_.undoAction(), *redo_action = app_.redoAction();
  undo_action->setEnabled(!undo.isEmpty());
  redo_action->setEnabled(!redo.isEmpty());
  undo_action->setToolTip(undo.isEmpty() ? tr("Takes back the last change; there is none")
                                         : tr("Undo: %1").arg(undo));
  redo_action->setToolTip(redo.isEmpty()
                              ? tr("Brings back what was taken back; there is nothing")
                              : tr("Redo: %1").arg(redo));
}

// In the place of the exercise's: what landmarks lose by it is said.
void PrepareWorkspace::takeSet(const TissueSet& set, const char* what) {
  if (!workstation_.exercise()) return;
  TissueSet own = set;
  own.elsewhere_file.clear();
  NewTissues wanted = workstation_.withTissues(own);
  workstation_.closeEdit();
  if (Status done = workstation_.edit(wanted.exercise, what); !done) {
    return app_.report(done.error());
  }
  workstation_.closeEdit();
  tissues_touched_ = true;
  showExercise();
  QStringList said{tr("The exercise has the tissues \"%1\" now.").arg(shownName(set.name))};
  for (const std::string& note : wanted.notes) said << toQt(note) + '.';
  app_.say(said.join(' '));
}

void PrepareWorkspace::newSet() {
  takeSet(startingSet(tr("My tissues").toStdString()), "set");
}

void PrepareWorkspace::duplicateSet() {
  if (!workstation_.exercise()) return;
  TissueSet set = workstation_.tissues();
  set.name = tr("Copy of %1").arg(toQt(set.name)).left(60).toStdString();
  takeSet(set, "set");
}

void PrepareWorkspace::askForSet() {
  app_.askForFile("importSetDialog", tr("Import tissues"), tr("Tissues (*.json)"),
                    [this](const auto& file) { useSet(file); });
}

void PrepareWorkspace::useSet(const std::filesystem::path& file) {
  const Result<TissueSet> set = readTissueSet(file);
  if (!set) return app_.report(set.error());
  takeSet(*set, "set");
}

// Among the sets of this workstation, unless another place is chosen.
void PrepareWorkspace::askToExportSet() {
  if (!workstation_.exercise()) return;
  (void)makeFolder(ownSets());
  QFileDialog* dialog =
      app_.saveDialog(tr("Export tissues"), setFileName(workstation_.tissues().name),
                        tr("Tissues (*.json)"));
  dialog->setDirectory(toQt(ownSets()));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { workstation_.saveTissues(toPath(file), [] {}); });
  dialog->open();
}

void PrepareWorkspace::revertSet() {
  if (!workstation_.exercise()) return;
  if (!workstation_.tissuesEdited()) return app_.say(tr("The set is as its file has it."));
  takeSet(workstation_.declaredTissues(), "revert");
}

}  // namespace trephine
