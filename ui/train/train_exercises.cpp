// Which exercise it is, and whether the case is what it is for.
#include <QMessageBox>
#include <QPushButton>
#include <QStandardItemModel>
#include <algorithm>

#include "ui/common/question.h"
#include "ui/common/settings.h"
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

void TrainWorkspace::fillScenes() {
  const QSignalBlocker quiet(scenes_);
  scenes_->clear();
  listed_.clear();
  for (const std::filesystem::path& file : bench_.exercises()) {
    Result<Scene> scene = readScene(file);
    const QString folder = toQt(file.parent_path().filename());
    if (!scene) {  // said where one looks for it
      scenes_->addItem(tr("%1 (cannot be read)").arg(folder), toQt(file));
      refuse(scenes_->count() - 1, toQt(scene.error().sentence()));
      continue;
    }
    const QString name = listedName(scene->name);  // of two from elsewhere perhaps the same
    scenes_->addItem(scenes_->findText(name) < 0 ? name : tr("%1 (%2)").arg(name, folder),
                     toQt(file));
    listed_.emplace_back(file, *std::move(scene));
  }
  showAllowed();
  showInUse();
}

void TrainWorkspace::chooseScene(int index) {
  const auto file = toPath(scenes_->itemData(index).toString());
  showInUse();  // until the other is on its way: it may be asked about, or not be had
  // A built-in case changes with the exercise, and its structures with it.
  const Case* of = workstation_.currentCase();
  std::vector<Bench::Loss> losses{Bench::Loss::cuts, Bench::Loss::tissues};
  if (of && of->built_in) losses.insert(losses.begin(), Bench::Loss::structures);
  bench_.unlessLost(losses, [this, file] { useScene(file); });
  view_->setFocus();
}

// One stays where one is: the list is over Prepare too.
void TrainWorkspace::useScene(const std::filesystem::path& file) {
  bench_.openExercise(file, here_ ? Place::train : Place::prepare);
}

// In the list of exercises; without a scene, the one that an imported case would get.
void TrainWorkspace::showInUse() {
  const std::optional<Scene>& scene = workstation_.scene();
  if (!scene) {
    scenes_->setCurrentIndex(scenes_->findData(toQt(defaultScene("cranium"))));
    return arms_->showController({});
  }
  const QString file = toQt(workstation_.sceneFile());
  int index = scenes_->findData(file);
  if (index < 0) index = scenes_->findText(listedName(scene->name));
  if (index < 0) {
    scenes_->addItem(listedName(scene->name), file);
    index = scenes_->count() - 1;
  }
  scenes_->setCurrentIndex(index);
  arms_->showController(scene->controller);
}

void TrainWorkspace::showScene() {
  const std::optional<Scene>& scene = workstation_.scene();
  if (!scene) return;
  showInUse();
  arms_->setScene(*scene);
  exercise_->setScene(*scene, read(settings::kLanguage));
  showOutline();
  showCard();
}

// What is said before it starts; nothing while one runs, or once one has ended and is looked at.
void TrainWorkspace::showCard() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool idle = phase == Phase::ready || phase == Phase::empty;
  const bool result = result_shown_ && phase == Phase::ready;
  const bool card = !result_shown_ && phase == Phase::ready && !bench_.carved();
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
  card_->showExercise(*workstation_.scene(), read(settings::kLanguage), start_->isEnabled());
}

void TrainWorkspace::putAside(bool aside) {
  aside_ = aside;
  showCard();
  view_->setFocus();
}

void TrainWorkspace::showOutline() {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed || !placed->scene.outline) return view_->setOutline({}, false, 1.0);
  const Scene& scene = placed->scene;
  view_->setOutline(
      outlineOn(scene, placed->landmarks, *placed->patient.volume, placed->labels.get()),
      scene.outline->closed, scene.outline->width_mm);
}

