#include "base/rt/thread.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "base/tr.h"

namespace trephine::rt {

bool requestRealTime(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

void sharpenTimers() {
  prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
}

void touchStack() {
  constexpr std::size_t kStack = 256 * 1024, kPage = 4096;
  [[maybe_unused]] volatile char stack[kStack];
  for (std::size_t at = 0; at < kStack; at += kPage) stack[at] = 0;
}

namespace {

std::atomic<bool> was_held{false};

// All memory of the process in slices. While the system goes through one, every thread that asks it
// for more has to wait: for all of a case at once some 70 ms, in which the window stood still. What
// is gone meanwhile, or refused, is no failure of it: the call for all that follows says so.
void forEachSlice(int (*use)(const void* at, std::size_t bytes)) {
  constexpr std::size_t kSlice = 8 << 20;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::size_t from = 0, to = 0;
    char may_read = '-';
    if (std::sscanf(line.c_str(), "%zx-%zx %c", &from, &to, &may_read) != 3) continue;
    if (may_read != 'r') continue;  // a guard page
    for (; from < to; from += std::min(kSlice, to - from)) {
      (void)use(reinterpret_cast<const void*>(from), std::min(kSlice, to - from));
    }
  }
}

// Whether this account may hold so much that slices are worth it; the system decides.
bool mayHold() {
  rlimit limit{};
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return ::geteuid() == 0 || (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 &&
                              pages * std::size_t(::sysconf(_SC_PAGESIZE)) <= limit.rlim_cur);
}

}  // namespace

LockedMemory::LockedMemory() {
  if (mayHold()) forEachSlice(::mlock);
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
  if (!whole()) return;
  forEachSlice(::munlock);
  ::munlockall();
}

std::string LockedMemory::reason() const {
  rlimit limit{};
  const bool limited = (error_ == ENOMEM || error_ == EPERM || error_ == EAGAIN) &&
                       ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  if (!limited) return std::strerror(error_);
  return tr("this account may hold {} KiB", limit.rlim_cur / 1024);
}

void nameThread(const char* name) {
  pthread_setname_np(pthread_self(), name);
}

}  // namespace trephine::rt
