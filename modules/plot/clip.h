// Lines cut at the edges of the plot, before a painter sees coordinates that it cannot hold.
#pragma once

#include <QPointF>
#include <QRectF>
#include <vector>

namespace trephine::plot {

// The pieces of a polyline that lie in `area`, each of two points at least. A point that is not
// finite ends a piece.
std::vector<std::vector<QPointF>> clipped(const std::vector<QPointF>& line, const QRectF& area);

}  // namespace trephine::plot
