#include "ui/work/case_views.h"

#include <QMessageBox>
#include <QPushButton>

#include "base/file.h"
#include "ui/common/event_loop.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/views/saved_picture.h"
#include "ui/views/view_strip.h"
#include "ui/work/opening_card.h"
#include "ui/work/point_to_show.h"

namespace trephine {

CaseViews::CaseViews(QMainWindow& window, Workstation& workstation, Messages& messages,
                     WorkGuards& guards)
    : QObject(&window),
      window_(window),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      views_(new FourUp(&window)) {
  new OpeningCard(*views_, workstation_);  // the views' own
  guards_.setGuard(UnsavedWork::cuts,
                   [this](WorkGuards::Next go_on) { unlessCutsAreLost(std::move(go_on)); });
  guards_.setGuard(UnsavedWork::measures,
                   [this](WorkGuards::Next go_on) { unlessMeasuresAreLost(std::move(go_on)); });
  connect(&workstation_, &Workstation::caseOpened, this, &CaseViews::showCase);
  const auto offerEntry = [this] {
    view().tools().setExerciseView(workstation_.viewLandmark().has_value());
  };
  connect(&workstation_, &Workstation::structuresChanged, this, offerEntry);
  connect(&workstation_, &Workstation::exerciseChanged, this, offerEntry);
  connect(&workstation_, &Workstation::startFailed, this, [this] {
    if (carved_) showWholeCase();
  });
  connect(&view(), &ViewWidget::failed, &messages_, &Messages::report);
  connect(&view().tools(), &ViewStrip::exerciseViewWanted, this, &CaseViews::lookAtEntry);
}

void CaseViews::unlessCutsAreLost(WorkGuards::Next go_on) {
  if (!cuts_unsaved_ || (recorded_ && !volume_wanted_)) return go_on();
  QMessageBox* question =
      ask(&window_, "cutsQuestion", tr("What was cut is not saved as a volume."),
          recorded_ ? tr("It then goes from the view. The recording of the exercise is kept.")
                    : tr("It then goes from the view, and no recording has all of it."),
          tr("&Do not save it"), go_on);
  orElse(*question, "saveFirst", tr("&Save volume\u2026"),
         [this, go_on = std::move(go_on)] { askToSaveVolume(go_on); });
}

// They come with every look, and no case keeps them.
void CaseViews::unlessMeasuresAreLost(WorkGuards::Next go_on) {
  const QStringList measures = views_->measureWords();
  if (measures.isEmpty() || measures == noted_) return go_on();
  constexpr qsizetype kMost = 8;
  QStringList shown = measures.mid(0, kMost);
  if (measures.size() > kMost) shown << tr("and %1 more").arg(measures.size() - kMost);
  QMessageBox* question =
      ask(&window_, "measuresQuestion", tr("What was measured is kept in no file."),
          shown.join('\n'), tr("&Go on without it"), go_on);
  orElse(*question, "saveMeasures", tr("Save as &text\u2026"),
         [this, measures, go_on = std::move(go_on)] {
           QFileDialog* dialog = messages_.saveDialog(tr("Save what was measured"),
                                                      "measurements.txt", tr("Text (*.txt)"));
           connect(dialog, &QFileDialog::fileSelected, this,
                   [this, measures, go_on](const QString& file) {
                     if (!guards_.keepsTheCase(toPath(file))) return;
                     workstation_.save(
                         tr("What was measured is saved."),
                         [text = (measures.join('\n') + '\n').toStdString(), path = toPath(file)](
                             const Progress&) { return writeTextFile(path, text); },
                         [this, measures, go_on] {
                           noted_ = measures;
                           go_on();
                         });
                   });
           dialog->open();
         });
}

void CaseViews::exerciseEnded(bool anything_cut, bool recorded) {
  recorded_ = recorded;
  setCuts(carved_, anything_cut);
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
  volume_wanted_ = false;
  setCuts(false, false);
  emit caseShown();
  lookAtCase();
}

// The view has the case already, unless an earlier exercise left its cuts there.
void CaseViews::exerciseBegan() {
  const Placement& placed = *workstation_.placed();
  if (carved_) views_->refill(placed.patient.volume, placed.labels);
  volume_wanted_ = false;
  setCuts(true, false);
}

void CaseViews::showWholeCase() {
  workstation_.makeWhole();
  const Placement& placed = *workstation_.placed();
  views_->refill(placed.patient.volume, placed.labels);
  volume_wanted_ = false;
  setCuts(false, false);
}

void CaseViews::lookAtCase() {
  const Placement& placed = *workstation_.placed();
  const std::optional<LandmarkFrame> landmark = workstation_.viewLandmark();
  view().tools().setExerciseView(landmark.has_value());
  if (const std::optional<Vec3> point = pointToShow(placed, landmark)) {
    views_->setPoint(*point);
  }
  const std::vector<std::string>& needed = placed.exercise.structures;
  const Landmark* of = placed.exercise.findLandmarkById(placed.exercise.view.landmark);
  const bool there = needed.empty() || (of && of->is_place) ||
                     (placed.labels && placed.labels->find(needed.front()));
  if (!landmark || !there) return view().lookAtAll({});
  view().lookAtLandmark(*landmark, workstation_.exercise()->view.distance_mm);
}

void CaseViews::lookAtEntry() {
  const std::optional<LandmarkFrame> landmark = workstation_.viewLandmark();
  view().tools().setExerciseView(landmark.has_value());
  if (!landmark) return;
  views_->setPoint(landmark->position_mm);
  view().lookAtLandmark(*landmark, workstation_.exercise()->view.distance_mm);
}

void CaseViews::lookAtAll() {
  view().lookAtAll(workstation_.viewLandmark());
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

void CaseViews::wantVolume() {
  volume_wanted_ = true;
  askToSaveVolume({});
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
    if (all) volume_wanted_ = false;
    if (all) setCuts(carved_, false);
    if (then) then();
  });
}

}  // namespace trephine
