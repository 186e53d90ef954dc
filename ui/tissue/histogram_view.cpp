#include "ui/tissue/histogram_view.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr double kGrip = 6.0;         // pixels on either side of a threshold
constexpr double kLeastShown = 40.0;  // HU
constexpr double kNotch = 120.0;

double stepOfTicks(double hu_per_tick) {
  const double ten = std::pow(10.0, std::floor(std::log10(std::max(hu_per_tick, 1.0))));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * ten >= hu_per_tick) return step * ten;
  }
  return 10.0 * ten;
}

QColor dimmed(const QColor& colour, double share) {
  QColor out = colour;
  out.setAlphaF(float(share));
  return out;
}

}  // namespace

HistogramView::HistogramView(QWidget* parent) : QWidget(parent) {
  setObjectName("histogram");
  setAccessibleName(tr("Tissues over the histogram"));
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
}

QSize HistogramView::sizeHint() const {
  return {500, 8 * fontMetrics().height()};
}

QSize HistogramView::minimumSizeHint() const {
  return {200, 6 * fontMetrics().height()};
}

QRectF HistogramView::plot() const {
  const double line = fontMetrics().height();
  return QRectF(rect()).adjusted(8.5, 4.5, -8.5, -(2.0 * line + 10.0));
}

QRectF HistogramView::bands() const {
  const QRectF above = plot();
  return {above.left(), above.bottom() + 2.0, above.width(), double(fontMetrics().height()) + 2.0};
}

double HistogramView::xOf(double hu) const {
  const QRectF in = plot();
  return in.left() + (hu - from_hu_) / (to_hu_ - from_hu_) * in.width();
}

double HistogramView::huAt(double x) const {
  const QRectF in = plot();
  return from_hu_ + (x - in.left()) / std::max(in.width(), 1.0) * (to_hu_ - from_hu_);
}

void HistogramView::setHistogram(std::shared_ptr<const HuHistogram> histogram) {
  histogram_ = std::move(histogram);
  any_case_ = true;
  fitted_ = false;
  count();
}

void HistogramView::setTissues(const TissueSet& tissues, std::size_t chosen) {
  tissues_ = tissues;
  table_ = tissueTable(tissues_);
  chosen_ = std::min(chosen, tissues_.tissues.empty() ? 0 : tissues_.tissues.size() - 1);
  if (active_.tissue != chosen_ && !dragged_) active_ = {chosen_, RangeEnd::low};
  count();
}

void HistogramView::showOverlaps(const std::vector<HuOverlap>& overlaps) {
  overlaps_ = overlaps;
  update();
}

void HistogramView::setLocked(bool locked) {
  locked_ = locked;
  update();
}

// A structure's voxels where the chosen tissue is one's.
void HistogramView::count() {
  counts_.clear();
  shares_ = {};
  update();
  if (!histogram_ || histogram_->empty() || tissues_.tissues.empty()) return;
  shares_ = sharesOf(tissues_, *histogram_);
  const Tissue& of = tissues_.tissues[chosen_];
  if (of.isAnywhere()) {
    counts_ = histogram_->whole();
  } else {
    counts_.assign(std::size_t(histogram_->high_hu - histogram_->low_hu + 1), 0);
    for (const HuHistogram::Row& row : histogram_->rows) {
      if (of.label != int(row.label)) continue;
      counts_.assign(row.counts.begin(), row.counts.end());
    }
  }
  if (!std::exchange(fitted_, true)) showAll();
}

