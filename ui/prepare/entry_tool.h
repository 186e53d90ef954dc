// Where the exercise enters the open case, as a person clicks it in the views; in a slice a drag
// says where the instrument comes from.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "ui/views/toolbox.h"
#include "ui/work/work_guards.h"

namespace trephine {

class EntryTool : public ViewTool {
 public:
  // Adds itself to the toolbox. All four outlive it.
  EntryTool(Workstation& workstation, Toolbox& toolbox, Messages& messages, WorkGuards& guards);

  // Takes it in hand until a place was taken, which is that of the landmark of this id.
  void useOnce(const std::string& landmark);
  // Puts it down where it was taken for one place.
  void letGo();
  // Whether a person has asked here for the placing that came to its end; the answer resets it.
  // Asked when structures changed and when placing failed, else the next placing would count.
  bool takeAsked() { return std::exchange(asked_, false); }

  bool worksIn3D() const override { return true; }
  void press(const ToolEvent& event) override;
  void release(const ToolEvent& event) override;
  bool key(int key, const Vec3* point_mm) override;
  bool giveUp() override { return std::exchange(pressed_, {}).has_value(); }
  void paint(QPainter& painter, const SliceView& on) const override;

 private:
  // From nowhere: out of what was clicked.
  void place(const Vec3& at_mm, const Vec3& from_mm);
  void leave();

  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  Toolbox& toolbox_;
  std::optional<ToolEvent> pressed_;
  bool asked_ = false, once_ = false;
  std::string landmark_;  // where it is used once: whose place it takes
};

}  // namespace trephine
