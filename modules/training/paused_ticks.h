// How long an exercise was in pauses that were asked for, from its events in their order.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "haptics/haptic_types.h"

namespace trephine {

class PausedTicks {
 public:
  void add(const Event& event) {
    if (event.kind != EventKind::command) return;
    if (event.command.kind == CommandKind::pause && !since_) since_ = event.tick;
    if (event.command.kind == CommandKind::resume && since_) {
      ended_ += event.tick - *std::exchange(since_, std::nullopt);
    }
  }
  // Of the pauses that have ended.
  std::uint64_t ended() const { return ended_; }
  // With the one that lasts still, up to that tick.
  std::uint64_t until(std::uint64_t tick) const {
    return since_ && tick > *since_ ? ended_ + tick - *since_ : ended_;
  }

 private:
  std::uint64_t ended_ = 0;
  std::optional<std::uint64_t> since_;
};

}  // namespace trephine