void TrainWorkspace::showLocks() {
  arms_->setLocked(workstation_.isLocked(Lock::controller)
                       ? tr("Locked. %1.").arg(unlockWords(workstation_.policy()))
                       : QString());
  showAllowed();
}

// What would be refused cannot be chosen.
void TrainWorkspace::showAllowed() {
  for (const auto& [file, scene] : listed_) {
    const Status may = workstation_.mayPractise(scene, file);
    refuse(scenes_->findData(toQt(file)), may ? QString() : toQt(may.error().sentence()));
  }
}

// Why the row cannot be chosen; empty: it can.
void TrainWorkspace::refuse(int index, const QString& why) {
  auto* rows = qobject_cast<QStandardItemModel*>(scenes_->model());
  QStandardItem* row = rows ? rows->item(index) : nullptr;
  if (!row) return;
  row->setEnabled(why.isEmpty());
  row->setToolTip(why);
}

// Until it is open, or cannot be had.
void TrainWorkspace::showOpening(const Scene& scene, const std::filesystem::path& file) {
  if (!result_shown_) aside_ = false;
  scenes_->setPlaceholderText(listedName(scene.name));  // where the list has it not yet
  const int index = scenes_->findData(toQt(file));
  scenes_->setCurrentIndex(index >= 0 ? index : scenes_->findText(listedName(scene.name)));
  arms_->showController(scene.controller);
}

// Which exercise the case has, where that is news, and that it is for something else.
void TrainWorkspace::sayWhatIsOpen() {
  const QString exercise = toQt(workstation_.scene()->name);
  QString words;
  if (!exercise_said_.isEmpty() && exercise != exercise_said_) {
    words = tr("The exercise is now \"%1\".").arg(exercise);
  }
  exercise_said_ = exercise;
  for (const Warning& warning : workstation_.placed()->warnings) {
    if (warning.code != "OTHER_ANATOMY" && warning.code != "NO_VAULT") continue;
    words += (words.isEmpty() ? "" : " ") + toQt(warning.text) + '.';
  }
  if (!words.isEmpty()) bench_.say(words);
}

// Before an exercise starts on a case that is not what it is for, once a case and exercise.
void TrainWorkspace::unlessItDoesNotFit(Bench::Next go_on) {
  const std::optional<Placement>& of = workstation_.placed();
  if (!of || of->warnings.empty() || warned_) return go_on();
  QStringList words;
  bool lacks = false, no_place = false;
  std::string fits;
  for (const Warning& warning : of->warnings) {
    words << toQt(warning.text) + (warning.text.ends_with('.') ? "" : ".");
    lacks = lacks || warning.code == "LACKS_STRUCTURE";
    no_place = no_place || warning.code == "NO_LANDMARK";
    if (warning.code == "OTHER_ANATOMY") fits = exerciseAnatomy(of->patient.anatomy->region);
  }
  const QString next = !fits.empty() ? tr("Choose an exercise that fits, or go on as it is.")
                       : lacks    ? tr("Make the structure in the slices first, or go on as it is.")
                       : no_place ? tr("Click where it is to enter (I) first, or go on as it is.")
                                  : tr("Choose an exercise that fits, or go on as it is.");
  QMessageBox* question = ask(bench_.window(), "misfitQuestion", words.join('\n'), next,
                              tr("&Go on as it is"), [this, go_on] {
                                warned_ = true;
                                go_on();
                              });
  if (!fits.empty()) {
    const std::filesystem::path file = defaultScene(fits);
    const int index = scenes_->findData(toQt(file));
    orElse(*question, "changeExercise", tr("&Change to \"%1\"").arg(scenes_->itemText(index)),
           [this, file] {
             bench_.unlessLost({Bench::Loss::cuts, Bench::Loss::tissues},
                               [this, file] { useScene(file); });
           });
  } else if (lacks) {
    orElse(*question, "makeStructure", tr("&Make it"), [this] { emit structureWanted(); });
  }
}

}  // namespace trephine
