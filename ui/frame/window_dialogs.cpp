#include "ui/frame/window_dialogs.h"

#include <QFile>
#include <QMessageBox>
#include <QPointer>
#include <QPushButton>
#include <utility>

#include "base/crash_report.h"
#include "base/system.h"
#include "ui/commission/commission_page.h"
#include "ui/commission/fitness_line.h"
#include "ui/common/actions.h"
#include "ui/common/making.h"
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

WindowDialogs::WindowDialogs(QMainWindow& window, AppContext& app, HeadsetView& headset,
                             StereoView& stereo, FitnessLine& fitness)
    : QObject(&window),
      window_(window),
      app_(app),
      workstation_(app.workstation()),
      headset_(headset),
      stereo_(stereo),
      fitness_(fitness) {
  const auto add = [&](const char* name, const QString& text, const QKeySequence& key,
                       const QString& tip, void (WindowDialogs::*open)()) {
    QAction* action = makeAction(window, Symbol::settings, name, text, key, tip);
    connect(action, &QAction::triggered, this, open);
    return action;
  };
  settings_ = add("settings", tr("Settings\u2026"), Qt::CTRL | Qt::Key_Comma,
                  tr("How you like to work"), &WindowDialogs::showSettings);
  devices_ = add("devices", tr("&Devices\u2026"), Qt::CTRL | Qt::Key_D,
                 tr("The arms that are plugged in: which is the left and which the right"),
                 &WindowDialogs::showDevices);
  headset_settings_ = add("headsetSettings", tr("Headset and s&creens\u2026"), {},
                          tr("Where the patient stands, and how another screen is used"),
                          &WindowDialogs::showHeadset);
  commission_ = add("commission", tr("Co&mmission\u2026"), {},
                    tr("Whether this machine is fit, with the next step for what is not"),
                    &WindowDialogs::showCommission);
  unlock_ = add("unlockTeaching", tr("Unlock for &teaching\u2026"), {},
                tr("With an educator's PIN, until it is locked again or Trephine is closed"),
                &WindowDialogs::askForPin);
  connect(&workstation_, &Workstation::phaseChanged, this, &WindowDialogs::showPhase);
  connect(&workstation_, &Workstation::locksChanged, this, &WindowDialogs::showLocks);
  showPhase();
  showLocks();
}

bool WindowDialogs::armsAreFree() const {
  const Workstation::Phase phase = workstation_.phase();
  return phase == Workstation::Phase::ready || phase == Workstation::Phase::empty;
}

void WindowDialogs::showPhase() {
  for (QAction* action : {devices_, commission_}) action->setEnabled(armsAreFree());
}

void WindowDialogs::showLocks() {
  const bool unlocked = workstation_.isUnlocked();
  unlock_->setEnabled(unlocked ||
                      (workstation_.anyLocked() && workstation_.policy().pin.has_value()));
  unlock_->setText(unlocked ? tr("&Lock again") : tr("Unlock for &teaching\u2026"));
}

void WindowDialogs::showKeys() {
  if (auto* page = window_.findChild<ShortcutsPage*>()) {
    page->raise();
    return page->activateWindow();
  }
  QList<QPair<QString, QString>> views = FourUp::helpOfViews();
  views.prepend({tr("While an exercise runs, over the 3-D view"),
                 tr("Mouse, arrow keys: where the tool goes. Wheel up, Page Down: press more. "
                    "Wheel down, Page Up: press less. Shift+arrow keys: tilt the tool. Shift+Home: "
                    "the tool upright again. Tab: the other hand. Space: pause. Right drag, "
                    "Ctrl+arrow keys: turn the view. Ctrl+wheel: zoom.")});
  (new ShortcutsPage(window_, views, &window_))->show();
}

void WindowDialogs::showAbout() {
  auto* box = named(new QMessageBox(&window_), "aboutDialog");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setWindowTitle(tr("About Trephine"));
  box->setText(tr("Trephine %1").arg(toQt(buildName())));
  box->setInformativeText(
      tr("Turns a CT into a case on which cutting can be practised with two "
         "hands, and felt.\n\n%1.\n\n"
         "Graphics: %2")
          .arg(purposeText(), toQt(app_.caseViews().view().openGlDescription())));
  box->open();
}

