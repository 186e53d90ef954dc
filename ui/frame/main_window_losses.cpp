// What would lose work: it is asked once, and the way to keep the work is offered.
#include <QCloseEvent>
#include <QFileDialog>
#include <QPushButton>

#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"

namespace trephine {

void MainWindow::unlessCutsAreLost(std::function<void()> go_on) {
  if (!unsaved_cuts_) return go_on();
  QMessageBox* question =
      ask(front(), "cutsQuestion", tr("What was cut is not saved as a volume."),
          tr("Going on takes it from the view. The recording of the exercise is kept."),
          tr("&Go on without it"), go_on);
  auto* save = question->addButton(tr("&Save volume\u2026"), QMessageBox::AcceptRole);
  save->setObjectName("saveFirst");
  connect(
      save, &QPushButton::clicked, this,
      [this, go_on = std::move(go_on)] { askToSaveVolume(go_on); }, Qt::QueuedConnection);
}

void MainWindow::askToSaveVolume(std::function<void()> then) {
  QFileDialog* dialog =
      saveDialog(tr("Save volume"), "carved.mha", tr("MetaImage (*.mha);;NIfTI (*.nii *.nii.gz)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, then = std::move(then)](const QString& file) { saveVolumeThen(file, then); });
  dialog->open();
}

void MainWindow::saveVolume(const QString& file) {
  saveVolumeThen(file, {});
}

void MainWindow::saveVolumeThen(const QString& file, std::function<void()> then) {
  if (!keepsTheCase(toPath(file))) return;
  // What a running exercise shows may be cut further.
  const bool all = workstation_.phase() == Workstation::Phase::ready;
  say(tr("Saving the volume\u2026"));
  workstation_.saveVolume(toPath(file), [this, all, then = std::move(then)] {
    if (all) unsaved_cuts_ = false;
    if (then) then();
  });
}

void MainWindow::unlessSceneIsLost(std::function<void()> go_on) {
  unlessCutsAreLost([this, go_on = std::move(go_on)] { unlessTissuesStay(go_on); });
}

void MainWindow::start() {
  if (editor_.busy()) {
    return say(tr("A structure is being made: wait for it, or cancel it, and start then."));
  }
  if (editor_.preview() && editor_.preview()->leaked) return askAboutPreview();
  if (editor_.preview()) editor_.takePreview();
  if (!takeStructures())
    return say(tr("The structures are being put in place: try again in a moment."));
  if (workstation_.isOpening()) {  // what was made a moment ago, first
    start_when_placed_ = true;
    return;
  }
  unlessItDoesNotFit([this] { unlessCutsAreLost([this] { startExercise(); }); });
}

void MainWindow::reset() {
  if (Session* session = workstation_.session()) {
    const LoopState& state = session->state();
    if (!state.can_undo && !state.can_redo) return;  // nothing was cut
    ask(this, "resetQuestion", tr("Put all tissue back?"),
        tr("Undo cannot bring the cuts again; the bar of seconds still leads back to them. Hands "
           "that mouse and keys move go back to where they began."),
        tr("&Put back"), [this] { command(CommandKind::reset); });
  } else if (workstation_.phase() == Workstation::Phase::ready) {
    unlessCutsAreLost([this] { showWholeCase(); });
  }
}

void MainWindow::showWholeCase() {
  carved_ = unsaved_cuts_ = false;
  workstation_.makeWhole();
  const Case& of = *workstation_.currentCase();
  views_->refill(of.volume, of.labels);
  showPhase();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  if (workstation_.isWriting()) {
    event->ignore();
    close_when_saved_ = true;
    return say(tr("A file is being saved; the window closes when it is written."));
  }
  const bool running = phase != Phase::empty && phase != Phase::ready;
  if (may_close_ || !(running || unsaved_cuts_ || workstation_.tissuesEdited() ||
                      workstation_.tissuesWait() || editor_.edited())) {
    return QMainWindow::closeEvent(event);
  }
  event->ignore();
  const auto for_good = [this] {
    unlessStructuresAreLost([this] {
      unlessTissuesStay([this] {
        may_close_ = true;
        close();
      });
    });
  };
  if (!running) return unlessCutsAreLost(for_good);
  ask(front(), "closeQuestion", tr("An exercise is running."),
      tr("Closing ends it. Its recording is kept; what was cut is not saved as a volume."),
      tr("&End it and close"), for_good);
}

}  // namespace trephine
