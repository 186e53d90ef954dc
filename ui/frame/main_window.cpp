#include "ui/frame/main_window.h"

#include <QCoreApplication>
#include <QDragEnterEvent>
#include <QHBoxLayout>
#include <QMenuBar>
#include <QMimeData>
#include <QTabWidget>
#include <QTimer>
#include <algorithm>
#include <memory>
#include <utility>

#include "ui/commission/fitness_line.h"
#include "ui/common/actions.h"
#include "ui/common/error_dialog.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/preferences.h"
#include "ui/common/question.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/frame/help_page.h"
#include "ui/headset/headset_view.h"
#include "ui/headset/stereo_view.h"
#include "ui/views/view_strip.h"

namespace trephine {

MainWindow::MainWindow(std::filesystem::path recordings, const Policy& policy, QWidget* parent)
    : QMainWindow(parent), app_(*this, std::move(recordings), policy) {
  setWindowTitle(tr("Trephine"));
  setAcceptDrops(true);
  buildWorkspaces();
  buildActions();
  buildBars();
  buildMenus();
  connectParts();
  resize(sizeOnScreen({1280, 800}, *this));
  restore();
}

void MainWindow::buildWorkspaces() {
  cases_ = new CasesWorkspace(app_);
  prepare_ = new PrepareWorkspace(app_);
  train_ = new TrainWorkspace(app_);
  review_ = new ReviewWorkspace(app_);
  headset_ = new HeadsetView(workstation(), app_.messages(), app_.caseViews());
  stereo_ = new StereoView(app_.messages(), view());
  rooms_ = {Room{Place::cases, "cases", cases_, {}, {}},
            Room{Place::prepare, "prepare", prepare_, {ViewLayout::Kind::four, 0}, {}},
            Room{Place::train, "train", train_, {ViewLayout::Kind::one_large, 0}, {}},
            Room{Place::review, "review", review_, {}, {}}};
  rail_ = new Rail(*this);
  pages_ = new QStackedWidget;
  // Not stacks: those would be as wide as their widest page, whichever is shown.
  for (QWidget** slot : {&left_, &below_, &right_}) {
    *slot = new QWidget;
    tight(new QVBoxLayout(*slot));
  }
  for (Room& one : rooms_) {
    one.parts = one.workspace->parts();
    rail_->add(one.place, *one.workspace);
    if (one.parts.page) pages_->addWidget(one.parts.page);
    if (one.parts.left) left_->layout()->addWidget(one.parts.left);
    if (one.parts.right) right_->layout()->addWidget(one.parts.right);
    if (one.parts.below) below_->layout()->addWidget(one.parts.below);
  }
  auto* middle = new QWidget;
  auto* middle_layout = tight(new QVBoxLayout(middle), 0);
  middle_layout->addWidget(&views(), 1);
  middle_layout->addWidget(below_);
  columns_ = new QSplitter(Qt::Horizontal);
  columns_->addWidget(left_);
  columns_->addWidget(middle);
  columns_->addWidget(right_);
  columns_->setStretchFactor(0, 0);
  columns_->setStretchFactor(1, 1);
  columns_->setStretchFactor(2, 0);
  columns_->setChildrenCollapsible(false);
  pages_->addWidget(columns_);

  auto* all = new QWidget;
  auto* layout = tight(new QHBoxLayout(all), 0);
  layout->addWidget(rail_);
  layout->addWidget(pages_, 1);
  setCentralWidget(all);
}

void MainWindow::buildActions() {
  picture_ = makeAction(*this, Symbol::picture, "savePicture", tr("Save picture\u2026"),
                        Qt::Key_F12, tr("Save the 3-D view as a picture"));
  volume_ = makeAction(*this, Symbol::save, "saveVolume", tr("Save volume\u2026"),
                       QKeySequence::Save, tr("Save the volume as it is now, with what was cut"));
  look_ = makeAction(*this, Symbol::view, "resetView", tr("Reset view"), Qt::Key_Home,
                     tr("All of the patient"));
  left_panel_ = makeAction(*this, Symbol::view, "leftPanel", tr("Left panel"), Qt::CTRL | Qt::Key_B,
                           tr("Show or hide the left panel"));
  right_panel_ = makeAction(*this, Symbol::view, "rightPanel", tr("Right panel"),
                            Qt::CTRL | Qt::SHIFT | Qt::Key_B, tr("Show or hide the right panel"));
  full_screen_ = makeAction(*this, Symbol::view, "fullScreen", tr("Full screen"), Qt::Key_F11,
                            tr("The whole screen; Esc leaves it"));
  for (QAction* action : {left_panel_, right_panel_, full_screen_}) action->setCheckable(true);
}

void MainWindow::buildBars() {
  bar_ = addToolBar(tr("Exercise"));
  bar_->setObjectName("toolBar");
  bar_->setMovable(false);
  bar_->setIconSize({20, 20});
  bar_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  bar_->setContextMenuPolicy(Qt::PreventContextMenu);
  bar_->addWidget(train_->exercises());
  bar_->addSeparator();
  bar_->addActions({train_->startAction(), train_->stopAction(), train_->pauseAction()});
  bar_->addSeparator();
  bar_->addActions({app_.undoAction(), app_.redoAction(), train_->resetAction()});
  bar_->addSeparator();
  bar_->addActions({look_, picture_, volume_});
  // Where a bar is short this opens the rest of it. Qt's own arrow is black on black.
  if (auto* rest = bar_->findChild<QToolButton*>("qt_toolbar_ext_button")) {
    rest->setToolButtonStyle(Qt::ToolButtonTextOnly);
    rest->setText(QStringLiteral("\u00bb"));
    rest->setToolTip(tr("More"));
  }
  status_ = new StatusLine(app_, *headset_, *stereo_);
  setStatusBar(status_);
}

void MainWindow::buildMenus() {
  dialogs_ = new WindowDialogs(*this, app_, *headset_, *stereo_, status_->fitness());
  QMenu* file = menuBar()->addMenu(tr("&File"));
  file->addActions(cases_->openActions());
  file->addSeparator();
  file->addActions({prepare_->saveInCaseAction(), volume_, picture_});
  file->addSeparator();
  file->addActions(dialogs_->actions());
  file->addSeparator();
  QAction* quit = file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
  quit->setObjectName("quit");
  QMenu* exercise = menuBar()->addMenu(tr("&Exercise"));
  exercise->addActions({train_->startAction(), train_->stopAction(), train_->pauseAction(),
                        train_->forceOnAction(), app_.undoAction(), app_.redoAction(),
                        train_->backAction(), train_->resetAction()});
  exercise->addSeparator();
  exercise->addActions(train_->handActions());
  exercise->addSeparator();
  exercise->addAction(prepare_->pokeAction());
  QMenu* view = menuBar()->addMenu(tr("&View"));
  view->addActions(rail_->actions());
  view->addSeparator();
  view->addActions({left_panel_, right_panel_, full_screen_});
  view->addSeparator();
  view->addActions(views().layoutActions());
  view->addAction(look_);
  view->addSeparator();
  for (QAction* tool : this->view().tools().all())
    tool ? view->addAction(tool) : void(view->addSeparator());
  view->addSeparator();
  view->addActions({headset_->onAction(), headset_->recentreAction(), stereo_->onAction(),
                    dialogs_->headsetAction()});
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("&Help"), QKeySequence(Qt::Key_F1), this, &MainWindow::showHelp)
      ->setObjectName("help");
  QAction* keys = help->addAction(tr("&Keys"), QKeySequence(Qt::SHIFT | Qt::Key_F1), dialogs_,
                                  &WindowDialogs::showKeys);
  keys->setObjectName("keys");
  help->addAction(tr("&About Trephine"), dialogs_, &WindowDialogs::showAbout)
      ->setObjectName("about");
}

