// What is said over the view of a pause and of arms without force, from states as the loop gives
// them.
#include "ui/train/state_notice.h"

#include <gtest/gtest.h>

#include <QLayout>
#include <QMouseEvent>
#include <QWheelEvent>

#include "qt_support.h"
#include "ui/common/words.h"

namespace trephine {
namespace {

Exercise twoArms() {
  Exercise exercise;
  exercise.arms.resize(2);
  exercise.arms[0].name = "left";
  exercise.arms[1].name = "right";
  return exercise;
}

// A view that counts what reaches it.
class View : public QWidget {
 public:
  QPointF pressed, moved;

 protected:
  void mousePressEvent(QMouseEvent* event) override { pressed = event->position(); }
  void mouseMoveEvent(QMouseEvent* event) override { moved = event->position(); }
};

class StateNoticeTest : public ::testing::Test {
 protected:
  StateNoticeTest() {
    view_.setFocusPolicy(Qt::StrongFocus);
    view_.resize(700, 500);
    view_.show();
  }
  template <class T>
  T& find(const char* name) {
    auto* found = notice_.findChild<T*>(name);
    EXPECT_NE(found, nullptr) << name;
    return *found;
  }
  void show(double still_s = 0.0) { notice_.showState(state_, exercise_, still_s); }
  std::string title() { return find<QLabel>("forceNoticeTitle").text().toStdString(); }
  std::string why() { return find<QLabel>("forceNoticeWhy").text().toStdString(); }
  bool shown(const char* name) { return find<QWidget>(name).isVisible(); }

