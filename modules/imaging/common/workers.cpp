#include "imaging/common/workers.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/codes.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr std::size_t kStackBytes = std::size_t(512) << 20;  // reserved, touched only as used
constexpr unsigned kMaxThreads = 8;

struct Loop {
  Loop(std::size_t loop_count, const std::function<void(std::size_t)>& loop_work)
      : count(loop_count), work(loop_work) {}

  const std::size_t count;
  const std::function<void(std::size_t)>& work;
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stop{false}, failed{false};
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t running = 0;
};

void* runWorker(void* argument) {
  Loop& loop = *static_cast<Loop*>(argument);
  try {
    while (!loop.stop.load(std::memory_order_relaxed)) {
      const std::size_t i = loop.next.fetch_add(1, std::memory_order_relaxed);
      if (i >= loop.count) break;
      loop.work(i);
      loop.done.fetch_add(1, std::memory_order_relaxed);
    }
  } catch (const std::exception&) {
    loop.failed.store(true);
    loop.stop.store(true);
  }
  const std::lock_guard lock(loop.mutex);
  --loop.running;
  loop.ended.notify_all();
  return nullptr;
}

}  // namespace

Status forEachFile(std::size_t count, const Progress& progress, const ProgressPart& part,
                   const std::function<void(std::size_t)>& work) {
  Loop loop(count, work);
  const std::size_t wanted = std::min<std::size_t>(
      count, std::clamp(std::thread::hardware_concurrency(), 2U, kMaxThreads));
  std::vector<pthread_t> threads;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  for (std::size_t i = 0; i < wanted; ++i) {
    {
      const std::lock_guard lock(loop.mutex);
      ++loop.running;
    }
    pthread_t thread;
    if (pthread_create(&thread, &attributes, runWorker, &loop) != 0) {
      const std::lock_guard lock(loop.mutex);
      --loop.running;
      break;
    }
    threads.push_back(thread);
  }
  pthread_attr_destroy(&attributes);

  {
    std::unique_lock lock(loop.mutex);
    while (loop.running > 0) {
      loop.ended.wait_for(lock, std::chrono::milliseconds(50));
      lock.unlock();
      if (progress.cancelled()) loop.stop.store(true, std::memory_order_relaxed);
      const double share = double(loop.done.load(std::memory_order_relaxed)) / double(count);
      progress.at(part.from + (part.to - part.from) * share, part.step);
      lock.lock();
    }
  }
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);

  if (progress.cancelled()) return Error{code::kCancelled, tr("The import was cancelled"), "", ""};
  if (loop.failed.load() || (count > 0 && threads.empty())) {
    return Error{code::kOutOfMemory, tr("There is not enough memory to read the files"), part.step,
                 tr("Close other programs and try again")};
  }
  return {};
}

}  // namespace trephine
