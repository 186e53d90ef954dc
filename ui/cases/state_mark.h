// The state of a series as a mark that differs in shape as well as in colour.
#pragma once

#include <QIcon>
#include <QPainter>

#include "ui/cases/import_words.h"

namespace trephine {

// Pass: a disc with a tick. Repaired: a triangle with a stroke. As answered: a square with a tick.
// Has a question: a ring with a question mark. Refused: an octagon with a cross.
void paintStateMark(QPainter& painter, const QRectF& box, SeriesState state);
QIcon stateIcon(SeriesState state);

}  // namespace trephine
