#include "haptics/loop_clock.h"

#include <time.h>

#include <algorithm>

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
  const std::int64_t before_ns = clock.now_ns();
  if (!started_) {
    started_ = true;
    deadline_ns_ = before_ns;
  }
  if (before_ns < deadline_ns_) clock.sleepUntil(deadline_ns_);
  const std::int64_t late_ns = std::max<std::int64_t>(0, clock.now_ns() - deadline_ns_);
  if (late_ns > period_ns_ / 2) ++missed_;
  deadline_ns_ += period_ns_ + (late_ns >= period_ns_ ? late_ns : 0);
  return late_ns;
}

}  // namespace trephine
