// Processor time of all threads, so that a busy machine is not taken for a hang.
#pragma once

#include <ctime>

namespace trephine::fuzz {

inline double processorSeconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace trephine::fuzz
