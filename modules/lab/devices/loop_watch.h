// What a session's loop got from the arms and gave them, tick by tick, without a pause for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "haptics/haptic_loop.h"

namespace trephine {

class LoopWatch : public LoopProbe {
 public:
  struct Tick {
    std::uint64_t sequence = 0;
    std::int64_t sampled_ns = 0, read_ns = 0, sent_ns = 0;
    Vec3 force_N{0.0};  // device axes
    bool lost = false;
  };

  explicit LoopWatch(std::size_t most_ticks);
  // Forgets all; between two sessions.
  void begin();

  void sampled(std::size_t arm, const TrephineArmState& state) override;
  void sent(std::size_t arm, const Vec3& force_N) override;

  // Any thread: of the ticks that were whole by now.
  std::size_t ticks(std::size_t arm) const { return counts_[arm].load(std::memory_order_acquire); }
  const Tick& tick(std::size_t arm, std::size_t i) const { return ticks_[arm][i]; }
  // Page faults of the haptic thread from a second after its first tick to its last; -1 before.
  long pageFaults() const { return faults_at_start_ < 0 ? -1 : faults_now_ - faults_at_start_; }

 private:
  std::size_t most_;
  std::vector<Tick> ticks_[kMaxArms];
  std::atomic<std::size_t> counts_[kMaxArms]{};
  std::int64_t first_ns_ = 0;
  std::atomic<long> faults_at_start_{-1}, faults_now_{0};
};

}  // namespace trephine
