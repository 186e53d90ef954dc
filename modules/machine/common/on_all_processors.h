// Independent pieces of work on all processors, with progress and cancel.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include "base/progress.h"

namespace trephine {

// Calls `work(i)` once for every i below `count`, on several threads; false once it was cancelled,
// with pieces left undone. Progress is told on the calling thread.
template <class Work>
bool onAllProcessors(std::size_t count, const std::string& step, const Progress& progress,
                     const Work& work) {
  std::atomic<std::size_t> next{0}, done{0};
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
      workers.emplace_back([&] {
        for (std::size_t item; !progress.cancelled() && (item = next++) < count; ++done) work(item);
      });
    }
    while (done < count && !progress.cancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      progress.at(double(done) / double(count), step);
    }
  }
  if (progress.cancelled()) return false;
  progress.at(1.0, step);
  return true;
}

}  // namespace trephine
