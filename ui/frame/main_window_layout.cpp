#include <QLabel>
#include <QMenuBar>
#include <QShortcut>
#include <QSplitter>
#include <QStatusBar>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "base/system.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/views/view_tools.h"

namespace trephine {

namespace {
constexpr int kLeftWidth = 300, kRightWidth = 270;
constexpr int kFrame_ms = 16;
}  // namespace

MainWindow::MainWindow(std::filesystem::path recordings, QWidget* parent)
    : QMainWindow(parent), recordings_(std::move(recordings)) {
  setWindowTitle(tr("Trephine"));
  setAcceptDrops(true);
  buildActions();
  buildPanels();
  buildBars();
  connectParts();
  fillScenes();
  frame_timer_.setInterval(kFrame_ms);
  rate_clock_.start();
  panel_clock_.start();
  resize(sizeOnScreen({1280, 800}, *this));
  showPhase();
  view_->setFocus();
}

QAction* MainWindow::makeAction(Symbol symbol, const char* name, const QString& text,
                                const QKeySequence& key, const QString& tip) {
  auto* action = new QAction(symbolIcon(symbol), text, this);
  action->setObjectName(name);
  action->setShortcut(key);
  const QString keys = key.toString(QKeySequence::NativeText);
  action->setToolTip(keys.isEmpty() ? tip : tr("%1 (%2)").arg(tip, keys));
  addAction(action);
  return action;
}

void MainWindow::buildActions() {
  open_ = makeAction(Symbol::open, "open", tr("Open folder\u2026"), QKeySequence::Open,
                     tr("Open a folder of CT"));
  open_file_ = makeAction(Symbol::open, "openFile", tr("Open file\u2026"), {},
                          tr("Open a DICOMDIR or a volume file (NIfTI, NRRD, MetaImage, raw)"));
  open_scene_ = makeAction(Symbol::open, "openScene", tr("Open scene\u2026"),
                           QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O), tr("Open a scene file"));
  start_ = makeAction(Symbol::start, "start", tr("Start"), QKeySequence(Qt::Key_F5),
                      tr("Start the exercise"));
  stop_ = makeAction(Symbol::stop, "stop", tr("Stop"), QKeySequence(Qt::CTRL | Qt::Key_Period),
                     tr("End the exercise and its recording"));
  pause_ = makeAction(Symbol::pause, "pause", tr("Pause"), QKeySequence(Qt::CTRL | Qt::Key_P),
                      tr("Hold: no force and no cutting until it is released; in the view Space"));
  pause_->setCheckable(true);
  pause_->setAutoRepeat(false);
  undo_ = makeAction(Symbol::undo, "undo", tr("Undo"), QKeySequence(Qt::CTRL | Qt::Key_Z),
                     tr("Put the last stroke's tissue back"));
  redo_ = makeAction(Symbol::redo, "redo", tr("Redo"),
                     QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), tr("Cut the stroke again"));
  redo_->setShortcuts(
      {QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), QKeySequence(Qt::CTRL | Qt::Key_Y)});
  reset_ = makeAction(Symbol::reset, "reset", tr("Reset"), QKeySequence(Qt::CTRL | Qt::Key_R),
                      tr("Put all tissue back"));
  picture_ = makeAction(Symbol::picture, "savePicture", tr("Save picture\u2026"),
                        QKeySequence(Qt::Key_F12), tr("Save the 3-D view as a picture"));
  volume_ = makeAction(Symbol::save, "saveVolume", tr("Save volume\u2026"), QKeySequence::Save,
                       tr("Save the volume as it is now, with what was cut"));
  look_ = makeAction(Symbol::view, "resetView", tr("Reset view"), QKeySequence(Qt::Key_Home),
                     tr("Look at the case as at the start"));
}

