// Time for the loop: the host's clock, or a fake one in tests. And the schedule of absolute
// deadlines that every tick waits for.
#pragma once

#include <cstdint>

namespace trephine {

class LoopClock {
 public:
  virtual ~LoopClock() = default;
  virtual std::int64_t now_ns() = 0;
  virtual void sleepUntil(std::int64_t time_ns) = 0;
};

class HostClock : public LoopClock {
 public:
  std::int64_t now_ns() override;                   // CLOCK_MONOTONIC
  void sleepUntil(std::int64_t time_ns) override;
};

// Deadlines k T after the first. A late tick is delayed, never skipped: when one starts a whole
// period or more late, the following deadlines move with it, so that no burst of ticks follows.
class TickSchedule {
 public:
  explicit TickSchedule(std::int64_t period_ns) : period_ns_(period_ns) {}

  // Sleeps until the next deadline and returns how late the tick starts [ns], 0 or more.
  std::int64_t waitForTick(LoopClock& clock);

  // Ticks that started more than half a period late.
  std::uint64_t missed() const { return missed_; }

 private:
  std::int64_t period_ns_;
  std::int64_t deadline_ns_ = 0;
  bool started_ = false;
  bool lost_ = false;  // the last reading told nothing
  std::uint64_t missed_ = 0;
};

}  // namespace trephine
