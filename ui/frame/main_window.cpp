#include "ui/frame/main_window.h"

#include <QCoreApplication>
#include <QDragEnterEvent>
#include <QFile>
#include <QMessageBox>
#include <QMimeData>
#include <QPointer>
#include <QPushButton>
#include <QStatusBar>
#include <QTabWidget>
#include <QTimer>
#include <algorithm>
#include <utility>

#include "base/crash_report.h"
#include "base/system.h"
#include "ui/commission/commission_page.h"
#include "ui/commission/fitness_line.h"
#include "ui/common/error_dialog.h"
#include "ui/common/question.h"
#include "ui/common/preferences.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/devices/devices_dialog.h"
#include "ui/frame/help_page.h"
#include "ui/frame/settings_dialog.h"
#include "ui/frame/shortcuts_page.h"
#include "ui/frame/unlock_dialog.h"
#include "ui/headset/headset_dialog.h"
#include "ui/headset/headset_view.h"
#include "ui/headset/stereo_view.h"

namespace trephine {

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
  const Room& now = room(place);
  {
    const FourUp::Still until_all_has_its_place(views());
    if (now.parts.page) {
      // Nobody sees what the arms do.
      if (Session* session = workstation().session()) (void)session->send(CommandKind::pause);
      pages_->setCurrentWidget(now.parts.page);
    } else {
      pages_->setCurrentWidget(views_page_);
      views().useLayoutOf(now.name, now.layout);
    }
    bar_->setVisible(!now.parts.page);
    // Its buttons stay where they are.
    rail_->setContentsMargins(0, now.parts.page ? bar_->sizeHint().height() : 0, 0, 0);
    rail_->show(place);
    showPanels();
    restoreColumns();
    now.workspace->enter();
    showHint();
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

void MainWindow::offerLeftBehind(const LeftBehind& left) {
  std::error_code ec;
  const bool recorded = std::filesystem::is_regular_file(left.recording, ec);
  if (left.report.empty() && !recorded) return;
  auto* box = new QMessageBox(QMessageBox::Information, tr("Trephine"),
                              tr("Trephine ended unexpectedly the last time."),
                              QMessageBox::NoButton, this);
  box->setObjectName("leftBehindDialog");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setTextFormat(Qt::PlainText);
  QStringList more;
  if (recorded) more << tr("The exercise is recorded up to then.");
  if (!left.report.empty()) {
    QFile file(toQt(left.report.string()));
    if (file.open(QIODevice::ReadOnly)) box->setDetailedText(QString::fromUtf8(file.readAll()));
    more << tr("A report for those who look after Trephine lies in %1. It names nobody, and "
               "nothing was sent.")
                .arg(toQt(left.report.string()));
  }
  box->setInformativeText(more.join("\n\n"));
  if (recorded) {
    QPushButton* open_it = box->addButton(tr("&Open the recording"), QMessageBox::AcceptRole);
    open_it->setObjectName("openLeftBehind");
    connect(open_it, &QPushButton::clicked, this, [this, file = left.recording] { open(file); });
  }
  box->addButton(QMessageBox::Close);
  box->open();
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
  const QString name = read(settings::kWorkspace);
  for (const Room& one : rooms_) {
    if (name == QLatin1String(one.name)) place_ = one.place;
  }
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
  app_.guards().takeTyped();
  const bool running = phase != Phase::empty && phase != Phase::ready;
  const bool unsaved = app_.caseViews().cutsUnsaved() || workstation().tissuesEdited() ||
                       workstation().exerciseEdited() || prepare_->structuresEdited();
  if (may_close_ || !(running || unsaved)) {
    keep();
    return QMainWindow::closeEvent(event);
  }
  event->ignore();
  const auto for_good = [this] {
    app_.guards().unlessLost({UnsavedWork::structures, UnsavedWork::tissues}, [this] {
      may_close_ = true;
      close();
    });
  };
  if (!running) return app_.guards().unlessLost({UnsavedWork::cuts}, for_good);
  ask(this, "closeQuestion", tr("An exercise is running."),
      tr("Closing ends it. Its recording is kept; what was cut is not saved as a volume."),
      tr("&End it and close"), for_good);
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

void MainWindow::showHint() {
  hint_->setText(room(place_).parts.page  ? QString()
                 : !help_words_.isEmpty() ? help_words_
                                          : hint_words_);
  // A message stands in their place.
  const bool free = statusBar()->currentMessage().isEmpty(), first = place_ == Place::cases;
  fitness_->setVisible(free && first);
  hint_->setVisible(free && !first);
}

void MainWindow::showAbout() {
  auto* box = new QMessageBox(this);
  box->setObjectName("aboutDialog");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setWindowTitle(tr("About Trephine"));
  box->setText(tr("Trephine %1").arg(toQt(buildName())));
  box->setInformativeText(tr("Turns a CT into a case on which cutting can be practised with two "
                             "hands, and felt.\n\n%1.\n\n"
                             "Graphics: %2")
                              .arg(purposeText(), toQt(view().openGlDescription())));
  box->open();
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

void MainWindow::showShortcuts() {
  if (auto* page = findChild<ShortcutsPage*>()) {
    page->raise();
    return page->activateWindow();
  }
  QList<QPair<QString, QString>> views = this->views().helpOfViews();
  views.prepend({tr("While an exercise runs, over the 3-D view"),
                 tr("Mouse, arrow keys: where the tool goes. Wheel up, Page Down: press more. "
                    "Wheel down, Page Up: press less. Shift+arrow keys: tilt the tool. Shift+Home: "
                    "the tool upright again. Tab: the other hand. Space: pause. Right drag, "
                    "Ctrl+arrow keys: turn the view. Ctrl+wheel: zoom.")});
  (new ShortcutsPage(*this, views, this))->show();
}

void MainWindow::showSettings() {
  auto* dialog =
      new SettingsDialog(toQt(app_.storage()), !workstation().policy().storage.empty(), this);
  helpByF1(dialog, "settings");
  dialog->open();
}

void MainWindow::showDevices() {
  if (workstation().phase() != Workstation::Phase::ready &&
      workstation().phase() != Workstation::Phase::empty) {
    return app_.messages().say(tr("An exercise has the arms: stop it first."));
  }
  workstation().lendArms(true);
  auto* dialog = new DevicesDialog(workstation().opensArms(), this);
  connect(dialog, &DevicesDialog::letGo, this, [this] { workstation().lendArms(false); });
  RoomPanel& room = dialog->room();
  const auto tell = [this, &room] { room.setHeadset(headset_->isSeen(), headset_->keepsRoom()); };
  connect(headset_, &HeadsetView::changed, &room, tell);
  connect(&room, &RoomPanel::marksWanted, this, [this, &room](bool wanted) {
    if (wanted) return room.setMarks(headset_->showMarks());
    headset_->hideMarks();
  });
  tell();
  // Its marks are touched with the headset on.
  dialog->addActions({headset_->onAction(), headset_->recentreAction()});
  helpByF1(dialog, "devices");
  dialog->open();
}

// What is read by both eyes, and what the window itself takes.
void MainWindow::showEyes() {
  QStringList words{headset_->isOn() ? headset_->words() : stereo_->words()};
  if (words.front().isEmpty()) {
    eyes_->hide();
    return eyes_->clear();
  }
  // While it shows what an eye sees it draws nothing itself.
  if (panel_ms_ >= 0.05) words << tr("window %1 ms").arg(panel_ms_, 0, 'f', 1);
  eyes_->setText(words.join(QStringLiteral(" \u00b7 ")));
  eyes_->setVisible(statusBar()->currentMessage().isEmpty());
}

void MainWindow::showHeadset() {
  auto* dialog = new HeadsetDialog(this);
  connect(dialog, &HeadsetDialog::headsetChanged, headset_, &HeadsetView::settingsChanged);
  connect(dialog, &HeadsetDialog::screenChanged, stereo_, &StereoView::settingsChanged);
  connect(dialog, &HeadsetDialog::lensWanted, dialog, [this, dialog] {
    app_.messages().askForFile("lensDialog", tr("A lens's file"), tr("Lenses (*.json)"),
                               [this, of = QPointer(dialog)](const std::filesystem::path& file) {
                                 const Result<LensProfile> lens = readLensProfile(file);
                                 if (!lens) return app_.messages().report(lens.error());
                                 if (of) of->setLens(toQt(file.string()));
                               });
  });
  // A window over its screen must not keep the keys from coming back here.
  connect(dialog, &QDialog::finished, this, [this] { activateWindow(); });
  helpByF1(dialog, "headset");
  dialog->open();
}

void MainWindow::checkAtStart() {
  constexpr int kBegun_ms = 1500;
  QTimer::singleShot(kBegun_ms, fitness_, &FitnessLine::look);
}

void MainWindow::showCommission() {
  const CommissionFolders folders = commissionFolders(workstation().policy());
  auto* page = new CommissionPage(app_.storage(), folders.own, folders.hospital, this);
  connect(page, &CommissionPage::begun, this, [this] { workstation().lendArms(true); });
  connect(page, &CommissionPage::ended, this, [this] { workstation().lendArms(false); });
  connect(page, &CommissionPage::commissioned, fitness_, &FitnessLine::look);
  connect(page, &CommissionPage::saveWanted, page, [this, page] {
    QFileDialog* dialog =
        app_.messages().saveDialog(tr("Save the commissioning"), "commissioning.pdf",
                                   tr("PDF (*.pdf);;A page for a browser (*.html)"));
    connect(dialog, &QFileDialog::fileSelected, page, [this, page](const QString& file) {
      const Status saved = page->save(toPath(file));
      saved ? app_.messages().say(tr("The commissioning is saved."))
            : app_.messages().report(saved.error());
    });
    dialog->open();
  });
  helpByF1(page, "commission");
  page->open();
}

void MainWindow::showLocks() {
  const bool locked = workstation().anyLocked(), unlocked = workstation().isUnlocked();
  const Policy& policy = workstation().policy();
  unlock_->setEnabled(unlocked || (locked && policy.pin.has_value()));
  unlock_->setText(unlocked ? tr("&Lock again") : tr("Unlock for &teaching\u2026"));
  locked_->setVisible(locked || unlocked);
  locked_->setText(unlocked ? tr("Unlocked") : tr("Locked"));
  locked_->setToolTip(unlocked ? tr("Until it is locked again (menu File), or Trephine is closed")
                               : unlockWords(policy));
}

void MainWindow::sayProblem() {
  if (workstation().policy().problem) showError(this, *workstation().policy().problem);
}

void MainWindow::askForPin() {
  if (workstation().isUnlocked()) {
    const auto lock = [this] {
      workstation().setUnlocked(false);
      app_.messages().say(tr("Locked again."));
    };
    return workstation().tissuesWouldGo() ? app_.guards().unlessLost({UnsavedWork::tissues}, lock)
                                          : lock();
  }
  if (!workstation().policy().pin) return;
  auto* dialog = new UnlockDialog(*workstation().policy().pin, this);
  connect(dialog, &UnlockDialog::unlocked, this, [this] {
    workstation().setUnlocked(true);
    app_.messages().say(tr("Unlocked for teaching, until you lock it again (menu File)."));
  });
  dialog->open();
}

}  // namespace trephine