// From the lowest to the highest HU that are no accident: a few voxels of metal would leave little
// room for what is cut.
void HistogramView::showAll() {
  from_hu_ = -1024.0;
  to_hu_ = 3071.0;
  if (histogram_ && !histogram_->empty()) {
    const std::vector<std::uint64_t> all = histogram_->whole();
    const std::uint64_t few = std::max<std::uint64_t>(1, histogram_->voxels / 100'000);
    std::uint64_t above = 0;
    std::size_t high = all.size();
    while (high > 1 && above < few) above += all[--high];
    to_hu_ = double(histogram_->low_hu) + double(high) + 50.0;
    from_hu_ = double(std::max(histogram_->low_hu, -1024));
  }
  if (to_hu_ - from_hu_ < kLeastShown) to_hu_ = from_hu_ + kLeastShown;
  update();
}

void HistogramView::zoom(double factor, double about_hu) {
  const double least = -1100.0, most = 4100.0;
  const double wanted = std::clamp((to_hu_ - from_hu_) * factor, kLeastShown, most - least);
  const double share = (about_hu - from_hu_) / (to_hu_ - from_hu_);
  from_hu_ = std::clamp(about_hu - share * wanted, least, most - wanted);
  to_hu_ = from_hu_ + wanted;
  update();
}

std::vector<std::size_t> HistogramView::shown() const {
  std::vector<std::size_t> of;
  if (tissues_.tissues.empty()) return of;
  for (std::size_t i = 0; i < tissues_.tissues.size(); ++i) {
    if (inSamePlace(tissues_.tissues[i], tissues_.tissues[chosen_])) of.push_back(i);
  }
  std::ranges::sort(of, {}, [&](std::size_t i) { return tissues_.tissues[i].hu_min; });
  return of;
}

int HistogramView::huOf(const Threshold& threshold) const {
  const Tissue& tissue = tissues_.tissues[threshold.tissue];
  return threshold.end == RangeEnd::low ? tissue.hu_min : tissue.hu_max;
}

double HistogramView::edgeOf(const Threshold& threshold) const {
  return double(huOf(threshold)) + (threshold.end == RangeEnd::low ? -0.5 : 0.5);
}

// The chosen tissue's before another's: two that touch lie in one place.
std::optional<HistogramView::Threshold> HistogramView::thresholdAt(const QPointF& place) const {
  std::optional<Threshold> best;
  double nearest = kGrip + 0.5;
  for (const std::size_t i : shown()) {
    for (const RangeEnd end : {RangeEnd::low, RangeEnd::high}) {
      double away = std::abs(xOf(edgeOf({i, end})) - place.x());
      if (i == chosen_) away -= 1.0;
      if (away < nearest) {
        nearest = away;
        best = Threshold{i, end};
      }
    }
  }
  return best;
}

std::optional<std::size_t> HistogramView::tissueAt(const QPointF& place) const {
  const double hu = std::round(huAt(place.x()));
  for (const std::size_t i : shown()) {
    const Tissue& tissue = tissues_.tissues[i];
    if (hu >= tissue.hu_min && hu <= tissue.hu_max) return i;
  }
  return {};
}

// --- Mouse and keys ---

void HistogramView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || tissues_.tissues.empty()) return;
  stopStepping();
  if (const auto threshold = thresholdAt(event->position()); threshold && !locked_) {
    dragged_ = active_ = *threshold;
    grip_hu_ = huAt(event->position().x()) - edgeOf(*threshold);
    if (threshold->tissue != chosen_) emit tissueChosen(threshold->tissue);
    active_ = *dragged_;
    emit dragBegan();
    update();
  } else if (const auto tissue = tissueAt(event->position())) {
    emit tissueChosen(*tissue);
  }
}

void HistogramView::mouseMoveEvent(QMouseEvent* event) {
  if (!dragged_) {
    const auto over = thresholdAt(event->position());
    if (over != std::exchange(over_, over)) update();
    setCursor(over_ && !locked_ ? Qt::SizeHorCursor : Qt::ArrowCursor);
    return;
  }
  const double edge = huAt(event->position().x()) - grip_hu_;
  const int hu = int(std::lround(edge + (dragged_->end == RangeEnd::low ? 0.5 : -0.5)));
  move(hu, event->modifiers().testFlag(Qt::ControlModifier));
}

void HistogramView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) letGo();
}

void HistogramView::letGo() {
  stopStepping();
  if (!dragged_) return;
  dragged_.reset();
  emit dragEnded();
  update();
}

void HistogramView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (!thresholdAt(event->position())) showAll();
}

void HistogramView::wheelEvent(QWheelEvent* event) {
  const double notches = double(event->angleDelta().y()) / kNotch;
  if (notches == 0.0) return event->ignore();
  zoom(std::pow(0.8, notches), huAt(event->position().x()));
  event->accept();
}

