// What a slice view draws: the slice, and what lies over it.
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/common/colours.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

constexpr double kNarrow_pixels = 300.0;  // where words would meet the letters at the edges

QString nameOf(SliceAxis axis) {
  switch (axis) {
    case SliceAxis::axial:
      return SliceView::tr("Axial");
    case SliceAxis::coronal:
      return SliceView::tr("Coronal");
    case SliceAxis::sagittal:
      break;
  }
  return SliceView::tr("Sagittal");
}

// The view whose slices run across (`down` false) or along the columns of this one.
SliceAxis lineOf(SliceAxis axis, bool across) {
  if (axis == SliceAxis::axial) return across ? SliceAxis::coronal : SliceAxis::sagittal;
  if (across) return SliceAxis::axial;
  return axis == SliceAxis::coronal ? SliceAxis::sagittal : SliceAxis::coronal;
}

}  // namespace

QColor colourOf(SliceAxis axis) {
  switch (axis) {
    case SliceAxis::axial:
      return {0xe8, 0x7d, 0x8c};
    case SliceAxis::coronal:
      return {0x7c, 0xcf, 0x92};
    case SliceAxis::sagittal:
      break;
  }
  return {0xdc, 0xc6, 0x5e};
}

// Only what can be seen is drawn, and only when it changed.
void SliceView::paintSlice(QPainter& painter) {
  const QRectF seen(toSlice({0.0, 0.0}), toSlice({double(width()), double(height())}));
  const QRect part = seen.toAlignedRect().adjusted(-1, -1, 1, 1) & QRect(QPoint(0, 0), shape());
  if (part.isEmpty()) return;
  if (stale_ || part != part_) {
    drawSlice(mirror_->volume(), mirror_->labels().get(), stack_, slice_, part, colours_, image_);
    part_ = part;
    stale_ = false;
    ++drawn_;
  }
  const QRectF into(toWidget(part.topLeft()),
                    toWidget(QPointF(part.left() + part.width(), part.top() + part.height())));
  painter.drawImage(into, image_);
}

void SliceView::paintOver(QPainter& painter) {
  paintCross(painter);
  painter.setRenderHint(QPainter::Antialiasing);
  paintTools(painter);
  for (const Measure& measure : measures_) {
    if (isShown(measure)) paintMeasure(painter, measure);
  }
  paintWorkspaces(painter);
  toolbox_.inHand().paint(painter, *this);
  paintText(painter);
  if (hasFocus()) {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(colours::kAccent);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
  }
}

// Where the other two views' slices cut this one; open around the point itself.
void SliceView::paintCross(QPainter& painter) const {
  constexpr double kOpen_pixels = 9.0;
  const QPointF at = fromPatient(point_mm_);
  const QRectF box = target() & QRectF(rect());
  const auto line = [&](SliceAxis of, const QPointF& from, const QPointF& to) {
    QColor colour = colourOf(of);
    colour.setAlpha(190);
    painter.setPen(colour);
    painter.drawLine(from, to);
  };
  const SliceAxis across = lineOf(axis_, true), along = lineOf(axis_, false);
  if (at.y() >= box.top() && at.y() <= box.bottom()) {
    line(across, {box.left(), at.y()}, {std::max(box.left(), at.x() - kOpen_pixels), at.y()});
    line(across, {std::min(box.right(), at.x() + kOpen_pixels), at.y()}, {box.right(), at.y()});
  }
  if (at.x() >= box.left() && at.x() <= box.right()) {
    line(along, {at.x(), box.top()}, {at.x(), std::max(box.top(), at.y() - kOpen_pixels)});
    line(along, {at.x(), std::min(box.bottom(), at.y() + kOpen_pixels)}, {at.x(), box.bottom()});
  }
}

SliceView::ToolMark SliceView::markOf(const ToolView& tool) const {
  const Vec3 tip = tool.pose_mm.position;
  const Vec3 back = tip + tool.pose_mm.orientation * Vec3(0.0, 0.0, std::max(5.0, tool.length_mm));
  return {fromPatient(tip), fromPatient(back), std::max(5.0, tool.radius_mm * pixelsPerMm()),
          offSlice_mm(tip) <= std::max(tool.radius_mm, 0.5 * stack_.spacing_mm.z) + 1e-9};
}

QRect SliceView::toolsRect() const {
  QRectF all;
  for (const ToolView& tool : tools_) {
    if (!isFinite(tool.pose_mm)) continue;
    const ToolMark mark = markOf(tool);
    const double more = mark.ring + 4.0;
    all |= QRectF(mark.tip, mark.back).normalized().adjusted(-more, -more, more, more);
  }
  return (all & QRectF(rect())).toAlignedRect();
}

// A ring at the tip and a line along the tool, seen along the slice's normal: full where the tip is
// in the slice, thin and broken where it is before or behind it.
void SliceView::paintTools(QPainter& painter) const {
  for (const ToolView& tool : tools_) {
    if (!isFinite(tool.pose_mm)) continue;
    const ToolMark mark = markOf(tool);
    QColor colour = colours::of(tool.colour);
    if (!mark.in_slice) colour.setAlpha(150);
    const QPen pen = mark.in_slice ? QPen(colour, 2.5) : QPen(colour, 1.2, Qt::DotLine);
    drawRimmed(painter, pen, mark.in_slice ? 2.0 : 0.0, [&] {
      painter.drawLine(mark.tip, mark.back);
      painter.drawEllipse(mark.tip, mark.ring, mark.ring);
    });
    if (!mark.in_slice) continue;
    painter.setPen(Qt::NoPen);
    painter.setBrush(colour);
    painter.drawEllipse(mark.tip, 2.0, 2.0);
  }
}

