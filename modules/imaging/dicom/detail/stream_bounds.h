// How much of a file is taken before what it says of itself is doubted.
#pragma once

#include <cstddef>
#include <cstdint>

namespace trephine {

// Where a DicomStream ends, whatever a file says.
struct StreamBounds {
  std::size_t stack;      // that nesting takes of the thread that parses
  std::int64_t inflated;  // bytes that are read of a deflated data set
  std::int64_t header;    // bytes that are read of another, less the values that are skipped
};
// For a worker's stack (forEachFile()); 16 bytes make a level of nesting.
constexpr StreamBounds kSliceBounds{std::size_t(256) << 20, std::int64_t(2) << 20,
                                    std::int64_t(128) << 20};
// For headers with thousands of frames, and for any thread: no real file nests a hundredth so deep.
constexpr StreamBounds kManyFrames{std::size_t(1) << 20, std::int64_t(32) << 20,
                                   std::int64_t(256) << 20};

}  // namespace trephine
