#include "ui/headset/headset_dialog.h"

#include <gtest/gtest.h>

#include <QKeyEvent>

#include "qt_support.h"
#include "ui/common/preferences.h"

namespace trephine {
namespace {

class HeadsetDialogTest : public ::testing::Test {
 protected:
  HeadsetDialogTest() {
    windowSettings().remove("headset");
    dialog_ = new HeadsetDialog(nullptr);
    dialog_->show();
    below_ = dialog_->findChild<DecimalField*>("headset/below_m");
  }
  ~HeadsetDialogTest() override {
    delete dialog_;
    windowSettings().remove("headset");
  }

  void enter(const QString& digits) {
    below_->findChild<QLineEdit*>()->selectAll();
    for (const QChar& digit : digits) press(digit.unicode(), digit);
    press(Qt::Key_Return, "\r");
  }
  void press(int key, const QString& text = {}) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, text);
    QCoreApplication::sendEvent(below_, &event);
  }

  QApplication& application_ = test::application();
  HeadsetDialog* dialog_ = nullptr;
  DecimalField* below_ = nullptr;
};

TEST_F(HeadsetDialogTest, WhatWasEnteredStaysWhenTheDialogIsLeftByEscape) {
  enter("30");
  EXPECT_EQ(preferences().headset_below_m, 0.3);
  press(Qt::Key_Escape);
  EXPECT_EQ(preferences().headset_below_m, 0.3);
  EXPECT_EQ(below_->value(), 30.0);
}

TEST_F(HeadsetDialogTest, ARefusalNamesTheNumberThatIsInForce) {
  enter("30");
  enter("999");
  const auto* reason = dialog_->findChild<QLabel*>("headset/below_mRefused");
  EXPECT_EQ(reason->text(), "999 cm is refused: between 0 and 100 only. 30 cm stays.");
  EXPECT_EQ(preferences().headset_below_m, 0.3);
}

TEST_F(HeadsetDialogTest, ItsFirstNumberIsSelectedToBeTypedOver) {
  auto* ahead = dialog_->findChild<DecimalField*>("headset/ahead_m");
  EXPECT_EQ(dialog_->focusWidget(), ahead);
  EXPECT_EQ(ahead->findChild<QLineEdit*>()->selectedText(), "40");
}

}  // namespace
}  // namespace trephine
