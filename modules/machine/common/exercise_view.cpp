#include "machine/common/exercise_view.h"

#include "exercise/exercise_outline.h"

namespace trephine {

std::vector<ToolView> toolsOf(SessionView& session) {
  const Vec3 steel(0.75, 0.78, 0.82);
  const Exercise& exercise = session.exercise();
  const LoopState& state = session.state();
  std::vector<ToolView> tools;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    const ExerciseTool* tool = exercise.toolOf(i, std::size_t(state.tools[i]));
    if (!tool || !isFinite(arm.proxy_position_mm)) continue;
    tools.push_back(toolView(*tool, {arm.proxy_position_mm, arm.proxy_orientation},
                             arm.tissue_class >= 0, steel));
  }
  return tools;
}

void lookAtExercise(SceneRenderer& renderer, const Session& session) {
  const ExerciseView& view = session.exercise().view;
  for (const PlacedLandmark& landmark : session.landmarks()) {
    if (landmark.id != view.landmark) continue;
    return renderer.lookAt(landmark.frame.position_mm, landmark.frame.viewDirection(),
                           landmark.frame.viewUp(), view.distance_mm);
  }
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
}

void showOutline(SceneRenderer& renderer, Session& session, const Volume& whole) {
  const Exercise& exercise = session.exercise();
  if (!exercise.outline) return renderer.setOutline({}, false, 0.0);
  renderer.setOutline(
      outlineOn(exercise, session.landmarks(), whole, session.grid().labels().get()),
      exercise.outline->closed, exercise.outline->width_mm);
}

}  // namespace trephine
