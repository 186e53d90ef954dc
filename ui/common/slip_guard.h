// Keeps values from changing by a slip: a wheel that turns over a field, a slider or a list of
// choices on its way down a panel, a key that was meant for a hand. For the whole program, its
// dialogs included, for as long as it lives.
//
// - The wheel turns a number, a slider or a row of tabs only where that has the focus, which the
//   wheel does not give.
// - Ctrl+Z in a field in which nothing was typed is the window's, as are Ctrl+E and Ctrl+K in any.
// - The keys of an open menu are the menu's: a letter that is a shortcut as well does not act
// behind it.
// - A list of choices changes by opening it and choosing: the wheel does nothing to it, Up, Down,
//   Space and F4 open it, Tab leaves it, other keys pass it by. One that can be typed in is left
//   alone.
#pragma once

#include <QObject>

namespace trephine {

class SlipGuard : public QObject {
  Q_OBJECT
 public:
  // Installs itself in the QApplication, which is there already. Window's thread.
  explicit SlipGuard(QObject* parent = nullptr);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace trephine
