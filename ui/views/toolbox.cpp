#include "ui/views/toolbox.h"

#include <utility>

#include "ui/views/slice_tools.h"

namespace trephine {

Toolbox::Toolbox(QObject* parent) : QObject(parent) {
  for (ViewTool* tool : {windowTool(this), pointTool(this), measureTool(Measure::Kind::ruler, this),
                         measureTool(Measure::Kind::angle, this)}) {
    add(*tool);
  }
  in_hand_ = tools_[0];
}

void Toolbox::add(ViewTool& tool) {
  tools_.push_back(&tool);
  connect(&tool, &QObject::destroyed, this, [this, gone = &tool] {
    std::erase(tools_, gone);
    if (in_hand_ == gone) in_hand_ = tools_[0];
  });
  emit added(&tool);
}

void Toolbox::take(ViewTool& tool) {
  (void)in_hand_->giveUp();
  ViewTool* before = std::exchange(in_hand_, &tool);
  if (before == &tool) return emit changed();
  disconnect(before, &ViewTool::changed, this, &Toolbox::changed);
  connect(&tool, &ViewTool::changed, this, &Toolbox::changed);
  emit taken(&tool);
}

bool Toolbox::useKey(int key, const Vec3* point_mm) {
  const bool leaves = key == Qt::Key_Escape;
  if ((leaves && in_hand_->giveUp()) || in_hand_->key(key, point_mm)) {
    emit changed();
    return true;
  }
  if (!leaves || isEmptyHanded()) return false;
  putDown();
  return true;
}

bool Toolbox::takeByKey(int key, bool in_3d) {
  for (ViewTool* tool : tools_) {
    if (tool->facts().key != key || key == 0 || (in_3d && !tool->worksIn3D())) continue;
    take(*tool);
    return true;
  }
  return false;
}

}  // namespace trephine
