// The exercise itself: its form, the outline that is clicked, saving it, trying it, and taking it to
// other workstations.
#include <QFileDialog>
#include <set>

#include "exercise/exercise_folder.h"
#include "library/case_folders.h"
#include "ui/common/words.h"
#include "ui/prepare/prepare_workspace.h"
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

void PrepareWorkspace::connectExercise() {
  form_->wanted = [this](const std::string& what, const auto& change) {
    return changeScene(what, change);
  };
  connect(form_, &ExerciseForm::drawingWanted, this, &PrepareWorkspace::draw);
  connect(form_, &ExerciseForm::entryWanted, this, [this] {
    views_->setTool(SliceTool::entry);
    entry_once_ = true;
  });
  connect(form_, &ExerciseForm::looksWanted, this, [this] {
    if (!workstation_.scene()) return;
    const Status done = changeScene("looks", [this](Scene& scene) {
      scene.view.looks.clear();
      for (const auto& [id, look] : workstation_.looks()) {
        if (scene.tissues.find(id)) scene.view.looks[id] = look;
      }
    });
    done ? bench_.say(tr("The exercise begins with these looks.")) : bench_.report(done.error());
  });
  connect(form_, &ExerciseForm::operatorWanted, this, [this] {
    bench_.askForFile("operatorDialog", tr("An operator script"), tr("Scripts (*.json)"),
                      [this](const auto& file) { form_->setOperator(file.string()); });
  });
  connect(form_, &ExerciseForm::saveWanted, this, [this] { saveExercise(false, {}); });
  connect(form_, &ExerciseForm::saveCopyWanted, this, [this] { saveExercise(true, {}); });
  connect(form_, &ExerciseForm::tryWanted, this, &PrepareWorkspace::tryExercise);
  connect(form_, &ExerciseForm::exportWanted, this, &PrepareWorkspace::exportExercise);
  connect(form_, &ExerciseForm::importWanted, this, &PrepareWorkspace::importExercise);
  connect(views_, &FourUp::structureClicked, this, [this](SliceTool tool, const Vec3& at_mm) {
    if (tool == SliceTool::outline) outlineClicked(at_mm);
  });
  connect(views_, &FourUp::toolChanged, this, [this](SliceTool tool) {
    form_->showDrawing(tool == SliceTool::outline);
    entry_once_ = false;
  });
  connect(&workstation_, &Workstation::locksChanged, this, &PrepareWorkspace::showExercise);
  connect(&workstation_, &Workstation::editsChanged, this, &PrepareWorkspace::showExercise);
}

// In the tab that is in front: a threshold that is dragged pays for no form that nobody sees.
void PrepareWorkspace::showExercise() {
  showArms();
  const int tab = tabs_->currentIndex();
  if (!workstation_.scene() || (tab != kToolTab && tab != kExerciseTab)) return;
  const QString locked =
      workstation_.anyLocked()
          ? tr("The exercise is locked. %1.").arg(unlockWords(workstation_.policy()))
          : QString();
  tools_->setLocked(locked);
  form_->setLocked(locked);
  if (tab == kToolTab) {
    tools_->setScene(*workstation_.scene());
    return showArms();  // which arm is chosen is known now
  }
  form_->setScene(*workstation_.scene());
  const bool edited = workstation_.sceneEdited() || workstation_.tissuesEdited();
  form_->showSaved(isOwnExercise()
                       ? edited ? tr("Changed since it was saved.")
                                : tr("Saved on this workstation.")
                       : tr("It came from elsewhere: saving makes one of your own of it."));
}

// --- The outline ---

void PrepareWorkspace::draw(bool on) {
  outline_first_.reset();
  if (on == (views_->tool() == SliceTool::outline)) return;
  views_->setTool(on ? SliceTool::outline : SliceTool::window);
  if (on) bench_.say(tr("Each click on the surface adds a point to the outline. Esc: done."));
}

void PrepareWorkspace::outlineClicked(const Vec3& at_mm) {
  const std::optional<Case>& of = workstation_.currentCase();
  if (!workstation_.scene() || !of || of->landmarks.empty()) return;
  const Scene& scene = *workstation_.scene();
  // It goes with the landmark that is looked at, or the first.
  const PlacedLandmark* with = &of->landmarks.front();
  for (const PlacedLandmark& landmark : of->landmarks) {
    if (landmark.id == scene.view.landmark) with = &landmark;
  }
  if (!scene.outline && !outline_first_) {
    outline_first_ = at_mm;
    return bench_.say(tr("The first point is set: click the next."));
  }
  SceneOutline outline;
  if (scene.outline) {
    const auto here = placedOutline(*scene.outline, of->landmarks);
    outline = here ? *here : *scene.outline;
  } else {
    outline.points_mm = {*outline_first_};
    outline.frame = SceneOutline::Frame{with->id, with->frame};
  }
  outline.points_mm.push_back(at_mm);
  const Status done = changeScene("outline", [&](Scene& now) { now.outline = outline; });
  if (!done) return bench_.report(done.error());
  outline_first_.reset();
}

