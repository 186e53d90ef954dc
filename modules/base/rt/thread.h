// Set-up of the haptic thread: real-time priority where it can be had, sharp timers, a name.
#pragma once

namespace trephine::rt {

// Asks for SCHED_FIFO at `priority` for the calling thread; true where the system grants it.
bool requestRealTime(int priority);

// Without real-time priority Linux may wake a thread 50 us late to save power; asks for 1 ns.
void sharpenTimers();

void nameThread(const char* name);  // at most 15 characters

}  // namespace trephine::rt
