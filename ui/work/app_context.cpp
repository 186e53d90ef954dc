#include "ui/work/app_context.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QFileInfo>
#include <QLineEdit>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QRegularExpression>

#include "base/log.h"
#include "exchange/exercise_folder.h"
#include "library/codes.h"
#include "library/stored_case.h"
#include "ui/common/actions.h"
#include "ui/common/error_dialog.h"
#include "ui/common/event_loop.h"
#include "ui/common/question.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/views/saved_picture.h"

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
      window_(window),
      storage_(recordings.empty() ? storageFolder(policy) : recordings.parent_path()),
      recordings_(recordings.empty() ? storage_ / "sessions" : std::move(recordings)),
      library_(std::make_shared<CaseLibrary>(storage_)),
      views_(new FourUp(&window)),
      workstation_(policy) {
  undo_ = makeAction(window_, Symbol::undo, "undo", tr("Undo"), QKeySequence(Qt::CTRL | Qt::Key_Z),
                     tr("Put the last stroke's tissue back"));
  redo_ = makeAction(window_, Symbol::redo, "redo", tr("Redo"),
                     QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), tr("Cut the stroke again"));
  redo_->setShortcuts(
      {QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), QKeySequence(Qt::CTRL | Qt::Key_Y)});
  setGuard(UnsavedWork::cuts, [this](Next go_on) { unlessCutsAreLost(std::move(go_on)); });
  connect(&workstation_, &Workstation::caseOpened, this, &AppContext::showCase);
  connect(&workstation_, &Workstation::startFailed, this, [this] {
    if (carved_) showWholeCase();
  });
  connect(&workstation_, &Workstation::saved, this, &AppContext::say);
  connect(&workstation_, &Workstation::failed, this, [this](const Error& error) {
    once_open_ = Place::prepare;
    report(error);
  });
  connect(&views_->threeD(), &ViewWidget::failed, this, &AppContext::report);
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
  setCaseSource(of.parent_path());
  workstation_.openExercise(file, [library = library_, id](const Progress& progress) {
    Result<StoredCase> stored = storedCase(*library, id, progress);
    if (!stored && stored.error().code == code::kNoSuchCase) {
      return Result<StoredCase>(
          Error{code::kNoSuchCase, "The case of this exercise is not on this workstation", "",
                "Import the exercise with its case, or choose another case for it"});
    }
    if (stored) {  // the exercise's own are felt
      stored->tissues.reset();
      stored->no_tissues.reset();
    }
    return stored;
  });
}

void AppContext::setTrying(bool trying) {
  if (std::exchange(trying_, trying) != trying) emit tryingChanged();
}

void AppContext::report(const Error& error) {
  spdlog::warn("Said in the window: {}", error.code.str());  // no more: the rest may name files
  showError(asking(), error);
  emit failed(error);
}

// Over a dialog that is open, so that the keys come back to it.
QWidget* AppContext::asking() const {
  QWidget* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
  // One that a file was just chosen in is about to go.
  while (qobject_cast<QFileDialog*>(dialog)) dialog = dialog->parentWidget();
  for (const QObject* of = dialog; of; of = of->parent()) {
    if (of == &window_) return dialog;
  }
  return &window_;
}

QFileDialog* AppContext::fileDialog(const char* name, const QString& title, const QString& filter) {
  auto* dialog = new QFileDialog(asking(), title, {}, filter);
  dialog->setObjectName(name);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  // Where files of this kind were last: Qt's own memory is one place for all kinds.
  QString& last = folders_[name + filter];
  dialog->setDirectory(last.isEmpty() ? QDir::homePath() : last);
  connect(dialog, &QFileDialog::fileSelected, this,
          [&last](const QString& file) { last = QFileInfo(file).absolutePath(); });
  return dialog;
}

void AppContext::askForFile(const char* name, const QString& title, const QString& filter,
                            GotPath then) {
  QFileDialog* dialog = fileDialog(name, title, filter);
  connect(dialog, &QFileDialog::fileSelected, this,
          [then = std::move(then)](const QString& file) { then(toPath(file)); });
  dialog->open();
}

