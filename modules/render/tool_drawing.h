// Tools as solids, with a mark where one touches.
#pragma once

#include <memory>
#include <vector>

#include "render/scene_renderer.h"

class vtkRenderer;

namespace trephine {

class ToolDrawing {
 public:
  ToolDrawing();
  ~ToolDrawing();
  ToolDrawing(const ToolDrawing&) = delete;
  ToolDrawing& operator=(const ToolDrawing&) = delete;

  // Shows these tools and no others. A tool whose pose or length is not finite is left out.
  void show(const std::vector<ToolView>& tools, vtkRenderer& renderer);

 private:
  struct Tool;
  std::vector<std::unique_ptr<Tool>> tools_;
};

}  // namespace trephine
