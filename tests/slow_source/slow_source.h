// A slow source, or one that vanishes, for tests: a library that stands before the C library's
// open() and read() for the files below one folder. Linked into a test program, or put before
// another one with LD_PRELOAD and the variables SLOW_SOURCE_FOLDER, SLOW_SOURCE_RATE (bytes a
// second) and SLOW_SOURCE_LASTS (bytes; none: for ever).
#pragma once

#include <cstdint>

namespace trephine::test {

// From here on what is read below `folder` comes at this rate, of all threads together, and once
// `lasts` bytes were read every call fails as that of a device which was pulled out.
void slowSource(const char* folder, double bytes_per_s, double lasts = 1e300);
void endSlowSource();
std::uint64_t bytesOfSlowSource();  // read since then

struct SlowSource {
  SlowSource(const char* folder, double bytes_per_s, double lasts = 1e300) {
    slowSource(folder, bytes_per_s, lasts);
  }
  ~SlowSource() { endSlowSource(); }
  SlowSource(const SlowSource&) = delete;
  SlowSource& operator=(const SlowSource&) = delete;
};

}  // namespace trephine::test
