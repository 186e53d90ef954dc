// Lines and areas made ready for a painter: cut at the edges of the plot, since it cannot hold any
// coordinate; lines thinned and dashed, since its time grows with the points of a line faster than
// their number. Pure.
#pragma once

#include <QPointF>
#include <QRectF>
#include <vector>

namespace trephine::plot {

// The pieces of a polyline that lie in `area`. A point that is not finite ends a piece; one alone
// between two of these is a piece by itself.
std::vector<std::vector<QPointF>> clipped(const std::vector<QPointF>& line, const QRectF& area);

// The same line as far as pixels show it: of the points that follow one another within a column of
// pixels the first, lowest, highest and last.
std::vector<QPointF> thinned(const std::vector<QPointF>& line);

// The inked pieces of a line; `dashes` are lengths of ink and gap in turn, all above 0.
std::vector<std::vector<QPointF>> dashed(const std::vector<QPointF>& line,
                                         const std::vector<double>& dashes);

// The part of a closed outline that lies in `area`; empty: none. Coordinates may be infinite, not
// NaN.
std::vector<QPointF> clippedArea(std::vector<QPointF> outline, const QRectF& area);

}  // namespace trephine::plot
