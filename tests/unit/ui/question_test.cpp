#include "ui/common/question.h"

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QPushButton>

#include "qt_support.h"

namespace trephine {
namespace {

TEST(Question, GoesOnOnlyWhenThatIsChosen) {
  test::application();
  QWidget window;
  window.show();
  int went_on = 0;
  const auto question = [&] {
    return ask(&window, "q", "This loses work.", "That stays.", "&Go on", [&] { ++went_on; });
  };
  EXPECT_EQ(question()->text(), "This loses work.");
  const auto open = [&] { return window.findChild<QMessageBox*>("q"); };
  open()->defaultButton()->click();
  EXPECT_TRUE(test::waitFor([&] { return !open(); }));
  question()->reject();
  EXPECT_TRUE(test::waitFor([&] { return !open(); }));
  question()->close();
  EXPECT_TRUE(test::waitFor([&] { return !open(); }));
  EXPECT_EQ(went_on, 0) << "Return, Esc and closing keep the work";
  question()->findChild<QPushButton*>("goOnAnyway")->click();
  EXPECT_TRUE(test::waitFor([&] { return !open() && went_on; }));
  EXPECT_EQ(went_on, 1);
}

}  // namespace
}  // namespace trephine
