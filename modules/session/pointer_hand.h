// A hand that goes where a pointer is: the rest point of a simulated arm's hand, tick by tick.
//
// The hand is a spring and damper, which pull the arm to the rest point r. With x where the arm is
// and k the spring, the hand pulls by F = k (r - x) / s, s the motion scale, and all is said of F,
// along the tool and across it:
//   along, push P > 0:  dr/dt = 15 mm/s per N of (P - F), at most 20 mm/s forwards
//   along, push 0:      to 4 mm before what is seen, and only then aside; out of whatever it
//   touches put down:           to where the arm is, within 50 ms: F is 0 and the tool stays, in
//   tissue too across:             to where the pointer is, slower as F comes to what P leaves of
//   the arm's
// So a push is a force and not a depth: it builds up where the tool is stopped, goes on while it
// overcomes the tissue, and nothing springs on where a resistance ends.
//
// It presses along the tool and not along the ray: an eye looks at a tool from aside, by 24 degrees
// at first, and along the ray a needle cut a slit and a burr a hole that its shaft did not fit. The
// tool's line goes through the pointed place; the ray itself is pressed along where it is flat to
// the tool.
#pragma once

#include <optional>

#include "haptics/haptic_types.h"
#include "haptics/workspace_map.h"
#include "session/pointer_path.h"

namespace trephine {

class PointerHand {
 public:
  // A firm hand, but not a rigid one: the shipped scripts'.
  static constexpr double kStiffness_N_per_m = 1000.0, kDamping_Ns_per_m = 10.0;
  // Of the arm's greatest force: with more it would run on through what stops the tool.
  static constexpr double kMostShare = 0.9;
  static constexpr double kHover_mm = 4.0;   // off what is seen
  static constexpr double kReach_mm = 10.0;  // in air, beyond what is seen and what was touched
  static constexpr double kPress_mm_s = 20.0;

  // Of an arm with this greatest force [N], device units.
  struct Reach {
    double max_force_N = 0.0;
    Vec3 workspace_m{0.0};
  };

  // Where the hand rests, device frame, a period after `arm`, over `map` then. Haptic thread.
  Vec3 rest_m(const PointerInput& to, const ArmRecord& arm, const WorkspaceMap& map,
              const Reach& reach, double period_s);
  // Begins where the arm is.
  void forget() { *this = PointerHand(); }

 private:
  // Along the ray and across it, mm from its origin; of the arm and of the rest point.
  struct Way {
    double arm_mm = 0.0, rest_mm = 0.0;
    Vec3 arm_aside_mm{0.0}, aside_mm{0.0};
    double mm_per_N = 1.0;
    std::optional<double> seen_mm, touched_mm;
    bool touches = false;
    double pull_N() const { return (rest_mm - arm_mm) / mm_per_N; }
  };
  Vec3 onPlane(const PointerSample& at, const Vec3& along, const ArmRecord& arm, bool presses,
               bool touches);
  void press(Way& way, double push_N, double period_s) const;
  void comeOut(Way& way, double target_mm, double period_s) const;
  static double hoverAt_mm(const Way& way);
  void hover(Way& way, double period_s) const;
  void goAside(Way& way, double push_N, double most_N, double period_s) const;

  std::optional<Vec3> rest_m_;      // device
  std::optional<Vec3> seen_mm_;     // the last place that was seen
  std::optional<Vec3> plane_mm_;    // a place of the plane on which a push or touch began
  Vec3 pressed_mm_{0.0};            // the pointer on it when it pressed last
  std::optional<Vec3> touched_mm_;  // the tip where it touched last, or where this push began
  bool pressing_ = false;
};

}  // namespace trephine
