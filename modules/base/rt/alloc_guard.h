// Traps allocation inside the tick. While a NoAllocation stands on a thread, every operator new or
// delete of that thread is counted; tests (and the debug build of the loop) require the count to
// stay zero. The counting operators live in alloc_guard.cpp and are linked into every program.
#pragma once

#include <cstdint>

namespace trephine::rt {

class NoAllocation {
 public:
  NoAllocation();
  ~NoAllocation();
  NoAllocation(const NoAllocation&) = delete;
  NoAllocation& operator=(const NoAllocation&) = delete;
};

// Allocations and releases seen under any guard since the program started.
std::uint64_t guardedAllocations();

}  // namespace trephine::rt
