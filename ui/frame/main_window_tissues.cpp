// The tissue panel in the window: what it says of the arms, and edits that would be lost.
#include <QFileDialog>
#include <QKeyEvent>
#include <QMessageBox>
#include <algorithm>

#include "ui/common/words.h"
#include "ui/frame/main_window.h"

namespace trephine {

void MainWindow::showRenderable(ControllerKind in_force) {
  const Scene& scene = *workstation_.scene();
  // The weaker of the arms: the panel speaks of both.
  std::optional<Renderable> most;
  for (const SceneArm& arm : scene.arms) {
    if (!arm.dynamics) continue;
    const Renderable on_arm = renderableOn(arm, scene.rate_hz);
    most =
        most ? Renderable{std::min(most->b_max, on_arm.b_max), std::min(most->k_max, on_arm.k_max)}
             : on_arm;
  }
  tissues_->setRenderable(
      most, [scene](const Tissue& tissue) { return demandedOf(scene, tissue); }, in_force);
  controller_shown_ = in_force;
}

// Return and Esc, where nobody else wants them, give the keys back to the hands.
void MainWindow::keyPressEvent(QKeyEvent* event) {
  const int key = event->key();
  if (key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Escape) {
    view_->setFocus();
  } else {
    QMainWindow::keyPressEvent(event);
  }
}

void MainWindow::unlessTissuesStay(std::function<void()> go_on) {
  if (!workstation_.tissuesEdited()) return go_on();
  auto* box = new QMessageBox(QMessageBox::Question, tr("Trephine"),
                              tr("The tissues have been changed and not saved."),
                              QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
  box->setObjectName("unsavedTissues");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setInformativeText(tr("Save them to a file? Discarded changes cannot be had back."));
  box->setDefaultButton(QMessageBox::Save);
  connect(box, &QMessageBox::finished, this, [this, go_on = std::move(go_on)](int answer) {
    if (answer == QMessageBox::Discard) return go_on();
    if (answer != QMessageBox::Save) return;
    QFileDialog* dialog = saveDialog(tr("Save tissues"), "tissues.json", tr("Tissues (*.json)"));
    connect(dialog, &QFileDialog::fileSelected, this,
            [this, go_on](const QString& file) { workstation_.saveTissues(toPath(file), go_on); });
    dialog->open();
  });
  box->open();
}

}  // namespace trephine
