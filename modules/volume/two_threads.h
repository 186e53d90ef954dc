// A loop over slices or blocks on two threads, as the smallest computer that this is for has two
// cores.
#pragma once

#include <atomic>
#include <system_error>
#include <thread>

namespace trephine {

// Calls work(n) once for each n from 0 to below `count`, two at the same time, on this thread and
// one more, and returns when all are done. `work` must not throw (for what may run out of memory
// there is onTwoThreadsOrThrow(), structures/voxel_runs.h), its calls must share nothing that they
// write, and what they write must not depend on their order.
template <class Work>
void onTwoThreads(int count, const Work& work) {
  std::atomic<int> next{0};
  const auto take = [&] {
    for (int n = next++; n < count; n = next++) work(n);
  };
  std::thread helper;
  try {
    if (count > 1) helper = std::thread(take);
  } catch (const std::system_error&) {
    // No thread to be had: this one does all of it.
  }
  take();
  if (helper.joinable()) helper.join();
}

}  // namespace trephine
