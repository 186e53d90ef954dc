#include "ui/common/stall_meter.h"

#include <gtest/gtest.h>

#include <QEventLoop>
#include <QTimer>
#include <algorithm>
#include <chrono>
#include <thread>

#include "qt_support.h"

namespace trephine {
namespace {

using std::chrono::milliseconds;

class StallMeter : public ::testing::Test {
 protected:
  void SetUp() override {
    application_.setWatcher([this](const Stall& stall) {
      if (stall.ms > longest_.ms) longest_ = stall;
    });
  }
  void TearDown() override { application_.setWatcher({}); }
  // So long, by the clock that the meter goes by, without computing.
  static void take(milliseconds time) {
    std::this_thread::sleep_for(time);  // the true clock is what the meter is held against
  }
  static void after(int ms, QObject& context, std::function<void()> work) {
    QTimer::singleShot(ms, &context, std::move(work));
  }

  TimedApplication& application_ = test::application();
  Stall longest_;
};

TEST_F(StallMeter, SaysHowLongAnEventTookAndWhoHadIt) {
  QObject slow;
  slow.setObjectName("slow");
  bool done = false;
  QMetaObject::invokeMethod(
      &slow,
      [&] {
        take(milliseconds(60));
        done = true;
      },
      Qt::QueuedConnection);
  ASSERT_TRUE(test::waitFor([&] { return done; }));
  EXPECT_GE(longest_.ms, 60.0);
  EXPECT_TRUE(longest_.by.contains("MetaCall to QObject slow, ")) << longest_.by.toStdString();
  EXPECT_LT(longest_.cpu_ms, 30.0) << "it slept";
}

TEST_F(StallMeter, EventsBetweenWhichNothingElseIsHandledAreOneStall) {
  QObject slow;
  int done = 0;
  for (int i = 0; i < 3; ++i) {
    QMetaObject::invokeMethod(
        &slow,
        [&] {
          take(milliseconds(20));
          ++done;
        },
        Qt::QueuedConnection);
  }
  ASSERT_TRUE(test::waitFor([&] { return done == 3; }));
  EXPECT_GE(longest_.ms, 60.0);
}

TEST_F(StallMeter, WhatRunsBetweenTwoEventsIsNone) {
  QObject quick;
  int done = 0;
  for (int i = 0; i < 2; ++i) {
    take(milliseconds(60));
    after(0, quick, [&] { ++done; });
    ASSERT_TRUE(test::waitFor([&] { return done == i + 1; }));
  }
  EXPECT_LT(longest_.ms, 60.0);
}

TEST_F(StallMeter, EventsThatTheLoopComesRoundBetweenAreNotAddedUp) {
  QObject quick;
  int done = 0;
  std::function<void()> again = [&] {
    take(milliseconds(10));
    if (++done < 20) after(0, quick, again);
  };
  after(0, quick, again);
  ASSERT_TRUE(test::waitFor([&] { return done == 20; }));
  EXPECT_LT(longest_.ms, 100.0) << longest_.by.toStdString();
}

TEST_F(StallMeter, ADialogsOwnLoopWaitsWithoutAStallAndItsEventsAreTimed) {
  QObject dialog;
  QEventLoop loop;
  double before = 0.0;
  after(100, dialog, [&] {
    before = longest_.ms;
    take(milliseconds(70));
    loop.quit();
  });
  bool done = false;
  after(0, dialog, [&] {
    loop.exec();
    take(milliseconds(40));
    done = true;
  });
  ASSERT_TRUE(test::waitFor([&] { return done; }));
  EXPECT_LT(before, 60.0) << "it waited";
  EXPECT_GE(longest_.ms, 70.0);
  EXPECT_LT(longest_.ms, 105.0) << "what the dialog's opener does afterwards is apart";
}

}  // namespace
}  // namespace trephine
