// How a scene's tool is drawn.
#pragma once

#include "exercise/exercise_tool.h"
#include "render/scene_renderer.h"

namespace trephine {

ToolView toolView(const ExerciseTool& tool, const Pose& pose_mm, bool contact, const Vec3& colour);

}  // namespace trephine
