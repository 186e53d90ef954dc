#include "render/tool_view.h"

namespace trephine {

namespace {

ToolShape shapeOf(ToolKind kind) {
  switch (kind) {
    case ToolKind::needle: return ToolShape::needle;
    case ToolKind::blade: return ToolShape::blade;
    case ToolKind::burr: return ToolShape::burr;
  }
  return ToolShape::needle;
}

}  // namespace

ToolView toolView(const ExerciseTool& tool, const Pose& pose_mm, bool contact, const Vec3& colour) {
  const ToolDescription& d = tool.tool.made_from;
  ToolView view;
  view.pose_mm = pose_mm;
  view.length_mm = d.length_mm;
  view.shape = shapeOf(d.kind);
  view.contact = contact;
  view.colour = colour;
  view.radius_mm = d.radius_mm;
  if (d.shape == BurrShape::cylinder) view.head_mm = d.head_mm;
  view.mesh_file = tool.look.mesh.string();
  view.mesh_tip_mm = tool.look.tip_mm;
  view.mesh_axis = tool.look.axis;
  return view;
}

}  // namespace trephine
