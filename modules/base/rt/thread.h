// Set-up of the haptic thread: real-time priority where it can be had, sharp timers, a name.
#pragma once

#include <string>

namespace trephine::rt {

// Asks for SCHED_FIFO at `priority` for the calling thread; true where the system grants it.
bool requestRealTime(int priority);

// Without real-time priority Linux may wake a thread 50 us late to save power; asks for 1 ns.
void sharpenTimers();

// Writes to the pages of the stack that a tick may use, so that none is first met in one.
void touchStack();

// Holds all that the program has in memory in place until release(). What comes later is not held:
// make it on the thread that is to be held, after touchStack() and before requestRealTime().
class LockedMemory {
 public:
  LockedMemory();
  void release();

  bool whole() const { return error_ == 0; }
  // Whether this process held memory before: what nobody had touched, the stacks of all threads
  // above all, it has taken since and keeps. Any thread.
  static bool wasHeld();
  std::string reason() const;  // why not, with the limit where that is why

 private:
  int error_ = 0;  // errno
};

void nameThread(const char* name);  // at most 15 characters

}  // namespace trephine::rt
