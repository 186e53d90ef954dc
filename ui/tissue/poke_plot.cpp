#include "ui/tissue/poke_plot.h"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/plain_text.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// A round number of steps that spans `most`.
double roundUp(double most) {
  const double ten = std::pow(10.0, std::floor(std::log10(std::max(most, 1e-3))));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0}) {
    if (step * ten >= most) return step * ten;
  }
  return most;
}

// Of the newest on: told apart by lightness and by their dashes too.
QColor toneOf(std::size_t age) {
  QColor colour = age == 0 ? colours::kAccent : age == 1 ? colours::kCaution : colours::kGood;
  if (age > 2) colour = colours::kQuiet;
  colour.setAlphaF(age == 0 ? 1.0f : 0.75f);
  return colour;
}

// "needle, computed: up to 0.42 N; shaded: published (derived)"
QString foreseenWords(const ForeseenPoke& of) {
  const QString words =
      PokePlot::tr("%1, computed: up to %2 N").arg(of.tool).arg(of.curve.most_N, 0, 'f', 2);
  if (of.bands.empty()) return words;
  Confidence weakest = Confidence::unstated;
  for (const PublishedBand& band : of.bands) weakest = std::max(weakest, band.confidence);
  const QString how = toQt(confidenceWord(weakest));
  return how.isEmpty() ? PokePlot::tr("%1; shaded: published, for it").arg(words)
                       : PokePlot::tr("%1; shaded: published, for it (%2)").arg(words, how);
}

}  // namespace

PokePlot::PokePlot(QWidget* parent) : QWidget(parent) {
  setObjectName("pokePlot");
  setAccessibleName(tr("Force against depth of the last pokes"));
  setToolTip(
      tr("Solid: the force that the arm was sent; dashed: what the tissue demanded. Depth is "
         "how far the hand has gone along the tool: where bone stops the tool, it is the "
         "hand that goes on. Thin: what each tool would meet in a block of the chosen tissue at "
         "10 mm/s; shaded: the published range of that "
         "force, for the tool's width and the arm's scale of force."));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
}

QSize PokePlot::sizeHint() const {
  return {300, 8 * fontMetrics().height()};
}

QSize PokePlot::minimumSizeHint() const {
  return {180, 6 * fontMetrics().height()};
}

void PokePlot::showPokes(const std::vector<PokeCurve>& pokes, const TissueSet& tissues,
                         double limit_N) {
  pokes_ = pokes;
  tissues_ = tissues;
  limit_N_ = limit_N;
  update();
}

QString PokePlot::nameOf(const PokeCurve& poke) const {
  const auto tissue = std::size_t(poke.tissue);
  return poke.tissue >= 0 && tissue < tissues_.tissues.size()
             ? shownName(tissues_.tissues[tissue].name)
             : tr("tissue");
}

void PokePlot::showForeseen(const std::vector<ForeseenPoke>& foreseen, double friction_N) {
  foreseen_ = foreseen;
  friction_N_ = friction_N;
  QStringList words;
  for (const ForeseenPoke& of : foreseen_) words << foreseenWords(of);
  setAccessibleDescription(words.join("; "));
  update();
}

QPointF PokePlot::Axes::at(double depth_mm, double force_N) const {
  return {in.left() + (depth_mm - least_mm) / (deepest_mm - least_mm) * in.width(),
          in.bottom() - std::clamp(force_N / most_N, 0.0, 1.0) * in.height()};
}

PokePlot::Axes PokePlot::axes() const {
  const double line = fontMetrics().height();
  const double left = fontMetrics().horizontalAdvance("0.00 N") + 6.0;
  Axes axes;
  axes.in = QRectF(rect()).adjusted(left, 6.5, -8.5, -(line + 6.0));
  const double tallest_N = 3.0 * std::max(limit_N_, 0.5);
  const auto hold = [&](const PokeCurve& curve) {
    for (const PokePoint& p : curve.points) {
      axes.deepest_mm = std::max(axes.deepest_mm, p.depth_mm);
      axes.least_mm = std::min(axes.least_mm, p.depth_mm);
      axes.most_N = std::max({axes.most_N, p.sent_N, std::min(p.demanded_N, tallest_N)});
    }
  };
  for (const PokeCurve& poke : pokes_) hold(poke);
  for (const ForeseenPoke& of : foreseen_) {
    hold(of.curve);
    for (const PublishedBand& band : of.bands) {
      axes.most_N =
          std::max(axes.most_N, std::min(std::max(band.high_from_N, band.high_to_N), tallest_N));
    }
  }
  axes.deepest_mm = roundUp(axes.deepest_mm);
  axes.most_N = roundUp(axes.most_N * 1.05);
  axes.least_mm = std::max(axes.least_mm, -0.2 * axes.deepest_mm);
  return axes;
}

void PokePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Axes axes = this->axes();
  painter.fillRect(axes.in, colours::kPanel);
  painter.setPen(QPen(colours::kLine, 1.0));
  painter.drawRect(axes.in);
  if (pokes_.empty() && foreseen_.empty()) {
    painter.setPen(colours::kQuiet);
    painter.drawText(
        axes.in.adjusted(6, 0, -6, 0), Qt::AlignCenter | Qt::TextWordWrap,
        tr("Push the tool into the tissue: the force against the depth is drawn here."));
    return;
  }
  painter.save();
  painter.setClipRect(axes.in);
  drawForeseen(painter, axes);
  painter.setPen(QPen(colours::kLine, 1.0, Qt::DotLine));
  painter.drawLine(axes.at(0.0, 0.0), axes.at(0.0, axes.most_N));
  drawLevel(painter, axes, limit_N_, colours::kBad, tr("the arm's limit"));
  drawLevel(painter, axes, friction_N_, colours::kQuiet, tr("the arm's own friction"));
  drawPokes(painter, axes);
  painter.restore();
  drawLegend(painter, axes);
  drawScales(painter, axes);
}

void PokePlot::drawLevel(QPainter& painter, const Axes& axes, double force_N, const QColor& colour,
                         const QString& words) const {
  if (!(force_N > 0.0) || force_N >= axes.most_N) return;
  painter.setPen(QPen(colour, 1.0, Qt::DashLine));
  painter.drawLine(axes.at(axes.least_mm, force_N), axes.at(axes.deepest_mm, force_N));
  const double line = fontMetrics().height();
  painter.drawText(
      QRectF(axes.in.left() + 4.0, axes.at(0.0, force_N).y() - line, axes.in.width() - 8.0, line),
      Qt::AlignRight, words);
}

void PokePlot::drawForeseen(QPainter& painter, const Axes& axes) const {
  for (const ForeseenPoke& of : foreseen_) {
    const QColor& colour = of.colour;
    QColor shade = colour;
    shade.setAlphaF(0.22f);
    painter.setPen(Qt::NoPen);
    painter.setBrush(shade);
    for (const PublishedBand& band : of.bands) {
      painter.drawPolygon(
          QPolygonF{axes.at(band.from_mm, band.low_from_N), axes.at(band.from_mm, band.high_from_N),
                    axes.at(band.to_mm, band.high_to_N), axes.at(band.to_mm, band.low_to_N)});
    }
    painter.setBrush(Qt::NoBrush);
    QPolygonF sent;
    for (const PokePoint& p : of.curve.points) sent << axes.at(p.depth_mm, p.sent_N);
    painter.setPen(QPen(colour, 1.3));
    painter.drawPolyline(sent);
  }
}

void PokePlot::drawPokes(QPainter& painter, const Axes& axes) const {
  for (std::size_t i = 0; i < pokes_.size(); ++i) {
    const QColor colour = toneOf(pokes_.size() - 1 - i);
    QPolygonF sent, demanded;
    for (const PokePoint& p : pokes_[i].points) {
      sent << axes.at(p.depth_mm, p.sent_N);
      demanded << axes.at(p.depth_mm, p.demanded_N);
    }
    painter.setPen(QPen(colour, 1.0, Qt::DashLine));
    painter.drawPolyline(demanded);
    painter.setPen(QPen(colour, i + 1 == pokes_.size() ? 2.2 : 1.5));
    painter.drawPolyline(sent);
  }
}

// What each is of, the newest first; then what was computed.
void PokePlot::drawLegend(QPainter& painter, const Axes& axes) const {
  const double line = fontMetrics().height();
  double y = axes.in.top() + 2.0;
  const auto add = [&](const QColor& colour, const QString& words) {
    if (y + line >= axes.in.bottom()) return;
    painter.setPen(colour);
    painter.drawText(QRectF(axes.in.left() + 6.0, y, axes.in.width() - 12.0, line), Qt::AlignLeft,
                     fontMetrics().elidedText(words, Qt::ElideRight, int(axes.in.width()) - 12));
    y += line;
  };
  for (std::size_t age = 0; age < pokes_.size(); ++age) {
    const PokeCurve& poke = pokes_[pokes_.size() - 1 - age];
    add(toneOf(age), tr("%1, up to %2 N").arg(nameOf(poke)).arg(poke.most_N, 0, 'f', 2));
  }
  for (const ForeseenPoke& of : foreseen_) add(of.colour, foreseenWords(of));
}

void PokePlot::drawScales(QPainter& painter, const Axes& axes) const {
  const double line = fontMetrics().height();
  const QRectF& in = axes.in;
  painter.setPen(colours::kQuiet);
  painter.drawText(QRectF(0, in.top() - 4.0, in.left() - 4.0, line), Qt::AlignRight,
                   tr("%1 N").arg(axes.most_N, 0, 'g', 2));
  painter.drawText(QRectF(0, in.bottom() - line, in.left() - 4.0, line), Qt::AlignRight, tr("0 N"));
  painter.drawText(QRectF(in.left(), in.bottom() + 2.0, in.width(), line), Qt::AlignRight,
                   tr("%1 mm deep").arg(axes.deepest_mm, 0, 'g', 3));
  painter.drawText(QRectF(axes.at(0.0, 0.0).x() - 20.0, in.bottom() + 2.0, 40.0, line),
                   Qt::AlignHCenter, "0");
}

}  // namespace trephine