  QApplication& application_ = test::application();
  Exercise exercise_ = twoArms();
  LoopState state_;
  View view_;
  StateNotice notice_{&view_};
};

TEST_F(StateNoticeTest, NothingIsSaidWhileTheArmsHaveTheirForce) {
  show();
  EXPECT_TRUE(notice_.isHidden());
  EXPECT_FALSE(notice_.forceOnAction()->isEnabled());
}

TEST_F(StateNoticeTest, LiesBelowTheToolsOfItsViews) {
  QWidget bar(&view_);
  bar.setGeometry(0, 0, 700, 34);
  bar.show();
  StateNotice below(&view_, &bar);
  state_.paused = true;
  below.showState(state_, exercise_, 0.0);
  EXPECT_GE(below.geometry().top(), 34);
  show();
  EXPECT_LT(notice_.geometry().top(), 34) << "without tools at the top";
}

TEST_F(StateNoticeTest, APauseIsSaidInLargeWordsWithTheWayOut) {
  state_.paused = true;
  show();
  ASSERT_TRUE(shown("pauseNotice"));
  EXPECT_FALSE(shown("forceNotice"));
  QLabel& title = find<QLabel>("pauseNoticeTitle");
  EXPECT_EQ(title.text(), "PAUSED");
  int asked = 0;
  QObject::connect(&notice_, &StateNotice::goOnWanted, &notice_, [&] { ++asked; });
  EXPECT_TRUE(find<QPushButton>("goOn").text().contains("Space"));
  find<QPushButton>("goOn").click();
  EXPECT_EQ(asked, 1);
  state_.paused = false;
  show();
  EXPECT_TRUE(notice_.isHidden());
}

TEST_F(StateNoticeTest, AStallThatPassesIsSaidWithoutAButton) {
  for (ArmRecord& arm : state_.record.arms) arm.faults = kFaultLate;
  show();
  EXPECT_EQ(title(), "NO FORCE: Both arms");
  EXPECT_NE(why().find("20 ms late"), std::string::npos) << why();
  EXPECT_NE(why().find("comes back by itself"), std::string::npos) << why();
  EXPECT_FALSE(shown("forceOn"));
  EXPECT_FALSE(notice_.forceOnAction()->isEnabled());
}

TEST_F(StateNoticeTest, StallsThatKeepTheForceOffSaySoWithAButton) {
  for (ArmRecord& arm : state_.record.arms) arm.faults = kFaultLate | kFaultStalled;
  show();
  EXPECT_EQ(title(), "NO FORCE: Both arms");
  EXPECT_NE(why().find("until you ask for it"), std::string::npos) << why();
  EXPECT_EQ(why().find("by itself"), std::string::npos) << "it would not";
  ASSERT_TRUE(shown("forceOn"));
  EXPECT_TRUE(find<QPushButton>("forceOn").text().startsWith("Force on"));
  int asked = 0;
  QObject::connect(&notice_, &StateNotice::forceWanted, &notice_, [&] { ++asked; });
  find<QPushButton>("forceOn").click();
  notice_.forceOnAction()->trigger();
  EXPECT_EQ(asked, 2);
}

TEST_F(StateNoticeTest, WhileTouchStandsStillItIsSaidForHowLong) {
  show(2.4);
  EXPECT_EQ(title(), "NO FORCE");
  EXPECT_NE(why().find("for 3 s"), std::string::npos) << why();
  EXPECT_FALSE(shown("forceOn")) << "nothing would answer";
  show();
  EXPECT_TRUE(notice_.isHidden());
}

TEST_F(StateNoticeTest, TheArmThatWasLostIsNamed) {
  state_.record.arms[0].faults = kFaultDeviceLost;
  show();
  EXPECT_EQ(title(), "NO FORCE: Left arm");
  EXPECT_NE(why().find("does not answer"), std::string::npos) << why();
  EXPECT_TRUE(find<QPushButton>("forceOn").text().startsWith("Try again"));
}

TEST_F(StateNoticeTest, APedalThatWasUnpluggedIsSaidWithTheWayToGoOn) {
  for (ArmRecord& arm : state_.record.arms) arm.buttons = kPedalThere | kPedalLost;
  show();
  EXPECT_EQ(title(), "THE PEDAL DOES NOT ANSWER");
  EXPECT_NE(why().find("motors are off"), std::string::npos) << why();
  EXPECT_TRUE(find<QPushButton>("forceOn").text().startsWith("Go on without it"));
  state_.record.arms[0].tool_state = kToolOff;
  EXPECT_TRUE(forceChangeWords(state_.record.arms[0], false).contains("does not answer"));
  state_.record.arms[1].faults = kFaultNonFinite;
  show();
  EXPECT_EQ(title(), "NO FORCE: Right arm");
  EXPECT_NE(why().find("The pedal was unplugged"), std::string::npos) << why();
  EXPECT_TRUE(find<QPushButton>("forceOn").text().startsWith("Force on"));
}

TEST_F(StateNoticeTest, EachReasonStandsByItsArmAndBothStatesAreSaidAtOnce) {
  state_.paused = true;
  state_.record.arms[0].faults = kFaultDeviceLost;
  state_.record.arms[1].faults = kFaultNonFinite;
  show();
  EXPECT_TRUE(shown("pauseNotice"));
  EXPECT_TRUE(shown("forceNotice"));
  EXPECT_NE(why().find("Left arm: The arm does not answer"), std::string::npos) << why();
  EXPECT_NE(why().find("Right arm: A pose"), std::string::npos) << why();
}

TEST_F(StateNoticeTest, WhileAnArmIsClutchedItIsSaidWithTheWayBack) {
  state_.record.arms[0].tool_state = state_.record.arms[1].tool_state = kToolClutched;
  show();
  EXPECT_EQ(title(), "NO FORCE: Both arms");
  EXPECT_NE(why().find("Ctrl+K"), std::string::npos) << why();
  state_.record.arms[0].tool_state = state_.record.arms[1].tool_state = 0;
  show();
  EXPECT_TRUE(notice_.isHidden());
}

TEST_F(StateNoticeTest, OfAToolInTissueThatItDidNotComeIntoItIsSaidToDrawItOut) {
  ArmRecord& arm = state_.record.arms[1];
  arm.tool_state = kToolWaits;
  show();
  EXPECT_EQ(title(), "NO FORCE: Right arm");
  EXPECT_NE(why().find("Draw it out"), std::string::npos) << why();
  EXPECT_FALSE(shown("forceOn"));
  arm.tool_state = kToolHeld;
  show();
  EXPECT_TRUE(notice_.isHidden());
}

TEST_F(StateNoticeTest, OfTwoReasonsWithoutForceBothAreSaid) {
  ArmRecord& arm = state_.record.arms[1];
  arm.tool_state = kToolWaits;
  arm.faults = kFaultLate | kFaultStalled;
  show();
  EXPECT_NE(why().find("until you ask for it"), std::string::npos) << why();
  EXPECT_NE(why().find("Draw it out"), std::string::npos) << why();
  EXPECT_TRUE(shown("forceOn"));
}

TEST_F(StateNoticeTest, AfterARewindItIsSaidToDrawOutOnlyWhatIsInTissueThatCameBack) {
  std::string words = backWords(20, state_, exercise_).toStdString();
  EXPECT_EQ(words.find("Back at 0:20"), 0u) << words;
  EXPECT_NE(words.find("clock runs on"), std::string::npos) << words;
  EXPECT_EQ(words.find("draw"), std::string::npos) << words;
  state_.record.arms[0].tool_state = kToolWaits;
  words = backWords(20, state_, exercise_).toStdString();
  EXPECT_NE(words.find("Left arm: draw the tool out"), std::string::npos) << words;
}

TEST_F(StateNoticeTest, AnUndoSaysWhoseCutCameBackAndARedoWhichWasMadeAgain) {
  exercise_.tissues.tissues.resize(1);
  exercise_.tissues.tissues[0].name = "Bone";
  LoopState cut = state_;
  cut.removed[1][0] = 300;
  cut.removed[0][0] = 40;  // of a stroke that stands
  LoopState undone = cut;
  undone.removed[1][0] = 0;
  EXPECT_EQ(undoneWords(cut, undone, exercise_, 0.5).toStdString(),
            "Brought back: Right arm, 150 mm\u00b3.");
  EXPECT_EQ(undoneWords(undone, cut, exercise_, 0.5).toStdString(),
            "Cut again: Right arm, 150 mm\u00b3.");
  EXPECT_TRUE(undoneWords(cut, cut, exercise_, 0.5).isEmpty());
}

TEST_F(StateNoticeTest, WhateverCameBeforeEachCardIsAsHighAsItsWords) {
  ArmRecord& arm = state_.record.arms[1];
  const auto expectFits = [&](const char* when) {
    int bottom = 0;
    for (const char* card : {"pauseNotice", "forceNotice"}) {
      auto& frame = find<QFrame>(card);
      if (!frame.isVisible()) continue;
      EXPECT_EQ(frame.height(), frame.layout()->totalHeightForWidth(frame.width())) << when << card;
      bottom = std::max(bottom, frame.geometry().bottom());
      for (QLabel* label : frame.findChildren<QLabel*>()) {
        EXPECT_GE(label->height(), label->heightForWidth(label->width())) << when << card;
      }
    }
    EXPECT_EQ(bottom + 1, notice_.height()) << when;
  };
  for (int round = 0; round < 2; ++round) {
    for (const bool at_once : {false, true}) {
      const auto next = [&](const char* when) {
        show();
        if (!at_once) QCoreApplication::processEvents();
        expectFits(when);
      };
      state_.paused = false;
      arm.faults = 0;
      arm.tool_state = kToolWaits;
      next("in tissue: ");
      state_.paused = true;
      next("paused: ");
      arm.faults = kFaultLate | kFaultStalled;
      next("paused, stalled: ");
      state_.paused = false;
      next("stalled in tissue: ");
      arm.faults = 0;
      next("force on: ");
    }
  }
}

TEST_F(StateNoticeTest, AHookedToolThatIsLetGoIsSaid) {
  state_.record.arms[0].tool_state = kToolHeld | kToolLetGo;
  show();
  EXPECT_NE(why().find("let go"), std::string::npos) << why();
}

TEST_F(StateNoticeTest, MouseAndWheelOverTheWordsReachTheView) {
  state_.paused = true;
  show();
  QLabel& title = find<QLabel>("pauseNoticeTitle");
  const QPointF at = QRectF(title.rect()).center();
  const QPointF in_view = title.mapTo(&view_, at);
  ASSERT_EQ(view_.childAt(in_view.toPoint()), &title);
  QMouseEvent press(QEvent::MouseButtonPress, at, title.mapToGlobal(at), Qt::LeftButton,
                    Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&title, &press);
  EXPECT_EQ(view_.pressed, in_view);
  QMouseEvent move(QEvent::MouseMove, at + QPointF(5, 0), title.mapToGlobal(at + QPointF(5, 0)),
                   Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&title, &move);
  EXPECT_EQ(view_.moved, in_view + QPointF(5, 0));
  QWheelEvent wheel(at, title.mapToGlobal(at), {}, {0, 120}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&title, &wheel);
  EXPECT_FALSE(wheel.isAccepted()) << "left to what lies below";
}

TEST_F(StateNoticeTest, LiesWithinTheViewAtAnySize) {
  state_.paused = true;
  for (ArmRecord& arm : state_.record.arms) arm.faults = kFaultStalled;
  for (const QSize size : {QSize(320, 300), QSize(700, 500), QSize(1600, 1000)}) {
    view_.resize(size);
    show();
    QCoreApplication::processEvents();
    EXPECT_TRUE(view_.rect().contains(notice_.geometry())) << size.width();
    EXPECT_LT(notice_.height(), size.height()) << size.width();
    EXPECT_NEAR(notice_.geometry().center().x(), view_.rect().center().x(), 1) << size.width();
  }
}

TEST_F(StateNoticeTest, AButtonThatGoesGivesTheKeysToTheView) {
  QApplication::setActiveWindow(&view_);
  state_.paused = true;
  show();
  find<QPushButton>("goOn").setFocus();
  state_.paused = false;
  show();
  EXPECT_EQ(view_.focusWidget(), &view_);
}

}  // namespace
}  // namespace trephine
