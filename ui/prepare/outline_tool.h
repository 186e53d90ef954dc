// Adds a point to the exercise's outline with each click on the surface, in any view.
#pragma once

#include <optional>

#include "ui/views/toolbox.h"
#include "ui/work/messages.h"
#include "ui/work/workstation.h"

namespace trephine {

class OutlineTool : public ViewTool {
 public:
  OutlineTool(Workstation& workstation, Toolbox& toolbox, Messages& messages);

  bool worksIn3D() const override { return true; }
  void press(const ToolEvent& event) override;
  bool key(int key, const Vec3* point_mm) override;

 private:
  void add(const Vec3& at_mm);

  Workstation& workstation_;
  Messages& messages_;
  std::optional<Vec3> first_mm_;  // of a new outline
  ExerciseOutline last_;  // that was there: one that is drawn anew is closed and as wide as it
};

}  // namespace trephine
