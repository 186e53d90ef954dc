// A head-mounted display through OpenXR, on a thread of its own: it owns every handle of OpenXR and
// an OpenGL context that shares the window's textures. It knows no exercise: it says where the eyes
// are and shows what it is given. The window's thread never waits for it, and what hangs in the
// headset's software holds up nobody.
//
// Where pictures for two eyes do not come fast enough (PaceRule) a flat screen with the panel's
// picture stands in the room instead, placed by the runtime at its own rate.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "base/result.h"
#include "base/rt/abandonable_thread.h"
#include "headset/pace_rule.h"
#include "headset/picture_exchange.h"

class QOpenGLContext;

namespace trephine {

struct HeadsetOptions {
  PaceLimits pace;
  double screen_m = 2.0;  // how far off the flat screen stands
  double screen_width_m = 1.8;
  int most_pixels = 0;  // along an edge of an eye's picture; 0: as the runtime recommends
  int patience_ms = 8;  // for the picture of this very frame; then the last is shown again
};

// Any of it may be a frame old.
struct HeadsetState {
  bool seen = false;  // somebody wears it and looks at us
  bool flat = false;  // the flat screen is what is seen
  double pairs_hz = 0.0;
  Eyes eyes_m{};                          // where they were last, in the room
  bool located = false;                   // it has said so
  bool keeps_room = false;                // a place in the room has the same numbers the next time
  int room_changes = 0;                   // another place has these numbers now
  int width = 0, height = 0;              // of an eye's picture
  std::uint64_t fresh = 0, repeated = 0;  // frames with a new pair, and with the one before
  // With one that was repeated already: it stands in the room as two flat pictures, one for each
  // eye, where the eyes were that it was drawn for.
  std::uint64_t held = 0;
  double pose_age_ms = 0.0;               // of the last frame: since its eyes were asked for
  double most_pose_age_ms = 0.0;
};

// Why it is over. `why` is empty where it was asked for.
struct HeadsetEnd {
  Status why;
  bool again = false;  // it may be there again: worth another try
};

// Whether OpenXR's loader is there: without it there are no headsets.
bool openXrInstalled();

class Headset {
 public:
  // The window's thread; `share` is its view's context. `wake` is called in the headset's thread
  // whenever a picture is wanted or all is over. What goes wrong from here on is told by end().
  // Errors: NO_LOADER, NO_GLX.
  static Result<std::unique_ptr<Headset>> start(QOpenGLContext& share,
                                                const HeadsetOptions& options,
                                                std::function<void()> wake);
  // Waits at most 0.5 s: one that hangs is left behind, and touches nothing once it comes back.
  ~Headset();

  void stop();  // returns at once; end() tells
  // Once all is cleaned up. The textures of pictures() are the window's to delete then.
  std::optional<HeadsetEnd> end() const;
  HeadsetState state() const;
  // For how long its software has not returned from a call.
  double stuck_s() const;
  PictureExchange& pictures();

 private:
  Headset() = default;
  struct Engine;
  std::shared_ptr<Engine> engine_;
  rt::AbandonableThread thread_;
};

}  // namespace trephine
