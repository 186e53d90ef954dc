#include "ui/cases/cases_workspace.h"

#include <QDialogButtonBox>
#include <QImage>
#include <QTextBrowser>
#include <QVBoxLayout>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "exchange/exercise_folder.h"
#include "exercise/exercise.h"
#include "library/codes.h"
#include "library/stored_case.h"
#include "ui/cases/report_file.h"
#include "ui/common/actions.h"
#include "ui/common/error_dialog.h"
#include "ui/common/placing.h"
#include "ui/common/question.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

constexpr int kMostRecent = 10;

// The page of a case's folder, which anybody may have made: it opens nothing else.
class PageAlone : public QTextBrowser {
 public:
  PageAlone() { setOpenLinks(false); }

 protected:
  // A picture: what is none, or nothing, Qt would then look for in a file by itself.
  QVariant loadResource(int, const QUrl&) override { return QImage(1, 1, QImage::Format_ARGB32); }
};

Error stillChanging() {
  return {code::kBusy, trephine::tr("The change before is still being written"), "",
          trephine::tr("Try again in a moment")};
}

}  // namespace

CasesWorkspace::CasesWorkspace(AppContext& app)
    : Workspace(&app),
      app_(app),
      workstation_(app.workstation()),
      messages_(app.messages()),
      guards_(app.guards()) {
  QWidget& window = *messages_.window();
  open_ = makeAction(window, Symbol::open, "open", tr("Open folder\u2026"), QKeySequence::Open,
                     tr("Open a folder of CT"));
  open_file_ = makeAction(window, Symbol::open, "openFile", tr("Open file\u2026"), {},
                          tr("Open a DICOMDIR or a volume file (NIfTI, NRRD, MetaImage, raw)"));
  open_exercise_ =
      makeAction(window, Symbol::open, "openScene", tr("Open exercise\u2026"),
                 QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O),
                 tr("Open an exercise: its file, or the folder of one that was exported"));
  page_ = new CasesPage;
  import_ = new ImportPage(workstation_.import());
  pages_ = new QStackedWidget;
  pages_->addWidget(page_);
  pages_->addWidget(import_);
  connectParts();
  showPhase();
}

Workspace::Parts CasesWorkspace::parts() {
  Parts parts;
  parts.page = pages_;
  return parts;
}

void CasesWorkspace::connectParts() {
  connect(open_, &QAction::triggered, this, &CasesWorkspace::askForFolder);
  connect(open_file_, &QAction::triggered, this, &CasesWorkspace::askForFile);
  connect(open_exercise_, &QAction::triggered, this, &CasesWorkspace::askForExercise);
  connect(page_, &CasesPage::folderWanted, this, &CasesWorkspace::askForFolder);
  connect(page_, &CasesPage::seriesWanted, import_, &ImportPage::open);
  connect(page_, &CasesPage::trainWanted, this,
          [this](const CaseEntry& entry) { openEntry(entry, Place::train); });
  connect(page_, &CasesPage::prepareWanted, this,
          [this](const CaseEntry& entry) { openEntry(entry, Place::prepare); });
  connect(page_, &CasesPage::goOnWanted, this,
          [this](bool train) { app_.go(train ? Place::train : Place::prepare); });
  connect(page_, &CasesPage::exercisesWanted, this,
          [this](const CaseEntry& entry) { app_.review(entry.caseKey()); });
  connect(page_, &CasesPage::saveWanted, this, &CasesWorkspace::saveCase);
  connect(page_, &CasesPage::renameWanted, this, &CasesWorkspace::rename);
  connect(page_, &CasesPage::deleteWanted, this, &CasesWorkspace::askToDelete);
  connect(page_, &CasesPage::reportWanted, this, &CasesWorkspace::showReport);
  connect(&listing_, &BackgroundTask::ended, this, [this] {
    if (std::exchange(list_again_, false))
      QMetaObject::invokeMethod(this, &CasesWorkspace::list, Qt::QueuedConnection);
  });
  connect(&reading_, &BackgroundTask::ended, this, [this] {
    if (std::exchange(read_again_, false))
      QMetaObject::invokeMethod(this, &CasesWorkspace::listRecordings, Qt::QueuedConnection);
  });

  connect(import_, &ImportPage::opened, this, [this] {
    pages_->setCurrentWidget(import_);
    app_.go(Place::cases);
  });
  connect(import_, &ImportPage::closed, this, [this] { pages_->setCurrentWidget(page_); });
  connect(import_, &ImportPage::folderWanted, this, &CasesWorkspace::askForFolder);
  connect(import_, &ImportPage::fileWanted, this, &CasesWorkspace::askForFile);
  connect(import_, &ImportPage::pathDropped, this,
          [this](const QString& path) { open(toPath(path)); });
  connect(import_, &ImportPage::reportWanted, this, [this](const QString& uid) {
    QFileDialog* dialog = messages_.saveDialog(tr("Save report"), "import-report.pdf",
                                               tr("PDF (*.pdf);;Web page (*.html *.htm)"));
    connect(dialog, &QFileDialog::fileSelected, this,
            [this, uid](const QString& file) { saveReport(file, uid); });
    dialog->open();
  });
  connect(import_, &ImportPage::caseRead, this, &CasesWorkspace::caseRead);
  connect(&workstation_.import(), &ImportTask::scanned, this,
          [this] { page_->setSeriesAtHand(true); });
  connect(&messages_, &Messages::said, import_, &ImportPage::say);

  connect(&workstation_, &Workstation::caseOpened, this, [this] {
    open_deleted_ = false;
    page_->sayInStrip({});
    showCase();
    const bool imported =
        import_to_save_ && import_to_save_->volume == workstation_.currentCase()->volume;
    imported ? saveCase() : import_to_save_.reset();
    const std::string& id = workstation_.currentCase()->stored;
    if (id.empty()) return;
    QStringList recent = read(settings::kRecentCases);
    recent.removeAll(toQt(id));
    recent.prepend(toQt(id));
    write(settings::kRecentCases, recent.mid(0, kMostRecent));
  });
  // Another program, or a person at the folders, has changed what is there.
  connect(&messages_, &Messages::failed, this, [this](const Error& error) {
    if (error.code == code::kNoSuchCase) list();
  });
  connect(&workstation_, &Workstation::structuresChanged, this, &CasesWorkspace::showCase);
  connect(&workstation_, &Workstation::phaseChanged, this, &CasesWorkspace::showPhase);
}

