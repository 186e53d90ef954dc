#include "ui/tissue/poke_plot.h"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// A round number of steps that spans `most`.
double roundUp(double most) {
  const double ten = std::pow(10.0, std::floor(std::log10(std::max(most, 1e-3))));
  for (const double step : {1.0, 2.0, 3.0, 5.0, 7.0, 10.0}) {
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

}  // namespace

PokePlot::PokePlot(QWidget* parent) : QWidget(parent) {
  setObjectName("pokePlot");
  setAccessibleName(tr("Force against depth of the last pokes"));
  setToolTip(
      tr("Solid: the force that the arm was sent; dashed: what the tissue demanded. Depth is "
         "how far the hand has gone along the tool: where bone stops the tool, it is the "
         "hand that goes on."));
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

void PokePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double line = fontMetrics().height();
  const double left = fontMetrics().horizontalAdvance("0.00 N") + 6.0;
  const QRectF in = QRectF(rect()).adjusted(left, 6.5, -8.5, -(line + 6.0));
  painter.fillRect(in, colours::kPanel);
  painter.setPen(QPen(colours::kLine, 1.0));
  painter.drawRect(in);
  if (pokes_.empty()) {
    painter.setPen(colours::kQuiet);
    painter.drawText(
        in.adjusted(6, 0, -6, 0), Qt::AlignCenter | Qt::TextWordWrap,
        tr("Push the tool into the tissue: the force against the depth is drawn here."));
    return;
  }
  double deepest = 1.0, most = 0.2, least = 0.0;
  for (const PokeCurve& poke : pokes_) {
    for (const PokePoint& p : poke.points) {
      deepest = std::max(deepest, p.depth_mm);
      least = std::min(least, p.depth_mm);
      most = std::max({most, p.sent_N, std::min(p.demanded_N, 3.0 * std::max(limit_N_, 0.5))});
    }
  }
  deepest = roundUp(deepest);
  most = roundUp(most * 1.05);
  least = std::max(least, -0.2 * deepest);
  const auto at = [&](double depth_mm, double force_N) {
    return QPointF(in.left() + (depth_mm - least) / (deepest - least) * in.width(),
                   in.bottom() - std::clamp(force_N / most, 0.0, 1.0) * in.height());
  };
  painter.setPen(QPen(colours::kLine, 1.0, Qt::DotLine));
  painter.drawLine(at(0.0, 0.0), at(0.0, most));
  if (limit_N_ > 0.0 && limit_N_ < most) {
    painter.setPen(QPen(colours::kBad, 1.0, Qt::DashLine));
    painter.drawLine(at(least, limit_N_), at(deepest, limit_N_));
    painter.drawText(QRectF(in.left() + 4.0, at(0.0, limit_N_).y() - line, in.width() - 8.0, line),
                     Qt::AlignRight, tr("the arm's limit"));
  }
  painter.save();
  painter.setClipRect(in);
  for (std::size_t i = 0; i < pokes_.size(); ++i) {
    const QColor colour = toneOf(pokes_.size() - 1 - i);
    QPolygonF sent, demanded;
    for (const PokePoint& p : pokes_[i].points) {
      sent << at(p.depth_mm, p.sent_N);
      demanded << at(p.depth_mm, p.demanded_N);
    }
    painter.setPen(QPen(colour, 1.0, Qt::DashLine));
    painter.drawPolyline(demanded);
    painter.setPen(QPen(colour, i + 1 == pokes_.size() ? 2.2 : 1.5));
    painter.drawPolyline(sent);
  }
  painter.restore();
  // What each is of, the newest first.
  double y = in.top() + 2.0;
  for (std::size_t age = 0; age < pokes_.size() && y + line < in.bottom(); ++age, y += line) {
    const PokeCurve& poke = pokes_[pokes_.size() - 1 - age];
    painter.setPen(toneOf(age));
    const QString words = tr("%1, up to %2 N").arg(nameOf(poke)).arg(poke.most_N, 0, 'f', 2);
    painter.drawText(QRectF(in.left() + 6.0, y, in.width() - 12.0, line), Qt::AlignLeft,
                     fontMetrics().elidedText(words, Qt::ElideRight, int(in.width()) - 12));
  }
  painter.setPen(colours::kQuiet);
  painter.drawText(QRectF(0, in.top() - 4.0, left - 4.0, line), Qt::AlignRight,
                   tr("%1 N").arg(most, 0, 'g', 2));
  painter.drawText(QRectF(0, in.bottom() - line, left - 4.0, line), Qt::AlignRight, tr("0 N"));
  painter.drawText(QRectF(in.left(), in.bottom() + 2.0, in.width(), line), Qt::AlignRight,
                   tr("%1 mm deep").arg(deepest, 0, 'g', 3));
  painter.drawText(QRectF(at(0.0, 0.0).x() - 20.0, in.bottom() + 2.0, 40.0, line),
                   Qt::AlignHCenter, "0");
}

}  // namespace trephine