// A name that is not there yet is a folder that will be made.
void AppContext::askForNewFolder(const char* name, const QString& title, const QString& suggestion,
                                 GotPath then) {
  QFileDialog* dialog = fileDialog(name, title);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  dialog->selectFile(suggestion);
  dialog->setLabelText(QFileDialog::FileName, tr("New folder:"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [then = std::move(then)](const QString& folder) { then(toPath(folder)); });
  dialog->open();
}

QFileDialog* AppContext::saveDialog(const QString& title, const QString& suggestion,
                                    const QString& filter) {
  QFileDialog* dialog = fileDialog("saveDialog", title, filter);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  const QFileInfo suggested(suggestion);
  // A name that is free there: nothing is replaced by one that nobody typed.
  const auto free =
      freshFile(toPath(dialog->directory().absolutePath()), suggested.baseName().toStdString(),
                '.' + suggested.completeSuffix().toStdString());
  dialog->selectFile(toQt(free.filename()));
  dialog->setDefaultSuffix(suggested.completeSuffix());
  // A plain name is of the kind that is chosen.
  connect(dialog, &QFileDialog::filterSelected, dialog, [dialog](const QString& chosen) {
    static const QRegularExpression first("\\*\\.([^ )]+)");
    const QString suffix = first.match(chosen).captured(1);
    if (!suffix.isEmpty()) dialog->setDefaultSuffix(suffix);
  });
  return dialog;
}

// --- What would be lost ---

// A field takes what was typed when the focus leaves it.
void AppContext::takeTyped() {
  QWidget* typed = window_.focusWidget();
  const bool field = qobject_cast<QLineEdit*>(typed) || qobject_cast<QPlainTextEdit*>(typed) ||
                     qobject_cast<QAbstractSpinBox*>(typed);
  if (!field) return;
  typed->clearFocus();
  typed->setFocus();
}

void AppContext::unlessLost(const std::vector<UnsavedWork>& losses, Next go_on) {
  if (losses.empty()) return go_on();
  takeTyped();
  const Guard& first = guards_[std::size_t(losses.front())];
  const std::vector<UnsavedWork> rest(losses.begin() + 1, losses.end());
  const Next next = [this, rest, go_on = std::move(go_on)] { unlessLost(rest, go_on); };
  first ? first(next) : next();
}

void AppContext::unlessCutsAreLost(Next go_on) {
  if (!cuts_unsaved_) return go_on();
  QMessageBox* question =
      ask(&window_, "cutsQuestion", tr("What was cut is not saved as a volume."),
          tr("It then goes from the view. The recording of the exercise is kept."),
          tr("&Do not save it"), go_on);
  orElse(*question, "saveFirst", tr("&Save volume\u2026"),
         [this, go_on = std::move(go_on)] { askToSaveVolume(go_on); });
}

bool AppContext::keepsTheCase(const std::filesystem::path& target) {
  const Case* open = workstation_.currentCase();
  for (const std::string& source : {case_source_.string(), open ? open->source : std::string()}) {
    const Status kept = keepsCase(target, source);
    if (kept) continue;
    report(kept.error());
    return false;
  }
  return true;
}

// --- The case in the views ---

void AppContext::setCuts(bool carved, bool unsaved) {
  carved_ = carved;
  cuts_unsaved_ = unsaved;
  emit cutsChanged();
}

void AppContext::showCase() {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed) return;
  const std::shared_ptr<const Volume>& volume = placed->patient.volume;
  paintNextTurn(window_);  // and what it takes to show the case is enough for one
  view().setTools({});
  views_->setTools({});
  if (Volume mirror = workstation_.takeMirror(); !mirror.hu.empty()) {
    views_->showVolume(std::move(mirror), placed->labels, volume);
  } else {
    views_->refill(volume, placed->labels);
  }
  setCuts(false, false);
  emit caseShown();
  lookAtCase();
  go(std::exchange(once_open_, Place::prepare));
}

// The view has the case already, unless an earlier exercise left its cuts there.
void AppContext::exerciseBegan() {
  const Placement& placed = *workstation_.placed();
  if (carved_) views_->refill(placed.patient.volume, placed.labels);
  setCuts(true, false);
}

void AppContext::exerciseEnded(bool anything_cut) {
  setCuts(carved_, anything_cut);
}

void AppContext::showWholeCase() {
  workstation_.makeWhole();
  const Placement& placed = *workstation_.placed();
  views_->refill(placed.patient.volume, placed.labels);
  setCuts(false, false);
}

void AppContext::lookAtCase() {
  if (const std::optional<LandmarkFrame> landmark = workstation_.viewLandmark()) {
    views_->setPoint(landmark->position_mm);
    view().lookAtLandmark(*landmark, workstation_.exercise()->view.distance_mm);
  } else {
    view().lookFromFront();
  }
}

void AppContext::askToSavePicture() {
  QFileDialog* dialog = saveDialog(tr("Save picture"), "trephine.png", tr("Picture (*.png)"));
  connect(dialog, &QFileDialog::fileSelected, this, &AppContext::savePicture);
  dialog->open();
}

void AppContext::savePicture(const QString& file) {
  Result<Picture> picture = view().picture();
  if (!picture) return report(picture.error());
  workstation_.save(tr("The picture is saved."),
                    [picture = withPurpose(*picture), path = toPath(file)](const Progress&) {
                      return writePng(picture, path);
                    });
}

void AppContext::askToSaveVolume(Next then) {
  QFileDialog* dialog =
      saveDialog(tr("Save volume"), "carved.mha", tr("MetaImage (*.mha);;NIfTI (*.nii *.nii.gz)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, then = std::move(then)](const QString& file) { saveVolume(file, then); });
  dialog->open();
}

void AppContext::saveVolume(const QString& file, Next then) {
  if (!keepsTheCase(toPath(file))) return;
  // What a running exercise shows may be cut further.
  const bool all = workstation_.phase() == Workstation::Phase::ready;
  say(tr("Saving the volume\u2026"));
  workstation_.saveVolume(toPath(file), [this, all, then = std::move(then)] {
    if (all) setCuts(carved_, false);
    if (then) then();
  });
}

}  // namespace trephine
