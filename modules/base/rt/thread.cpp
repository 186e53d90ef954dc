#include "base/rt/thread.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace trephine::rt {

bool requestRealTime(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

void sharpenTimers() { prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0); }

void touchStack() {
  constexpr std::size_t kStack = 256 * 1024, kPage = 4096;
  volatile char stack[kStack];
  for (std::size_t at = 0; at < kStack; at += kPage) stack[at] = 0;
}

namespace {
std::atomic<bool> was_held{false};
}

LockedMemory::LockedMemory() {
  if (::mlockall(MCL_CURRENT) != 0) {
    error_ = errno;
  } else {
    was_held = true;
  }
}

bool LockedMemory::wasHeld() {
  return was_held;
}

void LockedMemory::release() {
  if (whole()) ::munlockall();
}

std::string LockedMemory::reason() const {
  rlimit limit{};
  const bool limited = (error_ == ENOMEM || error_ == EPERM || error_ == EAGAIN) &&
                       ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  if (!limited) return std::strerror(error_);
  return "this account may hold " + std::to_string(limit.rlim_cur / 1024) + " KiB";
}

void nameThread(const char* name) { pthread_setname_np(pthread_self(), name); }

}  // namespace trephine::rt
