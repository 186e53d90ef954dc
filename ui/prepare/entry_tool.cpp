#include "ui/prepare/entry_tool.h"

#include "exercise/entry_point.h"

namespace trephine {

EntryTool::EntryTool(AppContext& app)
    : QObject(&app), app_(app), workstation_(app.workstation()), views_(&app.views()) {
  connect(views_, &FourUp::entryChosen, this, &EntryTool::place);
  connect(views_, &FourUp::entryLeft, this, &EntryTool::leave);
}

void EntryTool::place(const Vec3& at_mm, const Vec3& from_mm) {
  const Case* of = workstation_.currentCase();
  if (workstation_.phase() != Workstation::Phase::ready || !of) {
    return app_.say(tr("The entry point cannot be changed while an exercise runs: stop it first."));
  }
  const Exercise& exercise = *workstation_.exercise();
  const Landmark* landmark = entryLandmark(exercise);
  if (!landmark) return app_.say(tr("This exercise is fixed in its own patient."));
  Vec3 outward = from_mm - at_mm;
  if (!(glm::length(outward) > 0.0)) {
    const auto out = outwardAt(*of->volume, workstation_.placedTissues(),
                               workstation_.placed()->labels.get(), landmark->tissue, at_mm);
    const auto before = workstation_.viewLandmark();
    outward = out ? *out : before ? before->rotation * Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
  }
  const Landmark entry = placedAt(*landmark, at_mm, glm::normalize(outward));
  app_.unlessLost({AppContext::UnsavedWork::cuts}, [this, entry] {
    asked_ = workstation_.placeEntry(entry);
    if (asked_ && wantsOne()) views_->setTool(SliceTool::window);
    app_.say(asked_ ? tr("The exercise enters here now. Del: back to its own place.")
                    : tr("Busy: try again in a moment."));
  });
}

void EntryTool::leave() {
  if (!workstation_.entry()) return app_.say(tr("The exercise enters at its own place."));
  app_.unlessLost({AppContext::UnsavedWork::cuts}, [this] {
    asked_ = workstation_.placeEntry({});
    app_.say(asked_ ? tr("The exercise enters at its own place again.")
                    : tr("Busy: try again in a moment."));
  });
}

void EntryTool::show() {
  const auto frame = workstation_.viewLandmark();
  if (!frame) return views_->setEntry({});
  views_->setEntry(SliceView::Entry{frame->position_mm, frame->rotation * Vec3(0.0, 0.0, 1.0)});
}

}  // namespace trephine
