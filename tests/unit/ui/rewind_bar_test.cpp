// The bar without an exercise: what it shows and asks for as time runs and a person chooses.
#include "ui/train/rewind_bar.h"

#include <gtest/gtest.h>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include "qt_support.h"

namespace trephine {
namespace {

class RewindBarTest : public ::testing::Test {
 protected:
  RewindBarTest() {
    QObject::connect(&bar_, &RewindBar::rewindAsked, &bar_,
                     [this](quint32 second) { asked_.push_back(second); });
    bar_.resize(600, 30);
    bar_.show();
    bar_.showTime(70, false);
  }
  template <class T>
  T& find(const char* name) {
    auto* found = bar_.findChild<T*>(name);
    EXPECT_NE(found, nullptr) << name;
    return *found;
  }
  void mouse(QEvent::Type type, double x) {
    const QPointF at(x, slider_.height() / 2.0);
    const auto button = type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton;
    const auto held = type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton;
    QMouseEvent event(type, at, slider_.mapToGlobal(at), button, held, Qt::NoModifier);
    QCoreApplication::sendEvent(&slider_, &event);
  }
  void key(int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier);
    QCoreApplication::sendEvent(&slider_, &event);
  }
  // Whether it would ask in a while, after which it does not: only then Esc is its own.
  bool waitsForKeys() {
    QKeyEvent event(QEvent::KeyPress, Qt::Key_Escape, Qt::NoModifier);
    QCoreApplication::sendEvent(&bar_, &event);
    return event.isAccepted();
  }
  // That nobody is choosing, so that nothing is asked later: the slider goes with the time.
  void expectNothingIsChosen(std::uint32_t now) {
    QCoreApplication::processEvents();
    bar_.showTime(now, false);
    EXPECT_EQ(slider_.value(), int(now));
    EXPECT_EQ(time(), std::to_string(now / 60) + ":" + std::to_string(now % 60));
  }
  std::string time() { return find<QLabel>("rewindTime").text().toStdString(); }

