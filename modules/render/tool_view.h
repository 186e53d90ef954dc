// How a scene's tool is drawn.
#pragma once

#include "render/scene_renderer.h"
#include "scene/scene_tool.h"

namespace trephine {

ToolView toolView(const SceneTool& tool, const Pose& pose_mm, bool contact, const Vec3& colour);

}  // namespace trephine
