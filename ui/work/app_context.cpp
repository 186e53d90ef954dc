#include "ui/work/app_context.h"

#include <QDir>
#include <QStandardPaths>

#include "base/file.h"
#include "base/tr.h"
#include "exchange/exercise_folder.h"
#include "library/case_folders.h"
#include "library/case_picture.h"
#include "library/codes.h"
#include "library/stored_case.h"
#include "ui/codes.h"
#include "ui/common/actions.h"
#include "ui/common/preferences.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

std::filesystem::path storageFolder(const Policy& policy) {
  if (!policy.storage.empty()) return policy.storage;
  const QString chosen = read(settings::kStorage);
  return toPath(QDir::isAbsolutePath(chosen)
                    ? chosen
                    : QStandardPaths::writableLocation(QStandardPaths::AppDataLocation));
}

// Of the case that an exercise brought along, beside it, as cases have one. Without it the list
// shows none.
void makePicture(const std::filesystem::path& exercise_file) {
  const std::filesystem::path file = exercise_file.parent_path() / case_folders::kPictureFile;
  const Result<Exercise> exercise = readExercise(exercise_file);
  std::error_code ec;
  const bool brought = exercise && !exercise->case_source.empty() &&
                       !phantomNamed(exercise->case_source) && !std::filesystem::exists(file, ec);
  if (!brought) return;
  const Result<Case> of = readCase(exercise->case_source);
  if (!of) return;
  const bool head = exercise->anatomy == exerciseAnatomy(BodyRegion::head);
  const CasePicture picture =
      casePicture(*of->volume, head ? BodyRegion::head : BodyRegion::abdomen);
  (void)writeTextFile(file, pngOf(picture));
}

std::string list(const std::vector<std::string>& files) {
  std::string words;
  for (const std::string& file : files) words += (words.empty() ? "" : ", ") + file;
  return words;
}

// Why nothing was imported, part by part.
Error notVerified(const ExerciseCheck& check) {
  const std::string missing = list(check.missing), changed = list(check.changed);
  const std::string what =
      missing.empty() && changed.empty() ? trephine::tr("The exercise is not as it was exported")
      : changed.empty()
          ? trephine::tr("The exercise is not as it was exported; missing: {}", missing)
      : missing.empty()
          ? trephine::tr("The exercise is not as it was exported; changed: {}", changed)
          : trephine::tr("The exercise is not as it was exported; missing: {}; changed: {}",
                         missing, changed);
  return {code::kNotVerified, what, trephine::tr("the folder"),
          trephine::tr("Export it anew, or copy the whole folder again")};
}

}  // namespace

AppContext::AppContext(QMainWindow& window, std::filesystem::path recordings, const Policy& policy)
    : QObject(&window),
      storage_(recordings.empty() ? storageFolder(policy) : recordings.parent_path()),
      recordings_(recordings.empty() ? storage_ / "sessions" : std::move(recordings)),
      library_(std::make_shared<CaseLibrary>(storage_)),
      messages_(window),
      workstation_(policy),
      guards_(workstation_, messages_),
      case_views_(window, workstation_, messages_, guards_) {
  undo_ = makeAction(window, Symbol::undo, "undo", tr("Undo"), Qt::CTRL | Qt::Key_Z,
                     tr("Put the last stroke's tissue back"));
  redo_ = makeAction(window, Symbol::redo, "redo", tr("Redo"), Qt::CTRL | Qt::SHIFT | Qt::Key_Z,
                     tr("Cut the stroke again"));
  redo_->setShortcuts(
      {QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), QKeySequence(Qt::CTRL | Qt::Key_Y)});
  // After the views have shown it.
  connect(&workstation_, &Workstation::caseOpened, this, [this] {
    came_ = true;
    if (workstation_.placed()) go(std::exchange(once_open_, Place::prepare));
  });
  // At once, where what it needs time for is shown; and back where nothing came of it.
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    const bool opening = workstation_.opensAnotherCase();
    if (std::exchange(opening_, opening) == opening) return;
    if (opening) {
      came_ = false;
      before_opening_ = shown_;
      return go(once_open_);
    }
    QMetaObject::invokeMethod(
        this,
        [this] {
          if (workstation_.opensAnotherCase()) return;  // the next one
          if (came_) return;
          once_open_ = Place::prepare;
          go(before_opening_);
        },
        Qt::QueuedConnection);
  });
  connect(&workstation_, &Workstation::asked, this, [this] { came_ = true; });
  // What was tried is there no longer.
  connect(&workstation_, &Workstation::exerciseOpening, this, [this] { setTrying(false); });
  connect(&workstation_, &Workstation::caseOpened, this, [this] { setTrying(false); });
  connect(&workstation_, &Workstation::saved, &messages_, &Messages::say);
  connect(&workstation_, &Workstation::failed, this, [this](const Error& error) {
    once_open_ = Place::prepare;
    messages_.report(error);
  });
}

