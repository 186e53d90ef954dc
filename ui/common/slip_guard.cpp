#include "ui/common/slip_guard.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMenu>
#include <QScrollBar>
#include <QTabBar>

namespace trephine {

namespace {

bool turnsByWheel(const QWidget* widget) {
  return qobject_cast<const QAbstractSpinBox*>(widget) || qobject_cast<const QTabBar*>(widget) ||
         (qobject_cast<const QAbstractSlider*>(widget) && !qobject_cast<const QScrollBar*>(widget));
}

// Passes an event on to the widgets around.
bool passOn(QEvent* event) {
  event->ignore();
  return true;
}

bool filterKey(QComboBox& choices, QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Up:
    case Qt::Key_Down:
      choices.showPopup();
      return true;
    case Qt::Key_F4:
    case Qt::Key_Space:  // both open it
    case Qt::Key_Tab:
    case Qt::Key_Backtab:
      return false;
    default:
      return passOn(event);
  }
}

// Undo and redo are the window's where nothing was typed in the field that has the keys.
bool hasNothingToUndo(QObject* watched, const QKeyEvent& key) {
  const bool undo = key.matches(QKeySequence::Undo), redo = key.matches(QKeySequence::Redo);
  if (!undo && !redo) return false;
  auto* line = qobject_cast<QLineEdit*>(watched);
  if (auto* box = qobject_cast<QAbstractSpinBox*>(watched)) line = box->findChild<QLineEdit*>();
  return line && !(undo ? line->isUndoAvailable() : line->isRedoAvailable());
}

// To Qt on X these two are the end of the line and deleting up to it; End is on every keyboard, and
// the window has a use for both.
bool isOfWindow(const QKeyEvent& key) {
  return key.modifiers() == Qt::ControlModifier &&
         (key.key() == Qt::Key_E || key.key() == Qt::Key_K);
}

}  // namespace

SlipGuard::SlipGuard(QObject* parent) : QObject(parent) {
  qApp->installEventFilter(this);
}

bool SlipGuard::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (type == QEvent::ShortcutOverride) {
    const auto& key = *static_cast<QKeyEvent*>(event);
    if (qobject_cast<QMenu*>(QApplication::activePopupWidget())) {
      event->accept();
      return true;
    }
    return (hasNothingToUndo(watched, key) || isOfWindow(key)) && passOn(event);
  }
  if (type != QEvent::Wheel && type != QEvent::KeyPress && type != QEvent::Polish) return false;
  auto* widget = qobject_cast<QWidget*>(watched);
  if (!widget) return false;
  auto* choices = qobject_cast<QComboBox*>(widget);
  if (choices && choices->isEditable()) return false;
  switch (type) {
    case QEvent::Polish:
      if ((choices || turnsByWheel(widget)) && widget->focusPolicy() == Qt::WheelFocus) {
        widget->setFocusPolicy(Qt::StrongFocus);
      }
      return false;
    case QEvent::Wheel:
      if (choices || (turnsByWheel(widget) && !widget->hasFocus())) return passOn(event);
      return false;
    default:
      return choices && filterKey(*choices, static_cast<QKeyEvent*>(event));
  }
}

}  // namespace trephine