void MainWindow::connectParts() {
  connect(headset_, &HeadsetView::changed, this, [this] {
    train_->setCardsWanted(headset_->isOn());
    if (!workstation().session()) headset_->setCards({});
    if (headset_->isSeen()) stereo_->stop();
  });
  // One pair of pictures at a time; a headset that cannot be had takes no screen away.
  connect(stereo_->onAction(), &QAction::toggled, this, [this](bool on) {
    if (on && stereo_->isOn()) headset_->onAction()->setChecked(false);
  });
  connect(train_, &TrainWorkspace::cardsChanged, headset_, &HeadsetView::setCards);
  connect(train_, &TrainWorkspace::recentreWanted, headset_, &HeadsetView::recentre);
  connect(rail_, &Rail::chosen, this, qOverload<Place>(&MainWindow::show));
  connect(&app_, &AppContext::placeWanted, this, qOverload<Place>(&MainWindow::show));
  connect(&app_.messages(), &Messages::failed, this, &MainWindow::failed);
  connect(train_, &TrainWorkspace::ratesChanged, status_, &StatusLine::showRates);
  connect(train_, &TrainWorkspace::structureWanted, prepare_, &PrepareWorkspace::makeMissing);
  connect(train_, &TrainWorkspace::replayWanted, this, [this] {
    show(Place::review);
    review_->replayNewest();
  });
  connect(look_, &QAction::triggered, &app_.caseViews(), &CaseViews::lookAtAll);
  connect(picture_, &QAction::triggered, &app_.caseViews(), &CaseViews::askToSavePicture);
  connect(volume_, &QAction::triggered, &app_.caseViews(), &CaseViews::wantVolume);
  for (QAction* panel : {left_panel_, right_panel_}) {
    connect(panel, &QAction::toggled, this, &MainWindow::showPanels);
  }
  connect(full_screen_, &QAction::toggled, this,
          [this](bool full) { setWindowState(windowState().setFlag(Qt::WindowFullScreen, full)); });

  Workstation& workstation = app_.workstation();
  const auto showPhase = [this] {
    const bool any = this->workstation().phase() != Workstation::Phase::empty;
    for (QAction* action : {picture_, volume_, look_}) action->setEnabled(any);
  };
  connect(&workstation, &Workstation::phaseChanged, this, showPhase);
  showPhase();
  for (auto changed : {&Workstation::exerciseChanged, &Workstation::caseNamed}) {
    connect(&workstation, changed, this, &MainWindow::showTitle);
  }
  connect(
      &workstation, &Workstation::savingEnded, this,
      [this] {
        if (std::exchange(close_when_saved_, false)) close();
      },
      Qt::QueuedConnection);  // what follows a save first
}

