#include "slow_source/slow_source.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

namespace {

using Clock = std::chrono::steady_clock;

struct Source {
  std::atomic<bool> slow{false};
  std::mutex mutex;
  std::string folder;
  double bytes_per_s = 0.0, lasts = 0.0, bytes = 0.0;
  Clock::time_point free_at;
};

Source& source() {
  static Source one;
  return one;
}

bool liesBelow(const char* path) {
  const std::lock_guard lock(source().mutex);
  return std::string(path).starts_with(source().folder);
}

bool concerns(int descriptor) {
  if (!source().slow.load()) return false;
  char name[32], path[4096];
  std::snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(name, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  return liesBelow(path);
}

bool vanished() {
  const std::lock_guard lock(source().mutex);
  return source().bytes >= source().lasts;
}

// The bytes of one read wait in line behind those of the others.
template <class Read>
ssize_t slowly(int descriptor, Read read) {
  if (!concerns(descriptor)) return read();
  if (vanished()) {
    errno = EIO;
    return -1;
  }
  const ssize_t count = read();
  if (count <= 0) return count;
  Clock::time_point until;
  {
    const std::lock_guard lock(source().mutex);
    source().bytes += double(count);
    const std::chrono::duration<double> takes(double(count) / source().bytes_per_s);
    source().free_at = std::max(source().free_at, Clock::now()) +
                       std::chrono::duration_cast<Clock::duration>(takes);
    until = source().free_at;
  }
  std::this_thread::sleep_until(until);  // the source's own clock
  return count;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// Reads what the environment says when the library is put before a program.
struct FromEnvironment {
  FromEnvironment() {
    const char *folder = std::getenv("SLOW_SOURCE_FOLDER"), *rate = std::getenv("SLOW_SOURCE_RATE");
    const char* lasts = std::getenv("SLOW_SOURCE_LASTS");
    if (folder && rate) {
      trephine::test::slowSource(folder, std::atof(rate), lasts ? std::atof(lasts) : 1e300);
    }
  }
} from_environment;

}  // namespace

namespace trephine::test {

void slowSource(const char* folder, double bytes_per_s, double lasts) {
  const std::lock_guard lock(source().mutex);
  source().folder = folder;
  source().bytes_per_s = bytes_per_s;
  source().lasts = lasts;
  source().bytes = 0.0;
  source().free_at = {};
  source().slow.store(true);
}

void endSlowSource() {
  source().slow.store(false);
}

std::uint64_t bytesOfSlowSource() {
  const std::lock_guard lock(source().mutex);
  return std::uint64_t(source().bytes);
}

}  // namespace trephine::test

extern "C" {

ssize_t read(int descriptor, void* to, size_t bytes) {
  static auto* const real = next<ssize_t(int, void*, size_t)>("read");
  return slowly(descriptor, [&] { return real(descriptor, to, bytes); });
}

ssize_t pread(int descriptor, void* to, size_t bytes, off_t at) {
  static auto* const real = next<ssize_t(int, void*, size_t, off_t)>("pread");
  return slowly(descriptor, [&] { return real(descriptor, to, bytes, at); });
}

ssize_t pread64(int descriptor, void* to, size_t bytes, off64_t at) {
  static auto* const real = next<ssize_t(int, void*, size_t, off64_t)>("pread64");
  return slowly(descriptor, [&] { return real(descriptor, to, bytes, at); });
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  std::va_list more;
  va_start(more, flags);
  const int mode = va_arg(more, int);
  va_end(more);
  if (source().slow.load() && liesBelow(path) && vanished()) {
    errno = EIO;
    return -1;
  }
  return real(path, flags, mode);
}

}  // extern "C"
