// Adds a point to the exercise's outline with each click on the surface, in any view.
#pragma once

#include <optional>

#include "ui/views/view_tool.h"
#include "ui/work/app_context.h"

namespace trephine {

class OutlineTool : public ViewTool {
 public:
  explicit OutlineTool(AppContext& app);

  bool worksIn3D() const override { return true; }
  void press(const ToolEvent& event) override;
  bool key(int key, const Vec3* point_mm) override;

 private:
  void add(const Vec3& at_mm);

  AppContext& app_;
  Workstation& workstation_;
  std::optional<Vec3> first_mm_;  // of a new outline
};

}  // namespace trephine