// They know the shared context, and go before it.
MainWindow::~MainWindow() {
  delete stereo_;
  delete headset_;
  delete review_;
  delete train_;
  delete prepare_;
  delete cases_;
}

// --- Workspaces ---

void MainWindow::show(Place place) {
  if (place == place_ && entered_) return rail_->show(place);
  if (entered_) {
    keepColumns();
    room(place_).workspace->leave();
  }
  entered_ = true;
  place_ = place;
  app_.noteShown(place);
  const Room& now = room(place);
  {
    const FourUp::Still until_all_has_its_place(views());
    if (now.parts.page) {
      // Nobody sees what the arms do.
      if (Session* session = workstation().session()) (void)session->send(CommandKind::pause);
      pages_->setCurrentWidget(now.parts.page);
    } else {
      pages_->setCurrentWidget(columns_);
      views().useLayoutOf(now.name, now.layout);
    }
    bar_->setVisible(!now.parts.page);
    // Its buttons stay where they are.
    rail_->setContentsMargins(0, now.parts.page ? bar_->sizeHint().height() : 0, 0, 0);
    rail_->show(place);
    showPanels();
    restoreColumns();
    now.workspace->enter();
    status_->setPlace(place, !now.parts.page);
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
  }
  if (!now.parts.page) view().setFocus();
}

