// Time for the loop: the host's clock, or a fake one in tests. And the schedule of absolute
// deadlines that every tick waits for.
#pragma once

#include <algorithm>
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
  std::int64_t now_ns() override;  // CLOCK_MONOTONIC
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

// Ticks by the samples of an arm that has a clock of its own: each is due a period after the one
// before. One that does not come is waited for 4 ms longer, less than what takes force away; from
// then on the host's clock takes its place, until samples come again: only the first missing sample
// makes a tick late and counts as missed. Whether an arm still answers, `wait` alone tells.
class SampleSchedule {
 public:
  static constexpr std::int64_t kPatience_ns = 4'000'000;
  explicit SampleSchedule(std::int64_t period_ns) : period_ns_(period_ns) {}

  // Waits with `wait(seconds)`, which answers whether a sample came, and returns how late the tick
  // starts [ns], 0 or more. Samples sooner than half a period after the last tick wait until then.
  template <class Wait>
  std::int64_t waitForTick(LoopClock& clock, Wait wait) {
    const std::int64_t before_ns = clock.now_ns();
    if (!started_) last_ns_ = before_ns;
    started_ = true;
    const std::int64_t due_ns = last_ns_ + period_ns_;
    const std::int64_t until_ns = due_ns + (replaced_ ? 0 : kPatience_ns);
    const bool sample = wait(1e-9 * double(std::max<std::int64_t>(0, until_ns - before_ns)));
    // An arm that answers at once that there is nothing must not make the loop spin, nor one whose
    // samples come in a heap.
    const std::int64_t earliest_ns = sample ? last_ns_ + period_ns_ / 2 : until_ns;
    if (clock.now_ns() < earliest_ns) clock.sleepUntil(earliest_ns);
    const std::int64_t now_ns = clock.now_ns();
    const std::int64_t late_ns = std::max<std::int64_t>(0, now_ns - due_ns);
    if (late_ns > period_ns_ / 2) ++missed_;
    replaced_ = !sample;
    last_ns_ = sample || late_ns >= period_ns_ ? now_ns : due_ns;
    return late_ns;
  }

  std::uint64_t missed() const { return missed_; }  // as TickSchedule's

 private:
  std::int64_t period_ns_;
  std::int64_t last_ns_ = 0;
  bool started_ = false, replaced_ = false;
  std::uint64_t missed_ = 0;
};

}  // namespace trephine