// Their edges as they lie over the slice, dotted where it does not cut the box, and what they are
// dragged by.
void SliceView::paintWorkspaces(QPainter& painter) const {
  if (!hasSlice()) return;
  for (const WorkspaceBox& box : workspaces_) {
    const std::array<Vec3, 8> corners = box.corners();
    double first = std::numeric_limits<double>::max(), last = -first;
    for (const Vec3& corner : corners) {
      const double slice = toVoxel(stack_, corner).z;
      first = std::min(first, slice);
      last = std::max(last, slice);
    }
    const bool cut = first <= slice_ && slice_ <= last;  // else it lies before or behind
    QColor colour = box.colour;
    if (!box.chosen || !cut) colour.setAlphaF(0.5f);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colour, box.chosen ? 1.6 : 1.0, cut ? Qt::SolidLine : Qt::DotLine));
    for (const auto& [a, b] : WorkspaceBox::kEdges) {
      painter.drawLine(fromPatient(corners[std::size_t(a)]), fromPatient(corners[std::size_t(b)]));
    }
    const QPointF middle = fromPatient(box.centre_mm);
    drawRimmed(painter, {colour, 2.0}, 2.0, [&] { painter.drawEllipse(middle, 7.0, 7.0); });
    if (box.chosen) {
      painter.drawLine(middle - QPointF(11, 0), middle + QPointF(11, 0));
      painter.drawLine(middle - QPointF(0, 11), middle + QPointF(0, 11));
    }
  }
}

void SliceView::paintMeasure(QPainter& painter, const Measure& measure) const {
  QPolygonF line;
  for (const Vec3& point : measure.points_mm) line << fromPatient(point);
  drawRimmed(painter, {colours::kCaution, 1.5}, 2.0, [&] {
    painter.drawPolyline(line);
    for (const QPointF& end : line) painter.drawEllipse(end, 3.0, 3.0);
  });
  const bool angle = measure.kind == Measure::Kind::angle;
  if (angle && line.size() < 3) return;
  const QString words = angle ? tr("%1\u00b0").arg(angle_deg(measure), 0, 'f', 1)
                              : tr("%1 mm").arg(length_mm(measure), 0, 'f', 1);
  QRectF box((line[0] + line[1]) / 2.0 + QPointF(8.0, -20.0), QSizeF(90.0, 18.0));
  if (angle) {  // outside of its arms
    const QLineF a(line[1], line[0]), b(line[1], line[2]);
    const QPointF between = a.unitVector().p2() + b.unitVector().p2() - 2.0 * line[1];
    box.moveTopLeft(line[1] +
                    QPointF(between.x() > 0.0 ? -52.0 : 8.0, between.y() > 0.0 ? -22.0 : 4.0));
  }
  box.moveLeft(std::max(4.0, std::min(box.left(), width() - 4.0 - box.width())));
  box.moveTop(std::clamp(box.top(), 2.0, std::max(2.0, height() - 20.0)));
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignVCenter, words, colours::kCaution);
}

void SliceView::paintText(QPainter& painter) const {
  const double line = painter.fontMetrics().height();
  const bool narrow = width() < kNarrow_pixels;
  QRectF box = QRectF(rect()).adjusted(7, 4 + (narrow ? line : 0), -7, -(6 + (narrow ? line : 0)));
  const QString place = tr("%1 %2/%3").arg(nameOf(axis_)).arg(slice_ + 1).arg(slices());
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignTop, place, colourOf(axis_));
  const HuWindow& window = colours_.window();
  // The letters at the edges do not say from which side a slice is seen.
  const QString side = tr("from %1").arg(QLatin1Char(patientLetter(-stack_.direction[2])));
  const QString shades = tr("W %1 L %2").arg(window.width_hu).arg(window.centre_hu);
  QStringList lines{tr("%1, %2").arg(side, shades)};
  if (painter.fontMetrics().horizontalAdvance(lines[0]) > box.width()) lines = {side, shades};
  for (qsizetype n = 0; n < lines.size(); ++n) {
    paintWords(painter, box.adjusted(0, line * double(n + 1), 0, 0), Qt::AlignLeft | Qt::AlignTop,
               lines[n], colours::kOnPicture);
  }
  box.setRight(box.right() - (narrow ? 0.0 : 0.25 * width() + 12.0));  // the scale bar's
  const QString words =
      painter.fontMetrics().elidedText(readout(), Qt::ElideRight, int(box.width()));
  // Above the letter in the middle, where they would reach it.
  const bool long_words = painter.fontMetrics().horizontalAdvance(words) > 0.5 * width() - 20.0;
  if (narrow || long_words) box.setBottom(box.bottom() - line);
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignBottom, words, colours::kOnPicture);
}

}  // namespace trephine