// A column that the workspace has nothing for, or that a person has hidden, is not there.
void MainWindow::showPanels() {
  const Workspace::Parts& parts = room(place_).parts;
  const auto put = [this](QWidget* into, QWidget* Workspace::Parts::*part, bool wanted) {
    for (const Room& one : rooms_) {
      if (QWidget* its = one.parts.*part) its->setVisible(one.place == place_);
    }
    into->setVisible(room(place_).parts.*part && wanted);
  };
  put(left_, &Workspace::Parts::left, left_panel_->isChecked());
  put(right_, &Workspace::Parts::right, right_panel_->isChecked());
  put(below_, &Workspace::Parts::below, true);
  left_panel_->setEnabled(parts.left);
  right_panel_->setEnabled(parts.right);
}

void MainWindow::openOnceShown(const std::filesystem::path& path) {
  if (Workstation::isExercise(path)) train_->chooseNothing();
  // The window manager finds it its place first.
  constexpr int kPlaced_ms = 200;
  QTimer::singleShot(kPlaced_ms, this, [this, path] {
    open(path);
    if (!workstation().isOpening()) train_->showInUse();
  });
}

void MainWindow::open(const std::filesystem::path& path) {
  if (!ReviewWorkspace::isRecording(path)) return cases_->open(path);
  review_->choose(path);
  place_ == Place::review ? review_->enter() : show(Place::review);
}

void MainWindow::startExercise(std::optional<OperatorScript> script, double seconds) {
  train_->startExercise(std::move(script), seconds);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile() && cases_->mayOpen()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() != 1 || !urls.front().isLocalFile()) return;
  event->acceptProposedAction();
  open(toPath(urls.front().toLocalFile()));
}

// Where nobody else wants them: Esc puts aside what lies over the views, then leaves the full
// screen; it and Return give the keys back to the hands.
void MainWindow::keyPressEvent(QKeyEvent* event) {
  const int key = event->key();
  const bool back = key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Escape;
  if (key == Qt::Key_Escape && room(place_).workspace->escape()) return;
  if (key == Qt::Key_Escape && isFullScreen()) return full_screen_->trigger();
  if (back && !room(place_).parts.page) {
    view().setFocus();
  } else {
    QMainWindow::keyPressEvent(event);
  }
}

// --- What is remembered ---

void MainWindow::keepColumns() {
  if (room(place_).parts.page) return;
  const std::string key = std::string(settings::kColumns) + room(place_).name;
  write(Setting<QByteArray>{key.c_str(), {}}, columns_->saveState());
}

void MainWindow::restoreColumns() {
  if (room(place_).parts.page) return;
  const std::string key = std::string(settings::kColumns) + room(place_).name;
  const QByteArray kept = read(Setting<QByteArray>{key.c_str(), {}});
  const int all = centralWidget()->width() - rail_->width();  // it may not be laid out yet
  const QWidget *left = room(place_).parts.left, *right = room(place_).parts.right;
  // The views are what one looks at: a column of words has a fifth at most, and more where its
  // letters are larger.
  const int most = all * preferences().text_percent / 500;
  const int left_width = left ? std::min(left->sizeHint().width(), most) : 0;
  const int right_width = right ? right->sizeHint().width() : 0;
  if (kept.isEmpty() || !columns_->restoreState(kept)) {
    columns_->setSizes({left_width, all - left_width - right_width, right_width});
  }
}

void MainWindow::restore() {
  const QByteArray geometry = read(settings::kGeometry);
  if (!geometry.isEmpty()) (void)restoreGeometry(geometry);
  left_panel_->setChecked(read(settings::kLeftPanel));
  right_panel_->setChecked(read(settings::kRightPanel));
  // Without a case there is nothing to be done in Prepare and Train.
  if (read(settings::kWorkspace) == QLatin1String("review")) place_ = Place::review;
}

void MainWindow::keep() {
  write(settings::kGeometry, saveGeometry());
  keepColumns();
  write(settings::kLeftPanel, left_panel_->isChecked());
  write(settings::kRightPanel, right_panel_->isChecked());
  write(settings::kWorkspace, QString(room(place_).name));
}

