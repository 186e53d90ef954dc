#include "ui/prepare/outline_tool.h"

namespace trephine {

OutlineTool::OutlineTool(Workstation& workstation, Toolbox& toolbox, Messages& messages)
    : ViewTool({"outlineTool",
                Qt::Key(0),
                {},
                {},
                tr("Each click on the surface adds a point to the outline. Esc: done.")},
               nullptr),
      workstation_(workstation),
      messages_(messages) {
  toolbox.add(*this);
  connect(&toolbox, &Toolbox::taken, this, [this] { first_mm_.reset(); });
  connect(&workstation_, &Workstation::exerciseChanged, this, [this] {
    const std::optional<Exercise>& exercise = workstation_.exercise();
    if (exercise && exercise->outline) last_ = *exercise->outline;
  });
}

void OutlineTool::press(const ToolEvent& event) {
  if (event.in_picture) add(event.at_mm);
}

// Without a mouse: at the common point.
bool OutlineTool::key(int key, const Vec3* point_mm) {
  if (!point_mm || (key != Qt::Key_Return && key != Qt::Key_Enter)) return false;
  add(*point_mm);
  return true;
}

void OutlineTool::add(const Vec3& at_mm) {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed || placed->landmarks.empty()) return;
  const std::vector<PlacedLandmark>& landmarks = placed->landmarks;
  const Exercise& exercise = *workstation_.exercise();
  // It goes with the landmark that is looked at, or the first.
  const PlacedLandmark* with = &landmarks.front();
  for (const PlacedLandmark& landmark : landmarks) {
    if (landmark.id == exercise.view.landmark) with = &landmark;
  }
  if (!exercise.outline && !first_mm_) {
    first_mm_ = at_mm;
    return messages_.say(tr("The first point is set: click the next."));
  }
  ExerciseOutline outline;
  if (exercise.outline) {
    const auto here = placedOutline(*exercise.outline, landmarks);
    outline = here ? *here : *exercise.outline;
  } else {
    outline = last_;
    outline.points_mm = {*first_mm_};
    outline.frame = ExerciseOutline::Frame{with->id, with->frame};
  }
  outline.points_mm.push_back(at_mm);
  const Status done = workstation_.edit("outline", [&](Exercise& now) { now.outline = outline; });
  if (!done) return messages_.report(done.error());
  first_mm_.reset();
  messages_.say(tr("The outline has %1 points. Esc: done.").arg(outline.points_mm.size()));
}

}  // namespace trephine