// --- Saving, trying ---

bool PrepareWorkspace::isOwnExercise() const {
  const std::filesystem::path& file = workstation_.sceneFile();
  return file.parent_path().parent_path() == bench_.storage() / "exercises";
}

// With the case that is open, as it lies in the library.
std::optional<Scene> PrepareWorkspace::sceneToSave() {
  if (!workstation_.scene() || !workstation_.currentCase()) return {};
  Scene scene = *workstation_.scene();
  const Case& of = *workstation_.currentCase();
  if (of.built_in) return scene;
  if (of.stored.empty()) {
    bench_.report({"CASE_NOT_SAVED", "The case of the exercise is not in the library yet", "",
                   "Save the case first: Cases, Save the case"});
    return {};
  }
  const std::filesystem::path folder = bench_.storage() / "cases" / of.stored;
  scene.case_source = (folder / kVolumeFile).string();
  const std::filesystem::path structures = folder / kStructuresFile;
  std::error_code ec;
  scene.labels_file =
      std::filesystem::is_regular_file(structures, ec) ? structures.string() : std::string();
  return scene;
}

void PrepareWorkspace::saveExercise(bool copy, Bench::Next then) {
  std::optional<Scene> scene = sceneToSave();
  if (!scene) return;
  const bool in_place = isOwnExercise() && !copy;
  if (copy && isOwnExercise()) scene->name = tr("Copy of %1").arg(toQt(scene->name)).toStdString();
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
      [this, file, name = scene->name, then = std::move(then)] {
        if (workstation_.scene() && workstation_.scene()->name != name) {
          Scene named = *workstation_.scene();
          named.name = name;
          (void)workstation_.edit(named, "exercise name");
        }
        workstation_.exerciseSaved(*file);
        tissues_touched_ = false;
        bench_.tellExercises();
        if (then) then();
      });
}

// One that no exercise in the list has.
std::string PrepareWorkspace::freeName(const std::string& wanted) const {
  std::set<std::string> taken;
  for (const auto& file : bench_.exercises()) {
    if (const Result<Scene> scene = readScene(file)) taken.insert(scene->name);
  }
  std::string name = wanted;
  for (int n = 2; taken.contains(name); ++n) name = wanted + " (" + std::to_string(n) + ")";
  return name;
}

void PrepareWorkspace::tryExercise() {
  if (!workstation_.currentCase()) return bench_.say(tr("Open a case first."));
  draw(false);
  bench_.go(Place::train);
  bench_.setTrying(true);
}

// --- To and from other workstations ---

void PrepareWorkspace::exportExercise() {
  if (!workstation_.currentCase()) return bench_.say(tr("Open a case first."));
  const bool saved =
      isOwnExercise() && !workstation_.sceneEdited() && !workstation_.tissuesEdited();
  if (!saved) return saveExercise(false, [this] { exportExercise(); });
  bench_.askForNewFolder(
      "exportExerciseDialog", tr("Export the exercise as a new folder"),
      toQt(workstation_.sceneFile().parent_path().filename()),
      [this, scene = workstation_.sceneFile()](const std::filesystem::path& folder) {
        workstation_.save(tr("The exercise is exported: one folder with all that it needs."),
                          [scene, folder](const Progress& progress) {
                            const auto done = trephine::exportExercise(scene, "", folder, progress);
                            return done ? Status() : Status(done.error());
                          });
      });
}

void PrepareWorkspace::importExercise() {
  QFileDialog* dialog =
      bench_.fileDialog("importExerciseDialog", tr("Import an exercise: its folder"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& folder) {
    auto scene = std::make_shared<std::filesystem::path>();
    workstation_.save(
        tr("The exercise is imported."),
        [from = toPath(folder), storage = bench_.storage(),
         scene](const Progress& progress) -> Status {
          const auto imported = trephine::importExercise(from, storage, progress);
          if (!imported) return imported.error();
          if (!imported->check.verified()) return notVerified(imported->check);
          *scene = imported->scene;
          return {};
        },
        [this, scene] {
          bench_.tellExercises();
          bench_.unlessLost({Bench::Loss::structures, Bench::Loss::cuts, Bench::Loss::tissues},
                            [this, scene] { bench_.openExercise(*scene, Place::prepare); });
        });
  });
  dialog->open();
}

}  // namespace trephine
