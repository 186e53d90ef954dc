// An exercise in a picture as the window shows it: from where, with which tools and outline.
#pragma once

#include <vector>

#include "render/scene_renderer.h"
#include "render/tool_view.h"
#include "session/session.h"

namespace trephine {

// Where the loop has them; what is not finite is left out.
std::vector<ToolView> toolsOf(SessionView& session);
// At the landmark that the exercise names; without one, all of it from before.
void lookAtExercise(SceneRenderer& renderer, const Session& session);
// The outline that is to be cut, if the exercise has one, on the surface of the whole volume.
void showOutline(SceneRenderer& renderer, Session& session, const Volume& whole);

}  // namespace trephine
