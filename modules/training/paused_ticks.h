// How long an exercise was in pauses that were asked for, from its events in their order.
#pragma once

#include <cstdint>

#include "haptics/haptic_types.h"

namespace trephine {

class PausedTicks {
 public:
  void add(const Event& event) {
    if (event.kind != EventKind::command) return;
    if (event.command.kind == CommandKind::pause && !pauses_) {
      pauses_ = true;
      since_ = event.tick;
    }
    if (event.command.kind == CommandKind::resume && pauses_) {
      pauses_ = false;
      ended_ += event.tick - since_;
    }
  }
  // Of the pauses that have ended.
  std::uint64_t ended() const { return ended_; }
  // With the one that lasts still, up to that tick.
  std::uint64_t until(std::uint64_t tick) const {
    return pauses_ && tick > since_ ? ended_ + tick - since_ : ended_;
  }

 private:
  std::uint64_t ended_ = 0;
  bool pauses_ = false;
  std::uint64_t since_ = 0;
};

}  // namespace trephine
