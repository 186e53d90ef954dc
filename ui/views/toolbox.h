// The tools of the views and the one that is in hand, the same in all of them. It makes those that
// need nothing but a slice: window, common point, ruler, angle; who has others adds them. Window's
// thread.
#pragma once

#include <functional>
#include <vector>

#include "ui/views/view_tool.h"

namespace trephine {

class Toolbox : public QObject {
  Q_OBJECT
 public:
  explicit Toolbox(QObject* parent = nullptr);

  // Its key takes it in hand while it lives, and its button in the bar where it has a symbol.
  void add(ViewTool& tool);
  const std::vector<ViewTool*>& tools() const { return tools_; }
  ViewTool& point() const { return *tools_[1]; }  // of all slices: with Shift for any tool

  ViewTool& inHand() const { return *in_hand_; }
  void take(ViewTool& tool);
  // The window is what the mouse has without a tool.
  void putDown() { take(*tools_[0]); }
  bool isEmptyHanded() const { return in_hand_ == tools_[0]; }

  // Whether the tool in hand had a use for the key, Esc to put it down among them.
  bool useKey(int key, const Vec3* point_mm);
  bool takeByKey(int key, bool in_3d = false);  // in 3-D those alone that work there
  // For keys that neither a view nor a tool has a use for: whether they were of use.
  std::function<bool(int key)> other_keys = [](int) { return false; };

 signals:
  void added(trephine::ViewTool* tool);
  void taken(trephine::ViewTool* tool);  // another one than before
  void changed();                        // what the one in hand paints, or its ring

 private:
  std::vector<ViewTool*> tools_;
  ViewTool* in_hand_;
};

}  // namespace trephine
