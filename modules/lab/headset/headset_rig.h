// A panel without a window: an exercise that runs, its picture drawn at 60 Hz, and a headset that
// is served beside it, as the window does it. One thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "headset/headset.h"
#include "headset/picture_painter.h"
#include "headset/room_place.h"
#include "render/scene_renderer.h"
#include "session/session.h"

class QGuiApplication;
class QOffscreenSurface;
class QOpenGLContext;
class QOpenGLExtraFunctions;

namespace trephine {

class HeadsetRig {
 public:
  static Result<std::unique_ptr<HeadsetRig>> create();
  ~HeadsetRig();

  SceneRenderer& renderer() { return *renderer_; }
  QOpenGLExtraFunctions& gl();
  const RoomPlace& place() const { return place_; }

  // Shows an exercise's case, and its tools where it begins. `recording`: and runs it, recorded.
  Status open(const std::filesystem::path& exercise, const std::filesystem::path& recording,
              const Progress& progress);
  Session& session() { return *session_; }
  Status endExercise();
  // Of the exercise that ended: whether its recording gives the same again.
  bool replays(const Progress& progress) const;

  // One turn of the event loop; waits at most a millisecond where there is nothing to do.
  void turn();
  template <class Condition>
  bool until(Condition condition, double limit_s) {
    const std::int64_t from_ns = monotonic_ns();
    while (!condition()) {
      if (1e-9 * double(monotonic_ns() - from_ns) > limit_s) return false;
      turn();
    }
    return true;
  }
  void pass(double seconds) {
    until([] { return false; }, seconds);
  }
  // Of a turn, or from one picture of the panel to the next, since this was asked last.
  double takeLongestTurn_ms();

  Status startHeadset(const HeadsetOptions& options);
  void stopHeadset() {  // nothing where it ended by itself
    if (headset_) headset_->stop();
  }
  Headset* headset() { return headset_.get(); }
  // It has ended, and all that the panel had of it is gone.
  const std::optional<HeadsetEnd>& end() const { return end_; }
  double pair_ms() const { return painter_.pair_ms(); }
  std::uint64_t pairs() const { return pairs_; }  // that were drawn

  int textures();

 private:
  HeadsetRig();

  std::unique_ptr<QGuiApplication> application_;
  std::unique_ptr<QOpenGLContext> context_;
  std::unique_ptr<QOffscreenSurface> surface_;
  std::unique_ptr<SceneRenderer> renderer_;
  PicturePainter::Panel panel_;
  unsigned int panel_texture_ = 0;
  std::optional<Exercise> exercise_;
  std::optional<Case> case_;
  std::unique_ptr<Session> session_;
  std::filesystem::path recording_;
  PicturePainter painter_;
  std::unique_ptr<Headset> headset_;
  std::optional<HeadsetEnd> end_;
  std::shared_ptr<std::atomic<bool>> woken_ = std::make_shared<std::atomic<bool>>(false);
  RoomPlace place_;
  bool placed_ = false;
  std::uint64_t pairs_ = 0;
  std::int64_t next_panel_ns_ = 0, last_turn_ns_ = 0;
  std::int64_t last_panel_ns_ = 0;
  double longest_ms_ = 0.0, longest_panel_ms_ = 0.0;
};

}  // namespace trephine
