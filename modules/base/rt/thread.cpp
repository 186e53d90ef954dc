#include "base/rt/thread.h"

#include <pthread.h>
#include <sys/prctl.h>

namespace trephine::rt {

bool requestRealTime(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

void sharpenTimers() { prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0); }

void nameThread(const char* name) { pthread_setname_np(pthread_self(), name); }

}  // namespace trephine::rt
