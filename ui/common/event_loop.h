// When the event loop of this thread comes round, which is when it looks for input.
#pragma once

#include <QAbstractEventDispatcher>

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

}  // namespace trephine