void WindowDialogs::offerLeftBehind(const LeftBehind& left,
                                    std::function<void(const std::filesystem::path&)> open) {
  std::error_code ec;
  const bool recorded = std::filesystem::is_regular_file(left.recording, ec);
  if (left.report.empty() && !recorded) return;
  auto* box = named(new QMessageBox(QMessageBox::Information, tr("Trephine"),
                                    tr("Trephine ended unexpectedly the last time."),
                                    QMessageBox::NoButton, &window_),
                    "leftBehindDialog");
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
    connect(open_it, &QPushButton::clicked, this,
            [open = std::move(open), file = left.recording] { open(file); });
  }
  box->addButton(QMessageBox::Close);
  box->open();
}

void WindowDialogs::showSettings() {
  auto* dialog =
      new SettingsDialog(toQt(app_.storage()), !workstation_.policy().storage.empty(), &window_);
  connect(dialog, &SettingsDialog::changed, &app_, &AppContext::tellExercises);
  helpByF1(dialog, "settings");
  dialog->open();
}

void WindowDialogs::showDevices() {
  if (!armsAreFree()) {
    return app_.messages().say(tr("An exercise has the arms: stop it first."));
  }
  workstation_.lendArms(true);
  auto* dialog = new DevicesDialog(workstation_.opensArms(), &window_);
  connect(dialog, &DevicesDialog::letGo, this, [this] { workstation_.lendArms(false); });
  RoomPanel& room = dialog->room();
  const auto tell = [this, &room] { room.setHeadset(headset_.isSeen(), headset_.keepsRoom()); };
  connect(&headset_, &HeadsetView::changed, &room, tell);
  connect(&room, &RoomPanel::marksWanted, this, [this, &room](bool wanted) {
    if (wanted) return room.setMarks(headset_.showMarks());
    headset_.hideMarks();
  });
  tell();
  // Its marks are touched with the headset on.
  dialog->addActions({headset_.onAction(), headset_.recentreAction()});
  helpByF1(dialog, "devices");
  dialog->open();
}

void WindowDialogs::showHeadset() {
  auto* dialog = new HeadsetDialog(&window_);
  connect(dialog, &HeadsetDialog::headsetChanged, &headset_, &HeadsetView::settingsChanged);
  connect(dialog, &HeadsetDialog::screenChanged, &stereo_, &StereoView::settingsChanged);
  connect(dialog, &HeadsetDialog::lensWanted, dialog, [this, dialog] {
    app_.messages().askForFile("lensDialog", tr("A lens's file"), tr("Lenses (*.json)"),
                               [this, of = QPointer(dialog)](const std::filesystem::path& file) {
                                 const Result<LensProfile> lens = readLensProfile(file);
                                 if (!lens) return app_.messages().report(lens.error());
                                 if (of) of->setLens(toQt(file.string()));
                               });
  });
  // A window over its screen must not keep the keys from coming back here.
  connect(dialog, &QDialog::finished, this, [this] { window_.activateWindow(); });
  helpByF1(dialog, "headset");
  dialog->open();
}

void WindowDialogs::showCommission() {
  const CommissionFolders folders = commissionFolders(workstation_.policy());
  auto* page = new CommissionPage(app_.storage(), folders.own, folders.hospital, &window_);
  connect(page, &CommissionPage::begun, this, [this] { workstation_.lendArms(true); });
  connect(page, &CommissionPage::ended, this, [this] { workstation_.lendArms(false); });
  connect(page, &CommissionPage::commissioned, &fitness_, &FitnessLine::look);
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

void WindowDialogs::askForPin() {
  if (workstation_.isUnlocked()) {
    const auto lock = [this] {
      workstation_.setUnlocked(false);
      app_.messages().say(tr("Locked again."));
    };
    return workstation_.tissuesWouldGo() ? app_.guards().unlessLost({UnsavedWork::tissues}, lock)
                                         : lock();
  }
  if (!workstation_.policy().pin) return;
  auto* dialog = new UnlockDialog(*workstation_.policy().pin, &window_);
  connect(dialog, &UnlockDialog::unlocked, this, [this] {
    workstation_.setUnlocked(true);
    app_.messages().say(tr("Unlocked for teaching, until you lock it again (menu File)."));
  });
  dialog->open();
}

}  // namespace trephine
