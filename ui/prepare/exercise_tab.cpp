#include "ui/prepare/exercise_tab.h"

#include <QFileDialog>
#include <QMessageBox>
#include <set>

#include "base/file.h"
#include "base/json.h"
#include "exercise/exercise_folder.h"
#include "library/case_folders.h"
#include "library/name_words.h"
#include "session/operator_script.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

std::string list(const std::vector<std::string>& files) {
  std::string words;
  for (const std::string& file : files) words += (words.empty() ? "" : ", ") + file;
  return words;
}

// Why nothing was imported, part by part.
Error notVerified(const ExerciseCheck& check) {
  std::string what = "The exercise is not as it was exported";
  if (!check.missing.empty()) what += "; missing: " + list(check.missing);
  if (!check.changed.empty()) what += "; changed: " + list(check.changed);
  return {"NOT_VERIFIED", what, "the folder", "Export it anew, or copy the whole folder again"};
}

}  // namespace

ExerciseTab::ExerciseTab(Bench& bench, ExerciseForm& form)
    : QObject(&bench),
      bench_(bench),
      workstation_(bench.workstation()),
      views_(&bench.views()),
      form_(&form) {
  form_->wanted = [this](const std::string& what, const auto& change) {
    return workstation_.edit(what, change);
  };
  connect(form_, &ExerciseForm::drawingWanted, this, &ExerciseTab::draw);
  connect(form_, &ExerciseForm::entryWanted, this, [this] {
    views_->setTool(SliceTool::entry);
    entry_once_ = true;
  });
  connect(form_, &ExerciseForm::looksWanted, this, [this] {
    if (!workstation_.scene()) return;
    const Status done = workstation_.edit("looks", [this](Scene& scene) {
      scene.view.looks.clear();
      for (const auto& [id, look] : workstation_.looks()) {
        if (scene.tissues.find(id)) scene.view.looks[id] = look;
      }
    });
    done ? bench_.say(tr("The exercise begins with these looks.")) : bench_.report(done.error());
  });
  connect(form_, &ExerciseForm::operatorWanted, this, [this] {
    bench_.askForFile("operatorDialog", tr("An operator script"), tr("Scripts (*.json)"),
                      [this](const auto& file) {
                        if (!workstation_.scene()) return;
                        const auto script = readOperatorScript(file, *workstation_.scene());
                        if (!script) return bench_.report(script.error());
                        form_->setOperator(file.string());
                      });
  });
  connect(form_, &ExerciseForm::labelsWanted, this, &ExerciseTab::labelsWanted);
  connect(form_, &ExerciseForm::elsewhereChosen, this, &ExerciseTab::takeElsewhere);
  connect(form_, &ExerciseForm::elsewhereWanted, this, [this] {
    bench_.askForFile("elsewhereDialog", tr("Tissues for other cases"), tr("Tissues (*.json)"),
                      [this](const auto& file) { takeElsewhere(file); });
  });
  connect(form_, &ExerciseForm::saveWanted, this, [this] { save(false, {}); });
  connect(form_, &ExerciseForm::saveCopyWanted, this, [this] { save(true, {}); });
  connect(form_, &ExerciseForm::tryWanted, this, &ExerciseTab::tryIt);
  connect(form_, &ExerciseForm::exportWanted, this, &ExerciseTab::exportIt);
  connect(form_, &ExerciseForm::importWanted, this, &ExerciseTab::importIt);
  connect(views_, &FourUp::structureClicked, this, [this](SliceTool tool, const Vec3& at_mm) {
    if (tool == SliceTool::outline) outlineClicked(at_mm);
  });
  connect(views_, &FourUp::toolChanged, this, [this](SliceTool tool) {
    form_->showDrawing(tool == SliceTool::outline);
    entry_once_ = false;
  });
  connect(&workstation_, &Workstation::sceneOpening, this,
          [this](const Scene&, const std::filesystem::path& file) { opened_ = onDisk(file); });
  connect(&workstation_, &Workstation::caseOpened, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::caseNamed, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::structuresChanged, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::locksChanged, this, &ExerciseTab::refresh);
  connect(&workstation_, &Workstation::editsChanged, this, &ExerciseTab::refresh);
}

void ExerciseTab::takeElsewhere(const std::filesystem::path& file) {
  const Result<TissueSet> set = readTissueSet(file);
  set ? form_->setElsewhere(*set) : bench_.report(set.error());
}

void ExerciseTab::show(bool in_front) {
  in_front_ = in_front;
  if (!in_front_) draw(false);
  refresh();
}

