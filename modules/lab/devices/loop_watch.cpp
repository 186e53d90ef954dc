#include "lab/devices/loop_watch.h"

#include <sys/resource.h>

namespace trephine {

namespace {

constexpr std::int64_t kSettles_ns = 1'000'000'000;

long pageFaultsOfThread() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace

LoopWatch::LoopWatch(std::size_t most_ticks) : most_(most_ticks) {
  for (std::vector<Tick>& of : ticks_) of.assign(most_, Tick{});
}

void LoopWatch::begin() {
  for (auto& count : counts_) count = 0;
  first_ns_ = 0;
  faults_at_start_ = -1;
}

void LoopWatch::sampled(std::size_t arm, const TrephineArmState& state) {
  const std::size_t i = counts_[arm].load(std::memory_order_relaxed);
  if (i >= most_) return;
  Tick& tick = ticks_[arm][i];
  tick.sequence = state.sequence;
  tick.sampled_ns = state.time_ns;
  tick.read_ns = HostClock().now_ns();
  tick.lost = state.flags & TREPHINE_ARM_LOST;
}

void LoopWatch::sent(std::size_t arm, const Vec3& force_N) {
  const std::size_t i = counts_[arm].load(std::memory_order_relaxed);
  if (i >= most_) return;
  Tick& tick = ticks_[arm][i];
  tick.sent_ns = HostClock().now_ns();
  tick.force_N = force_N;
  counts_[arm].store(i + 1, std::memory_order_release);
  if (arm != 0) return;
  if (first_ns_ == 0) first_ns_ = tick.sent_ns;
  if (tick.sent_ns - first_ns_ < kSettles_ns) return;
  const long now = pageFaultsOfThread();
  if (faults_at_start_ < 0) faults_at_start_ = now;
  faults_now_ = now;
}

}  // namespace trephine
