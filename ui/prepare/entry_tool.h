// Where the exercise enters the open case, as a person clicks it in the views.
#pragma once

#include <QObject>
#include <functional>
#include <utility>

#include "ui/work/app_context.h"

namespace trephine {

class EntryTool : public QObject {
  Q_OBJECT
 public:
  explicit EntryTool(AppContext& app);

  // The tool goes once it was used.
  std::function<bool()> wantsOne = [] { return false; };
  // In the views, as the exercise is placed now.
  void show();
  // Whether the case was placed anew for it; asked once.
  bool takeAsked() { return std::exchange(asked_, false); }

 private:
  // From nowhere: out of what was clicked.
  void place(const Vec3& at_mm, const Vec3& from_mm);
  void leave();

  AppContext& app_;
  Workstation& workstation_;
  FourUp* views_;
  bool asked_ = false;
};

}  // namespace trephine
