// How the window is put together.
#include <QHBoxLayout>
#include <QMenuBar>
#include <QPushButton>
#include <QStatusBar>
#include <QVBoxLayout>

#include "ui/commission/fitness_line.h"
#include "ui/common/actions.h"
#include "ui/common/colours.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/headset/headset_view.h"
#include "ui/headset/stereo_view.h"
#include "ui/views/view_strip.h"

namespace trephine {

namespace {
constexpr int kProgressSteps = 1000, kProgressWidth = 140;
}  // namespace

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
    auto* slot_layout = new QVBoxLayout(*slot);
    slot_layout->setContentsMargins(0, 0, 0, 0);
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
  auto* middle_layout = new QVBoxLayout(middle);
  middle_layout->setContentsMargins(0, 0, 0, 0);
  middle_layout->setSpacing(0);
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
  views_page_ = columns_;
  pages_->addWidget(views_page_);

  auto* all = new QWidget;
  auto* layout = new QHBoxLayout(all);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(rail_);
  layout->addWidget(pages_, 1);
  setCentralWidget(all);
}

void MainWindow::buildActions() {
  picture_ = makeAction(*this, Symbol::picture, "savePicture", tr("Save picture\u2026"),
                        QKeySequence(Qt::Key_F12), tr("Save the 3-D view as a picture"));
  volume_ = makeAction(*this, Symbol::save, "saveVolume", tr("Save volume\u2026"),
                       QKeySequence::Save, tr("Save the volume as it is now, with what was cut"));
  look_ = makeAction(*this, Symbol::view, "resetView", tr("Reset view"), QKeySequence(Qt::Key_Home),
                     tr("Look at the case as at the start"));
  left_panel_ = makeAction(*this, Symbol::view, "leftPanel", tr("Left panel"),
                           QKeySequence(Qt::CTRL | Qt::Key_B), tr("Show or hide the left panel"));
  right_panel_ = makeAction(*this, Symbol::view, "rightPanel", tr("Right panel"),
                            QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_B),
                            tr("Show or hide the right panel"));
  full_screen_ = makeAction(*this, Symbol::view, "fullScreen", tr("Full screen"),
                            QKeySequence(Qt::Key_F11), tr("The whole screen; Esc leaves it"));
  for (QAction* action : {left_panel_, right_panel_, full_screen_}) action->setCheckable(true);
  settings_ = makeAction(*this, Symbol::settings, "settings", tr("Settings\u2026"),
                         QKeySequence(Qt::CTRL | Qt::Key_Comma), tr("How you like to work"));
  devices_ = makeAction(*this, Symbol::settings, "devices", tr("&Devices\u2026"),
                        QKeySequence(Qt::CTRL | Qt::Key_D),
                        tr("The arms that are plugged in: which is the left and which the right"));
  headset_settings_ =
      makeAction(*this, Symbol::settings, "headsetSettings", tr("Headset and s&creens\u2026"), {},
                 tr("Where the patient stands, and how another screen is used"));
  commission_ = makeAction(*this, Symbol::settings, "commission", tr("Co&mmission\u2026"), {},
                           tr("Whether this machine is fit, with the next step for what is not"));
  unlock_ =
      makeAction(*this, Symbol::settings, "unlockTeaching", tr("Unlock for &teaching\u2026"), {},
                 tr("With an educator's PIN, until it is locked again or Trephine is closed"));
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

  hint_ = new ElidedLabel;
  hint_->setObjectName("hint");
  hint_->setContentsMargins(6, 0, 0, 0);
  hint_->setProperty("quiet", true);
  opening_ = new QProgressBar;
  opening_->setObjectName("openProgress");
  opening_->setRange(0, kProgressSteps);
  opening_->setTextVisible(false);
  opening_->setMaximumHeight(14);
  opening_->setFixedWidth(kProgressWidth);
  auto* cancel = new QPushButton(tr("Cancel"));
  cancel->setObjectName("cancelOpening");
  connect(cancel, &QPushButton::clicked, this, [this] {
    workstation().cancelOpening();
    workstation().cancelSaving();
  });
  opening_box_ = new QWidget;
  opening_words_ = new ElidedLabel;
  opening_words_->setObjectName("openWords");
  auto* opening_row = new QHBoxLayout(opening_box_);
  opening_row->setContentsMargins(0, 0, 0, 0);
  opening_row->addWidget(opening_words_);
  opening_row->addWidget(opening_);
  opening_row->addWidget(cancel);
  opening_box_->hide();
  eyes_ = new ElidedLabel;
  eyes_->setObjectName("eyes");
  eyes_->setProperty("quiet", true);
  eyes_->hide();
  rates_ = new ElidedLabel;
  rates_->setObjectName("rates");
  rates_->setProperty("quiet", true);
  locked_ = new QLabel(tr("Locked"));
  locked_->setObjectName("locked");
  locked_->setContentsMargins(8, 0, 8, 0);
  colours::setText(*locked_, colours::kCaution);
  auto* purpose = new QLabel(purposeText());
  purpose->setObjectName("purpose");
  purpose->setContentsMargins(12, 0, 6, 0);
  fitness_ = new FitnessLine(workstation(), view(), app_.storage());
  statusBar()->addWidget(hint_, 1);
  statusBar()->addWidget(fitness_, 1);
  statusBar()->addPermanentWidget(opening_box_);
  statusBar()->addPermanentWidget(eyes_);
  statusBar()->addPermanentWidget(rates_);
  statusBar()->addPermanentWidget(locked_);
  statusBar()->addPermanentWidget(purpose);
}

