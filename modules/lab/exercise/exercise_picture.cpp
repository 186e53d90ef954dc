#include "lab/exercise/exercise_picture.h"

#include "base/memory.h"
#include "render/scene_renderer.h"
#include "render/tool_view.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {
constexpr int kWidth = 1280, kHeight = 800;
}

Status writeExercisePicture(Session& session, const std::shared_ptr<const Volume>& whole,
                            const std::filesystem::path& file) {
  const double needed_mb = shownMb(session.grid().geometry().voxelCount());
  if (Status enough = enoughMemory(needed_mb, "A picture", file.string()); !enough) return enough;
  Result<std::unique_ptr<SceneRenderer>> made = SceneRenderer::offscreen(kWidth, kHeight);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  const Scene& scene = session.scene();
  renderer.setTissues(scene.tissues, scene.view.looks);
  renderer.setVolume(session.grid(), whole);
  std::vector<ToolView> tools;
  const LoopState& state = session.state();
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    tools.push_back(toolView(*scene.toolOf(i, std::size_t(state.tools[i])),
                             {arm.proxy_position_mm, arm.proxy_orientation}, arm.tissue_class >= 0,
                             Vec3(0.75, 0.78, 0.82)));
  }
  renderer.setTools(tools);
  if (scene.outline) {
    renderer.setOutline(
        outlineOn(scene, session.landmarks(), *whole, session.grid().labels().get()),
        scene.outline->closed, scene.outline->width_mm);
  }
  bool placed = false;
  for (const PlacedLandmark& landmark : session.landmarks()) {
    if (landmark.id != scene.view.landmark) continue;
    renderer.lookAt(landmark.frame.position_mm, landmark.frame.viewDirection(),
                    landmark.frame.viewUp(), scene.view.distance_mm);
    placed = true;
  }
  if (!placed) renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  return writePng(renderer.picture(), file);
}

}  // namespace trephine