void MainWindow::buildPanels() {
  case_ = new CasePanel;
  import_ = new ImportDialog(workstation_.import(), this);
  tissues_ = new TissuePanel;
  left_ = new QTabWidget;
  left_->setObjectName("leftTabs");
  left_->setDocumentMode(true);
  left_->insertTab(kCaseTab, scrolled(case_, "casePage"), tr("Case"));
  structures_ = new StructurePanel(editor_);
  left_->addTab(scrolled(tissues_, "tissuePage"), tr("Tissues"));
  left_->insertTab(kStructureTab, scrolled(structures_, "structurePage"), tr("Structures"));
  left_->setMinimumWidth(275);
  views_ = new FourUp;
  view_ = &views_->threeD();
  notice_ = new StateNotice(views_);
  rewind_ = new RewindBar;
  auto* middle = new QWidget;
  auto* middle_layout = new QVBoxLayout(middle);
  middle_layout->setContentsMargins(0, 0, 0, 0);
  middle_layout->setSpacing(0);
  middle_layout->addWidget(views_, 1);
  middle_layout->addWidget(rewind_);
  arms_ = new ArmsPanel;
  arms_->setMinimumWidth(240);

  auto* splitter = new QSplitter(Qt::Horizontal);
  splitter->addWidget(left_);
  splitter->addWidget(middle);
  splitter->addWidget(arms_);
  splitter->setStretchFactor(0, 0);
  splitter->setStretchFactor(1, 1);
  splitter->setStretchFactor(2, 0);
  splitter->setCollapsible(1, false);
  splitter->setSizes({kLeftWidth, 1280 - kLeftWidth - kRightWidth, kRightWidth});
  setCentralWidget(splitter);
}

void MainWindow::buildBars() {
  auto* tools = addToolBar(tr("Exercise"));
  tools->setObjectName("toolBar");
  tools->setMovable(false);
  tools->setIconSize({20, 20});
  tools->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  tools->setContextMenuPolicy(Qt::PreventContextMenu);
  scenes_ = new QComboBox;
  scenes_->setObjectName("scenes");
  scenes_->setToolTip(tr("The exercise"));
  scenes_->setAccessibleName(tr("Exercise"));
  scenes_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  tools->addWidget(scenes_);
  tools->addSeparator();
  tools->addActions({start_, stop_, pause_});
  tools->addSeparator();
  tools->addActions({undo_, redo_, reset_});
  tools->addSeparator();
  tools->addActions({look_, picture_, volume_});
  // Where a bar is short this opens the rest of it. Qt's own arrow is black on black.
  if (auto* rest = tools->findChild<QToolButton*>("qt_toolbar_ext_button")) {
    rest->setToolButtonStyle(Qt::ToolButtonTextOnly);
    rest->setText(QStringLiteral("\u00bb"));
    rest->setToolTip(tr("More"));
  }

  QMenu* file = menuBar()->addMenu(tr("&File"));
  file->addActions({open_, open_file_, open_scene_});
  file->addSeparator();
  file->addActions({picture_, volume_});
  file->addSeparator();
  QAction* quit = file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
  quit->setObjectName("quit");
  menuBar()
      ->addMenu(tr("&Exercise"))
      ->addActions({start_, stop_, pause_, notice_->forceOnAction(), undo_, redo_,
                    rewind_->backAction(), reset_});
  QMenu* view = menuBar()->addMenu(tr("&View"));
  view->addActions(views_->layoutActions());
  view->addAction(look_);
  view->addSeparator();
  for (QAction* tool : view_->tools().all())
    tool ? view->addAction(tool) : void(view->addSeparator());
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("&About Trephine"), this, &MainWindow::showAbout)->setObjectName("about");

  hint_ = new ElidedLabel;
  hint_->setObjectName("hint");
  hint_->setContentsMargins(6, 0, 0, 0);
  hint_->setProperty("quiet", true);
  rates_ = new QLabel;
  rates_->setObjectName("rates");
  rates_->setProperty("quiet", true);
  auto* purpose = new QLabel(purposeText());
  purpose->setObjectName("purpose");
  purpose->setContentsMargins(12, 0, 6, 0);
  statusBar()->addWidget(hint_, 1);
  statusBar()->addPermanentWidget(rates_);
  statusBar()->addPermanentWidget(purpose);
}