void HistogramView::move(int hu, bool alone) {
  const Threshold at = dragged_.value_or(active_);
  emit thresholdMoved(at.tissue, at.end,
                      std::clamp(hu, int(kHuRange.low), int(kHuRange.high)), alone);
}

void HistogramView::step(int hus, bool alone) {
  if (locked_ || tissues_.tissues.empty()) return;
  if (!std::exchange(stepping_, true)) emit dragBegan();
  move(huOf(active_) + hus, alone);
}

void HistogramView::stopStepping() {
  if (std::exchange(stepping_, false)) emit dragEnded();
}

// Through the thresholds of the place, from the lowest on.
void HistogramView::chooseNext(int by) {
  stopStepping();
  std::vector<Threshold> all;
  for (const std::size_t i : shown()) {
    all.push_back({i, RangeEnd::low});
    all.push_back({i, RangeEnd::high});
  }
  if (all.empty()) return;
  const auto now = std::ranges::find(all, active_);
  const auto place = now == all.end() ? 0 : int(now - all.begin()) + by;
  active_ = all[std::size_t(std::clamp(place, 0, int(all.size()) - 1))];
  const Threshold kept = active_;
  if (active_.tissue != chosen_) emit tissueChosen(active_.tissue);
  active_ = kept;
  update();
}

void HistogramView::keyPressEvent(QKeyEvent* event) {
  const bool alone = event->modifiers().testFlag(Qt::ControlModifier);
  const int hus = event->modifiers().testFlag(Qt::ShiftModifier) ? 10 : 1;
  switch (event->key()) {
    case Qt::Key_Left:
      return step(-hus, alone);
    case Qt::Key_Right:
      return step(hus, alone);
    case Qt::Key_Down:
      return chooseNext(1);
    case Qt::Key_Up:
      return chooseNext(-1);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      if (tissues_.tissues.empty()) return;
      return zoom(0.64, edgeOf(active_));
    case Qt::Key_Minus:
      if (tissues_.tissues.empty()) return;
      return zoom(1.0 / 0.64, edgeOf(active_));
    case Qt::Key_0:
      return showAll();
    default:
      QWidget::keyPressEvent(event);
  }
}

// A key that is held down is one edit.
void HistogramView::keyReleaseEvent(QKeyEvent* event) {
  const bool arrow = event->key() == Qt::Key_Left || event->key() == Qt::Key_Right;
  if (arrow && !event->isAutoRepeat()) stopStepping();
  QWidget::keyReleaseEvent(event);
}

void HistogramView::focusInEvent(QFocusEvent* event) {
  QWidget::focusInEvent(event);
  update();
}

void HistogramView::focusOutEvent(QFocusEvent* event) {
  stopStepping();
  QWidget::focusOutEvent(event);
  update();
}

void HistogramView::leaveEvent(QEvent* event) {
  over_.reset();
  update();
  QWidget::leaveEvent(event);
}

bool HistogramView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* at = static_cast<QHelpEvent*>(event);
  QString words = tr("Drag a threshold, with Ctrl without its neighbour; arrow keys move it (Shift: "
                     "10), Up and Down choose one; wheel, + and - zoom, 0 shows all.");
  const auto tissue = tissueAt(at->pos());
  if (tissue && !shares_.voxels.empty()) {
    const Tissue& of = tissues_.tissues[*tissue];
    words = tr("%1: %2 to %3 HU, %4 % of the scan, %5 mL")
                .arg(toQt(of.name))
                .arg(of.hu_min)
                .arg(of.hu_max)
                .arg(shares_.percent(*tissue), 0, 'f', 2)
                .arg(shares_.millilitres(*tissue), 0, 'f', 1) +
            "\n" + words;
  }
  QToolTip::showText(at->globalPos(), words, this);
  return true;
}

// --- Painting ---

