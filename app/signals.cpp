#include "app/signals.h"

#include <unistd.h>

#include <csignal>

namespace trephine {

namespace {

constexpr unsigned kGrace_s = 30;  // a large volume may still have to be saved

volatile std::sig_atomic_t received = 0;
Progress* work = nullptr;

void endNow() {
  ::_exit(128 + received);
}

// On any thread, the haptic one too: async-signal-safe calls alone.
void onSignal(int signal) {
  if (received != 0) endNow();
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
