#include "ui/tissue/limit_bar.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"

namespace trephine {

LimitBar::LimitBar(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void LimitBar::setRange(double most, double least_step, int decimals) {
  most_ = most;
  step_ = least_step;
  decimals_ = decimals;
  tell();
}

void LimitBar::setValue(double value) {
  value_ = value;
  tell();
}

void LimitBar::setFelt(bool felt) {
  felt_ = felt;
  tell();
}

void LimitBar::setWeaker(bool weaker) {
  weaker_ = weaker;
  tell();
}

void LimitBar::setLimit(std::optional<double> shown, bool bounds) {
  limit_ = shown;
  bounds_ = bounds;
  tell();
}

double LimitBar::at(double value) const {
  return std::clamp(std::log1p(std::max(value, 0.0) / step_) / std::log1p(most_ / step_), 0.0, 1.0);
}

QString LimitBar::words() const {
  if (!felt_) return tr("not felt");
  if (weaker_) return tr("felt weaker");
  if (limit_ && *limit_ < 0.5 * std::pow(10.0, -decimals_)) return tr("none left");
  if (!limit_ || *limit_ >= most_) return tr("any arm");
  return tr("arm %1").arg(*limit_, 0, 'f', *limit_ < 1.0 ? 2 : *limit_ < 100.0 ? 1 : 0);
}

void LimitBar::tell() {
  QString tip = tr("From 0 to %1.").arg(most_, 0, 'g', 6) + ' ';
  if (!felt_) {
    tip +=
        tr("Nothing in this exercise uses it, with the tissue's other numbers and the laws "
           "(Tools, What is felt) as they are.");
  } else if (weaker_) {
    tip +=
        tr("The tissue is stiffer than the arms can show: its force is felt weaker than this "
           "when it gives way.");
  } else if (!limit_ || *limit_ >= most_) {
    tip += tr("No arm limits it.");
  } else if (*limit_ < 0.5 * std::pow(10.0, -decimals_)) {
    tip += tr("The tissue's other numbers take all that the arms can show.");
  } else if (bounds_) {
    tip += tr("The arms show up to %1; more is felt as that.").arg(*limit_, 0, 'g', 3);
  } else {
    tip += tr("The arms show up to %1; nothing bounds more under this controller, and they may "
              "shake.")
               .arg(*limit_, 0, 'g', 3);
  }
  setToolTip(tip);
  setAccessibleName(tip);
  update();
}

QSize LimitBar::sizeHint() const {
  return {fontMetrics().horizontalAdvance("arm 0.00 ") + 50, fontMetrics().height() + 2};
}

QSize LimitBar::minimumSizeHint() const {
  return {fontMetrics().horizontalAdvance("arm 0.00 ") + 30, fontMetrics().height() + 2};
}

void LimitBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double text = fontMetrics().horizontalAdvance(words()) + 4.0;
  const QRectF track(0.5, height() / 2.0 - 2.5, std::max(width() - text - 4.0, 10.0), 5.0);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colours::kLine);
  painter.drawRoundedRect(track, 2.5, 2.5);
  const bool limited = felt_ && limit_ && *limit_ < most_;
  const double end = !felt_ ? 0.0 : limited ? at(*limit_) : 1.0;
  QRectF shown = track;
  shown.setWidth(track.width() * end);
  painter.setBrush(colours::kGood);
  painter.drawRoundedRect(shown, 2.5, 2.5);
  if (limited) {
    QRectF beyond = track;
    beyond.setLeft(shown.right());
    painter.setBrush(QBrush(bounds_ ? colours::kQuiet : colours::kBad, Qt::Dense4Pattern));
    painter.drawRect(beyond);
  }
  const bool over = limited && value_ > *limit_;
  const double x = track.left() + track.width() * at(value_);
  painter.setBrush(over ? (bounds_ ? colours::kCaution : colours::kBad) : colours::kText);
  painter.drawRoundedRect(QRectF(x - 1.5, 1.0, 3.0, height() - 2.0), 1.0, 1.0);
  painter.setPen(over ? (bounds_ ? colours::kCaution : colours::kBad) : colours::kQuiet);
  painter.drawText(QRectF(width() - text, 0, text, height()), Qt::AlignRight | Qt::AlignVCenter,
                   words());
}

}  // namespace trephine