void HistogramView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QRectF in = plot();
  painter.fillRect(in, colours::kPanel);
  if (counts_.empty()) {
    painter.setPen(colours::kQuiet);
    painter.drawText(in, Qt::AlignCenter,
                     histogram_  ? tr("No voxel is of this structure.")
                     : any_case_ ? tr("Counting the case\u2026")
                                 : tr("Open a case first."));
  }
  paintCounts(painter, in);
  paintBands(painter);
  paintThresholds(painter);
  paintAxis(painter, in);
  if (dragged_ || stepping_) paintLegend(painter, in);
  painter.setPen(QPen(hasFocus() ? colours::kAccent : colours::kLine, 1.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(in);
}

// A column of a pixel is as high as the logarithm of its voxels, in the colour of what takes them.
void HistogramView::paintCounts(QPainter& painter, const QRectF& in) const {
  if (counts_.empty()) return;
  const int columns = int(in.width());
  const auto low = double(histogram_->low_hu);
  std::vector<double> height(std::size_t(std::max(columns, 0)), 0.0);
  double most = 1.0;
  for (int c = 0; c < columns; ++c) {
    const double from = huAt(in.left() + c), to = huAt(in.left() + c + 1.0);
    // The HU whose middles lie in the column, or the one that it lies in.
    auto first = std::int64_t(std::ceil(from - low)), last = std::int64_t(std::ceil(to - low)) - 1;
    if (last < first) first = last = std::int64_t(std::lround(0.5 * (from + to) - low));
    double sum = 0.0;
    for (std::int64_t h = std::max<std::int64_t>(first, 0);
         h <= last && h < std::int64_t(counts_.size()); ++h) {
      sum += double(counts_[std::size_t(h)]);
    }
    sum /= double(last - first + 1);
    height[std::size_t(c)] = std::log10(1.0 + sum);
    most = std::max(most, height[std::size_t(c)]);
  }
  const Tissue& chosen = tissues_.tissues[chosen_];
  const int label = chosen.isAnywhere() ? 0 : chosen.label.value_or(0);
  painter.setRenderHint(QPainter::Antialiasing, false);
  for (int c = 0; c < columns; ++c) {
    const double hu = std::round(huAt(in.left() + c + 0.5));
    const int of = classify(table_, hu, label);
    QColor colour = colours::kQuiet;
    if (of >= 0) colour = colours::of(tissues_.tissues[std::size_t(of)].colour);
    colour = dimmed(colour, of < 0 ? 0.35 : std::size_t(of) == chosen_ ? 1.0 : 0.55);
    const double h = height[std::size_t(c)] / most * (in.height() - 4.0);
    painter.fillRect(QRectF(in.left() + c, in.bottom() - h, 1.0, h), colour);
  }
}

// The range of each tissue as a bar with its name and share; gaps stay empty, what two claim is
// hatched.
void HistogramView::paintBands(QPainter& painter) const {
  const QRectF row = bands();
  painter.save();
  painter.setClipRect(row.adjusted(-1, -1, 1, 1));
  painter.fillRect(row, QBrush(colours::kLine, Qt::BDiagPattern));
  for (const std::size_t i : shown()) {
    const Tissue& tissue = tissues_.tissues[i];
    const double left = std::max(xOf(tissue.hu_min - 0.5), row.left() - 2.0);
    const double right = std::min(xOf(tissue.hu_max + 0.5), row.right() + 2.0);
    if (right < row.left() || left > row.right()) continue;
    const QRectF band(left, row.top(), std::max(right - left, 1.5), row.height());
    const QColor colour = colours::of(tissue.colour);
    painter.fillRect(band, dimmed(colour, i == chosen_ ? 1.0 : 0.6));
    QString words = toQt(tissue.name);
    if (!shares_.voxels.empty()) {
      words += tr("  %1 %, %2 mL")
                   .arg(shares_.percent(i), 0, 'f', shares_.percent(i) < 1.0 ? 2 : 1)
                   .arg(shares_.millilitres(i), 0, 'f', 0);
    }
    const QRectF room = band.intersected(row).adjusted(4, 0, -4, 0);
    if (room.width() < fontMetrics().averageCharWidth() * 4) continue;
    painter.setPen(colour.lightnessF() * (i == chosen_ ? 1.0f : 0.8f) > 0.5f ? Qt::black
                                                                              : Qt::white);
    painter.drawText(room, Qt::AlignLeft | Qt::AlignVCenter,
                     fontMetrics().elidedText(words, Qt::ElideRight, int(room.width())));
  }
  for (const HuOverlap& overlap : overlaps_) {
    const double left = xOf(overlap.range.low - 0.5), right = xOf(overlap.range.high + 0.5);
    const QRectF both(left, row.top(), std::max(right - left, 3.0), row.height());
    painter.fillRect(both, colours::kPanel);
    painter.fillRect(both, QBrush(colours::kBad, Qt::DiagCrossPattern));
  }
  painter.restore();
}

void HistogramView::paintThresholds(QPainter& painter) const {
  const QRectF in = plot();
  painter.setRenderHint(QPainter::Antialiasing, true);
  for (const std::size_t i : shown()) {
    for (const RangeEnd end : {RangeEnd::low, RangeEnd::high}) {
      const Threshold at{i, end};
      const double x = xOf(edgeOf(at));
      if (x < in.left() - 1.0 || x > in.right() + 1.0) continue;
      const bool held = dragged_ == at || (!dragged_ && over_ == at);
      const bool active = i == chosen_;
      painter.setPen(QPen(active ? colours::kText : dimmed(colours::kText, 0.4),
                          held ? 2.5 : active ? 1.5 : 1.0));
      painter.drawLine(QPointF(x, in.top()), QPointF(x, bands().bottom()));
      if (locked_ || !active) continue;
      // A flag that points into the tissue: what is taken hold of.
      const double into = end == RangeEnd::low ? 7.0 : -7.0;
      QPainterPath flag;
      flag.moveTo(x, in.top());
      flag.lineTo(x + into, in.top() + 5.0);
      flag.lineTo(x, in.top() + 10.0);
      flag.closeSubpath();
      const bool keys = hasFocus() && active_ == at;
      painter.fillPath(flag, keys || held ? colours::kAccent : colours::kText);
      if (!(keys || held)) continue;
      const QString words = tr("%1 HU").arg(huOf(at));
      const double width = fontMetrics().horizontalAdvance(words) + 6.0;
      const double left = std::clamp(end == RangeEnd::low ? x - width - 2.0 : x + 2.0, in.left(),
                                     in.right() - width);
      const QRectF box(left, in.top() + 1.0, width, fontMetrics().height());
      painter.fillRect(box, dimmed(colours::kWindow, 0.85));
      painter.setPen(colours::kText);
      painter.drawText(box, Qt::AlignCenter, words);
    }
  }
}

// Of what the slices show meanwhile.
void HistogramView::paintLegend(QPainter& painter, const QRectF& in) const {
  const double line = fontMetrics().height();
  double x = in.left() + 8.0;
  for (const auto& [colour, words] :
       {std::pair{colours::kGained, tr("taken")}, {colours::kLost, tr("given up")}}) {
    painter.fillRect(QRectF(x, in.top() + 6.0, line * 0.7, line * 0.7), colour);
    painter.setPen(colours::kText);
    const double width = fontMetrics().horizontalAdvance(words);
    painter.drawText(QRectF(x + line, in.top() + 3.0, width + 2.0, line), Qt::AlignLeft, words);
    x += line + width + 16.0;
  }
}

void HistogramView::paintAxis(QPainter& painter, const QRectF& in) const {
  painter.setPen(colours::kQuiet);
  const double wanted = fontMetrics().horizontalAdvance("-1000 ") * 1.6;
  const double step = stepOfTicks((to_hu_ - from_hu_) * wanted / std::max(in.width(), 1.0));
  const double y = bands().bottom();
  const double line = fontMetrics().height();
  for (double hu = std::ceil(from_hu_ / step) * step; hu <= to_hu_; hu += step) {
    const double x = xOf(hu);
    painter.drawLine(QPointF(x, y), QPointF(x, y + 3.0));
    const QString words = QString::number(std::lround(hu));
    const double half = fontMetrics().horizontalAdvance(words) / 2.0;
    if (x + half > in.right() - fontMetrics().horizontalAdvance(tr("HU")) - 6.0) break;
    if (x - half < 0.0) continue;
    painter.drawText(QRectF(x - half - 2.0, y + 3.0, 2.0 * half + 4.0, line), Qt::AlignCenter,
                     words);
  }
  painter.drawText(QRectF(in.right() - 40.0, y + 3.0, 40.0, line),
                   Qt::AlignRight | Qt::AlignVCenter, tr("HU"));
}

}  // namespace trephine
