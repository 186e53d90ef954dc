// The exercise itself: its form, the outline that is clicked, saving it, trying it, and taking it to
// other workstations.
#include <QFileDialog>
#include <set>

#include "exercise/exercise_folder.h"
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
  form_->wanted = [this](const Scene& scene, const std::string& what) {
    return sceneWanted(scene, what);
  };
  connect(form_, &ExerciseForm::drawingWanted, this, &PrepareWorkspace::draw);
  connect(form_, &ExerciseForm::entryWanted, this, [this] {
    views_->setTool(SliceTool::entry);
    entry_once_ = true;
  });
  connect(form_, &ExerciseForm::looksWanted, this, [this] {
    if (!workstation_.scene()) return;
    Scene scene = *workstation_.scene();
    scene.view.looks.clear();
    for (const auto& [id, look] : workstation_.looks()) {
      if (scene.tissues.find(id)) scene.view.looks[id] = look;
    }
    const Status done = sceneWanted(scene, "looks");
    done ? bench_.say(tr("The exercise begins with these looks.")) : bench_.report(done.error());
  });
  connect(form_, &ExerciseForm::operatorWanted, this, [this] {
    QFileDialog* dialog =
        bench_.fileDialog("operatorDialog", tr("An operator script"), tr("Scripts (*.json)"));
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
      form_->setOperator(toPath(file).string());
    });
    dialog->open();
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

void PrepareWorkspace::showExercise() {
  if (!workstation_.scene()) return;
  const QString locked =
      workstation_.anyLocked()
          ? tr("The exercise is locked. %1.").arg(unlockWords(workstation_.policy()))
          : QString();
  tools_->setLocked(locked);
  form_->setLocked(locked);
  tools_->setScene(*workstation_.scene());
  form_->setScene(*workstation_.scene());
  const bool edited = workstation_.sceneEdited() || workstation_.tissuesEdited();
  form_->showSaved(isOwnExercise()
                       ? edited ? tr("Changed since it was saved.") : tr("Saved on this workstation.")
                       : tr("It came from elsewhere: saving makes one of your own of it."));
  showArms();
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
  Scene scene = *workstation_.scene();
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
  scene.outline = outline;
  const Status done = sceneWanted(scene, "outline");
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
  scene.case_source = (folder / "volume.mha").string();
  const std::filesystem::path structures = folder / "structures.seg.nrrd";
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
  std::vector<std::filesystem::path> files = scenesOfWorkstation(workstation_.policy());
  for (const auto& file : exercisesIn(bench_.storage())) files.push_back(file);
  for (const auto& file : files) {
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
  QFileDialog* dialog =
      bench_.fileDialog("exportExerciseDialog", tr("Export the exercise as a new folder"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  dialog->selectFile(toQt(workstation_.sceneFile().parent_path().filename()));
  dialog->setLabelText(QFileDialog::FileName, tr("New folder:"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, scene = workstation_.sceneFile()](const QString& folder) {
            workstation_.save(tr("The exercise is exported: one folder with all that it needs."),
                              [scene, to = toPath(folder)](const Progress& progress) {
                                const auto done =
                                    trephine::exportExercise(scene, "", to, progress);
                                return done ? Status() : Status(done.error());
                              });
          });
  dialog->open();
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
