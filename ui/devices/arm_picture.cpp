#include "ui/devices/arm_picture.h"

#include <QPainter>
#include <algorithm>

namespace trephine {

namespace {

constexpr double kMargin = 12.0, kDepthBar = 14.0, kDot = 7.0;
constexpr double kArrowPerNewton = 22.0;

void drawArrow(QPainter& painter, const QPointF& from, const QPointF& to) {
  painter.drawLine(from, to);
  const QPointF back = from - to;
  const double length = std::hypot(back.x(), back.y());
  if (length < 4.0) return;
  const QPointF along = 8.0 / length * back, aside(-along.y() / 2.0, along.x() / 2.0);
  painter.drawLine(to, to + along + aside);
  painter.drawLine(to, to + along - aside);
}

}  // namespace

ArmPicture::ArmPicture(QWidget* parent) : QWidget(parent) {
  setObjectName("armPicture");
  setMinimumSize(200, 150);
}

void ArmPicture::showTip(const Vec3& tip_m, const Vec3& reach_m, double force_N) {
  shows_ = Shows::tip;
  tip_m_ = tip_m;
  reach_m_ = reach_m;
  force_N_ = force_N;
  update();
}

void ArmPicture::showHolder() {
  shows_ = Shows::holder;
  update();
}

void ArmPicture::clear() {
  shows_ = Shows::nothing;
  update();
}

void ArmPicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF all = QRectF(rect()).adjusted(kMargin, kMargin, -kMargin, -kMargin);
  const QColor line = palette().color(QPalette::PlaceholderText), strong = palette().color(QPalette::Text),
               accent = palette().color(QPalette::Highlight);
  painter.setPen(QPen(line, 1.0));
  if (shows_ == Shows::holder) {
    // A foot, two links, and the stylus on its way into the holder beside the foot.
    const QPointF foot(all.left() + 0.30 * all.width(), all.bottom() - 6.0);
    const QPointF elbow(foot.x() - 6.0, all.top() + 0.25 * all.height());
    const QPointF wrist(all.left() + 0.68 * all.width(), all.top() + 0.38 * all.height());
    const QPointF well(all.left() + 0.68 * all.width(), all.bottom() - 14.0);
    painter.setPen(QPen(strong, 3.0, Qt::SolidLine, Qt::RoundCap));
    painter.drawEllipse(foot, 34.0, 9.0);
    painter.drawLine(foot, elbow);
    painter.drawLine(elbow, wrist);
    painter.drawRect(QRectF(well.x() - 11.0, well.y() - 6.0, 22.0, 20.0));
    painter.setPen(QPen(strong, 6.0, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(wrist, wrist + QPointF(0.0, 0.22 * all.height()));
    painter.setPen(QPen(accent, 3.0, Qt::SolidLine, Qt::RoundCap));
    drawArrow(painter, wrist + QPointF(22.0, 8.0), QPointF(well.x() + 22.0, well.y() - 4.0));
    return;
  }
  const QRectF front = all.adjusted(0, 0, -kDepthBar - kMargin, 0);
  const QRectF depth(all.right() - kDepthBar, all.top(), kDepthBar, all.height());
  painter.drawRect(front);
  painter.drawRect(depth);
  painter.drawLine(QPointF(front.center().x(), front.top()),
                   QPointF(front.center().x(), front.bottom()));
  painter.drawLine(QPointF(front.left(), front.center().y()),
                   QPointF(front.right(), front.center().y()));
  const auto say = [&](const QRectF& in, int where, const QString& words) {
    painter.drawText(in.adjusted(4, 2, -4, -2), where, words);
  };
  say(front, Qt::AlignTop | Qt::AlignLeft, tr("from the front"));
  const QRectF beside(front.right() - 60.0, front.top(), 60.0, front.height());
  say(beside, Qt::AlignTop | Qt::AlignRight, tr("far"));
  say(beside, Qt::AlignBottom | Qt::AlignRight, tr("near"));
  if (shows_ != Shows::tip) return;
  const auto part = [&](int axis) {
    return std::clamp(tip_m_[axis] / std::max(1e-3, reach_m_[axis]), -0.5, 0.5);
  };
  const QPointF at(front.center().x() + part(0) * front.width(),
                   front.center().y() - part(1) * front.height());
  painter.setPen(Qt::NoPen);
  painter.setBrush(accent);
  painter.drawEllipse(at, kDot, kDot);
  painter.drawRect(QRectF(depth.left(), depth.center().y() + part(2) * depth.height() - 2.0,
                          depth.width(), 4.0));
  if (force_N_ <= 0.0) return;
  painter.setPen(QPen(strong, 3.0, Qt::SolidLine, Qt::RoundCap));
  drawArrow(painter, at, at - QPointF(0.0, kArrowPerNewton * force_N_ + 10.0));
}

}  // namespace trephine
