#include "ui/prepare/exercise_tab.h"

#include <QFileDialog>
#include <QMessageBox>
#include <algorithm>
#include <set>

#include "base/file.h"
#include "base/json.h"
#include "base/system.h"
#include "base/tr.h"
#include "exchange/exercise_folder.h"
#include "exchange/exercise_parts.h"
#include "library/case_folders.h"
#include "library/name_words.h"
#include "session/operator_script.h"
#include "ui/codes.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

ExerciseTab::ExerciseTab(Workstation& workstation, Messages& messages, WorkGuards& guards,
                         Toolbox& toolbox, const std::filesystem::path& storage, ExerciseForm& form,
                         QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      storage_(storage),
      toolbox_(toolbox),
      outline_(workstation_, toolbox_, messages_),
      form_(&form) {
  form_->wanted = [this](const std::string& what, const auto& change) {
    return workstation_.edit(what, change);
  };
  connect(form_, &ExerciseForm::drawingWanted, this, &ExerciseTab::draw);
  connect(form_, &ExerciseForm::placeWanted, this, &ExerciseTab::placeWanted);
  connect(form_, &ExerciseForm::looksWanted, this, [this] {
    if (!workstation_.exercise()) return;
    const Status done = workstation_.edit("looks", [this](Exercise& exercise) {
      exercise.view.looks.clear();
      for (const auto& [id, look] : workstation_.looks()) {
        if (exercise.tissues.find(id)) exercise.view.looks[id] = look;
      }
    });
    done ? messages_.say(tr("The exercise begins with these looks."))
         : messages_.report(done.error());
  });
  connect(form_, &ExerciseForm::operatorWanted, this, [this] {
    messages_.askForFile("operatorDialog", tr("An operator script"), tr("Scripts (*.json)"),
                         [this](const auto& file) {
                           if (!workstation_.exercise()) return;
                           const auto script = readOperatorScript(file, *workstation_.exercise());
                           if (!script) return messages_.report(script.error());
                           form_->setOperator(file.string());
                         });
  });
  connect(form_, &ExerciseForm::labelsWanted, this, &ExerciseTab::labelsWanted);
  connect(form_, &ExerciseForm::elsewhereChosen, this, &ExerciseTab::takeElsewhere);
  connect(form_, &ExerciseForm::elsewhereWanted, this, [this] {
    messages_.askForFile("elsewhereDialog", tr("Tissues for other cases"), tr("Tissues (*.json)"),
                         [this](const auto& file) { takeElsewhere(file); });
  });
  connect(form_, &ExerciseForm::saveWanted, this, [this] { save(false, {}); });
  connect(form_, &ExerciseForm::saveCopyWanted, this, [this] { save(true, {}); });
  connect(form_, &ExerciseForm::tryWanted, this, &ExerciseTab::tryIt);
  connect(form_, &ExerciseForm::exportWanted, this, &ExerciseTab::exportIt);
  connect(form_, &ExerciseForm::importWanted, this, &ExerciseTab::importIt);
  connect(&toolbox_, &Toolbox::taken, this,
          [this](ViewTool* tool) { form_->showDrawing(tool == &outline_); });
  connect(&workstation_, &Workstation::exerciseOpening, this,
          [this](const Exercise&, const std::filesystem::path& file) {
            opened_ = onDisk(file);
            form_->forgetCard();
          });
  connect(&workstation_, &Workstation::caseOpened, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::caseNamed, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::structuresChanged, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::locksChanged, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::editsChanged, this, &ExerciseTab::refresh);
}

void ExerciseTab::takeElsewhere(const std::filesystem::path& file) {
  const Result<TissueSet> set = readTissueSet(file);
  set ? form_->setElsewhere(*set) : messages_.report(set.error());
}

void ExerciseTab::show(bool in_front) {
  if (in_front_ && !in_front) guards_.takeTyped();
  in_front_ = in_front;
  if (!in_front_) draw(false);
  refresh();
}

// A threshold that is dragged pays for no form that nobody sees.
void ExerciseTab::refresh() {
  if (!in_front_ || !workstation_.exercise()) return;
  form_->setLocked(
      workstation_.anyLocked()
          ? tr("The exercise is locked. %1.")
                .arg(lockedWords(workstation_.policy(), !workstation_.policy().locks.empty()))
          : QString());
  form_->setElsewherePossible(!workstation_.isElsewhere());
  const std::optional<Placement>& placed = workstation_.placed();
  if (std::exchange(shown_, workstation_.exerciseFile()) != shown_) form_->forgetCard();
  form_->setExercise(*workstation_.exercise(),
                     placed ? placed->landmarks : std::vector<PlacedLandmark>());
  form_->showCase(caseWords());
  const bool edited = workstation_.exerciseEdited() || workstation_.tissuesUnlikeExercise();
  const QString from =
      isShipped() ? tr("It comes with Trephine: saving makes a copy of yours, and it stays.")
                  : tr("It is none of this workstation's exercises: saving makes a copy of yours.");
  form_->showSaved(!isOwn() ? from
                   : edited ? tr("Changed since it was saved.")
                            : tr("Saved on this workstation."));
}

QString ExerciseTab::caseWords() const {
  const Case* of = workstation_.currentCase();
  if (!of) return tr("no case");
  const auto phantom = phantomNamed(of->source);
  const QString name = of->built_in && phantom ? builtInName(std::string(*phantom))
                       : of->stored.empty()    ? tr("a case that is not saved yet")
                                               : toQt(of->name);
  const int count = of->structures ? int(of->structures->structures.size()) : 0;
  return count == 0 ? tr("%1, no structures").arg(name)
                    : tr("%1, structures: %2").arg(name).arg(count);
}

// --- The outline ---

void ExerciseTab::draw(bool on) {
  if (on == (&toolbox_.inHand() == &outline_)) return;
  on ? toolbox_.take(outline_) : toolbox_.putDown();
}

// --- Saving, trying ---

bool ExerciseTab::isShipped() const {
  std::error_code ec;
  const auto path = [&](const std::filesystem::path& of) {
    return std::filesystem::weakly_canonical(of, ec);
  };
  const std::filesystem::path file = path(workstation_.exerciseFile()),
                              shipped = path(resourceFolder() / "scenes");
  return std::mismatch(shipped.begin(), shipped.end(), file.begin(), file.end()).first ==
         shipped.end();
}

bool ExerciseTab::anyRefused() const {
  return form_->anyRefused();
}

bool ExerciseTab::isOwn() const {
  return isOwnExercise(storage_, workstation_.exerciseFile());
}

// With the case that is open, as it lies in the library.
std::optional<Exercise> ExerciseTab::exerciseToSave() {
  if (!workstation_.exercise() || !workstation_.currentCase()) return {};
  const Case& of = *workstation_.currentCase();
  // What holds of another case alone stays behind, but for the tissues, which have a set for each.
  const Exercise& made = *workstation_.exercise();
  Exercise exercise = onCase(made, of.source);
  exercise.tissues = made.tissues;
  exercise.tissues_elsewhere = made.tissues_elsewhere;
  if (of.built_in) return exercise;
  if (of.stored.empty() && isOfOwnExercise(storage_, of.source)) {  // it came with its case
    exercise.case_source = of.source;
    const Result<Exercise> brought = readExercise(exerciseThatBrought(storage_, of.source));
    exercise.labels_file = brought ? brought->labels_file : made.labels_file;
    return exercise;
  }
  if (of.stored.empty()) {
    messages_.report(
        {code::kCaseNotSaved, trephine::tr("The case of the exercise is not in the library"), "",
         trephine::tr("Save the case first (Cases), or import it again where it was deleted")});
    return {};
  }
  const std::filesystem::path folder = storage_ / "cases" / of.stored;
  exercise.case_source = (folder / case_folders::kVolumeFile).string();
  const std::filesystem::path structures = folder / case_folders::kStructuresFile;
  std::error_code ec;
  exercise.labels_file =
      std::filesystem::is_regular_file(structures, ec) ? structures.string() : std::string();
  return exercise;
}

ExerciseTab::OnDisk ExerciseTab::onDisk(const std::filesystem::path& file) {
  const Result<std::string> text = readWholeFile(file, kMostWrittenBytes);
  return {file, text ? *text : std::string()};
}

// Something of a person's would go: it is replaced, or stays and this one is saved beside it.
void ExerciseTab::askToReplace(const char* name, const QString& why, const QString& what,
                               const WorkGuards::Next& replace, const WorkGuards::Next& then) {
  QMessageBox* question = ask(messages_.window(), name, why, what, tr("&Replace it"), replace);
  orElse(*question, "saveBeside", tr("Save a &copy"), [this, then] { save(true, then); });
}

void ExerciseTab::save(bool copy, WorkGuards::Next then, bool on_another_case) {
  if (!then && workstation_.isWriting()) return messages_.say(tr("It is being saved."));
  guards_.takeTyped();
  std::optional<Exercise> exercise = exerciseToSave();
  if (!exercise) return;
  const bool in_place = isOwn() && !copy;
  const OnDisk now = onDisk(workstation_.exerciseFile());
  if (in_place && opened_.file == now.file && !now.text.empty() && opened_.text != now.text) {
    const auto replace = [this, now, then] {
      opened_ = now;
      save(false, then);
    };
    return askToReplace(
        "changedOnDisk",
        tr("The exercise has been changed by another program since it was opened here."),
        tr("Save yours as another one, or in the place of what is there now."), replace, then);
  }
  if (copy && isOwn()) exercise->name = tr("Copy of %1").arg(toQt(exercise->name)).toStdString();
  if (in_place && !on_another_case) {
    const Result<Exercise> there = readExercise(now.file);
    const auto place = [](const std::string& source) {
      return std::filesystem::path(source).lexically_normal();
    };
    if (there && place(there->case_source) != place(exercise->case_source)) {
      return askToReplace(
          "madeOnAnotherCase", tr("This exercise was made on another case."),
          tr("Save it on the open case as another one, or in the place of the one that is there."),
          [this, then] { save(false, then, true); }, then);
    }
  }
  if (!in_place) exercise->name = freeName(exercise->name);
  const std::filesystem::path folder = in_place ? workstation_.exerciseFile().parent_path()
                                                : freshExercise(storage_, exercise->name);
  auto file = std::make_shared<std::filesystem::path>();
  workstation_.save(
      tr("The exercise \"%1\" is saved.").arg(toQt(exercise->name)),
      [exercise = *exercise, folder, storage = storage_, file](const Progress& progress) {
        const auto saved = trephine::saveExercise(exercise, folder, storage, progress);
        if (saved) *file = *saved;
        return saved ? Status() : Status(saved.error());
      },
      [this, file, then = std::move(then)] {
        opened_ = onDisk(*file);
        shown_ = *file;  // the same exercise: a text that was not taken stays
        workstation_.exerciseSaved(*file);
        emit saved();
        emit exercisesChanged();
        if (then) then();
      });
}

// One that no exercise in the list has.
std::string ExerciseTab::freeName(const std::string& wanted) const {
  std::set<std::string> taken;
  for (const auto& file : exercises()) {
    if (const Result<Exercise> exercise = readExercise(file)) taken.insert(exercise->name);
  }
  std::string name = wanted;
  for (int n = 2; taken.contains(name); ++n) name = wanted + " (" + std::to_string(n) + ")";
  return name;
}

void ExerciseTab::tryIt() {
  if (!workstation_.currentCase()) return messages_.say(tr("Open a case first."));
  guards_.takeTyped();
  draw(false);
  emit tryWanted();
}

// --- To and from other workstations ---

void ExerciseTab::exportIt() {
  if (!workstation_.currentCase()) return messages_.say(tr("Open a case first."));
  guards_.takeTyped();
  if (!structuresInCase()) {
    QMessageBox* question =
        ask(messages_.window(), "exportQuestion",
            tr("The structures have been changed and are not saved in the case."),
            tr("The exercise goes with those of the case as it was saved."),
            tr("Export &without the changes"), [this] { exportSaved(); });
    if (!workstation_.currentCase()->stored.empty()) {
      orElse(*question, "saveInCaseFirst", tr("Save in the &case"),
             [this] { saveInCase([this] { exportSaved(); }); });
    }
    return;
  }
  exportSaved();
}

void ExerciseTab::exportSaved() {
  const bool saved =
      isOwn() && !workstation_.exerciseEdited() && !workstation_.tissuesUnlikeExercise();
  if (!saved) return save(false, [this] { exportSaved(); });
  messages_.askForNewFolder(
      "exportExerciseDialog", tr("Export the exercise as a new folder"),
      toQt(plainName(workstation_.exercise()->name,
                     workstation_.exerciseFile().parent_path().filename().string())),
      [this, exercise = workstation_.exerciseFile()](const std::filesystem::path& folder) {
        workstation_.save(tr("The exercise is exported: one folder with all that it needs."),
                          [exercise, folder](const Progress& progress) {
                            const auto done = trephine::exportExercise(exercise, "", folder,
                                                                       progress, hideNamesOf);
                            return done ? Status() : Status(done.error());
                          });
      });
}

void ExerciseTab::importIt() {
  QFileDialog* dialog =
      messages_.fileDialog("importExerciseDialog", tr("Import an exercise: its folder"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& folder) { emit takeInWanted(toPath(folder)); });
  dialog->open();
}

}  // namespace trephine
