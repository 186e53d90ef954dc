// Turns of this thread's event loop: when it comes round it looks for input.
#pragma once

#include <QAbstractEventDispatcher>
#include <QWidget>

namespace trephine {

// Calls `then` each time, while `owner` lives. Loops within an event, of a dialog or a drag, come
// round as well.
template <class Owner, class Function>
void onEachTurn(Owner* owner, Function then) {
  // Whether it may wait or not, the loop says one of the two.
  const QAbstractEventDispatcher* loop = QAbstractEventDispatcher::instance();
  QObject::connect(loop, &QAbstractEventDispatcher::aboutToBlock, owner, then);
  QObject::connect(loop, &QAbstractEventDispatcher::awake, owner, then);
}

// What changes in the window in this turn is painted in the next one, all of it at once.
inline void paintNextTurn(QWidget& window) {
  window.setUpdatesEnabled(false);
  auto* once = new QObject(&window);
  onEachTurn(once, [&window, once] {
    window.setUpdatesEnabled(true);
    once->deleteLater();
  });
}

}  // namespace trephine
