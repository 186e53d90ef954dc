// An action of the window: symbol, words, key and tip in one place.
#pragma once

#include <QAction>
#include <QKeySequence>

#include "ui/common/icons.h"

namespace trephine {

// Belongs to `window` and answers its key anywhere in it. `name` is the object's.
QAction* makeAction(QWidget& window, Symbol symbol, const char* name, const QString& text,
                    const QKeySequence& key, const QString& tip);

}  // namespace trephine
