#include "ui/common/number_field.h"

#include <gtest/gtest.h>

#include <QLineEdit>

#include "qt_support.h"

namespace trephine {
namespace {

class NumberFieldTest : public ::testing::Test {
 protected:
  NumberFieldTest() {
    field_ = new DecimalField("damping", &panel_);
    panel_.setLayout(field_->withReason());
    field_->setSuffix(" N");
    field_->setLimits(0.0, 100000.0);
    field_->show(12.0);
    field_->entered = [this] { ++entered_; };
    reason_ = panel_.findChild<QLabel*>("dampingRefused");
    panel_.show();
  }
  void key(int key, const QString& text = {}) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, text);
    QCoreApplication::sendEvent(field_, &event);
  }
  void type(const QString& digits) {
    field_->findChild<QLineEdit*>()->selectAll();
    for (const QChar& digit : digits) key(digit.unicode(), digit);
    key(Qt::Key_Return, "\r");
  }

  QApplication& application_ = test::application();
  QWidget panel_;
  DecimalField* field_ = nullptr;
  QLabel* reason_ = nullptr;
  int entered_ = 0;
};

TEST_F(NumberFieldTest, ANumberBeyondItsLimitsIsRefusedInWordsAndNotCut) {
  type("1000000");
  EXPECT_EQ(field_->value(), 1000000.0) << "it can be typed";
  EXPECT_TRUE(field_->isRefused());
  EXPECT_EQ(field_->wanted(), 12.0);
  EXPECT_EQ(entered_, 0);
  ASSERT_FALSE(reason_->isHidden());
  EXPECT_EQ(reason_->text(), "1000000 N is refused: between 0 and 100000 only. 12 N stays.");

  type("-50");
  EXPECT_EQ(field_->value(), -50.0);
  EXPECT_EQ(field_->wanted(), 12.0);
  EXPECT_TRUE(reason_->text().startsWith("-50 N is refused")) << reason_->text().toStdString();
  EXPECT_EQ(entered_, 0);
}

TEST_F(NumberFieldTest, TheReasonStandsUntilItIsMended) {
  type("1000000");
  field_->clearFocus();
  field_->setLimits(0.0, 50000.0);
  EXPECT_FALSE(reason_->isHidden());
  type("40");
  EXPECT_TRUE(reason_->isHidden());
  EXPECT_EQ(field_->wanted(), 40.0);
  EXPECT_EQ(entered_, 1);
}

TEST_F(NumberFieldTest, EscapeGivesUpWhatWasTypedAndPassesOn) {
  type("1000000");
  QKeyEvent escape(QEvent::KeyPress, Qt::Key_Escape, Qt::NoModifier);
  escape.accept();
  QCoreApplication::sendEvent(field_, &escape);
  EXPECT_EQ(field_->value(), 12.0);
  EXPECT_TRUE(reason_->isHidden());
  EXPECT_FALSE(escape.isAccepted());

  field_->findChild<QLineEdit*>()->selectAll();
  key(Qt::Key_7, "7");
  key(Qt::Key_Escape);
  EXPECT_EQ(field_->text(), "12.00 N");
  EXPECT_EQ(field_->wanted(), 12.0);
}

TEST_F(NumberFieldTest, StepsGoFromTheNumberInForceAndStopAtTheLimits) {
  type("1000000");
  field_->stepBy(1);
  EXPECT_EQ(field_->wanted(), 13.0);
  EXPECT_FALSE(field_->isRefused());
  field_->stepBy(-20);
  EXPECT_EQ(field_->wanted(), 0.0);
}

TEST_F(NumberFieldTest, ANumberOfAFileIsShownAsItIsEvenBeyondTheLimits) {
  field_->show(2e6);
  EXPECT_EQ(field_->value(), 2e6);
  EXPECT_EQ(field_->wanted(), 2e6);
  EXPECT_TRUE(reason_->isHidden());
  EXPECT_EQ(entered_, 0);
}

TEST_F(NumberFieldTest, IsNoWiderThanTheNumbersWithinItsLimits) {
  EXPECT_LT(field_->minimumSizeHint().width(),
            field_->fontMetrics().horizontalAdvance("100000.00 N") + 60);
}

}  // namespace
}  // namespace trephine
