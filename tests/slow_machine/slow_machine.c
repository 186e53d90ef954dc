// A machine whose disk is slow and whose ticks come late, put before a program with LD_PRELOAD:
// each write to the disk takes SLOW_SYNC_MS longer, and who sleeps until a time wakes LATE_US late.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

static long number(const char* name) {
  const char* text = getenv(name);
  return text ? atol(text) : 0;
}

int fdatasync(int descriptor) {
  int (*real)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fdatasync");
  const long ms = number("SLOW_SYNC_MS");
  const struct timespec longer = {ms / 1000, ms % 1000 * 1000000};
  nanosleep(&longer, NULL);  // the disk's own clock
  return real(descriptor);
}

int clock_nanosleep(clockid_t clock, int flags, const struct timespec* until,
                    struct timespec* left) {
  static int (*real)(clockid_t, int, const struct timespec*, struct timespec*);
  static long late_ns;
  if (!real) {
    late_ns = number("LATE_US") * 1000;
    real = (int (*)(clockid_t, int, const struct timespec*, struct timespec*))dlsym(
        RTLD_NEXT, "clock_nanosleep");
  }
  struct timespec late = *until;
  if (flags & TIMER_ABSTIME) {
    late.tv_nsec += late_ns;
    late.tv_sec += late.tv_nsec / 1000000000;
    late.tv_nsec %= 1000000000;
  }
  return real(clock, flags, &late, left);
}
