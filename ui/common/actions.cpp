#include "ui/common/actions.h"

#include <QObject>
#include <QWidget>

namespace trephine {

QAction* makeAction(QWidget& window, Symbol symbol, const char* name, const QString& text,
                    const QKeySequence& key, const QString& tip) {
  auto* action = new QAction(symbolIcon(symbol), text, &window);
  action->setObjectName(name);
  action->setShortcut(key);
  const QString keys = key.toString(QKeySequence::NativeText);
  action->setToolTip(keys.isEmpty() ? tip : QObject::tr("%1 (%2)").arg(tip, keys));
  window.addAction(action);
  return action;
}

}  // namespace trephine
