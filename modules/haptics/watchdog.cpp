#include "haptics/watchdog.h"

namespace trephine {

namespace {
constexpr std::chrono::milliseconds kLookEvery{2};
}

bool Standstill::begins(std::uint64_t count, bool counting, std::int64_t now_ns) {
  if (!counting || !counting_ || count != count_) {
    count_ = count;
    since_ns_ = now_ns;
    counting_ = counting;
    said_ = false;
    return false;
  }
  if (said_ || now_ns - since_ns_ < kAllowed_ns) return false;
  return said_ = true;
}

void Watchdog::run() {
  HostClock clock;
  Standstill standstill;
  std::unique_lock lock(mutex_);
  while (!ending_) {
    changed_.wait_for(lock, kLookEvery, [this] { return ending_ || (asked_ && !silenced_); });
    const bool asked = asked_ && !silenced_;
    lock.unlock();
    const std::uint64_t ticks = loop_.ticks();
    const bool still = standstill.begins(ticks, loop_.running(), clock.now_ns());
    // Said first: a plugin whose safe_stop takes its time, or for ever, must not hide it.
    still_since_ns_ = standstill.since_ns();
    if (still) loop_.noteSilenced(ticks);
    if (still || asked) loop_.silence();
    lock.lock();
    if (asked) {
      silenced_ = true;
      changed_.notify_all();
    }
  }
}

void Watchdog::end() {
  std::lock_guard lock(mutex_);
  ending_ = true;
  changed_.notify_all();
}

bool Watchdog::silence(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  asked_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, patience, [this] { return silenced_; });
}

double Watchdog::stillFor_s() const {
  const std::int64_t since_ns = still_since_ns_;
  return since_ns == 0 ? 0.0 : 1e-9 * double(HostClock().now_ns() - since_ns);
}

}  // namespace trephine
