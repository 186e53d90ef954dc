// Which exercise it is, and whether the case is what it is for.
#include <QMessageBox>
#include <QPushButton>
#include <QStandardItemModel>
#include <algorithm>

#include "case/codes.h"
#include "exercise/codes.h"
#include "ui/common/preferences.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/train/train_workspace.h"

namespace trephine {

namespace {

// One line that leaves room for the buttons beside it, whatever a file calls itself.
QString listedName(const std::string& name) {
  constexpr int kMostLetters = 40;
  QString line = toQt(name).simplified();
  line.removeIf([](QChar c) { return !c.isPrint(); });
  if (line.isEmpty()) return TrainWorkspace::tr("(no name)");
  return line.size() > kMostLetters ? line.left(kMostLetters - 1) + QChar(0x2026) : line;
}

}  // namespace

void TrainWorkspace::fillExercises() {
  const QSignalBlocker quiet(exercises_);
  exercises_->clear();
  listed_.clear();
  for (const std::filesystem::path& file : app_.exercises()) {
    Result<Exercise> exercise = readExercise(file);
    const QString folder = toQt(file.parent_path().filename());
    if (!exercise) {  // said where one looks for it
      exercises_->addItem(tr("%1 (cannot be read)").arg(folder), toQt(file));
      refuse(exercises_->count() - 1, toQt(exercise.error().sentence()));
      continue;
    }
    const QString name = listedName(exercise->name);  // of two from elsewhere perhaps the same
    exercises_->addItem(exercises_->findText(name) < 0 ? name : tr("%1 (%2)").arg(name, folder),
                        toQt(file));
    listed_.emplace_back(file, *std::move(exercise));
  }
  showAllowed();
  showInUse();
}

void TrainWorkspace::chooseExercise(int index) {
  const auto file = toPath(exercises_->itemData(index).toString());
  showInUse();  // until the other is on its way: it may be asked about, or not be had
  // A built-in case changes with the exercise, and its structures with it.
  const Case* of = workstation_.currentCase();
  std::vector<UnsavedWork> losses{UnsavedWork::cuts, UnsavedWork::tissues};
  if (of && of->built_in) losses.insert(losses.begin(), UnsavedWork::structures);
  guards_.unlessLost(losses, [this, file] { useExercise(file); });
  view_->setFocus();
}

// One stays where one is: the list is over Prepare too.
void TrainWorkspace::useExercise(const std::filesystem::path& file) {
  app_.openExercise(file, here_ ? Place::train : Place::prepare);
}

// In the list of exercises; without an exercise, the one that an imported case would get.
void TrainWorkspace::showInUse() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) {
    exercises_->setCurrentIndex(exercises_->findData(toQt(defaultExercise("cranium"))));
    return arms_->showController({});
  }
  const QString file = toQt(workstation_.exerciseFile());
  int index = exercises_->findData(file);
  if (index < 0) index = exercises_->findText(listedName(exercise->name));
  if (index < 0) {
    exercises_->addItem(listedName(exercise->name), file);
    index = exercises_->count() - 1;
  }
  exercises_->setCurrentIndex(index);
  arms_->showController(exercise->controller);
}

void TrainWorkspace::showChosen() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) return;
  showInUse();
  arms_->setExercise(*exercise);
  exercise_->setExercise(*exercise, toQt(languageInUse()));
  showOutline();
  showCard();
}

// What is said before it starts; nothing while one runs, or once one has ended and is looked at.
void TrainWorkspace::showCard() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool idle = phase == Phase::ready || phase == Phase::empty;
  const bool result = result_shown_ && phase == Phase::ready;
  const bool card = !result_shown_ && phase == Phase::ready && !case_views_.carved();
  exercise_->offerCard(!here_ || !aside_ ? QString()
                       : result          ? tr("Show the &result")
                       : card            ? tr("Show &what to do")
                                         : QString());
  if (!idle || !here_) {
    card_->hide();
    if (!here_ || phase == Phase::running) result_->hide();
    return;
  }
  if (phase == Phase::empty) return workstation_.isOpening() ? card_->hide() : card_->showNoCase();
  result_->setVisible(result && !aside_);
  if (!card || aside_) return card_->hide();
  card_->showExercise(*workstation_.exercise(), toQt(languageInUse()), start_->isEnabled());
}

void TrainWorkspace::putAside(bool aside) {
  aside_ = aside;
  showCard();
  view_->setFocus();
}

