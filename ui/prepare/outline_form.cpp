#include "ui/prepare/outline_form.h"

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>

#include "exercise/exercise_numbers.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr NumberOf<OutlinePoint> kPointNumbers[] = {
    {{"at_mm", kMapPlace_mm, Given::always, "where this point lies in this patient, LPS"},
     &OutlinePoint::at_mm},
};

}  // namespace

OutlineForm::OutlineForm(QWidget* parent) : QWidget(parent) {
  auto* fields = new QWidget(this);
  QFormLayout* form = settingForm(fields);
  problem_ = problemLabel("outlineProblem", this);
  form->addRow(withHint(buildButtons(fields),
                        tr("A line on the tissue that shows where to work; it is neither felt nor "
                           "scored."),
                        fields));
  count_ = settingHint({}, fields);
  count_->setObjectName("outlinePoints");
  form->addRow(count_);
  closed_ = new QCheckBox(tr("Closed"), fields);
  closed_->setObjectName("outlineClosed");
  connect(closed_, &QCheckBox::toggled, this, [this](bool on) {
    edit("outline closed", [&](Exercise& exercise) {
      if (exercise.outline) exercise.outline->closed = on;
    });
  });
  form->addRow(withHint(closed_, tr("The last point is joined to the first."), fields));
  width_ = std::make_unique<NumberRows<ExerciseOutline>>(
      std::span<const NumberOf<ExerciseOutline>>(kOutlineNumbers), *form, fields, "outline:");
  width_->entered = [this](const ExerciseOutline& outline, const char* key) {
    edit(key, [&](Exercise& exercise) {
      if (exercise.outline) exercise.outline->width_mm = outline.width_mm;
    });
  };
  landmark_ = settingChoice("outlineLandmark", tr("Landmark of the outline"), fields);
  connect(landmark_, &QComboBox::activated, this,
          [this](int) { goWith(landmark_->currentData().toString().toStdString()); });
  form->addRow(tr("Goes with"),
               withHint(landmark_,
                        tr("The landmark that it lies by on any patient; or none, in this one."),
                        fields));
  point_ = new WholeNumberField("outlinePoint", fields);
  point_->setAccessibleName(tr("Point of the outline"));
  point_->entered = [this] { showPoint(); };
  point_off_ = settingButton("outlinePointOff", tr("Take it off"), tr("Takes this point away"),
                             fields);
  connect(point_off_, &QToolButton::clicked, this, [this] {
    point_->interpretText();  // a click leaves the field as it was typed
    takeOff(std::size_t(point_->wanted() - 1));
  });
  auto* chosen = new QWidget(fields);
  auto* beside = new QHBoxLayout(chosen);
  beside->setContentsMargins(0, 0, 0, 0);
  beside->addLayout(point_->withReason(), 1);
  beside->addWidget(point_off_);
  form->addRow(tr("Point"), chosen);
  place_ = std::make_unique<NumberRows<OutlinePoint>>(
      std::span<const NumberOf<OutlinePoint>>(kPointNumbers), *form, fields, "outlinePoint:");
  place_->entered = [this](const OutlinePoint& point, const char*) {
    const auto at = std::size_t(point_->wanted() - 1);
    editHere("outline", [&](ExerciseOutline& outline) {
      if (at < outline.points_mm.size()) outline.points_mm[at] = point.at_mm;
    });
  };
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(settingTitle(tr("Outline"), this));
  layout->addWidget(problem_);
  layout->addWidget(fields);
}

QWidget* OutlineForm::buildButtons(QWidget* parent) {
  auto* row = new QWidget(parent);
  auto* buttons = new QHBoxLayout(row);
  buttons->setContentsMargins(0, 0, 0, 0);
  draw_ = settingButton("drawOutline", tr("Draw it"), tr("Each click on the surface adds a point"),
                        row);
  draw_->setCheckable(true);
  back_ = settingButton("outlineBack", tr("Last off"), tr("Takes the last point away"), row);
  clear_ = settingButton("clearOutline", tr("Clear"), tr("No outline"), row);
  connect(draw_, &QToolButton::toggled, this, [this](bool on) {
    if (!showing_) emit drawingWanted(on);
  });
  connect(clear_, &QToolButton::clicked, this,
          [this] { edit("outline off", [](Exercise& exercise) { exercise.outline.reset(); }); });
  connect(back_, &QToolButton::clicked, this, [this] {
    if (here_) takeOff(here_->points_mm.size() - 1);
  });
  buttons->addWidget(draw_);
  buttons->addWidget(back_);
  buttons->addWidget(clear_);
  buttons->addStretch(1);
  return row;
}

