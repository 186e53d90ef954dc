#include "app/signals.h"

#include <time.h>
#include <unistd.h>

#include <csignal>

namespace trephine {

namespace {

constexpr unsigned kGrace_s = 30;  // a large volume may still have to be saved

// A SIGTERM that comes again so soon is the same wish of another, such as a parent that ends.
constexpr time_t kSame_s = 2;

volatile std::sig_atomic_t received = 0;
volatile time_t received_at_s = 0;
Progress* work = nullptr;

void endNow() {
  ::_exit(128 + received);
}

// On any thread, the haptic one too: async-signal-safe calls alone.
void onSignal(int signal) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  if (received != 0) {
    if (signal == SIGTERM && now.tv_sec - received_at_s <= kSame_s) return;
    endNow();
  }
  received = signal;
  received_at_s = now.tv_sec;
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
