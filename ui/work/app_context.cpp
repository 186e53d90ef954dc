#include "ui/work/app_context.h"

#include <QDir>
#include <QStandardPaths>

#include "base/tr.h"
#include "exchange/exercise_folder.h"
#include "library/codes.h"
#include "library/stored_case.h"
#include "ui/common/actions.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

std::filesystem::path storageFolder(const Policy& policy) {
  if (!policy.storage.empty()) return policy.storage;
  const QString chosen = read(settings::kStorage);
  return toPath(QDir::isAbsolutePath(chosen)
                    ? chosen
                    : QStandardPaths::writableLocation(QStandardPaths::AppDataLocation));
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
    if (workstation_.placed()) go(std::exchange(once_open_, Place::prepare));
  });
  connect(&workstation_, &Workstation::saved, &messages_, &Messages::say);
  connect(&workstation_, &Workstation::failed, this, [this](const Error& error) {
    once_open_ = Place::prepare;
    messages_.report(error);
  });
}

std::vector<std::filesystem::path> AppContext::exercises() const {
  std::vector<std::filesystem::path> files = exercisesOfWorkstation(workstation_.policy());
  for (const auto& file : exercisesIn(storage_)) files.push_back(file);
  return files;
}

void AppContext::openExercise(const std::filesystem::path& file, Place then) {
  goOnceOpen(then);
  const Result<Exercise> exercise = readExercise(file);
  const std::filesystem::path cases = storage_ / "cases";
  const std::filesystem::path of = exercise ? std::filesystem::path(exercise->case_source) : "";
  if (of.empty() || of.parent_path().parent_path() != cases.lexically_normal()) {
    return workstation_.useExercise(file);  // which says what is wrong with it
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

}  // namespace trephine