// A threshold that is dragged pays for no form that nobody sees.
void ExerciseTab::refresh() {
  if (!in_front_ || !workstation_.scene()) return;
  form_->setLocked(workstation_.anyLocked()
                       ? tr("The exercise is locked. %1.").arg(unlockWords(workstation_.policy()))
                       : QString());
  form_->setElsewherePossible(!workstation_.isElsewhere());
  const std::optional<Placement>& placed = workstation_.placed();
  form_->setScene(*workstation_.scene(),
                  placed ? placed->landmarks : std::vector<PlacedLandmark>());
  form_->showCase(caseWords());
  const bool edited = workstation_.sceneEdited() || workstation_.tissuesEdited();
  form_->showSaved(isOwn() ? edited ? tr("Changed since it was saved.")
                                    : tr("Saved on this workstation.")
                           : tr("It came from elsewhere: saving makes one of your own of it."));
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
  outline_first_.reset();
  if (on == (views_->tool() == SliceTool::outline)) return;
  views_->setTool(on ? SliceTool::outline : SliceTool::window);
  if (on) bench_.say(tr("Each click on the surface adds a point to the outline. Esc: done."));
}

void ExerciseTab::outlineClicked(const Vec3& at_mm) {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed || placed->landmarks.empty()) return;
  const std::vector<PlacedLandmark>& landmarks = placed->landmarks;
  const Scene& scene = *workstation_.scene();
  // It goes with the landmark that is looked at, or the first.
  const PlacedLandmark* with = &landmarks.front();
  for (const PlacedLandmark& landmark : landmarks) {
    if (landmark.id == scene.view.landmark) with = &landmark;
  }
  if (!scene.outline && !outline_first_) {
    outline_first_ = at_mm;
    return bench_.say(tr("The first point is set: click the next."));
  }
  SceneOutline outline;
  if (scene.outline) {
    const auto here = placedOutline(*scene.outline, landmarks);
    outline = here ? *here : *scene.outline;
  } else {
    outline.points_mm = {*outline_first_};
    outline.frame = SceneOutline::Frame{with->id, with->frame};
  }
  outline.points_mm.push_back(at_mm);
  const Status done = workstation_.edit("outline", [&](Scene& now) { now.outline = outline; });
  if (!done) return bench_.report(done.error());
  outline_first_.reset();
  bench_.say(tr("The outline has %1 points. Esc: done.").arg(outline.points_mm.size()));
}

// --- Saving, trying ---

bool ExerciseTab::isOwn() const {
  const std::filesystem::path& file = workstation_.sceneFile();
  return file.parent_path().parent_path() == bench_.storage() / "exercises";
}

// With the case that is open, as it lies in the library.
std::optional<Scene> ExerciseTab::sceneToSave() {
  if (!workstation_.scene() || !workstation_.currentCase()) return {};
  const Case& of = *workstation_.currentCase();
  // What holds of another case alone stays behind, but for the tissues, which have a set for each.
  const Scene& made = *workstation_.scene();
  Scene scene = onCase(made, of.source);
  scene.tissues = made.tissues;
  scene.tissues_elsewhere = made.tissues_elsewhere;
  if (of.built_in) return scene;
  if (of.stored.empty()) {
    bench_.report({"CASE_NOT_SAVED", "The case of the exercise is not in the library", "",
                   "Save the case first (Cases), or import it again where it was deleted"});
    return {};
  }
  const std::filesystem::path folder = bench_.storage() / "cases" / of.stored;
  scene.case_source = (folder / case_folders::kVolumeFile).string();
  const std::filesystem::path structures = folder / case_folders::kStructuresFile;
  std::error_code ec;
  scene.labels_file =
      std::filesystem::is_regular_file(structures, ec) ? structures.string() : std::string();
  return scene;
}

ExerciseTab::OnDisk ExerciseTab::onDisk(const std::filesystem::path& file) {
  const Result<std::string> text = readWholeFile(file, kMostWrittenBytes);
  return {file, text ? *text : std::string()};
}

// Something of a person's would go: it is replaced, or stays and this one is saved beside it.
void ExerciseTab::askToReplace(const char* name, const QString& why, const QString& what,
                               const Bench::Next& replace, const Bench::Next& then) {
  QMessageBox* question = ask(bench_.window(), name, why, what, tr("&Replace it"), replace);
  orElse(*question, "saveBeside", tr("Save a &copy"), [this, then] { save(true, then); });
}

