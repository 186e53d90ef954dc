// Tools as solids, built in or read from meshes, with a mark where one touches.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render/scene_renderer.h"
#include "render/tool_mesh.h"

class vtkRenderer;

namespace trephine {

class ToolDrawing {
 public:
  ToolDrawing();
  ~ToolDrawing();
  ToolDrawing(const ToolDrawing&) = delete;
  ToolDrawing& operator=(const ToolDrawing&) = delete;

  // Shows these tools and no others. A tool whose pose or length is not finite is left out. A mesh
  // is read when it is first shown and never again; one that cannot be drawn is logged once.
  void show(const std::vector<ToolView>& tools, vtkRenderer& renderer);
  // The corners of a box around each tool that is shown, patient frame.
  std::vector<std::array<Vec3, 8>> boxes() const;

 private:
  struct Tool;
  std::optional<ToolMesh> meshOf(const ToolView& view);  // in the tool's frame
  void warn(const ToolView& view, const Error& why);

  std::vector<std::unique_ptr<Tool>> tools_;
  std::map<std::string, std::optional<ToolMesh>> meshes_;  // by file; none: it cannot be read
  std::set<std::string> warned_;
};

}  // namespace trephine
