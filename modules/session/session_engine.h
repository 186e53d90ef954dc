// The running part of a session. Inside it alone.
#pragma once

#include <deque>

#include "base/rt/thread.h"
#include "haptics/watchdog.h"
#include "session/session.h"

namespace trephine {

// What the haptic thread and the watchdog work on, each of which owns it too: a thread that a
// device holds goes on with it after the session.
struct Session::Engine {
  Engine(HapticCore& core, std::vector<LoopDevice> devices, std::unique_ptr<Operator> script)
      : oper(std::move(script), live_hands, core.parameters().period_s),
        loop(core, std::move(devices), &oper),
        watchdog(loop) {}

  // What the tissues have been set to: those that commands point to stay.
  std::deque<TissueTable> tissues;
  rt::ParameterSet<LiveHands> live_hands;
  LiveOperator oper;
  HapticLoop loop;
  Watchdog watchdog;
  std::atomic<bool> stop{false}, finished{false};
  std::optional<rt::LockedMemory> locked;  // from before the first tick to the end of stop()
  std::atomic<bool> memory_known{false};
};

}  // namespace trephine