void OutlineForm::edit(const std::string& what, const std::function<void(Exercise&)>& change) {
  if (showing_) return;
  const Status done = wanted ? wanted(what, change) : Status();
  done ? problem_->hide() : sayNotApplied(*problem_, done.error());
}

void OutlineForm::editHere(const std::string& what,
                           const std::function<void(ExerciseOutline&)>& change) {
  if (!here_) return;
  ExerciseOutline outline = *here_;
  change(outline);
  edit(what, [&](Exercise& exercise) { exercise.outline = outline; });
}

void OutlineForm::takeOff(std::size_t point) {
  if (!here_ || point >= here_->points_mm.size()) return;
  ExerciseOutline outline = *here_;
  outline.points_mm.erase(outline.points_mm.begin() + std::ptrdiff_t(point));
  edit("outline", [&](Exercise& exercise) {
    if (outline.points_mm.size() < 2) {
      exercise.outline.reset();
    } else {
      exercise.outline = outline;
    }
  });
}

void OutlineForm::goWith(const std::string& landmark) {
  if (!here_ || landmark == (here_->frame ? here_->frame->landmark : std::string())) return;
  editHere("outline", [&](ExerciseOutline& outline) {
    outline.frame.reset();
    for (const PlacedLandmark& placed : landmarks_) {
      if (placed.id == landmark) outline.frame = ExerciseOutline::Frame{landmark, placed.frame};
    }
  });
}

void OutlineForm::show(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks) {
  showing_ = true;
  landmarks_ = landmarks;
  here_ = exercise.outline;
  bool is_here = here_.has_value();
  if (here_) {
    const auto placed = placedOutline(*here_, landmarks_);
    is_here = placed.has_value();
    if (placed) here_ = placed;
  }
  const std::size_t count = here_ ? here_->points_mm.size() : 0;
  count_->setText(!here_    ? tr("No outline yet.")
                  : is_here ? tr("%1 points").arg(count)
                            : tr("%1 points. Its landmark is not in this case.").arg(count));
  closed_->setChecked(here_ && here_->closed);
  landmark_->clear();
  landmark_->addItem(tr("none: in this patient"), QString());
  for (const PlacedLandmark& of : landmarks_) landmark_->addItem(toQt(of.id), toQt(of.id));
  const QString with = here_ && here_->frame ? toQt(here_->frame->landmark) : QString();
  if (landmark_->findData(with) < 0) landmark_->addItem(with, with);  // not in this case
  landmark_->setCurrentIndex(landmark_->findData(with));
  for (QWidget* of : std::initializer_list<QWidget*>{closed_, back_, clear_}) {
    of->setEnabled(here_.has_value());
  }
  // What lies in another patient cannot be placed in this one.
  for (QWidget* of : std::initializer_list<QWidget*>{landmark_, point_, point_off_}) {
    of->setEnabled(is_here);
  }
  width_->setEnabled(here_.has_value());
  width_->show(here_ ? *here_ : ExerciseOutline{});
  const int last = std::max(1, int(count));
  point_->setLimits(1, last);
  point_->show(std::clamp(point_->wanted(), 1, last));
  place_->setEnabled(is_here);
  showPoint();
  showing_ = false;
}

void OutlineForm::showPoint() {
  const auto at = std::size_t(point_->wanted() - 1);
  point_->take();
  place_->show({here_ && at < here_->points_mm.size() ? here_->points_mm[at] : Vec3(0.0)});
}

void OutlineForm::showDrawing(bool drawing) {
  const QSignalBlocker quiet(draw_);
  draw_->setChecked(drawing);
}

}  // namespace trephine
