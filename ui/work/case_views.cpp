#include "ui/work/case_views.h"

#include <QMessageBox>
#include <QPushButton>

#include "ui/common/event_loop.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/views/saved_picture.h"

namespace trephine {

CaseViews::CaseViews(QMainWindow& window, Workstation& workstation, Messages& messages,
                     WorkGuards& guards)
    : QObject(&window),
      window_(window),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      views_(new FourUp(&window)) {
  guards_.setGuard(UnsavedWork::cuts,
                   [this](WorkGuards::Next go_on) { unlessCutsAreLost(std::move(go_on)); });
  connect(&workstation_, &Workstation::caseOpened, this, &CaseViews::showCase);
  connect(&workstation_, &Workstation::startFailed, this, [this] {
    if (carved_) showWholeCase();
  });
  connect(&view(), &ViewWidget::failed, &messages_, &Messages::report);
}

void CaseViews::unlessCutsAreLost(WorkGuards::Next go_on) {
  if (!cuts_unsaved_) return go_on();
  QMessageBox* question =
      ask(&window_, "cutsQuestion", tr("What was cut is not saved as a volume."),
          tr("It then goes from the view. The recording of the exercise is kept."),
          tr("&Do not save it"), go_on);
  orElse(*question, "saveFirst", tr("&Save volume\u2026"),
         [this, go_on = std::move(go_on)] { askToSaveVolume(go_on); });
}

void CaseViews::setCuts(bool carved, bool unsaved) {
  carved_ = carved;
  cuts_unsaved_ = unsaved;
  emit cutsChanged();
}

void CaseViews::showCase() {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed) return;
  const std::shared_ptr<const Volume>& volume = placed->patient.volume;
  paintNextTurn(window_);  // and what it takes to show the case is enough for one
  view().setTools({});
  views_->setTools({});
  if (Volume mirror = workstation_.takeMirror(); !mirror.hu.empty()) {
    views_->showVolume(std::move(mirror), placed->labels, volume);
  } else {
    views_->refill(volume, placed->labels);
  }
  setCuts(false, false);
  emit caseShown();
  lookAtCase();
}

// The view has the case already, unless an earlier exercise left its cuts there.
void CaseViews::exerciseBegan() {
  const Placement& placed = *workstation_.placed();
  if (carved_) views_->refill(placed.patient.volume, placed.labels);
  setCuts(true, false);
}

void CaseViews::showWholeCase() {
  workstation_.makeWhole();
  const Placement& placed = *workstation_.placed();
  views_->refill(placed.patient.volume, placed.labels);
  setCuts(false, false);
}

void CaseViews::lookAtCase() {
  if (const std::optional<LandmarkFrame> landmark = workstation_.viewLandmark()) {
    views_->setPoint(landmark->position_mm);
    view().lookAtLandmark(*landmark, workstation_.exercise()->view.distance_mm);
  } else {
    view().lookFromFront();
  }
}

void CaseViews::askToSavePicture() {
  QFileDialog* dialog =
      messages_.saveDialog(tr("Save picture"), "trephine.png", tr("Picture (*.png)"));
  connect(dialog, &QFileDialog::fileSelected, this, &CaseViews::savePicture);
  dialog->open();
}

void CaseViews::savePicture(const QString& file) {
  Result<Picture> picture = view().picture();
  if (!picture) return messages_.report(picture.error());
  workstation_.save(tr("The picture is saved."),
                    [picture = withPurpose(*picture), path = toPath(file)](const Progress&) {
                      return writePng(picture, path);
                    });
}

void CaseViews::askToSaveVolume(WorkGuards::Next then) {
  QFileDialog* dialog = messages_.saveDialog(tr("Save volume"), "carved.mha",
                                             tr("MetaImage (*.mha);;NIfTI (*.nii *.nii.gz)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, then = std::move(then)](const QString& file) { saveVolume(file, then); });
  dialog->open();
}

void CaseViews::saveVolume(const QString& file, WorkGuards::Next then) {
  if (!guards_.keepsTheCase(toPath(file))) return;
  // What a running exercise shows may be cut further.
  const bool all = workstation_.phase() == Workstation::Phase::ready;
  messages_.say(tr("Saving the volume\u2026"));
  workstation_.saveVolume(toPath(file), [this, all, then = std::move(then)] {
    if (all) setCuts(carved_, false);
    if (then) then();
  });
}

}  // namespace trephine
