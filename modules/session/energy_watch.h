// Whether an arm gives out energy that nothing put in: it shakes, or pushes by itself.
#pragma once

#include <optional>

#include "haptics/haptic_types.h"

namespace trephine {

// One for each arm, on one thread. It is shown records of the arm in order of time, as many a
// second as the caller likes; for a new session take a new one. It only tells; the caller shows it
// (Train).
//
// What the hand pressed into the springs may come back. Beyond that a little is no fault: a step of
// the encoder hides some 0.1 mJ of each contact, and a force that returns after a pause, a change
// or a fault gives out what the tissue holds then. So it is a leaky account, and nothing is put to
// it in a pause or a fault, while a tool waits, and while the output limiter still lets the force
// rise.
class EnergyWatch {
 public:
  static constexpr double kFault_J = 2e-3;  // in the account
  static constexpr double kLeak_W = 1e-3;   // no hand feels less
  static constexpr double kMost_J = 5e-3;   // so that a fault that has ended is soon forgotten

  // `device_per_model`: force_scale / motion_scale of the arm's map (WorkspaceMap), which makes
  // joules at the arm of the record's stored_J; energy_out_J is at the arm already. `now_s`: of the
  // session. True while the arm gives out.
  bool look(const ArmRecord& arm, double device_per_model, bool paused, double now_s);

 private:
  struct Seen {
    double energy_out_J, stored_J, share, at_s;
  };
  std::optional<Seen> last_;
  double account_J_ = 0.0;
};

}  // namespace trephine