std::vector<std::filesystem::path> AppContext::exercises() const {
  std::vector<std::filesystem::path> files =
      exercisesOfWorkstation(workstation_.policy(), preferences().research);
  for (const auto& file : exercisesIn(storage_)) files.push_back(file);
  return files;
}

void AppContext::openExercise(const std::filesystem::path& file, Place then, bool with_its_case) {
  goOnceOpen(then);
  const Result<Exercise> exercise = readExercise(file);
  const std::filesystem::path cases = storage_ / "cases";
  const std::filesystem::path of = exercise ? std::filesystem::path(exercise->case_source) : "";
  if (of.empty() || of.parent_path().parent_path() != cases.lexically_normal()) {
    // They say what is wrong with it.
    with_its_case ? workstation_.openExercise(file) : workstation_.useExercise(file);
    if (!workstation_.isOpening()) goOnceOpen(Place::prepare);  // it waits for a case
    return;
  }
  const std::string id = of.parent_path().filename().string();
  guards_.setCaseSource(of.parent_path());
  workstation_.openExercise(file, [library = library_, id](const Progress& progress) {
    Result<StoredCase> stored = storedCase(*library, id, progress);
    if (!stored && stored.error().code == code::kNoSuchCase) {
      return Result<StoredCase>(Error{
          code::kNoSuchCase, trephine::tr("The case of this exercise is not on this workstation"),
          "", trephine::tr("Import the exercise with its case, or choose another case for it")});
    }
    if (stored) {  // the exercise's own are felt
      stored->tissues.reset();
      stored->no_tissues.reset();
    }
    return stored;
  });
}

bool AppContext::changesCase(const std::filesystem::path& exercise_file, bool with_its_case) const {
  const Case* of = workstation_.currentCase();
  const Result<Exercise> exercise = readExercise(exercise_file);
  if (!of || !exercise || exercise->case_source.empty()) return false;
  return with_its_case || of->built_in || !phantomNamed(exercise->case_source);
}

void AppContext::openUnlessLost(const std::filesystem::path& file, Place then, bool with_its_case) {
  std::vector<UnsavedWork> losses{UnsavedWork::cuts};
  if (changesCase(file, with_its_case)) losses = WorkGuards::ofTheCase();
  losses.push_back(UnsavedWork::tissues);
  guards_.unlessLost(losses, [=, this] { openExercise(file, then, with_its_case); });
}

void AppContext::takeInExercise(const std::filesystem::path& folder, Place then) {
  auto exercise = std::make_shared<std::filesystem::path>();
  workstation_.save(
      tr("The exercise is imported."),
      [from = folder, storage = storage_, exercise](const Progress& progress) -> Status {
        const auto imported = importExercise(from, storage, progress);
        if (!imported) return imported.error();
        if (!imported->check.verified()) return notVerified(imported->check);
        *exercise = imported->exercise;
        makePicture(imported->exercise);
        return {};
      },
      [this, exercise, then] {
        tellExercises();
        openUnlessLost(*exercise, then, true);
      });
}

}  // namespace trephine
