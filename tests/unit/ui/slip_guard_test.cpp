#include "ui/common/slip_guard.h"

#include <QtTest/qtestspontaneevent.h>
#include <gtest/gtest.h>

#include <QAbstractItemView>
#include <QComboBox>
#include <QKeyEvent>
#include <QMenu>
#include <QTest>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QSpinBox>
#include <QTabBar>
#include <QVBoxLayout>
#include <QWheelEvent>

#include "qt_support.h"

namespace trephine {
namespace {

class SlipGuardTest : public ::testing::Test {
 protected:
  SlipGuardTest() {
    auto* inside = new QWidget;
    auto* layout = new QVBoxLayout(inside);
    number_ = new QSpinBox;
    decimal_ = new QDoubleSpinBox;
    slider_ = new QSlider(Qt::Horizontal);
    choices_ = new QComboBox;
    tabs_ = new QTabBar;
    for (QWidget* widget : {static_cast<QWidget*>(number_), static_cast<QWidget*>(decimal_),
                            static_cast<QWidget*>(slider_), static_cast<QWidget*>(choices_),
                            static_cast<QWidget*>(tabs_)}) {
      layout->addWidget(widget);
    }
    layout->addSpacing(2000);
    number_->setValue(50);
    decimal_->setValue(50.0);
    slider_->setValue(50);
    choices_->addItems({"Bounded", "Seed", "Off"});
    for (const char* name : {"one", "two", "three"}) tabs_->addTab(name);
    tabs_->setCurrentIndex(1);
    area_.setWidget(inside);
    area_.resize(400, 300);
    area_.show();
    QApplication::setActiveWindow(&area_);
    area_.setFocus();
  }
  void wheelOver(QWidget* widget, int angle = -120) {
    const QPointF at = QRectF(widget->rect()).center();
    QWheelEvent event(at, widget->mapToGlobal(at), {}, {0, angle}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QSpontaneKeyEvent::setSpontaneous(&event);  // as from a mouse: other events go to no parent
    QCoreApplication::instance()->notify(widget, &event);
  }
  void key(QWidget* widget, int key, const QString& text = {}) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, text);
    QCoreApplication::sendEvent(widget, &event);
  }

  QApplication& application_ = test::application();
  SlipGuard guard_;
  QScrollArea area_;
  QSpinBox* number_;
  QDoubleSpinBox* decimal_;
  QSlider* slider_;
  QComboBox* choices_;
  QTabBar* tabs_;
};

TEST_F(SlipGuardTest, ALetterInAnOpenMenuIsTheMenusAndNotAShortcutBehindIt) {
  QMenu menu(&area_);
  int shortcut = 0, chosen = 0;
  QAction behind;
  behind.setShortcut(Qt::Key_P);
  area_.addAction(&behind);
  QObject::connect(&behind, &QAction::triggered, &area_, [&] { ++shortcut; });
  QObject::connect(menu.addAction("&Put it here"), &QAction::triggered, &menu, [&] { ++chosen; });
  const auto press = [&] {  // as the platform asks first whether a widget wants it
    QKeyEvent override(QEvent::ShortcutOverride, Qt::Key_P, Qt::NoModifier, "p");
    override.ignore();
    QCoreApplication::sendEvent(&area_, &override);
    return override.isAccepted();
  };
  EXPECT_FALSE(press()) << "without a menu it is a shortcut";
  menu.popup(area_.mapToGlobal(QPoint(10, 10)));
  ASSERT_EQ(QApplication::activePopupWidget(), &menu);
  EXPECT_TRUE(press());
  QTest::keyClick(&menu, Qt::Key_P);
  EXPECT_EQ(chosen, 1);
  EXPECT_EQ(shortcut, 0);
}

TEST_F(SlipGuardTest, TheWheelOverAFieldWithoutFocusScrollsThePanelAndNotTheValue) {
  for (QWidget* widget : {static_cast<QWidget*>(number_), static_cast<QWidget*>(decimal_),
                          static_cast<QWidget*>(slider_), static_cast<QWidget*>(choices_),
                          static_cast<QWidget*>(tabs_)}) {
    area_.verticalScrollBar()->setValue(0);
    ASSERT_GT(area_.verticalScrollBar()->maximum(), 100);
    wheelOver(widget);
    EXPECT_GT(area_.verticalScrollBar()->value(), 0) << widget->metaObject()->className();
  }
  EXPECT_EQ(number_->value(), 50);
  EXPECT_EQ(decimal_->value(), 50.0);
  EXPECT_EQ(slider_->value(), 50);
  EXPECT_EQ(choices_->currentIndex(), 0);
  EXPECT_EQ(tabs_->currentIndex(), 1);
}

TEST_F(SlipGuardTest, TheWheelGivesNoFocus) {
  for (QWidget* widget : {static_cast<QWidget*>(number_), static_cast<QWidget*>(decimal_),
                          static_cast<QWidget*>(slider_), static_cast<QWidget*>(choices_)}) {
    wheelOver(widget);
    wheelOver(widget);
    EXPECT_FALSE(widget->hasFocus()) << widget->metaObject()->className();
  }
  EXPECT_TRUE(area_.hasFocus());
}

TEST_F(SlipGuardTest, AFieldThatHasTheFocusFollowsTheWheel) {
  number_->setFocus();
  ASSERT_TRUE(number_->hasFocus());
  wheelOver(number_, 120);
  EXPECT_EQ(number_->value(), 51);
}

TEST_F(SlipGuardTest, AListOfChoicesChangesByOpeningItAlone) {
  choices_->setFocus();
  ASSERT_TRUE(choices_->hasFocus());
  wheelOver(choices_);
  for (int other : {Qt::Key_PageDown, Qt::Key_PageUp, Qt::Key_End, Qt::Key_Home}) {
    key(choices_, other);
  }
  key(choices_, Qt::Key_O, "o");  // the first letter of "Off"
  EXPECT_EQ(choices_->currentIndex(), 0);
  EXPECT_FALSE(choices_->view()->isVisible());
  key(choices_, Qt::Key_Down);
  EXPECT_EQ(choices_->currentIndex(), 0);
  EXPECT_TRUE(choices_->view()->isVisible());
  choices_->hidePopup();
}

}  // namespace
}  // namespace trephine