void TrainWorkspace::showOutline() {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed || !placed->exercise.outline) return view_->setOutline({}, false, 1.0);
  const Exercise& exercise = placed->exercise;
  view_->setOutline(
      outlineOn(exercise, placed->landmarks, *placed->patient.volume, placed->labels.get()),
      exercise.outline->closed, exercise.outline->width_mm);
}

void TrainWorkspace::showLocks() {
  arms_->setLocked(workstation_.isLocked(Lock::controller)
                       ? tr("Locked. %1.").arg(unlockWords(workstation_.policy()))
                       : QString());
  showAllowed();
}

// What would be refused cannot be chosen.
void TrainWorkspace::showAllowed() {
  for (const auto& [file, exercise] : listed_) {
    const Status may = workstation_.mayPractise(exercise, file);
    refuse(exercises_->findData(toQt(file)), may ? QString() : toQt(may.error().sentence()));
  }
}

// Why the row cannot be chosen; empty: it can.
void TrainWorkspace::refuse(int index, const QString& why) {
  auto* rows = qobject_cast<QStandardItemModel*>(exercises_->model());
  QStandardItem* row = rows ? rows->item(index) : nullptr;
  if (!row) return;
  row->setEnabled(why.isEmpty());
  row->setToolTip(why);
}

// Until it is open, or cannot be had.
void TrainWorkspace::showOpening(const Exercise& exercise, const std::filesystem::path& file) {
  if (!result_shown_) aside_ = false;
  exercises_->setPlaceholderText(listedName(exercise.name));  // where the list has it not yet
  const int index = exercises_->findData(toQt(file));
  exercises_->setCurrentIndex(index >= 0 ? index : exercises_->findText(listedName(exercise.name)));
  arms_->showController(exercise.controller);
}

// Which exercise the case has, where that is news, and that it is for something else.
void TrainWorkspace::sayWhatIsOpen() {
  const QString name = toQt(workstation_.exercise()->name);
  QString words;
  if (!exercise_said_.isEmpty() && name != exercise_said_) {
    words = tr("The exercise is now \"%1\".").arg(name);
  }
  exercise_said_ = name;
  for (const Warning& warning : workstation_.placed()->warnings) {
    if (warning.code != code::kOtherAnatomy && warning.code != code::kNoVault) continue;
    words += (words.isEmpty() ? "" : " ") + toQt(warning.text) + '.';
  }
  if (!words.isEmpty()) messages_.say(words);
}

// Before an exercise starts on a case that is not what it is for, once a case and exercise.
void TrainWorkspace::unlessItDoesNotFit(WorkGuards::Next go_on) {
  const std::optional<Placement>& of = workstation_.placed();
  if (!of || of->warnings.empty() || warned_) return go_on();
  QStringList words;
  bool lacks = false, no_place = false;
  std::string fits;
  for (const Warning& warning : of->warnings) {
    words << toQt(warning.text) + (warning.text.ends_with('.') ? "" : ".");
    lacks = lacks || warning.code == code::kLacksStructure;
    no_place = no_place || warning.code == code::kNoLandmark;
    if (warning.code == code::kOtherAnatomy) fits = exerciseAnatomy(of->patient.anatomy->region);
  }
  const QString next = !fits.empty() ? tr("Choose an exercise that fits, or go on as it is.")
                       : lacks    ? tr("Make the structure in the slices first, or go on as it is.")
                       : no_place ? tr("Click where it is to enter (I) first, or go on as it is.")
                                  : tr("Choose an exercise that fits, or go on as it is.");
  QMessageBox* question = ask(messages_.window(), "fitQuestion", words.join('\n'), next,
                              tr("&Go on as it is"), [this, go_on] {
                                warned_ = true;
                                go_on();
                              });
  if (!fits.empty()) {
    const std::filesystem::path file = defaultExercise(fits);
    const int index = exercises_->findData(toQt(file));
    orElse(*question, "changeExercise", tr("&Change to \"%1\"").arg(exercises_->itemText(index)),
           [this, file] {
             guards_.unlessLost({UnsavedWork::cuts, UnsavedWork::tissues},
                                [this, file] { useExercise(file); });
           });
  } else if (lacks) {
    orElse(*question, "makeStructure", tr("&Make it"), [this] { emit structureWanted(); });
  }
}

}  // namespace trephine
