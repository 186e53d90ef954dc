#include "ui/train/exercise_choice.h"

#include <QMessageBox>
#include <QStandardItemModel>

#include "case/codes.h"
#include "desk/fit_question.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// One line that leaves room for the buttons beside it, whatever a file calls itself.
QString listedName(const std::string& name) {
  constexpr int kMostOfLine = 40;
  QString line = toQt(name).simplified();
  line.removeIf([](QChar c) { return !c.isPrint(); });
  if (line.isEmpty()) return ExerciseChoice::tr("(no name)");
  return line.size() > kMostOfLine ? line.left(kMostOfLine - 1) + QChar(0x2026) : line;
}

}  // namespace

ExerciseChoice::ExerciseChoice(AppContext& app, QObject* parent)
    : QObject(parent),
      app_(app),
      workstation_(app.workstation()),
      messages_(app.messages()),
      list_(new QComboBox) {
  list_->setObjectName("scenes");
  list_->setToolTip(tr("The exercise"));
  list_->setAccessibleName(tr("Exercise"));
  list_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  constexpr int kMostWidth = 320;  // of the widest letters
  list_->setMaximumWidth(kMostWidth);
  connect(list_, &QComboBox::activated, this, &ExerciseChoice::choose);
  connect(&app_, &AppContext::exercisesChanged, this, &ExerciseChoice::fill);
  connect(&app_.caseViews(), &CaseViews::caseShown, this, [this] {
    warned_ = false;
    sayWhatIsOpen();
  });
  connect(&workstation_, &Workstation::locksChanged, this, &ExerciseChoice::showAllowed);
  connect(&workstation_, &Workstation::openingEnded, this, &ExerciseChoice::showInUse);
  connect(&workstation_, &Workstation::exerciseOpening, this, &ExerciseChoice::showOpening);
  connect(&workstation_, &Workstation::phaseChanged, this, &ExerciseChoice::showPhase);
  showPhase();
}

void ExerciseChoice::fill() {
  const QSignalBlocker quiet(list_);
  list_->clear();
  listed_.clear();
  for (const std::filesystem::path& file : app_.exercises()) {
    Result<Exercise> exercise = readExercise(file);
    const QString folder = toQt(file.parent_path().filename());
    if (!exercise) {  // said where one looks for it
      list_->addItem(tr("%1 (cannot be read)").arg(folder), toQt(file));
      refuse(list_->count() - 1, toQt(exercise.error().sentence()));
      continue;
    }
    const QString name = listedName(exercise->name);  // of two from elsewhere perhaps the same
    list_->addItem(list_->findText(name) < 0 ? name : tr("%1 (%2)").arg(name, folder), toQt(file));
    listed_.emplace_back(file, *std::move(exercise));
  }
  showAllowed();
  showInUse();
}

void ExerciseChoice::choose(int index) {
  const auto file = toPath(list_->itemData(index).toString());
  showInUse();  // until the other is on its way: it may be asked about, or not be had
  app_.openUnlessLost(file, place_);
  app_.caseViews().view().setFocus();
}

void ExerciseChoice::showInUse() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) {
    list_->setCurrentIndex(list_->findData(toQt(defaultExercise("cranium"))));
    emit controllerShown({});
    return;
  }
  const QString file = toQt(workstation_.exerciseFile());
  int index = list_->findData(file);
  if (index < 0) index = list_->findText(listedName(exercise->name));
  if (index < 0) {
    list_->addItem(listedName(exercise->name), file);
    index = list_->count() - 1;
  }
  list_->setCurrentIndex(index);
  emit controllerShown(exercise->controller);
}

void ExerciseChoice::showPhase() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  list_->setEnabled(!workstation_.isOpening() && (phase == Phase::ready || phase == Phase::empty));
}

// What would be refused cannot be chosen.
void ExerciseChoice::showAllowed() {
  for (const auto& [file, exercise] : listed_) {
    const Status may = workstation_.mayPractise(exercise, file);
    refuse(list_->findData(toQt(file)), may ? QString() : toQt(may.error().sentence()));
  }
}

// Why the row cannot be chosen; empty: it can.
void ExerciseChoice::refuse(int index, const QString& why) {
  auto* rows = qobject_cast<QStandardItemModel*>(list_->model());
  QStandardItem* row = rows ? rows->item(index) : nullptr;
  if (!row) return;
  row->setEnabled(why.isEmpty());
  row->setToolTip(why);
}

// Until it is open, or cannot be had.
void ExerciseChoice::showOpening(const Exercise& exercise, const std::filesystem::path& file) {
  list_->setPlaceholderText(listedName(exercise.name));  // where the list has it not yet
  const int index = list_->findData(toQt(file));
  list_->setCurrentIndex(index >= 0 ? index : list_->findText(listedName(exercise.name)));
  emit controllerShown(exercise.controller);
}

// Which exercise the case has, where that is news, and that it is for something else.
void ExerciseChoice::sayWhatIsOpen() {
  const QString name = toQt(workstation_.exercise()->name);
  QString words;
  if (!said_.isEmpty() && name != said_) {
    words = tr("The exercise is now \"%1\".").arg(name);
  }
  said_ = name;
  for (const Warning& warning : workstation_.placed()->warnings) {
    if (warning.code != code::kOtherAnatomy && warning.code != code::kNoVault) continue;
    words += (words.isEmpty() ? "" : " ") + toQt(warning.text) + '.';
  }
  if (!words.isEmpty()) messages_.say(words);
}

void ExerciseChoice::unlessItDoesNotFit(WorkGuards::Next go_on) {
  if (!workstation_.placed() || warned_) return go_on();
  const std::optional<FitQuestion> asked = fitQuestion(*workstation_.placed());
  if (!asked) return go_on();
  using Mend = FitQuestion::Mend;
  QStringList why;
  for (const std::string& sentence : asked->why) why << toQt(sentence);
  QString next = tr("Choose an exercise that fits, or go on as it is.");
  if (asked->mend == Mend::make_structure) {
    next = tr("Make the structure in the slices first, or go on as it is.");
  } else if (asked->mend == Mend::place_entry) {
    next = tr("Click where it is to enter (I) first, or go on as it is.");
  }
  QMessageBox* question = ask(messages_.window(), "fitQuestion", why.join('\n'), next,
                              tr("&Go on as it is"), [this, go_on] {
                                warned_ = true;
                                go_on();
                              });
  if (asked->mend == Mend::change_exercise) {
    const std::filesystem::path file = defaultExercise(asked->anatomy);
    const int index = list_->findData(toQt(file));
    orElse(*question, "changeExercise", tr("&Change to \"%1\"").arg(list_->itemText(index)),
           [this, file] { app_.openUnlessLost(file, place_); });
  } else if (asked->mend == Mend::make_structure) {
    orElse(*question, "makeStructure", tr("&Make it"), [this] { emit structureWanted(); });
  }
}

}  // namespace trephine
