#include "ui/views/slice_marks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/common/colours.h"
#include "ui/views/slice_pane.h"

namespace trephine {

namespace {

constexpr double kNarrow_pixels = 300.0;  // where words would meet the letters at the edges

struct AxisFacts {
  const char* name;  // translated
  QRgb colour;
  SliceAxis across, along;  // the views whose slices run across and along the columns of this one
};
constexpr AxisFacts kAxes[] = {{QT_TRANSLATE_NOOP("trephine::SlicePane", "Axial"), 0xffe87d8c,
                                SliceAxis::coronal, SliceAxis::sagittal},
                               {QT_TRANSLATE_NOOP("trephine::SlicePane", "Coronal"), 0xff7ccf92,
                                SliceAxis::axial, SliceAxis::sagittal},
                               {QT_TRANSLATE_NOOP("trephine::SlicePane", "Sagittal"), 0xffdcc65e,
                                SliceAxis::axial, SliceAxis::coronal}};

const AxisFacts& factsOf(SliceAxis axis) {
  return kAxes[std::size_t(axis)];
}

// Of a tool, in the widget.
struct ToolMark {
  QPointF tip, back;
  double ring;
  bool in_slice;
  QColor colour;
};

std::vector<ToolMark> marksOf(const std::vector<ToolView>& tools, const ShownSlice& on) {
  const Vec3& pixel_mm = on.stack.spacing_mm;
  const double pixels_per_mm = on.target.width() / (on.stack.size[0] * pixel_mm.x);
  std::vector<ToolMark> marks;
  for (const ToolView& tool : tools) {
    if (!isFinite(tool.pose_mm)) continue;
    const Vec3 tip = tool.pose_mm.position;
    const Vec3 along(0.0, 0.0, std::max(5.0, tool.length_mm));
    marks.push_back({on.at(tip), on.at(tip + tool.pose_mm.orientation * along),
                     std::max(5.0, tool.radius_mm * pixels_per_mm),
                     on.off_mm(tip) <= std::max(tool.radius_mm, 0.5 * pixel_mm.z) + 1e-9,
                     colours::of(tool.colour)});
  }
  return marks;
}

}  // namespace

QString nameOf(SliceAxis axis) {
  return SlicePane::tr(factsOf(axis).name);
}

QString valueOf(const Measure& measure) {
  return measure.kind == Measure::Kind::angle
             ? SlicePane::tr("%1\u00b0").arg(angle_deg(measure), 0, 'f', 1)
             : SlicePane::tr("%1 mm").arg(length_mm(measure), 0, 'f', 1);
}

QColor colourOf(SliceAxis axis) {
  return factsOf(axis).colour;
}

QPointF ShownSlice::at(const Vec3& patient_mm) const {
  const Vec3 voxel = toVoxel(stack, patient_mm);
  return inBox(target, {stack.size[0], stack.size[1]}, {voxel.x + 0.5, voxel.y + 0.5});
}

double ShownSlice::off_mm(const Vec3& patient_mm) const {
  return std::abs(toVoxel(stack, patient_mm).z - slice) * stack.spacing_mm.z;
}

bool ShownSlice::holds(const Measure& measure) const {
  return std::ranges::all_of(measure.points_mm, [&](const Vec3& point) {
    return std::lround(toVoxel(stack, point).z) == slice;
  });
}

void paintCross(QPainter& painter, const ShownSlice& on, const Vec3& point_mm) {
  constexpr double kOpen_pixels = 9.0;
  const QPointF at = on.at(point_mm);
  const QRectF box = on.target & QRectF(QPointF(), on.widget);
  const auto line = [&](SliceAxis of, const QPointF& from, const QPointF& to) {
    QColor colour = colourOf(of);
    colour.setAlpha(190);
    painter.setPen(colour);
    painter.drawLine(from, to);
  };
  const AxisFacts& facts = factsOf(on.axis);
  if (at.y() >= box.top() && at.y() <= box.bottom()) {
    line(facts.across, {box.left(), at.y()}, {std::max(box.left(), at.x() - kOpen_pixels), at.y()});
    line(facts.across, {std::min(box.right(), at.x() + kOpen_pixels), at.y()},
         {box.right(), at.y()});
  }
  if (at.x() >= box.left() && at.x() <= box.right()) {
    line(facts.along, {at.x(), box.top()}, {at.x(), std::max(box.top(), at.y() - kOpen_pixels)});
    line(facts.along, {at.x(), std::min(box.bottom(), at.y() + kOpen_pixels)},
         {at.x(), box.bottom()});
  }
}

QRect toolsRect(const ShownSlice& on, const std::vector<ToolView>& tools) {
  QRectF all;
  for (const ToolMark& mark : marksOf(tools, on)) {
    const double more = mark.ring + 4.0;
    all |= QRectF(mark.tip, mark.back).normalized().adjusted(-more, -more, more, more);
  }
  return (all & QRectF(QPointF(), on.widget)).toAlignedRect();
}

// A ring at the tip and a line along the tool, seen along the slice's normal: full where the tip is
// in the slice, thin and broken where it is before or behind it.
void paintTools(QPainter& painter, const ShownSlice& on, const std::vector<ToolView>& tools) {
  for (const ToolMark& mark : marksOf(tools, on)) {
    QColor colour = mark.colour;
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
void paintWorkspaces(QPainter& painter, const ShownSlice& on,
                     const std::vector<WorkspaceBox>& boxes) {
  for (const WorkspaceBox& box : boxes) {
    double first = std::numeric_limits<double>::max(), last = -first;
    for (const Vec3& corner : box.corners()) {
      const double slice = toVoxel(on.stack, corner).z;
      first = std::min(first, slice);
      last = std::max(last, slice);
    }
    const bool cut = first <= on.slice && on.slice <= last;  // else it lies before or behind
    QColor colour = box.colour;
    if (!box.chosen || !cut) colour.setAlphaF(0.5f);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colour, box.chosen ? 1.6 : 1.0, cut ? Qt::SolidLine : Qt::DotLine));
    for (const auto& [from, to] : box.edges()) painter.drawLine(on.at(from), on.at(to));
    const QPointF middle = on.at(box.centre_mm);
    drawRimmed(painter, {colour, 2.0}, 2.0, [&] { painter.drawEllipse(middle, 7.0, 7.0); });
    if (box.chosen) {
      painter.drawLine(middle - QPointF(11, 0), middle + QPointF(11, 0));
      painter.drawLine(middle - QPointF(0, 11), middle + QPointF(0, 11));
    }
  }
}

static double pixelsFrom(const QPointF& from, const QPointF& to, const QPointF& at) {
  const QPointF along = to - from;
  const double squared = QPointF::dotProduct(along, along);
  const double share =
      squared > 0.0 ? std::clamp(QPointF::dotProduct(at - from, along) / squared, 0.0, 1.0) : 0.0;
  const QPointF apart = at - from - share * along;
  return std::hypot(apart.x(), apart.y());
}

const WorkspaceBox* workspaceAt(const QPointF& place, const ShownSlice& on,
                                const std::vector<WorkspaceBox>& boxes) {
  constexpr double kReach_pixels = 11.0, kEdge_pixels = 5.0;
  const auto within = [](const QPointF& off, double pixels) {
    return std::hypot(off.x(), off.y()) <= pixels;
  };
  for (const WorkspaceBox& box : boxes) {
    if (!box.chosen) continue;
    if (within(on.at(box.centre_mm) - place, kReach_pixels)) return &box;
    for (const auto& [a, b] : box.edges()) {
      const QPointF from = on.at(a), to = on.at(b);
      if (QLineF(from, to).length() < 1.0) continue;  // seen end on
      if (pixelsFrom(from, to, place) <= kEdge_pixels) return &box;
    }
  }
  return nullptr;
}

double pixelsFrom(const ShownSlice& on, const Measure& measure, const QPointF& at) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < measure.points_mm.size(); ++n) {
    least = std::min(least,
                     pixelsFrom(on.at(measure.points_mm[n - 1]), on.at(measure.points_mm[n]), at));
  }
  return least;
}

