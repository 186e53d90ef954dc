#include "ui/common/colours.h"

#include <QFont>
#include <QPalette>
#include <QStyleFactory>

#include "exercise/exercise.h"
#include "ui/common/plain_text.h"

namespace trephine::colours {

namespace {

// As legible on white as the dark theme's are on black: text 12:1, colours that mean something 4:1.
void makeLight() {
  kWindow = QColor(0xee, 0xef, 0xf1);
  kPanel = QColor(0xff, 0xff, 0xff);
  kRaised = QColor(0xe0, 0xe2, 0xe6);
  kLine = QColor(0xb9, 0xbe, 0xc6);
  kText = QColor(0x1c, 0x1e, 0x22);
  kQuiet = QColor(0x55, 0x5b, 0x66);
  kAccent = QColor(0x1f, 0x6f, 0xb5);
  kGood = QColor(0x1f, 0x7d, 0x47);
  kCaution = QColor(0x8f, 0x5f, 0x00);
  kBad = QColor(0xb8, 0x32, 0x2a);
  kLeftArm = QColor(0x0f, 0x72, 0x90);
  kRightArm = QColor(0xa3, 0x57, 0x05);
}

}  // namespace

void applyTheme(QApplication& application, Theme theme, int text_percent) {
  PlainText::rule();
  if (theme == Theme::light) makeLight();
  QFont font = application.font();
  font.setPointSizeF(font.pointSizeF() * text_percent / 100.0);
  application.setFont(font);
  application.setStyle(QStyleFactory::create("Fusion"));
  QPalette p;
  p.setColor(QPalette::Window, kWindow);
  p.setColor(QPalette::WindowText, kText);
  p.setColor(QPalette::Base, kPanel);
  p.setColor(QPalette::AlternateBase, kWindow);
  p.setColor(QPalette::Text, kText);
  p.setColor(QPalette::Button, kRaised);
  p.setColor(QPalette::ButtonText, kText);
  p.setColor(QPalette::BrightText, Qt::white);
  p.setColor(QPalette::ToolTipBase, kRaised);
  p.setColor(QPalette::ToolTipText, kText);
  p.setColor(QPalette::PlaceholderText, kQuiet);
  p.setColor(QPalette::Highlight, kAccent);
  p.setColor(QPalette::HighlightedText, Qt::white);
  p.setColor(QPalette::Link, kAccent);
  p.setColor(QPalette::Light, kLine);
  p.setColor(QPalette::Midlight, kLine);
  p.setColor(QPalette::Mid, kPanel);
  p.setColor(QPalette::Dark, kPanel);
  p.setColor(QPalette::Shadow, Qt::black);
  const QColor off = kQuiet.darker(150);
  for (QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    p.setColor(QPalette::Disabled, role, off);
  }
  p.setColor(QPalette::Disabled, QPalette::Highlight, kLine);
  application.setPalette(p);

  // What a palette cannot say. Colours by name, so that this list and the palette stay one.
  application.setStyleSheet(
      QString(
          "QToolTip { color: %1; background: %2; border: 1px solid %3; padding: 3px; }"
          "QToolButton:checked { background: %6; color: white; border: 1px solid %6;"
          " border-radius: 3px; padding: 2px; }"
          "QToolBar { border: none; border-bottom: 1px solid %4; padding: 4px; spacing: 4px; }"
          "QToolBar QToolButton { padding: 4px 8px; border-radius: 4px; }"
          "QToolBar QToolButton:hover { background: %2; }"
          "QToolBar QToolButton:pressed { background: %4; }"
          "QToolButton#qt_toolbar_ext_button { padding: 0; font-weight: bold; }"
          "QToolBar QToolButton:checked { background: %6; color: white; }"
          "QStatusBar { border-top: 1px solid %4; }"
          "QStatusBar::item { border: none; }"
          "QLabel[quiet=\"true\"] { color: %5; }"
          "QLabel[title=\"true\"] { font-weight: bold; }"
          "QToolButton[segment=\"true\"] { padding: 3px 10px; border: 1px solid %3;"
          " border-radius: 4px; background: %2; }"
          "QToolButton[segment=\"true\"]:hover { border-color: %5; }"
          "QToolButton[segment=\"true\"]:focus { border-color: %7; }"
          "QToolButton[segment=\"true\"]:checked { background: %6; color: white; }"
          // Fusion's own box cannot be seen on a dark window.
          "QCheckBox::indicator, QAbstractItemView::indicator { width: 14px; height: 14px;"
          " border-radius: 2px;"
          " border: 1px solid %5; background: %4; }"
          "QCheckBox::indicator:checked, QAbstractItemView::indicator:checked { border-color: %6;"
          " background: %6; image:"
          " url(:/qt-project.org/styles/commonstyle/images/standardbutton-apply-32.png); }"
          "QCheckBox::indicator:focus { border-color: %7; }"
          "QCheckBox::indicator:disabled, QAbstractItemView::indicator:disabled {"
          " border-color: %3; }"
          "QRadioButton::indicator { width: 14px; height: 14px; border-radius: 8px;"
          " border: 1px solid %5; background: %4; }"
          "QRadioButton::indicator:checked { border-color: %6; background:"
          " qradialgradient(cx: 0.5, cy: 0.5, radius: 0.5, fx: 0.5, fy: 0.5, stop: 0.48 white,"
          " stop: 0.58 %6); }"
          "QRadioButton::indicator:focus { border: 1px solid white; }"
          "QRadioButton::indicator:disabled { border-color: %3; }"
          "QWidget#rail { background: %4; border-right: 1px solid %3; }"
          "QToolButton[rail=\"true\"] { border: none; border-radius: 6px; padding: 6px 2px; }"
          "QToolButton[rail=\"true\"]:hover { background: %2; }"
          "QToolButton[rail=\"true\"]:focus { border: 1px solid %7; }"
          "QToolButton[rail=\"true\"]:checked { background: %6; color: white; }"
          "QLabel[heading=\"true\"] { font-size: %10pt; font-weight: bold; }"
          "QPushButton[primary=\"true\"]:enabled { background: %6; color: white;"
          " border: 1px solid %6; border-radius: 3px; padding: 4px 12px; }"
          "QPushButton[primary=\"true\"]:enabled:hover { background: %7; }"
          "QPushButton[primary=\"true\"]:focus { border: 2px solid %1; }"
          "QFrame[card=\"true\"] { background: %4; border: 1px solid %3; border-radius: 6px; }"
          // Over a picture of bone and of black alike.
          "QFrame[notice=\"true\"] { background: %4; border: 2px solid %8; border-radius: 8px; }"
          "QLabel[noticeTitle=\"true\"] { font-size: %11pt; font-weight: bold; color: %8; }"
          "QFrame[overlay=\"true\"] { background: %4; border: 1px solid %3; border-radius: 8px; }"
          "QLabel[large=\"true\"] { font-size: %9pt; }"
          "QLabel[largest=\"true\"] { font-size: %11pt; font-weight: bold; }"
          "QPushButton[big=\"true\"] { font-size: %9pt; padding: 8px 22px; }")
          .arg(kText.name(), kRaised.name(), kLine.name(), kPanel.name(), kQuiet.name(),
               kAccent.darker(125).name(), kAccent.name(), kCaution.name())
          .arg(1.3 * font.pointSizeF())
          .arg(1.5 * font.pointSizeF())
          .arg(2.3 * font.pointSizeF()));
}

QColor ofArm(const ExerciseArm& arm, std::size_t index) {
  const bool left = arm.name == "left" || (arm.name != "right" && index == 0);
  return left ? kLeftArm : kRightArm;
}

QColor of(const Vec3& rgb) {
  return QColor::fromRgbF(float(rgb.x), float(rgb.y), float(rgb.z));
}

Vec3 rgbOf(const QColor& colour) {
  return {colour.redF(), colour.greenF(), colour.blueF()};
}

void setText(QLabel& label, const QColor& colour) {
  QPalette palette = label.palette();
  if (palette.color(QPalette::WindowText) == colour) return;
  palette.setColor(QPalette::WindowText, colour);
  label.setPalette(palette);
}

}  // namespace trephine::colours