  QApplication& application_ = test::application();
  RewindBar bar_;
  QSlider& slider_ = find<QSlider>("rewindSlider");
  std::vector<std::uint32_t> asked_;
};

TEST_F(RewindBarTest, FollowsTheTimeAndSaysItInMinutes) {
  EXPECT_EQ(slider_.minimum(), 0);
  EXPECT_EQ(slider_.value(), 70);
  EXPECT_EQ(time(), "1:10");
  bar_.showTime(605, false);
  EXPECT_EQ(slider_.maximum(), 605);
  EXPECT_EQ(slider_.value(), 605);
  EXPECT_EQ(time(), "10:05");
  EXPECT_TRUE(asked_.empty()) << "showing is no question";
  EXPECT_FALSE(slider_.accessibleName().isEmpty());
  EXPECT_TRUE(find<QToolButton>("backButton").toolTip().contains("Ctrl+Backspace"));
}

TEST_F(RewindBarTest, ADragAsksOnceWhenItIsLetGo) {
  mouse(QEvent::MouseButtonPress, slider_.width() - 10.0);
  for (double share : {0.9, 0.8, 0.6, 0.5}) mouse(QEvent::MouseMove, share * slider_.width());
  const int chosen = slider_.value();
  EXPECT_NEAR(chosen, 35, 2);
  bar_.showTime(71, false);
  EXPECT_EQ(slider_.value(), chosen) << "time runs on, the hand's choice stays";
  EXPECT_EQ(time(), "0:" + std::to_string(chosen) + " of 1:11");
  EXPECT_FALSE(waitsForKeys()) << "held for long nothing is asked";
  EXPECT_TRUE(asked_.empty());
  mouse(QEvent::MouseButtonRelease, 0.5 * slider_.width());
  EXPECT_EQ(asked_, std::vector<std::uint32_t>{std::uint32_t(chosen)});
  bar_.showTime(73, false);
  EXPECT_EQ(slider_.value(), 73);
}

TEST_F(RewindBarTest, AClickOnTheWayChoosesThatSecond) {
  mouse(QEvent::MouseButtonPress, 0.25 * slider_.width());
  mouse(QEvent::MouseButtonRelease, 0.25 * slider_.width());
  ASSERT_EQ(asked_.size(), 1u);
  EXPECT_NEAR(asked_[0], 17.5, 2.0);
}

TEST_F(RewindBarTest, LetGoAtTheEndNothingIsAsked) {
  mouse(QEvent::MouseButtonPress, slider_.width() - 5.0);
  mouse(QEvent::MouseMove, 0.5 * slider_.width());
  mouse(QEvent::MouseMove, slider_.width() + 20.0);
  mouse(QEvent::MouseButtonRelease, slider_.width() + 20.0);
  expectNothingIsChosen(74);
  EXPECT_TRUE(asked_.empty());
}

TEST_F(RewindBarTest, KeysAreWaitedForAndAskOnce) {
  key(Qt::Key_Left);
  key(Qt::Key_PageDown);
  EXPECT_EQ(slider_.value(), 59);
  bar_.showTime(71, false);
  EXPECT_EQ(slider_.value(), 59);
  EXPECT_TRUE(asked_.empty());
  EXPECT_TRUE(test::waitFor([&] { return !asked_.empty(); }));
  EXPECT_EQ(asked_, std::vector<std::uint32_t>{59});
}

TEST_F(RewindBarTest, EscapeStaysAndTheWheelDoesNothing) {
  key(Qt::Key_Home);
  EXPECT_EQ(time(), "0:00 of 1:10");
  key(Qt::Key_Escape);
  EXPECT_EQ(time(), "1:10");
  key(Qt::Key_Home);
  EXPECT_TRUE(waitsForKeys());
  EXPECT_EQ(time(), "1:10");
  QWheelEvent wheel({10, 10}, slider_.mapToGlobal(QPointF(10, 10)), {}, {0, -120}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&slider_, &wheel);
  EXPECT_EQ(slider_.value(), 70);
  expectNothingIsChosen(71);
  EXPECT_TRUE(asked_.empty());
}

TEST_F(RewindBarTest, IsDisabledWhileGoingBackAndWithoutAnExercise) {
  mouse(QEvent::MouseButtonPress, 0.5 * slider_.width());
  bar_.showTime(71, true);
  EXPECT_FALSE(slider_.isEnabled());
  EXPECT_FALSE(bar_.backAction()->isEnabled());
  EXPECT_EQ(time(), "Going back\u2026");
  mouse(QEvent::MouseButtonRelease, 0.5 * slider_.width());
  expectNothingIsChosen(72);
  EXPECT_TRUE(asked_.empty()) << "what was being chosen is dropped, not asked";
  EXPECT_TRUE(slider_.isEnabled());
  bar_.showIdle();
  EXPECT_FALSE(slider_.isEnabled());
  EXPECT_FALSE(bar_.backAction()->isEnabled());
  EXPECT_EQ(slider_.value(), 0);
}

TEST_F(RewindBarTest, TheFocusComesBackToTheSlider) {
  QApplication::setActiveWindow(&bar_);
  slider_.setFocus();
  bar_.showTime(71, true);
  EXPECT_NE(bar_.focusWidget(), &slider_);
  bar_.showTime(72, false);
  EXPECT_EQ(bar_.focusWidget(), &slider_);
}

TEST_F(RewindBarTest, BackTwiceIsTwiceAsFar) {
  bar_.backAction()->trigger();
  bar_.showTime(70, true);
  bar_.showTime(70, false);
  bar_.backAction()->trigger();
  bar_.showTime(73, false);
  EXPECT_EQ(asked_, (std::vector<std::uint32_t>{60, 50}));
  bar_.showIdle();
  bar_.showTime(4, false);
  bar_.backAction()->trigger();
  EXPECT_EQ(asked_.back(), 0u) << "no further than the beginning";
}

TEST(RewindHistory, GoesByTheTimeOfThePersonAtWork) {
  RewindHistory way;
  EXPECT_EQ(way.before(50, 10), 40u);
  way.went(50, 40);
  EXPECT_EQ(way.before(50, 10), 30u);
  EXPECT_EQ(way.before(53, 10), 33u) << "3 s since, then 7 before 0:40";
  EXPECT_EQ(way.before(60, 10), 40u) << "not 0:50, which is before the jump";
  EXPECT_EQ(way.before(61, 10), 51u);
  way.went(53, 33);
  EXPECT_EQ(way.before(54, 10), 24u);
  way.went(60, 52);  // into the two seconds between the jumps
  EXPECT_EQ(way.before(60, 1), 51u);
  EXPECT_EQ(way.before(60, 10), 32u);
  EXPECT_EQ(way.before(60, 100), 0u);
}

TEST(RewindHistory, WhatLiesBehindAJumpStandsNoMoreAndWhatCameAfterItDoes) {
  RewindHistory history;
  EXPECT_TRUE(history.stands(12.5, 70));
  EXPECT_TRUE(history.stands(70.8, 70)) << "in the running second";
  history.went(70, 40);
  EXPECT_TRUE(history.stands(39.9, 75));
  EXPECT_FALSE(history.stands(50.0, 75));
  EXPECT_TRUE(history.stands(72.0, 75));
  history.went(80, 20);  // before the first jump: what it left is as it was
  EXPECT_TRUE(history.stands(15.0, 81));
  EXPECT_FALSE(history.stands(30.0, 81));
  EXPECT_FALSE(history.stands(72.0, 81));
  EXPECT_TRUE(history.stands(80.5, 81));
  EXPECT_TRUE(history.stands(81.5, 81));
}

TEST_F(RewindBarTest, AfterGoingBackItSaysOfWhichSecondTheTissueIsUntilItIsCutAgain) {
  bar_.showStrokes({{12.0, Qt::red}, {55.0, Qt::red}});
  key(Qt::Key_PageDown);
  ASSERT_TRUE(test::waitFor([&] { return !asked_.empty(); }));
  ASSERT_EQ(asked_, std::vector<std::uint32_t>{60});
  bar_.showTime(72, false);
  EXPECT_EQ(time(), "1:12, tissue of 1:00");
  bar_.showStrokes({{12.0, Qt::red}, {55.0, Qt::red}, {73.2, Qt::red}});
  bar_.showTime(74, false);
  EXPECT_EQ(time(), "1:14");
}

TEST_F(RewindBarTest, AStrokeHasAMarkThatIsFaintOnceOneWentBackToBeforeIt) {
  const auto redPixels = [&] {
    const QImage picture = bar_.grab().toImage();
    int strong = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        const QColor c = picture.pixelColor(x, y);
        strong += c.red() > 230 && c.green() < 40 && c.blue() < 40;
      }
    }
    return strong;
  };
  EXPECT_EQ(redPixels(), 0);
  bar_.showStrokes({{12.0, QColor(255, 0, 0)}, {55.0, QColor(255, 0, 0)}});
  const int both = redPixels();
  EXPECT_GT(both, 8);
  bar_.noteReset();
  bar_.showTime(71, false);
  EXPECT_EQ(redPixels(), 0) << "all is put back";
  EXPECT_EQ(time(), "1:11, tissue of 0:00");
}

}  // namespace
}  // namespace trephine
