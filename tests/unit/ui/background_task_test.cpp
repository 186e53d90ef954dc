#include "ui/common/background_task.h"

#include <gtest/gtest.h>

#include <QThread>
#include <latch>
#include <map>
#include <mutex>
#include <stdexcept>

#include "base/codes.h"
#include "qt_support.h"
#include "support.h"

namespace trephine {
namespace {

using test::waitFor;
using test::waitUntil;

class BackgroundTaskTest : public ::testing::Test {
 protected:
  QApplication& application_ = test::application();
};

TEST_F(BackgroundTaskTest, WorksElsewhereAndDeliversHere) {
  BackgroundTask task;
  QThread *worked_on = nullptr, *delivered_on = nullptr;
  int answer = 0;
  ASSERT_TRUE(task.run(
      [&](const Progress&) -> Result<int> {
        worked_on = QThread::currentThread();
        return 42;
      },
      [&](Result<int> result) {
        delivered_on = QThread::currentThread();
        answer = *result;
      }));
  EXPECT_TRUE(task.busy());
  EXPECT_EQ(answer, 0) << "delivered before the event loop ran";
  ASSERT_TRUE(waitFor([&] { return answer == 42; }));
  EXPECT_FALSE(task.busy());
  EXPECT_EQ(delivered_on, QThread::currentThread());
  EXPECT_NE(worked_on, delivered_on);
}

TEST_F(BackgroundTaskTest, DoesOneThingAtATimeAndTheNextAfterIt) {
  BackgroundTask task;
  std::latch go(1);
  int done = 0;
  ASSERT_TRUE(task.run(
      [&](const Progress&) -> Status {
        go.wait();
        return {};
      },
      [&](Status) {
        ++done;
        // What was delivered may start the next piece of work.
        EXPECT_TRUE(
            task.run([](const Progress&) -> Status { return {}; }, [&](Status) { ++done; }));
      }));
  EXPECT_FALSE(task.run([](const Progress&) -> Status { return {}; }, [&](Status) { done = 100; }));
  go.count_down();
  ASSERT_TRUE(waitFor([&] { return done == 2; }));
}

TEST_F(BackgroundTaskTest, CancelReachesTheWork) {
  BackgroundTask task;
  std::string code;
  ASSERT_TRUE(task.run(
      [](const Progress& progress) -> Status {
        waitUntil([&] { return progress.cancelled(); });
        return Error{code::kCancelled, "Cancelled", "", ""};
      },
      [&](Status status) { code = status.error().code.str(); }));
  task.cancel();
  ASSERT_TRUE(waitFor([&] { return !code.empty(); }));
  EXPECT_EQ(code, "CANCELLED");
}

TEST_F(BackgroundTaskTest, AnExceptionBecomesAnError) {
  BackgroundTask task;
  std::string code;
  const auto deliver = [&](Result<int> result) { code = result.error().code.str(); };
  ASSERT_TRUE(task.run([](const Progress&) -> Result<int> { throw std::bad_alloc(); }, deliver));
  ASSERT_TRUE(waitFor([&] { return !code.empty(); }));
  EXPECT_EQ(code, "OUT_OF_MEMORY");
  code.clear();
  ASSERT_TRUE(
      task.run([](const Progress&) -> Result<int> { throw std::runtime_error("odd"); }, deliver));
  ASSERT_TRUE(waitFor([&] { return !code.empty(); }));
  EXPECT_EQ(code, "UNEXPECTED");
}

TEST_F(BackgroundTaskTest, ReportsProgressOnThisThreadAndNotTooOften) {
  BackgroundTask task;
  std::atomic<int> reports{0};
  bool done = false;
  QObject::connect(&task, &BackgroundTask::progressed, &task,
                   [&](double fraction, const QString& s) {
                     ++reports;
                     EXPECT_GE(fraction, 0.0);
                     EXPECT_EQ(s, "Reading");
                     EXPECT_EQ(QThread::currentThread(), task.thread());
                   });
  ASSERT_TRUE(task.run(
      [&](const Progress& progress) -> Status {
        for (int i = 0; i < 100000; ++i) progress.at(i / 1e5, "Reading");
        EXPECT_TRUE(waitUntil([&] {
          progress.at(1.0, "Reading");
          return reports >= 2;
        }));
        return {};
      },
      [&](Status) { done = true; }));
  ASSERT_TRUE(waitFor([&] { return done; }));
  EXPECT_LT(reports, 1000);
}

TEST_F(BackgroundTaskTest, AStepThatCountsAnewDoesNotTakeTheBarBack) {
  BackgroundTask task;
  for (int run = 0; run < 2; ++run) {  // the next one begins at nothing again
    std::mutex mutex;
    std::map<std::string, double> said;  // by step
    bool done = false;
    const auto listening = QObject::connect(
        &task, &BackgroundTask::progressed, &task, [&](double fraction, const QString& step) {
          std::lock_guard lock(mutex);
          said[step.section(',', 0, 0).toStdString()] = fraction;
        });
    ASSERT_TRUE(task.run(
        [&](const Progress& progress) -> Status {
          std::string step = "a";
          for (const double at : {0.1, 0.8, 0.0, 0.5}) {
            EXPECT_TRUE(waitUntil([&] {  // what comes too soon after the one before is not said
              progress.at(at, step);
              std::lock_guard lock(mutex);
              return said.contains(step);
            }));
            ++step[0];
          }
          return {};
        },
        [&](Status) { done = true; }));
    ASSERT_TRUE(waitFor([&] { return done; }));
    QObject::disconnect(listening);
    EXPECT_EQ(said,
              (std::map<std::string, double>{{"a", 0.1}, {"b", 0.8}, {"c", 0.8}, {"d", 0.8}}));
  }
}

TEST_F(BackgroundTaskTest, GoingAwayCancelsWaitsAndDeliversNothing) {
  bool delivered = false;
  std::atomic<bool> ended{false};
  {
    BackgroundTask task;
    ASSERT_TRUE(task.run(
        [&](const Progress& progress) -> Status {
          ended = waitUntil([&] { return progress.cancelled(); });
          return {};
        },
        [&](Status) { delivered = true; }));
  }
  EXPECT_TRUE(ended);
  QCoreApplication::processEvents();
  EXPECT_FALSE(delivered);
}

}  // namespace
}  // namespace trephine
