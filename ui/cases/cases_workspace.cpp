#include "ui/cases/cases_workspace.h"

#include "ui/cases/report_file.h"
#include "ui/common/actions.h"
#include "ui/common/words.h"

namespace trephine {

CasesWorkspace::CasesWorkspace(Bench& bench)
    : Workspace(&bench), bench_(bench), workstation_(bench.workstation()) {
  QWidget& window = *bench.window();
  open_ = makeAction(window, Symbol::open, "open", tr("Open folder\u2026"), QKeySequence::Open,
                     tr("Open a folder of CT"));
  open_file_ = makeAction(window, Symbol::open, "openFile", tr("Open file\u2026"), {},
                          tr("Open a DICOMDIR or a volume file (NIfTI, NRRD, MetaImage, raw)"));
  open_scene_ =
      makeAction(window, Symbol::open, "openScene", tr("Open exercise\u2026"),
                 QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O), tr("Open an exercise's file"));
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
  connect(open_scene_, &QAction::triggered, this, &CasesWorkspace::askForScene);
  connect(page_, &CasesPage::folderWanted, this, &CasesWorkspace::askForFolder);
  connect(page_, &CasesPage::phantomWanted, this,
          [this](const QString& name) { openPhantom(name.toStdString()); });
  connect(page_, &CasesPage::seriesWanted, import_, &ImportPage::open);
  connect(page_, &CasesPage::cancelWanted, &workstation_, &Workstation::cancelOpening);

  connect(import_, &ImportPage::opened, this, [this] {
    pages_->setCurrentWidget(import_);
    bench_.go(Place::cases);
  });
  connect(import_, &ImportPage::closed, this, [this] { pages_->setCurrentWidget(page_); });
  connect(import_, &ImportPage::folderWanted, this, &CasesWorkspace::askForFolder);
  connect(import_, &ImportPage::fileWanted, this, &CasesWorkspace::askForFile);
  connect(import_, &ImportPage::pathDropped, this,
          [this](const QString& path) { open(toPath(path)); });
  connect(import_, &ImportPage::reportWanted, this, [this] {
    QFileDialog* dialog = bench_.saveDialog(tr("Save report"), "import-report.pdf",
                                            tr("PDF (*.pdf);;Web page (*.html *.htm)"));
    connect(dialog, &QFileDialog::fileSelected, this, &CasesWorkspace::saveReport);
    dialog->open();
  });
  connect(import_, &ImportPage::caseRead, this, &CasesWorkspace::caseRead);
  connect(&workstation_.import(), &ImportTask::scanned, this,
          [this] { page_->setSeriesAtHand(true); });
  connect(&bench_, &Bench::said, import_, &ImportPage::say);

  connect(&workstation_, &Workstation::openingProgressed, this,
          [this](double fraction, const QString& step) {
            // What is placed anew is on the screen: a moment.
            if (!workstation_.isPlacing()) page_->showProgress(fraction, step);
          });
  connect(&workstation_, &Workstation::openingEnded, page_, &CasesPage::endProgress);
  connect(&workstation_, &Workstation::caseOpened, this, [this] {
    showCase();
    bench_.go(std::exchange(train_wanted_, false) ? Place::train : Place::prepare);
  });
  connect(&workstation_, &Workstation::structuresChanged, this, &CasesWorkspace::showCase);
  connect(&workstation_, &Workstation::phaseChanged, this, &CasesWorkspace::showPhase);
}

void CasesWorkspace::askForFolder() {
  QFileDialog* dialog = bench_.fileDialog("folderDialog", tr("Open a folder of CT"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& folder) { open(toPath(folder)); });
  dialog->open();
}

void CasesWorkspace::askForFile() {
  QFileDialog* dialog =
      bench_.fileDialog("fileDialog", tr("Open a file of CT"),
                        tr("Any file (*);;Volumes (*.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.raw)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void CasesWorkspace::askForScene() {
  QFileDialog* dialog =
      bench_.fileDialog("sceneDialog", tr("Open an exercise"), tr("Exercise (*.json)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void CasesWorkspace::open(const std::filesystem::path& path) {
  const auto go_on = [this, path] {
    train_wanted_ = Workstation::isScene(path);
    workstation_.openPath(path);
  };
  if (!Workstation::isScene(path)) return go_on();
  bench_.unlessLost({Bench::Loss::structures, Bench::Loss::cuts, Bench::Loss::tissues}, go_on);
}

void CasesWorkspace::openPhantom(const std::string& name) {
  std::vector<Bench::Loss> losses{Bench::Loss::structures, Bench::Loss::cuts};
  if (!workstation_.sceneFits(name)) losses.push_back(Bench::Loss::tissues);
  bench_.unlessLost(losses, [this, name] { workstation_.openPhantom(name); });
}

void CasesWorkspace::caseRead(const Case& read, const std::filesystem::path& labels) {
  bench_.unlessLost({Bench::Loss::structures, Bench::Loss::cuts}, [this, read, labels] {
    bench_.setCaseSource(workstation_.import().source());
    train_wanted_ = false;
    workstation_.openImported(read, labels);
  });
}

void CasesWorkspace::saveReport(const QString& file) {
  workstation_.save(tr("The report is saved."),
                    [report = workstation_.import().report(),
                     path = toPath(file)](const Progress&) { return writeReport(report, path); });
}

void CasesWorkspace::showCase() {
  if (const std::optional<Case>& of = workstation_.currentCase()) page_->showCase(caseWords(*of));
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