void CasesWorkspace::askForFolder() {
  QFileDialog* dialog = messages_.fileDialog("folderDialog", tr("Open a folder of CT"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& folder) { open(toPath(folder)); });
  dialog->open();
}

void CasesWorkspace::askForFile() {
  QFileDialog* dialog = messages_.fileDialog(
      "fileDialog", tr("Open a file of CT"),
      tr("Any file (*);;Volumes (*.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.raw)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void CasesWorkspace::askForExercise() {
  QFileDialog* dialog = messages_.fileDialog(
      "sceneDialog", tr("Open an exercise, or the folder of one that was exported"),
      tr("Exercise (*.json)"));
  // Who exported a folder looks for that folder, and not for one of its files.
  connect(dialog, &QFileDialog::directoryEntered, this, [this, dialog](const QString& folder) {
    if (exportedExercise(toPath(folder)).empty()) return;
    dialog->reject();
    open(toPath(folder));
  });
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void CasesWorkspace::open(const std::filesystem::path& path) {
  const std::filesystem::path exported = exportedExercise(path);
  if (!exported.empty()) {
    if (isOwnExercise(app_.storage(), exported))
      return app_.openUnlessLost(exported, Place::train, true);
    return app_.takeInExercise(exported.parent_path(), Place::train);
  }
  if (Workstation::isExercise(path)) return app_.openUnlessLost(path, Place::train, true);
  app_.goOnceOpen(Place::prepare);
  workstation_.openPath(path);
}

// --- The library ---

void CasesWorkspace::list() {
  const bool begun = listing_.run(
      [library = app_.library(), storage = app_.storage()](const Progress&)
          -> Result<std::vector<CaseEntry>> { return listCases(*library, storage); },
      [this](Result<std::vector<CaseEntry>> entries) {
        if (!entries) return;
        page_->showCases(*entries);
        const QStringList recent = read(settings::kRecentCases);
        page_->setRecent(recent.isEmpty() ? std::string() : recent.front().toStdString());
        emit listed();
      });
  list_again_ = !begun;
}

// Beside the list of cases, which does not wait for them.
void CasesWorkspace::listRecordings() {
  const bool begun = reading_.run(
      [this, folder = app_.recordings()](const Progress& progress) {
        ReadApart how;
        how.read = [this](const std::vector<ListedRecording>& so_far) {
          QMetaObject::invokeMethod(
              this, [this, so_far] { page_->showRecordings(so_far, false); }, Qt::QueuedConnection);
        };
        return trephine::listRecordings(folder, progress, how);
      },
      [this](Result<std::vector<ListedRecording>> rows) {
        if (rows) return page_->showRecordings(*std::move(rows), true);
        page_->showNoRecordings(toQt(rows.error().sentence()));
      });
  read_again_ = !begun;
}

void CasesWorkspace::openEntry(const CaseEntry& entry, Place then) {
  const Case* open = workstation_.currentCase();
  if (open && entry.isOfLibrary() && open->stored == entry.id) return app_.go(then);
  const auto begin = [this, then](auto go_on) {
    return [this, then, go_on] {
      app_.goOnceOpen(then);
      go_on();
    };
  };
  if (!entry.exercise.empty()) return app_.openUnlessLost(entry.exercise, then, true);
  // Where nobody chose one, the newest that was made on it is practised on it.
  if (entry.isOfLibrary() && then == Place::train && !workstation_.exerciseChosen()) {
    const auto when = [](const std::filesystem::path& file) {
      std::error_code ec;
      return std::filesystem::last_write_time(file, ec);
    };
    const auto made = madeOn(entry);
    const auto newest = std::ranges::max_element(made, {}, when);
    if (newest != made.end()) return app_.openUnlessLost(*newest, then, true);
  }
  std::vector<UnsavedWork> losses = WorkGuards::ofTheCase();
  const std::string anatomy = entry.built_in ? entry.id : exerciseAnatomy(entry.record.region);
  // A place that was clicked is of the patient who goes; a case of the library has its own tissues.
  const bool tissues_go = !entry.built_in && workstation_.tissuesEdited();
  if (anatomy.empty() || !workstation_.exerciseFits(anatomy) || workstation_.entry() || tissues_go)
    losses.push_back(UnsavedWork::tissues);
  if (entry.built_in) {
    return guards_.unlessLost(losses, begin([this, name = entry.id] {
                                guards_.setCaseSource({});
                                workstation_.openPhantom(name);
                              }));
  }
  guards_.unlessLost(
      losses, begin([this, id = entry.id, folder = entry.record.folder] {
        guards_.setCaseSource(folder);
        workstation_.openStored([library = app_.library(), id](const Progress& progress) {
          return storedCase(*library, id, progress);
        });
      }));
}

// The case that is open, whole or not at all, in the background: it can be looked at meanwhile.
void CasesWorkspace::saveCase() {
  const Case* of = workstation_.currentCase();
  if (!of || of->built_in || !of->stored.empty()) return;
  NewCase made = import_to_save_.value_or(NewCase{});
  import_to_save_ = made;  // for another try
  made.volume = of->volume;
  made.structures = of->structures;
  made.provenance = of->provenance;
  made.region = of->anatomy ? of->anatomy->region : BodyRegion::not_sure;
  made.tissues = toJson(workstation_.tissues());
  const auto done = std::make_shared<SavedCase>();
  workstation_.save(
      tr("The case is saved."),
      [library = app_.library(), made, done](const Progress& progress) -> Status {
        Result<SavedCase> written = library->save(made, progress);
        if (!written) return written.error();
        *done = *std::move(written);
        return {};
      },
      [this, done, volume = made.volume] {
        const Case* now = workstation_.currentCase();
        if (now && now->volume == volume) saved(*done);
        list();
      });
}

void CasesWorkspace::saved(const SavedCase& saved) {
  import_to_save_.reset();
  workstation_.setStored(saved.record.id, saved.record.name);
  const QString name = toQt(saved.record.name);
  write(settings::kRecentCases,
        (QStringList{toQt(saved.record.id)} + read(settings::kRecentCases)).mid(0, kMostRecent));
  showCase();
  const QString words =
      tr("Saved as \"%1\", without a word of who the patient is. What it was imported from is not "
         "needed any more.")
          .arg(name);
  page_->sayInStrip(words);
  page_->selectOnceThere(saved.record.id);
  messages_.say(words);
  emit caseSaved(name);
}

void CasesWorkspace::rename(const CaseEntry& entry, const QString& name) {
  const bool begun =
      changing_.run([library = app_.library(), id = entry.id,
                     to = name.toStdString()](const Progress&) { return library->rename(id, to); },
                    [this, entry, name](Result<CaseRecord> renamed) {
                      if (!renamed) {
                        QMessageBox* why = showError(messages_.window(), renamed.error());
                        connect(why, &QMessageBox::finished, page_,
                                [this, entry, name] { page_->askForName(entry, name); });
                        return;
                      }
                      const Case* open = workstation_.currentCase();
                      if (open && open->stored == renamed->id) {
                        workstation_.setStored(renamed->id, renamed->name);
                        page_->sayInStrip({});
                        showCase();
                      }
                      list();
                      messages_.say(tr("It is called \"%1\" now.").arg(toQt(renamed->name)));
                    });
  if (!begun) messages_.report(stillChanging());
}

std::vector<std::filesystem::path> CasesWorkspace::madeOn(const CaseEntry& entry) const {
  std::vector<std::filesystem::path> made;
  for (const auto& file : app_.exercises()) {
    const Result<Exercise> exercise = readExercise(file);
    const std::filesystem::path of = exercise ? exercise->case_source : "";
    if (of.parent_path() == app_.storage() / "cases" / entry.id) made.push_back(file);
  }
  return made;
}

void CasesWorkspace::askToDelete(const CaseEntry& entry) {
  const int made_on_it = int(madeOn(entry).size());
  const std::size_t exercises = page_->exercisesOn(entry).size();
  const QString made = made_on_it == 0 ? QString()
                                       : ' ' + tr("Exercises that were made on it: %1; they have "
                                                  "no case then.")
                                                   .arg(made_on_it);
  ask(messages_.window(), "deleteQuestion",
      tr("Delete \"%1\"?").arg(toQt(entry.record.name.empty() ? entry.id : entry.record.name)),
      (!page_->allRecordingsRead()
           ? tr("Its volume, structures and report are removed from this workstation for good. "
                "Recordings of exercises on it stay, if there are any, but cannot be replayed "
                "without it.")
       : exercises == 0
           ? tr("Its volume, structures and report are removed from this workstation for good.")
           : tr("Its volume, structures and report are removed from this workstation for good. "
                "Recordings of exercises on it (%1) stay, but cannot be replayed without it.")
                 .arg(exercises)) +
          made,
      tr("&Delete it"), [this, entry] {
        const bool begun =
            changing_.run([library = app_.library(),
                           id = entry.id](const Progress&) { return library->remove(id); },
                          [this, entry](Status removed) {
                            if (!removed) messages_.report(removed.error());
                            const Case* open = workstation_.currentCase();
                            if (removed && open && open->stored == entry.id) {
                              workstation_.setStored({});
                              open_deleted_ = true;
                              page_->sayInStrip(tr("\"%1\" is deleted. It stays in the views "
                                                   "until another case is opened.")
                                                    .arg(toQt(entry.record.name)));
                            }
                            list();
                            showCase();
                          });
        if (!begun) messages_.report(stillChanging());
      });
}

void CasesWorkspace::showReport(const CaseEntry& entry) {
  constexpr std::size_t kMostBytes = std::size_t{4} << 20;
  const Result<std::string> page =
      readWholeFile(entry.record.folder / case_folders::kReportPage, kMostBytes);
  if (!page) {
    return messages_.report({page.error().code, trephine::tr("The case's report cannot be read"),
                             (entry.record.folder / case_folders::kReportPage).string(),
                             trephine::tr("The case can be used without it")});
  }
  auto* dialog = new QDialog(messages_.window());
  dialog->setObjectName("reportDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Import report of \"%1\"").arg(toQt(entry.record.name)));
  auto* text = new PageAlone;
  text->setHtml(toQt(*page));
  auto* close = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(close, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
  auto* layout = new QVBoxLayout(dialog);
  layout->addWidget(text, 1);
  layout->addWidget(close);
  dialog->resize(sizeOnScreen({720, 640}, *dialog));
  dialog->open();
}

// --- Importing ---

void CasesWorkspace::caseRead(Case read, const std::filesystem::path& labels) {
  NewCase to_save;
  to_save.report = workstation_.import().report();
  to_save.source = workstation_.import().identity();
  to_save.volume = read.volume;
  read.identity = std::make_shared<const SourceIdentity>(to_save.source);
  std::vector<UnsavedWork> losses = WorkGuards::ofTheCase();
  // Nor does an exercise stay that does not fit, unless a person chose it.
  const bool fits =
      read.anatomy && workstation_.exerciseFits(exerciseAnatomy(read.anatomy->region));
  if (workstation_.entry() || !fits) losses.push_back(UnsavedWork::tissues);
  guards_.unlessLost(losses, [this, read, labels, to_save] {
    guards_.setCaseSource(workstation_.import().source());
    app_.goOnceOpen(Place::prepare);
    import_to_save_ = to_save;
    workstation_.openImported(read, labels);
  });
}

void CasesWorkspace::saveReport(const QString& file, const QString& uid) {
  const auto only = uid.isEmpty() ? std::nullopt : std::optional(uid.toStdString());
  workstation_.save(tr("The report is saved."),
                    [report = workstation_.import().report(), only, path = toPath(file)](
                        const Progress&) { return writeReport(report, path, only); });
}

void CasesWorkspace::showCase() {
  const Case* of = workstation_.currentCase();
  if (!of) return;
  const bool phantom = of->built_in;
  const std::filesystem::path came_with = exerciseThatBrought(app_.storage(), of->source);
  const std::string id = phantom             ? workstation_.exercise()->anatomy
                         : came_with.empty() ? of->stored
                                             : idOfExercise(came_with);
  const bool kept = !of->stored.empty() || !came_with.empty();
  page_->showOpen(id, caseWords(*of), phantom || open_deleted_ || kept);
}

void CasesWorkspace::showPhase() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool may_open =
      (phase == Phase::ready || phase == Phase::empty) && !workstation_.isOpening();
  for (QAction* action : openActions()) action->setEnabled(may_open);
  page_->setOpeningAllowed(may_open);
}

}  // namespace trephine