void MainWindow::showEvent(QShowEvent* event) {
  QMainWindow::showEvent(event);
  if (entered_) return;
  show(place_);
  // A timer of no time comes when all that waits to be painted is.
  const auto once_idle = [this] { QTimer::singleShot(0, this, &MainWindow::usable); };
  if (place_ != Place::cases) return once_idle();
  connect(cases_, &CasesWorkspace::listed, this, once_idle, Qt::SingleShotConnection);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  using Phase = Workstation::Phase;
  const Phase phase = workstation().phase();
  if (workstation().isWriting()) {
    event->ignore();
    close_when_saved_ = true;
    return app_.messages().say(tr("A file is being saved; the window closes when it is written."));
  }
  if (may_close_) {
    keep();
    return QMainWindow::closeEvent(event);
  }
  event->ignore();
  // Where nothing is to be asked it closes within this call.
  const auto within = std::make_shared<bool>(true);
  const auto for_good = [this, within] {
    may_close_ = true;
    if (!*within) close();
  };
  const bool running = phase != Phase::empty && phase != Phase::ready;
  std::vector<UnsavedWork> losses = WorkGuards::ofTheCase();
  losses.push_back(UnsavedWork::tissues);
  if (running) {
    // Nobody goes on cutting while this is asked.
    Session* session = workstation().session();
    const bool pauses = session && !session->state().paused;
    if (pauses) (void)session->send(CommandKind::pause);
    QMessageBox* question =
        ask(this, "closeQuestion", tr("An exercise is running."),
            tr("Closing ends it. Its recording is kept; what was cut is not saved as a volume."),
            tr("&End it and close"), [this, for_good] {
              app_.guards().unlessLost(
                  {UnsavedWork::structures, UnsavedWork::measures, UnsavedWork::tissues}, for_good);
            });
    orElse(*question, "saveVolumeFirst", tr("&Save volume\u2026"),
           [this] { app_.caseViews().wantVolume(); });
    const QAbstractButton* stay = question->button(QMessageBox::Cancel);
    connect(question, &QMessageBox::buttonClicked, this,
            [this, stay, pauses](QAbstractButton* button) {
              Session* runs = workstation().session();
              if (button == stay && pauses && runs) (void)runs->send(CommandKind::resume);
            });
  } else if (cases_->importing()) {
    ask(this, "importQuestion", tr("A CT is being imported."),
        tr("Closing ends that: no case is made of it. Its files stay as they are."),
        tr("&End it and close"),
        [this, losses, for_good] { app_.guards().unlessLost(losses, for_good); });
  } else {
    app_.guards().unlessLost(losses, for_good);
  }
  *within = false;
  if (!may_close_) return;
  keep();
  event->accept();
  QMainWindow::closeEvent(event);
}

// --- Saying ---

// What is practised, and on which case: what its series was called may name somebody.
void MainWindow::showTitle() {
  const Case* of = workstation().currentCase();
  QStringList words;
  if (workstation().exercise()) words << toQt(workstation().exercise()->name);
  if (of && !of->stored.empty()) words << toQt(of->name);
  words << tr("Trephine");
  setWindowTitle(words.join(QStringLiteral(" \u2013 ")));
}

// At the page of what is before a person.
void MainWindow::showHelp() {
  const auto* tabs = findChild<QTabWidget*>("prepareTabs");
  const bool structures = tabs && tabs->currentIndex() == PrepareWorkspace::kStructureTab;
  trephine::showHelp(this, place_ == Place::cases    ? "first-case"
                           : place_ == Place::train  ? "first-cut"
                           : place_ == Place::review ? "review"
                           : structures              ? "structures"
                                                     : "prepare");
}

void MainWindow::checkAtStart() {
  constexpr int kBegun_ms = 1500;
  QTimer::singleShot(kBegun_ms, &status_->fitness(), &FitnessLine::look);
}

void MainWindow::sayProblem() {
  if (workstation().policy().problem) showError(this, *workstation().policy().problem);
}

}  // namespace trephine
