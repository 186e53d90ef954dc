// The colours of a plot: for print and reports light, beside the window's panels dark.
#pragma once

#include <QColor>

#include "plot/plot.h"

namespace trephine::plot {

enum class Theme { light, dark };

struct Colours {
  QColor background;
  QColor grid;  // faint
  QColor edge;  // of cells and of the frame
};

Colours coloursOf(Theme theme);
// Texts, lines and discs in any tone but a heat map's stand out from the background by 3 to 1 at
// least, ink and quiet by 4.5.
QColor colourOf(Tone tone, Theme theme);
// A band's, through which grid and background are seen.
QColor bandFill(QColor tone);
// Black or white, whichever is read more easily on it.
QColor inkOn(const QColor& fill);
// The contrast of two colours as in WCAG 2.1: 1 to 21.
double contrast(const QColor& a, const QColor& b);

}  // namespace trephine::plot