void MainWindow::buildMenus() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  file->addActions(cases_->openActions());
  file->addSeparator();
  file->addActions({prepare_->saveInCaseAction(), volume_, picture_});
  file->addSeparator();
  file->addActions({settings_, devices_, commission_, unlock_});
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
  view->addActions(
      {headset_->onAction(), headset_->recentreAction(), stereo_->onAction(), headset_settings_});
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("&Help"), QKeySequence(Qt::Key_F1), this, &MainWindow::showHelp)
      ->setObjectName("help");
  QAction* keys = help->addAction(tr("&Keys"), QKeySequence(Qt::SHIFT | Qt::Key_F1), this,
                                  &MainWindow::showShortcuts);
  keys->setObjectName("keys");
  help->addAction(tr("&About Trephine"), this, &MainWindow::showAbout)->setObjectName("about");
}

void MainWindow::connectParts() {
  connect(headset_, &HeadsetView::changed, this, [this] {
    train_->setCardsWanted(headset_->isOn());
    if (!workstation().session()) headset_->setCards({});
    if (headset_->isSeen()) stereo_->stop();
    showEyes();
  });
  connect(stereo_, &StereoView::changed, this, &MainWindow::showEyes);
  connect(&view(), &ViewWidget::framePainted, this, [this](double ms) { panel_ms_ = ms; });
  // One pair of pictures at a time; a headset that cannot be had takes no screen away.
  connect(stereo_->onAction(), &QAction::toggled, this, [this](bool on) {
    if (on && stereo_->isOn()) headset_->onAction()->setChecked(false);
  });
  connect(train_, &TrainWorkspace::cardsChanged, headset_, &HeadsetView::setCards);
  connect(train_, &TrainWorkspace::recentreWanted, headset_, &HeadsetView::recentre);
  connect(rail_, &Rail::chosen, this, qOverload<Place>(&MainWindow::show));
  connect(&app_, &AppContext::placeWanted, this, qOverload<Place>(&MainWindow::show));
  connect(&app_.messages(), &Messages::failed, this, &MainWindow::failed);
  connect(&app_.messages(), &Messages::said, this, [this](const QString& text) {
    constexpr int kMessage_ms = 15000;
    text.isEmpty() ? statusBar()->clearMessage() : statusBar()->showMessage(text, kMessage_ms);
  });
  connect(&app_.messages(), &Messages::hinted, this, [this](const QString& words) {
    hint_words_ = words;
    showHint();
  });
  connect(&views(), &FourUp::helpChanged, this, [this](const QString& words) {
    help_words_ = words;
    showHint();
  });
  connect(train_, &TrainWorkspace::ratesChanged, rates_, &QLabel::setText);
  connect(train_, &TrainWorkspace::structureWanted, prepare_, &PrepareWorkspace::makeMissing);
  connect(train_, &TrainWorkspace::replayWanted, this, [this] {
    show(Place::review);
    review_->replayNewest();
  });
  connect(look_, &QAction::triggered, &app_.caseViews(), &CaseViews::lookAtCase);
  connect(picture_, &QAction::triggered, &app_.caseViews(), &CaseViews::askToSavePicture);
  connect(volume_, &QAction::triggered, this, [this] { app_.caseViews().askToSaveVolume({}); });
  for (QAction* panel : {left_panel_, right_panel_}) {
    connect(panel, &QAction::toggled, this, &MainWindow::showPanels);
  }
  connect(full_screen_, &QAction::toggled, this,
          [this](bool full) { setWindowState(windowState().setFlag(Qt::WindowFullScreen, full)); });
  connect(settings_, &QAction::triggered, this, &MainWindow::showSettings);
  connect(devices_, &QAction::triggered, this, &MainWindow::showDevices);
  connect(headset_settings_, &QAction::triggered, this, &MainWindow::showHeadset);
  connect(commission_, &QAction::triggered, this, &MainWindow::showCommission);
  connect(unlock_, &QAction::triggered, this, &MainWindow::askForPin);
  connect(&app_.workstation(), &Workstation::locksChanged, this, &MainWindow::showLocks);
  showLocks();

  Workstation& workstation = app_.workstation();
  const auto showPhase = [this] {
    const bool any = this->workstation().phase() != Workstation::Phase::empty;
    for (QAction* action : {picture_, volume_, look_}) action->setEnabled(any);
    for (QAction* action : {devices_, commission_}) {
      action->setEnabled(!any || this->workstation().phase() == Workstation::Phase::ready);
    }
  };
  connect(&workstation, &Workstation::phaseChanged, this, showPhase);
  showPhase();
  for (auto changed : {&Workstation::exerciseChanged, &Workstation::caseNamed}) {
    connect(&workstation, changed, this, &MainWindow::showTitle);
  }
  connect(&workstation, &Workstation::openingProgressed, this,
          [this](double fraction, const QString& step) {
            if (this->workstation().isPlacing()) return;  // a moment, of what is on the screen
            opening_box_->show();
            opening_words_->setText(step);
            opening_->setValue(int(fraction * kProgressSteps));
          });
  // What is said needs the room.
  connect(statusBar(), &QStatusBar::messageChanged, rates_, [this](const QString& said) {
    rates_->setVisible(said.isEmpty());
    showHint();
    showEyes();
  });
  connect(&workstation, &Workstation::openingEnded, opening_box_, &QWidget::hide);
  connect(&workstation, &Workstation::savingProgressed, this,
          [this](double fraction, const QString& step) {
            app_.messages().say(tr("%1\u2026 %2 %").arg(step).arg(int(100.0 * fraction)));
            opening_box_->show();
            opening_words_->clear();  // in the line beside it
            opening_->setValue(int(fraction * kProgressSteps));
          });
  connect(&workstation, &Workstation::savingEnded, opening_box_, &QWidget::hide);
  connect(
      &workstation, &Workstation::savingEnded, this,
      [this] {
        if (std::exchange(close_when_saved_, false)) close();
      },
      Qt::QueuedConnection);  // what follows a save first
}

}  // namespace trephine