void MainWindow::connectParts() {
  connect(open_, &QAction::triggered, this, &MainWindow::askForFolder);
  connect(open_scene_, &QAction::triggered, this, &MainWindow::askForScene);
  connect(start_, &QAction::triggered, this, &MainWindow::start);
  connect(stop_, &QAction::triggered, &workstation_, &Workstation::stop);
  connect(pause_, &QAction::triggered, this,
          [this](bool on) { command(on ? CommandKind::pause : CommandKind::resume); });
  connect(notice_, &StateNotice::goOnWanted, this, [this] { command(CommandKind::resume); });
  connect(notice_, &StateNotice::forceWanted, this, [this] { command(CommandKind::clear_faults); });
  connect(undo_, &QAction::triggered, this,
          [this] { workstation_.session() ? command(CommandKind::undo) : editor_.undo(); });
  connect(redo_, &QAction::triggered, this,
          [this] { workstation_.session() ? command(CommandKind::redo) : editor_.redo(); });
  connect(reset_, &QAction::triggered, this, &MainWindow::reset);
  connect(rewind_, &RewindBar::rewindAsked, this, &MainWindow::rewind);
  connect(look_, &QAction::triggered, this, &MainWindow::lookAtCase);
  connect(picture_, &QAction::triggered, this, [this] {
    askWhereToSave(tr("Save picture"), "trephine.png", tr("Picture (*.png)"),
                   &MainWindow::savePicture);
  });
  connect(volume_, &QAction::triggered, this, [this] { askToSaveVolume({}); });
  // Space belongs to buttons and lists where they have the focus.
  auto* space = new QShortcut(Qt::Key_Space, view_, nullptr, nullptr, Qt::WidgetShortcut);
  space->setAutoRepeat(false);
  connect(space, &QShortcut::activated, pause_, &QAction::trigger);

  connect(case_, &CasePanel::folderWanted, this, &MainWindow::askForFolder);
  connect(open_file_, &QAction::triggered, this, &MainWindow::askForFile);
  connect(case_, &CasePanel::phantomWanted, this, [this](const QString& name) {
    const auto go_on = [this, name] { workstation_.openPhantom(name.toStdString()); };
    unlessStructuresAreLost([this, name, go_on] {
      if (workstation_.sceneFits(name.toStdString())) return unlessCutsAreLost(go_on);
      unlessSceneIsLost(go_on);
    });
  });
  connect(case_, &CasePanel::seriesWanted, import_, &ImportDialog::open);
  connect(import_, &ImportDialog::folderWanted, this, &MainWindow::askForFolder);
  connect(import_, &ImportDialog::fileWanted, this, &MainWindow::askForFile);
  connect(import_, &ImportDialog::reportWanted, this, [this] {
    askWhereToSave(tr("Save report"), "import-report.pdf",
                   tr("PDF (*.pdf);;Web page (*.html *.htm)"), &MainWindow::saveReport);
  });
  connect(import_, &ImportDialog::pathDropped, this,
          [this](const QString& path) { open(toPath(path)); });
  connect(import_, &ImportDialog::caseRead, this,
          [this](const Case& read, const std::filesystem::path& labels) {
            unlessStructuresAreLost([this, read, labels] {
              unlessCutsAreLost([this, read, labels] {
                case_source_ = workstation_.import().source();
                workstation_.openImported(read, labels);
              });
            });
          });
  connect(&workstation_.import(), &ImportTask::scanned, this,
          [this] { case_->setSeriesAtHand(true); });
  connect(case_, &CasePanel::labelsWanted, this, &MainWindow::askForLabels);
  connect(case_, &CasePanel::cancelWanted, &workstation_, &Workstation::cancelOpening);
  connect(tissues_, &TissuePanel::tissuesChanged, this,
          [this](const TissueSet& set) { tissuesEdited(set); });
  connect(tissues_, &TissuePanel::looksChanged, this, [this](const TissueLooks& looks) {
    workstation_.setLooks(looks);
    views_->setTissues(tissues_->tissues(), looks);
    showSeen();
  });
  connect(arms_, &ArmsPanel::controllerWanted, this, [this](ControllerKind kind) {
    workstation_.setController(kind);
    if (!workstation_.session() && workstation_.scene()) showRenderable(kind);
    view_->setFocus();
  });
  connect(scenes_, &QComboBox::activated, this, [this](int index) {
    const auto file = toPath(scenes_->itemData(index).toString());
    showInUse();  // until the other is on its way: it may be asked about, or not be had
    // A built-in case changes with the exercise, and its structures with it.
    const std::optional<Case>& of = workstation_.currentCase();
    const auto go_on = [this, file] {
      unlessSceneIsLost([this, file] { workstation_.useScene(file); });
    };
    of && of->built_in ? unlessStructuresAreLost(go_on) : go_on();
    view_->setFocus();
  });

  connect(views_, &FourUp::helpChanged, this,
          [this](const QString& words) { words.isEmpty() ? showPhase() : hint_->setText(words); });
  connect(view_, &ViewWidget::handMoved, this, &MainWindow::moveHand);
  connect(view_, &ViewWidget::failed, this, &MainWindow::report);
  connect(view_, &ViewWidget::framePainted, this, [this] { ++frames_; });

  connect(&workstation_, &Workstation::openingProgressed, this,
          [this](double fraction, const QString& step) {
            if (workstation_.isPlacing()) return;  // a moment, of what is on the screen
            case_->showProgress(fraction, step);
            left_->setCurrentIndex(kCaseTab);
            tissues_->setEnabled(false);  // they may be about to go
          });
  connect(&workstation_, &Workstation::openingEnded, case_, &CasePanel::endProgress);
  connect(&workstation_, &Workstation::openingEnded, this, [this] {
    tissues_->setEnabled(true);
    showInUse();
  });
  connect(&workstation_, &Workstation::sceneOpening, this, &MainWindow::showOpening);
  connect(&workstation_, &Workstation::sceneChanged, this, &MainWindow::showScene);
  connect(&workstation_, &Workstation::caseOpened, this, &MainWindow::showCase);
  connect(&workstation_, &Workstation::phaseChanged, this, &MainWindow::showPhase);
  connect(&workstation_, &Workstation::sessionStarted, this, &MainWindow::sessionStarted);
  connect(&workstation_, &Workstation::sessionEnded, this, &MainWindow::sessionEnded);
  connect(&workstation_, &Workstation::startFailed, this, [this] {
    if (carved_) showWholeCase();
  });
  connect(&workstation_, &Workstation::savingProgressed, this,
          [this](double fraction, const QString& step) {
            say(tr("%1\u2026 %2 %").arg(step).arg(int(100.0 * fraction)));
          });
  connect(
      &workstation_, &Workstation::savingEnded, this,
      [this] {
        if (std::exchange(close_when_saved_, false)) close();
      },
      Qt::QueuedConnection);  // what follows a save first
  connect(&workstation_, &Workstation::saved, this, &MainWindow::say);
  connect(&workstation_, &Workstation::failed, this, &MainWindow::report);
  connect(&workstation_, &Workstation::recordingFailed, this, &MainWindow::askToGoOn);
  connect(&frame_timer_, &QTimer::timeout, this, &MainWindow::tick);
  connectStructures();
}

void MainWindow::fillScenes() {
  std::vector<std::filesystem::path> files;
  std::error_code ec;
  for (std::filesystem::directory_iterator it(resourceFolder() / "scenes", ec), end;
       !ec && it != end; it.increment(ec)) {
    if (it->path().extension() == ".json") files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    if (Result<Scene> scene = readScene(file)) scenes_->addItem(toQt(scene->name), toQt(file));
  }
  showInUse();
}

}  // namespace trephine
