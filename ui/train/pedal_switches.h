// What feet ask for at a pedal's outer switches; the middle one is the loop's: the tools' motors.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "haptics/haptic_types.h"

namespace trephine {

class PedalSwitches {
 public:
  struct Asked {
    bool recentre = false;       // both at once: the patient before a headset's wearer
    bool back = false;           // the left one alone, once it is up again: it may become both
    std::optional<bool> clutch;  // the right one went down, or came up
  };

  // An arm's buttons, as often as they are looked at.
  Asked follow(std::uint32_t buttons) {
    constexpr std::uint32_t kBoth = kPedalLeft | kPedalRight;
    const std::uint32_t now = buttons & kBoth;
    const std::uint32_t changed = now ^ std::exchange(down_, now);
    Asked asked;
    asked.recentre = now == kBoth && changed != 0;
    asked.back = (changed & ~now & kPedalLeft) && !both_;
    // Hands that are let go of for it would find their tools elsewhere than they are felt.
    const bool right = (now & kPedalRight) && now != kBoth;
    if (right && !clutches_ && !both_) asked.clutch = clutches_ = true;
    if (!(now & kPedalRight) && std::exchange(clutches_, false)) asked.clutch = false;
    both_ = now == kBoth || (both_ && now != 0);
    return asked;
  }

 private:
  std::uint32_t down_ = 0;
  bool both_ = false;  // were down together, and one still is
  bool clutches_ = false;
};

}  // namespace trephine
