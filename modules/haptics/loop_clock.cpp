#include "haptics/loop_clock.h"

#include <time.h>

#include <algorithm>
#include <cmath>

namespace trephine {

std::int64_t HostClock::now_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

void HostClock::sleepUntil(std::int64_t time_ns) {
  const timespec time{time_ns / 1'000'000'000, long(time_ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) != 0) {
  }
}

std::int64_t TickSchedule::waitForTick(LoopClock& clock) {
  // More than a second off the schedule, either way: the next tick starts a new one. Behind it, the
  // tick is as late as that; a clock that went back tells nothing, and counts as a second.
  constexpr std::int64_t kLost_ns = 1'000'000'000;
  const auto lost = [&](std::int64_t now_ns) {
    lost_ = true;
    ++missed_;
    constexpr double kMost_ns = 1e18;  // within 64 bits
    const double late_ns = double(now_ns) - double(deadline_ns_);
    return std::int64_t(std::clamp(late_ns, double(kLost_ns), kMost_ns));
  };
  const std::int64_t before_ns = clock.now_ns();
  if (!started_) {
    started_ = true;
    deadline_ns_ = before_ns;
  }
  if (lost_) {
    lost_ = false;
    deadline_ns_ = before_ns + period_ns_;
  }
  // As doubles: differences of the extremes do not fit.
  if (std::abs(double(before_ns) - double(deadline_ns_)) > double(kLost_ns)) return lost(before_ns);
  if (before_ns < deadline_ns_) clock.sleepUntil(deadline_ns_);
  const std::int64_t after_ns = clock.now_ns();
  if (std::abs(double(after_ns) - double(deadline_ns_)) > double(kLost_ns)) return lost(after_ns);
  const std::int64_t late_ns = std::max<std::int64_t>(0, after_ns - deadline_ns_);
  if (late_ns > period_ns_ / 2) ++missed_;
  deadline_ns_ += period_ns_ + (late_ns >= period_ns_ ? late_ns : 0);
  return late_ns;
}

}  // namespace trephine
