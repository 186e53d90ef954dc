// What would lose work: it is asked once, and the way to keep the work is offered.
#include <QCloseEvent>
#include <QPushButton>

#include "ui/main_window.h"
#include "ui/question.h"
#include "ui/words.h"

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
      [this, go_on = std::move(go_on)] {
        volume_->trigger();  // asks where, and forgets what an earlier save was to lead to
        after_saving_ = go_on;
      },
      Qt::QueuedConnection);
}

void MainWindow::start() {
  unlessCutsAreLost([this] { startExercise(); });
}

void MainWindow::reset() {
  if (Session* session = workstation_.session()) {
    const LoopState& state = session->state();
    if (!state.can_undo && !state.can_redo) return;  // nothing was cut
    ask(this, "resetQuestion", tr("Put all tissue back?"),
        tr("Undo cannot bring the cuts again. The bar of seconds still leads back to them."),
        tr("&Put back"), [this] { command(CommandKind::reset); });
  } else if (workstation_.phase() == Workstation::Phase::ready) {
    unlessCutsAreLost([this] { showWholeCase(); });
  }
}

void MainWindow::showWholeCase() {
  carved_ = unsaved_cuts_ = false;
  view_->showVolume(Grid(*workstation_.volume(), workstation_.labels()));
  showPhase();
}

// A scene brings its own case; any other path is only looked through until its case is read.
void MainWindow::openPath(const QString& path) {
  const auto open = [this, path] { workstation_.openPath(toPath(path)); };
  if (!Workstation::isScene(toPath(path))) return open();
  unlessCutsAreLost([this, open] { unlessTissuesStay(open); });
}

void MainWindow::closeEvent(QCloseEvent* event) {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool running = phase != Phase::empty && phase != Phase::ready;
  const bool asks = running || unsaved_cuts_ || workstation_.tissuesEdited();
  if (closing_ || !asks) return event->accept();
  event->ignore();
  const auto close_anyway = [this] {
    closing_ = true;
    close();
  };
  const auto then = [this, close_anyway] { unlessTissuesStay(close_anyway); };
  if (!running) return unlessCutsAreLost(then);
  ask(front(), "closeQuestion", tr("An exercise is running."),
      tr("Closing ends it. Its recording is kept; what was cut is not saved as a volume."),
      tr("&End it and close"), then);
}

}  // namespace trephine