void ExerciseTab::save(bool copy, Bench::Next then, bool on_another_case) {
  if (!then && workstation_.isWriting()) return bench_.say(tr("It is being saved."));
  bench_.takeTyped();
  std::optional<Scene> scene = sceneToSave();
  if (!scene) return;
  const bool in_place = isOwn() && !copy;
  const OnDisk now = onDisk(workstation_.sceneFile());
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
  if (copy && isOwn()) scene->name = tr("Copy of %1").arg(toQt(scene->name)).toStdString();
  if (in_place && !on_another_case) {
    const Result<Scene> there = readScene(now.file);
    const auto place = [](const std::string& source) {
      return std::filesystem::path(source).lexically_normal();
    };
    if (there && place(there->case_source) != place(scene->case_source)) {
      return askToReplace(
          "madeOnAnotherCase", tr("This exercise was made on another case."),
          tr("Save it on the open case as another one, or in the place of the one that is there."),
          [this, then] { save(false, then, true); }, then);
    }
  }
  if (!in_place) scene->name = freeName(scene->name);
  const std::filesystem::path folder = in_place ? workstation_.sceneFile().parent_path()
                                                : freshExercise(bench_.storage(), scene->name);
  auto file = std::make_shared<std::filesystem::path>();
  workstation_.save(
      tr("The exercise \"%1\" is saved.").arg(toQt(scene->name)),
      [scene = *scene, folder, storage = bench_.storage(), file](const Progress& progress) {
        const auto saved = trephine::saveExercise(scene, folder, storage, progress);
        if (saved) *file = *saved;
        return saved ? Status() : Status(saved.error());
      },
      [this, file, then = std::move(then)] {
        opened_ = onDisk(*file);
        workstation_.exerciseSaved(*file);
        emit saved();
        bench_.tellExercises();
        if (then) then();
      });
}

// One that no exercise in the list has.
std::string ExerciseTab::freeName(const std::string& wanted) const {
  std::set<std::string> taken;
  for (const auto& file : bench_.exercises()) {
    if (const Result<Scene> scene = readScene(file)) taken.insert(scene->name);
  }
  std::string name = wanted;
  for (int n = 2; taken.contains(name); ++n) name = wanted + " (" + std::to_string(n) + ")";
  return name;
}

void ExerciseTab::tryIt() {
  if (!workstation_.currentCase()) return bench_.say(tr("Open a case first."));
  bench_.takeTyped();
  draw(false);
  bench_.go(Place::train);
  bench_.setTrying(true);
}

// --- To and from other workstations ---

void ExerciseTab::exportIt() {
  if (!workstation_.currentCase()) return bench_.say(tr("Open a case first."));
  bench_.takeTyped();
  if (!structuresInCase()) {
    QMessageBox* question =
        ask(bench_.window(), "exportQuestion",
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
  const bool saved = isOwn() && !workstation_.sceneEdited() && !workstation_.tissuesEdited();
  if (!saved) return save(false, [this] { exportSaved(); });
  bench_.askForNewFolder(
      "exportExerciseDialog", tr("Export the exercise as a new folder"),
      toQt(workstation_.sceneFile().parent_path().filename()),
      [this, scene = workstation_.sceneFile()](const std::filesystem::path& folder) {
        workstation_.save(tr("The exercise is exported: one folder with all that it needs."),
                          [scene, folder](const Progress& progress) {
                            const auto done =
                                trephine::exportExercise(scene, "", folder, progress, hideNamesOf);
                            return done ? Status() : Status(done.error());
                          });
      });
}

void ExerciseTab::importIt() {
  QFileDialog* dialog =
      bench_.fileDialog("importExerciseDialog", tr("Import an exercise: its folder"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& folder) {
    auto scene = std::make_shared<std::filesystem::path>();
    auto without_devices = std::make_shared<bool>(false);
    workstation_.save(
        tr("The exercise is imported."),
        [from = toPath(folder), storage = bench_.storage(), scene,
         without_devices](const Progress& progress) -> Status {
          const auto imported = trephine::importExercise(from, storage, progress);
          if (!imported) return imported.error();
          if (!imported->check.verified()) return notVerified(imported->check);
          *scene = imported->scene;
          *without_devices = imported->left_devices_out;
          return {};
        },
        [this, scene, without_devices] {
          if (*without_devices) {
            bench_.say(
                tr("The exercise is imported. It named devices and how they are set: those "
                   "of this workstation are used instead."));
          }
          bench_.tellExercises();
          bench_.unlessLost({Bench::Loss::structures, Bench::Loss::cuts, Bench::Loss::tissues},
                            [this, scene] { bench_.openExercise(*scene, Place::prepare); });
        });
  });
  dialog->open();
}

}  // namespace trephine
