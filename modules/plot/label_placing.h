// Where texts stand that want to be near a point but not over one another.
#pragma once

#include <QPointF>
#include <QRectF>
#include <QSizeF>
#include <vector>

namespace trephine::plot {

// The first candidate that lies within `area` and over none of `taken`, else the one that covers
// least of these; what lies outside of the area counts as covered.
QRectF placed(const std::vector<QRectF>& candidates, const std::vector<QRectF>& taken,
              const QRectF& area);

// Around a disc, the nearest first: above right, above left, below, beside.
std::vector<QRectF> around(const QPointF& centre, double radius, const QSizeF& size);

// Moves positions along an axis until they are `apart`, as little as their order allows, and keeps
// the last within `high`. `at` ascends.
void spread(std::vector<double>& at, double apart, double high);

}  // namespace trephine::plot
