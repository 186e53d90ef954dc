// A loop over slices or blocks on two threads: as many as the smallest machine has cores.
#pragma once

#include <atomic>
#include <system_error>
#include <thread>

namespace trephine {

// Calls work(n) once for each n below `count`, on this thread and one more. `work` must not throw,
// and what it writes must not depend on the order of the calls.
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
