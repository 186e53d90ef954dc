#include "ui/prepare/outline_form.h"

#include <QSignalBlocker>
#include <algorithm>

#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr FieldOf<OutlinePoint> kPointFields[] = {
    {{"at_mm", kMapPlace_mm, Given::always, "where this point lies in this patient, LPS"},
     &OutlinePoint::at_mm},
};

}  // namespace

OutlineForm::OutlineForm(const ExerciseEdited& wanted, QWidget* parent)
    : FormGroup(tr("Outline"), "outlineProblem", wanted, parent) {
  form().addRow(withHint(buildButtons(),
                         tr("A line on the tissue that shows where to work; it is neither felt nor "
                            "scored."),
                         fields()));
  count_ = settingHint({}, fields());
  count_->setObjectName("outlinePoints");
  form().addRow(count_);
  line_ = addFields<ExerciseOutline>(kOutlineFields, "outline:");
  line_->entered = [this](const ExerciseOutline& outline, const char* key) {
    edit(std::string("outline ") + key, [&](Exercise& exercise) {
      if (!exercise.outline) return;
      exercise.outline->closed = outline.closed;
      exercise.outline->width_mm = outline.width_mm;
    });
  };
  landmark_ = settingChoice("outlineLandmark", tr("Landmark of the outline"), fields());
  connect(landmark_, &QComboBox::activated, this,
          [this](int) { goWith(landmark_->currentData().toString().toStdString()); });
  addRow(tr("Goes with"), landmark_,
         tr("The landmark that it lies by on any patient; or none, in this one."));
  point_ = new WholeNumberField("outlinePoint", fields());
  point_->setAccessibleName(tr("Point of the outline"));
  point_->entered = [this] { showPoint(); };
  point_off_ =
      settingButton("outlinePointOff", tr("Remove"), tr("Takes this point away"), fields());
  connect(point_off_, &QToolButton::clicked, this, [this] {
    point_->interpretText();  // a click leaves the field as it was typed
    takeOff(std::size_t(point_->wanted() - 1));
  });
  auto* typed = new QWidget(fields());
  typed->setLayout(point_->withReason());
  typed->layout()->setContentsMargins(0, 0, 0, 0);
  form().addRow(tr("Point"), besideEachOther({typed, point_off_}, fields()));
  place_ = addFields<OutlinePoint>(kPointFields, "outlinePoint:");
  place_->entered = [this](const OutlinePoint& point, const char*) {
    const auto at = std::size_t(point_->wanted() - 1);
    if (!here_ || at >= here_->points_mm.size()) return;
    ExerciseOutline outline = *here_;
    outline.points_mm[at] = point.at_mm;
    editOutline("outline", outline);
  };
}

QWidget* OutlineForm::buildButtons() {
  draw_ = settingButton("drawOutline", tr("Draw it"), tr("Each click on the surface adds a point"),
                        fields());
  draw_->setCheckable(true);
  back_ =
      settingButton("outlineBack", tr("Remove last"), tr("Takes the last point away"), fields());
  clear_ = settingButton("clearOutline", tr("Clear"), tr("No outline"), fields());
  connect(draw_, &QToolButton::toggled, this, &OutlineForm::drawingWanted);
  connect(clear_, &QToolButton::clicked, this, [this] { editOutline("outline off", {}); });
  connect(back_, &QToolButton::clicked, this, [this] {
    if (here_) takeOff(here_->points_mm.size() - 1);
  });
  auto* row = new QWidget(fields());
  auto* buttons = tight(new QHBoxLayout(row));
  for (QToolButton* button : {draw_, back_, clear_}) buttons->addWidget(button);
  buttons->addStretch(1);
  return row;
}

void OutlineForm::editOutline(const std::string& what,
                              const std::optional<ExerciseOutline>& outline) {
  edit(what, [&](Exercise& exercise) { exercise.outline = outline; });
}

void OutlineForm::takeOff(std::size_t point) {
  if (!here_ || point >= here_->points_mm.size()) return;
  std::optional<ExerciseOutline> outline = here_;
  outline->points_mm.erase(outline->points_mm.begin() + std::ptrdiff_t(point));
  if (outline->points_mm.size() < 2) outline.reset();
  editOutline("outline", outline);
}

void OutlineForm::goWith(const std::string& landmark) {
  if (!here_ || landmark == (here_->frame ? here_->frame->landmark : std::string())) return;
  ExerciseOutline outline = *here_;
  outline.frame.reset();
  for (const PlacedLandmark& placed : landmarks_) {
    if (placed.id == landmark) outline.frame = ExerciseOutline::Frame{landmark, placed.frame};
  }
  editOutline("outline", outline);
}

void OutlineForm::show(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks) {
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
  landmark_->clear();
  landmark_->addItem(tr("none: in this patient"), QString());
  for (const PlacedLandmark& of : landmarks_) landmark_->addItem(toQt(of.id), toQt(of.id));
  const QString with = here_ && here_->frame ? toQt(here_->frame->landmark) : QString();
  if (landmark_->findData(with) < 0) landmark_->addItem(with, with);  // not in this case
  landmark_->setCurrentIndex(landmark_->findData(with));
  for (QToolButton* of : {back_, clear_}) of->setEnabled(here_.has_value());
  line_->setEnabled(here_.has_value());
  line_->show(here_ ? *here_ : ExerciseOutline{});
  // What lies in another patient cannot be placed in this one.
  for (QWidget* of : std::initializer_list<QWidget*>{landmark_, point_, point_off_}) {
    of->setEnabled(is_here);
  }
  place_->setEnabled(is_here);
  const int last = std::max(1, int(count));
  point_->setLimits(1, last);
  point_->show(std::clamp(point_->wanted(), 1, last));
  showPoint();
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
