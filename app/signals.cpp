#include "app/signals.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>

namespace trephine {

namespace {

constexpr unsigned kGrace_s = 30;  // a large volume may still have to be saved

// A SIGTERM that comes again so soon is the same wish of another, such as a parent that ends.
constexpr std::int64_t kSame_ms = 2000;

std::atomic<int> received{0};
std::atomic<std::int64_t> received_at_ms{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);
Progress* work = nullptr;

void endNow() {
  ::_exit(128 + received);
}

// On any thread, the haptic one too: async-signal-safe calls alone.
void onSignal(int signal) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_ms = std::int64_t(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
  if (received != 0) {
    if (signal == SIGTERM && now_ms - received_at_ms <= kSame_ms) return;
    endNow();
  }
  received_at_ms = now_ms;  // first: another thread may have the second one now
  received = signal;
  work->cancel();
  ::alarm(kGrace_s);
}

void onAlarm(int) {
  constexpr char kText[] = "The work did not end in time and was broken off.\n";
  static_cast<void>(!::write(STDERR_FILENO, kText, sizeof(kText) - 1));
  endNow();
}

}  // namespace

void cancelOnSignals(Progress& progress) {
  work = &progress;
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  std::signal(SIGHUP, onSignal);  // the terminal went away
  std::signal(SIGALRM, onAlarm);
}

int signalReceived() {
  return received;
}

}  // namespace trephine
