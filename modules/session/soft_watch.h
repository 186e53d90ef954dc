// Whether an arm shows next to nothing of a tissue, since it shook.
#pragma once

#include <optional>

#include "haptics/haptic_types.h"

namespace trephine {

// One for each arm, on one thread; shown records of the arm in order of time. What the controller
// `bounded` has learnt of this hand (ArmRecord::learnt_scale, 0 of another controller) comes back
// by itself once the arm has been calm; where it stays low, what is felt is not the tissue.
class SoftWatch {
 public:
  static constexpr double kLow = 0.2;  // of what the arm could show
  static constexpr double kFor_s = 1.0;

  // `now_s`: of the session. True while it has been lower than kLow for kFor_s.
  bool look(const ArmRecord& arm, double now_s) {
    if (!(arm.learnt_scale > 0.0 && arm.learnt_scale < kLow)) {
      since_s_.reset();
      return false;
    }
    if (!since_s_) since_s_ = now_s;
    return now_s - *since_s_ >= kFor_s;
  }

 private:
  std::optional<double> since_s_;
};

}  // namespace trephine
