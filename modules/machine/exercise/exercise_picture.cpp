#include "machine/exercise/exercise_picture.h"

#include "base/memory.h"
#include "base/tr.h"
#include "machine/common/exercise_view.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {
constexpr int kWidth = 1280, kHeight = 800;
}

Status writeExercisePicture(Session& session, const std::shared_ptr<const Volume>& whole,
                            const std::filesystem::path& file) {
  const double needed_mb = shownMb(session.grid().geometry().voxelCount());
  if (Status enough = enoughMemory(needed_mb, tr("A picture"), file.string()); !enough)
    return enough;
  Result<std::unique_ptr<SceneRenderer>> made = SceneRenderer::offscreen(kWidth, kHeight);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  const Exercise& exercise = session.exercise();
  renderer.setTissues(exercise.tissues, exercise.view.looks);
  renderer.setVolume(session.grid(), whole);
  renderer.setTools(toolsOf(session));
  showOutline(renderer, session, *whole);
  lookAtExercise(renderer, session);
  return writePng(renderer.picture(), file);
}

}  // namespace trephine
