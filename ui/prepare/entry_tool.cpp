#include "ui/prepare/entry_tool.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "exercise/entry_point.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/views/slice_view.h"

namespace trephine {

EntryTool::EntryTool(Workstation& workstation, Toolbox& toolbox, Messages& messages,
                     WorkGuards& guards)
    : ViewTool({"sliceEntryTool",
                Qt::Key_I,
                {},
                tr("Where the exercise enters: click, and drag to where the instrument comes from "
                   "(I)"),
                tr("Click where the exercise enters; drag to where the instrument comes from. Del: "
                   "back to its own place."),
                [](QPainter& painter) {  // an arrow into a surface
                  painter.drawArc(QRectF(-1.0, 10.0, 20.0, 20.0), 30 * 16, 120 * 16);
                  painter.drawLine(QPointF(9, 1.5), QPointF(9, 9));
                  painter.drawPolyline(QPolygonF({{6.0, 6.0}, {9.0, 9.5}, {12.0, 6.0}}));
                }},
               nullptr),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      toolbox_(toolbox) {
  toolbox_.add(*this);
  connect(&toolbox_, &Toolbox::taken, this, [this] { once_ = false; });
}

void EntryTool::useOnce(const std::string& landmark) {
  toolbox_.take(*this);
  once_ = true;
  landmark_ = landmark;
}

void EntryTool::letGo() {
  if (once_) toolbox_.putDown();
}

void EntryTool::press(const ToolEvent& event) {
  if (!event.slice) return place(event.at_mm, event.at_mm);
  if (event.in_picture) pressed_ = event;
}

void EntryTool::release(const ToolEvent& event) {
  const std::optional<ToolEvent> from = std::exchange(pressed_, {});
  if (!from) return;
  place(from->at_mm, isClick(from->in_widget, event.in_widget) ? from->at_mm : event.at_mm);
}

bool EntryTool::key(int key, const Vec3* point_mm) {
  const bool here = key == Qt::Key_Return || key == Qt::Key_Enter;
  if (here && point_mm) {
    place(*point_mm, *point_mm);
  } else if (key == Qt::Key_Delete || key == Qt::Key_Backspace) {
    leave();
  } else {
    return false;
  }
  return true;
}

void EntryTool::place(const Vec3& at_mm, const Vec3& from_mm) {
  const Case* of = workstation_.currentCase();
  if (workstation_.phase() != Workstation::Phase::ready || !of) {
    return messages_.say(
        tr("The entry point cannot be changed while an exercise runs: stop it first."));
  }
  const Exercise& exercise = *workstation_.exercise();
  const Landmark* enters = entryLandmark(exercise);
  const Landmark* landmark = once_ ? exercise.findLandmarkById(landmark_) : enters;
  if (!landmark) return messages_.say(tr("This exercise is fixed in its own patient."));
  Vec3 outward = from_mm - at_mm;
  if (!(glm::length(outward) > 0.0)) {
    const auto out = outwardAt(*of->volume, workstation_.placedTissues(),
                               workstation_.placed()->labels.get(), landmark->tissue, at_mm);
    const auto before = workstation_.viewLandmark();
    outward = out ? *out : before ? before->rotation * Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
  }
  const Landmark entry = placedAt(*landmark, at_mm, glm::normalize(outward));
  const double deep_mm =
      depthInTissue_mm(*of->volume, workstation_.placedTissues(),
                       workstation_.placed()->labels.get(), at_mm, entry.outward);
  constexpr double kSurface_mm = 6.0;  // a click is that exact
  const QString done = landmark != enters
                           ? tr("The landmark %1 is here now.").arg(toQt(landmark->id))
                       : deep_mm <= kSurface_mm
                           ? tr("The exercise enters here now. Del: back to its own place.")
                           : tr("The exercise enters here now, %1 mm inside of tissue. A tool that "
                                "begins in tissue has "
                                "no force: click nearer to the surface.")
                                 .arg(deep_mm, 0, 'f', 0);
  guards_.unlessLost({UnsavedWork::cuts}, [this, entry, done] {
    asked_ = workstation_.placeEntry(entry);
    if (asked_ && once_) toolbox_.putDown();
    messages_.say(asked_ ? done : tr("Busy: try again in a moment."));
  });
}

void EntryTool::leave() {
  if (!workstation_.entry()) return messages_.say(tr("The exercise enters at its own place."));
  guards_.unlessLost({UnsavedWork::cuts}, [this] {
    asked_ = workstation_.placeEntry({});
    messages_.say(asked_ ? tr("The exercise enters at its own place again.")
                         : tr("Busy: try again in a moment."));
  });
}

// A ring where the exercise enters and an arrow along which the instrument comes: thin and broken
// where that is before or behind the slice.
void EntryTool::paint(QPainter& painter, const SliceView& on) const {
  constexpr double kArrow_mm = 30.0, kHead_pixels = 7.0;
  const auto draw = [&](const QPointF& at, const QPointF& from, bool in_slice) {
    const QPointF along = from - at;
    const double long_pixels = std::hypot(along.x(), along.y());
    const QPen pen =
        in_slice ? QPen(colours::kAccent, 2.0) : QPen(colours::kAccent, 1.2, Qt::DotLine);
    drawRimmed(painter, pen, in_slice ? 2.5 : 1.3, [&] {
      painter.drawEllipse(at, 5.0, 5.0);
      if (long_pixels < 2.0 * kHead_pixels) return;
      const QPointF unit = along / long_pixels, aside(-unit.y(), unit.x());
      const QPointF tip = at + 6.0 * unit;
      painter.drawLine(tip, from);
      painter.drawPolyline(QPolygonF({tip + kHead_pixels * (unit + 0.6 * aside), tip,
                                      tip + kHead_pixels * (unit - 0.6 * aside)}));
    });
  };
  if (pressed_ && pressed_->slice == &on && on.pointer()) {
    return draw(pressed_->in_widget, *on.pointer(), true);
  }
  const auto entry = workstation_.viewLandmark();
  if (!entry) return;
  const Vec3 outward = entry->rotation * Vec3(0.0, 0.0, 1.0);
  draw(on.fromPatient(entry->position_mm), on.fromPatient(entry->position_mm + kArrow_mm * outward),
       on.shown().off_mm(entry->position_mm) <= std::max(1.0, 0.5 * on.stack().spacing_mm.z));
}

}  // namespace trephine