void paintMeasure(QPainter& painter, const ShownSlice& on, const Measure& measure) {
  QPolygonF line;
  for (const Vec3& point : measure.points_mm) line << on.at(point);
  drawRimmed(painter, {colours::kCaution, 1.5}, 2.0, [&] {
    painter.drawPolyline(line);
    for (const QPointF& end : line) painter.drawEllipse(end, 3.0, 3.0);
  });
  const bool angle = measure.kind == Measure::Kind::angle;
  if (angle && line.size() < 3) return;
  const QString words = valueOf(measure);
  QRectF box((line[0] + line[1]) / 2.0 + QPointF(8.0, -20.0), QSizeF(90.0, 18.0));
  if (angle) {  // outside of its arms
    const QLineF a(line[1], line[0]), b(line[1], line[2]);
    const QPointF between = a.unitVector().p2() + b.unitVector().p2() - 2.0 * line[1];
    box.moveTopLeft(line[1] +
                    QPointF(between.x() > 0.0 ? -52.0 : 8.0, between.y() > 0.0 ? -22.0 : 4.0));
  }
  box.moveLeft(std::max(4.0, std::min(box.left(), on.widget.width() - 4.0 - box.width())));
  box.moveTop(std::clamp(box.top(), 2.0, std::max(2.0, on.widget.height() - 20.0)));
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignVCenter, words, colours::kCaution);
}

void paintFacts(QPainter& painter, const ShownSlice& on, const HuWindow& window,
                const QString& readout) {
  const double line = painter.fontMetrics().height();
  const AxisFacts& facts = factsOf(on.axis);
  const double wide = on.widget.width();
  const bool narrow = wide < kNarrow_pixels;
  QRectF box = QRectF(QPointF(), on.widget)
                   .adjusted(7, 4 + (narrow ? line : 0), -7, -(6 + (narrow ? line : 0)));
  const QString place =
      SlicePane::tr("%1 %2/%3").arg(nameOf(on.axis)).arg(on.slice + 1).arg(on.stack.size[2]);
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignTop, place, facts.colour);
  // The letters at the edges do not say from which side a slice is seen.
  const QString side =
      SlicePane::tr("from %1").arg(QLatin1Char(patientLetter(-on.stack.direction[2])));
  const QString shades = SlicePane::tr("W %1 L %2").arg(window.width_hu).arg(window.centre_hu);
  QStringList lines{SlicePane::tr("%1, %2").arg(side, shades)};
  if (painter.fontMetrics().horizontalAdvance(lines[0]) > box.width()) lines = {side, shades};
  for (qsizetype n = 0; n < lines.size(); ++n) {
    paintWords(painter, box.adjusted(0, line * double(n + 1), 0, 0), Qt::AlignLeft | Qt::AlignTop,
               lines[n], colours::kOnPicture);
  }
  box.setRight(box.right() - (narrow ? 0.0 : 0.25 * wide + 12.0));  // the scale bar's
  const QString words = painter.fontMetrics().elidedText(readout, Qt::ElideRight, int(box.width()));
  // Above the letter in the middle, where they would reach it.
  const bool long_words = painter.fontMetrics().horizontalAdvance(words) > 0.5 * wide - 20.0;
  if (narrow || long_words) box.setBottom(box.bottom() - line);
  paintWords(painter, box, Qt::AlignLeft | Qt::AlignBottom, words, colours::kOnPicture);
}

}  // namespace trephine
