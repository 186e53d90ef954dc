#include "session/energy_watch.h"

#include <algorithm>

#include "haptics/bounded_controller.h"

namespace trephine {

bool EnergyWatch::look(const ArmRecord& arm, double device_per_model, bool paused, double now_s) {
  const Seen now{arm.energy_out_J.x + arm.energy_out_J.y + arm.energy_out_J.z, arm.stored_J,
                 arm.rendered_share, now_s};
  const bool returning = paused || arm.faults != 0 || (arm.tool_state & kToolWaits) ||
                         (arm.controller_parts & kPartLimiter);
  if (last_) {
    // Stored is the model's; the arm shows a share of it, which in air is all. Where the share
    // changed, neither that nor what the model has by another share came from the hand.
    const double by_share_J = now.share * now.stored_J - last_->share * last_->stored_J;
    const double by_model_J = std::min(now.share, last_->share) * (now.stored_J - last_->stored_J);
    const double given_J = now.energy_out_J - last_->energy_out_J;
    const double into_springs_J = device_per_model * std::min(by_share_J, by_model_J);
    const double leaked_J = kLeak_W * std::max(0.0, now.at_s - last_->at_s);
    const double more_J = returning ? 0.0 : given_J + into_springs_J;
    account_J_ = std::clamp(account_J_ + more_J - leaked_J, 0.0, kMost_J);
  }
  last_ = now;
  return account_J_ > kFault_J;
}

}  // namespace trephine
