// Lines made ready for a painter: cut at the edges of the plot, since it cannot hold any
// coordinate, and thinned, since its time grows with the points faster than their number.
#pragma once

#include <QPointF>
#include <QRectF>
#include <vector>

namespace trephine::plot {

// The pieces of a polyline that lie in `area`, each of two points at least. A point that is not
// finite ends a piece.
std::vector<std::vector<QPointF>> clipped(const std::vector<QPointF>& line, const QRectF& area);

// The same line as far as pixels show it: of the points that follow one another within a column of
// pixels the first, lowest, highest and last.
std::vector<QPointF> thinned(const std::vector<QPointF>& line);

}  // namespace trephine::plot
