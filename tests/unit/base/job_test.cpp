#include "base/job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <stdexcept>
#include <vector>

namespace trephine {
namespace {

class JobTest : public ::testing::Test {
 protected:
  // Takes what came until the job is over.
  void finish() {
    while (job_.busy()) {
      {
        std::unique_lock lock(mutex_);
        woken_.wait(lock, [this] { return wakes_ > 0; });
        wakes_ = 0;
      }
      job_.take();
    }
  }

  std::mutex mutex_;
  std::condition_variable woken_;
  int wakes_ = 0;
  Job job_{[this] {
    const std::lock_guard lock(mutex_);
    ++wakes_;
    woken_.notify_one();
  }};
};

TEST_F(JobTest, WorksOnAThreadOfItsOwnAndBringsTheOutcomeToItsOwner) {
  std::thread::id worker;
  std::vector<const char*> order;
  job_.began = [&] { order.push_back("began"); };
  job_.ended = [&] { order.push_back(job_.busy() ? "busy" : "ended"); };
  std::optional<Result<int>> outcome;
  ASSERT_TRUE(job_.run(
      [&](const Progress&) {
        worker = std::this_thread::get_id();
        return Result<int>(7);
      },
      [&](Result<int> came) {
        order.push_back("outcome");
        outcome = came;
      }));
  EXPECT_TRUE(job_.busy());
  EXPECT_FALSE(outcome) << "it waits for take()";
  finish();
  ASSERT_TRUE(outcome && outcome->ok());
  EXPECT_EQ(**outcome, 7);
  EXPECT_NE(worker, std::this_thread::get_id());
  EXPECT_EQ(order, (std::vector<const char*>{"began", "ended", "outcome"}));
}

TEST_F(JobTest, OneAtATimeAndAnOutcomeMayBeginTheNext) {
  int done = 0;
  const auto work = [](const Progress&) { return Status(); };
  ASSERT_TRUE(job_.run(work, [&](const Status&) {
    ++done;
    EXPECT_TRUE(job_.run(work, [&](const Status&) { ++done; }));
  }));
  EXPECT_FALSE(job_.run(work, [](const Status&) { FAIL() << "another is under way"; }));
  finish();
  EXPECT_EQ(done, 2);
}

TEST_F(JobTest, WhatItThrowsIsAnError) {
  std::string code;
  ASSERT_TRUE(job_.run([](const Progress&) -> Status { throw std::bad_alloc(); },
                       [&](const Status& status) { code = status.error().code.str(); }));
  finish();
  EXPECT_EQ(code, "OUT_OF_MEMORY");
  ASSERT_TRUE(job_.run([](const Progress&) -> Status { throw std::runtime_error("odd"); },
                       [&](const Status& status) { code = status.error().code.str(); }));
  finish();
  EXPECT_EQ(code, "UNEXPECTED");
}

TEST_F(JobTest, ItsProgressNeverGoesBack) {
  std::vector<double> said;
  job_.progressed = [&](double fraction, const std::string&) { said.push_back(fraction); };
  std::atomic<std::size_t> heard{0};
  ASSERT_TRUE(job_.run(
      [&](const Progress& progress) {
        for (const double fraction : {0.5, 0.1, 0.7}) {
          const std::size_t before = heard;
          while (heard == before && !progress.cancelled()) progress.at(fraction, "step");
        }
        return Status();
      },
      [](const Status&) {}));
  while (job_.busy()) {
    job_.take();
    heard = said.size();
    std::this_thread::yield();
  }
  ASSERT_GE(said.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(said));
  EXPECT_EQ(said.front(), 0.5);
  EXPECT_EQ(said.back(), 0.7);
}

TEST(Job, ThatGoesAwayCancelsItsWorkAndDeliversNothing) {
  std::atomic<bool> cancelled{false};
  {
    Job job([] {});
    ASSERT_TRUE(job.run(
        [&](const Progress& progress) {
          while (!progress.cancelled()) std::this_thread::yield();
          cancelled = true;
          return Status();
        },
        [](const Status&) { FAIL() << "nobody is there"; }));
  }
  EXPECT_TRUE(cancelled);
}

}  // namespace
}  // namespace trephine
