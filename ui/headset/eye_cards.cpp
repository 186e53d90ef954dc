#include "ui/headset/eye_cards.h"

#include <QCoreApplication>
#include <QFontMetricsF>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ui/common/colours.h"

namespace trephine {

namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("trephine", text);
}

constexpr double kMargin_deg = 0.6, kRadius_deg = 0.5;
constexpr double kAside_deg = 27.0;  // a card of 17 degrees leaves the middle free
const QColor kBack(18, 20, 24, 225);

int pixels(double degrees) {
  return int(std::lround(degrees * kPixelsPerDegree));
}

double metres(double degrees) {
  return 2.0 * kCardDistance_m * std::tan(0.5 * degrees * std::numbers::pi / 180.0);
}

// Whose small letters have this height in degrees.
QFont lettersOf(double degrees, bool bold = false) {
  QFont font;
  font.setBold(bold);
  font.setPixelSize(100);
  const double share = QFontMetricsF(font).xHeight() / 100.0;
  font.setPixelSize(
      std::max(1, int(std::lround(degrees * kPixelsPerDegree / std::max(share, 0.1)))));
  return font;
}

// An empty card, that many degrees wide and high, with a painter on it.
class Sheet {
 public:
  Sheet(double width_deg, double height_deg)
      : image_(pixels(width_deg), pixels(height_deg), QImage::Format_RGBA8888) {
    image_.fill(Qt::transparent);
    painter_.begin(&image_);
    painter_.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing);
    painter_.setPen(Qt::NoPen);
    painter_.setBrush(kBack);
    painter_.drawRoundedRect(QRectF(image_.rect()), pixels(kRadius_deg), pixels(kRadius_deg));
    inside_ = QRectF(image_.rect())
                  .adjusted(pixels(kMargin_deg), pixels(kMargin_deg), -pixels(kMargin_deg),
                            -pixels(kMargin_deg));
  }
  QPainter& painter() { return painter_; }
  // What is left of the sheet.
  QRectF& inside() { return inside_; }
  // At its top, in as many lines as it needs; cut where the sheet ends.
  void write(const QString& text, const QFont& font, const QColor& colour) {
    painter_.setFont(font);
    painter_.setPen(colour);
    const int how = Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap;
    QRectF took;
    painter_.drawText(inside_, how, text, &took);
    inside_.setTop(std::min(inside_.bottom(), took.bottom() + pixels(0.25)));
  }
  QImage take() {
    painter_.end();
    return std::move(image_);
  }

 private:
  QImage image_;
  QPainter painter_;
  QRectF inside_;
};

}  // namespace

EyeCard forceCard(const std::vector<HandForce>& hands) {
  constexpr double kWidth_deg = 17.0, kEach_deg = 5.2;
  Sheet sheet(kWidth_deg,
              2.0 * kMargin_deg + kEach_deg * std::max<double>(1, double(hands.size())));
  for (const HandForce& hand : hands) {
    const double top = sheet.inside().top();
    const double share = std::clamp(hand.sent_N / std::max(hand.limit_N, 1e-6), 0.0, 1.0);
    sheet.write(hand.why.isEmpty() ? tr("%1: %2 of %3 N")
                                         .arg(hand.name)
                                         .arg(hand.sent_N, 0, 'f', 1)
                                         .arg(hand.limit_N, 0, 'f', 1)
                                   : tr("%1: NO FORCE").arg(hand.name),
                lettersOf(kLetters_deg, true), hand.colour);
    const QRectF bar(sheet.inside().left(), sheet.inside().top(), sheet.inside().width(),
                     pixels(0.8));
    QPainter& painter = sheet.painter();
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(70, 74, 80));
    painter.drawRect(bar);
    painter.setBrush(share > 0.95  ? colours::kBad
                     : share > 0.7 ? colours::kCaution
                                   : colours::kGood);
    painter.drawRect(QRectF(bar.topLeft(), QSizeF(bar.width() * share, bar.height())));
    if (hand.demanded_N > 0.0) {
      const double at =
          bar.left() +
          bar.width() * std::clamp(hand.demanded_N / std::max(hand.limit_N, 1e-6), 0.0, 1.0);
      painter.setPen(QPen(Qt::white, pixels(0.12)));
      painter.drawLine(QPointF(at, bar.top()), QPointF(at, bar.bottom()));
    }
    sheet.inside().setTop(bar.bottom() + pixels(0.2));
    if (!hand.why.isEmpty()) {
      const double bottom = sheet.inside().bottom();
      sheet.inside().setBottom(top + pixels(kEach_deg));
      sheet.write(hand.why, lettersOf(0.8 * kLetters_deg), colours::kBad);
      sheet.inside().setBottom(bottom);
    }
    sheet.inside().setTop(top + pixels(kEach_deg));
  }
  EyeCard card;
  card.name = "force";
  card.image = sheet.take();
  card.width_m = metres(kWidth_deg);
  card.right_deg = kAside_deg;
  return card;
}

EyeCard exerciseCard(const QString& title, const QString& time, const QString& goal) {
  // As high as what it asks for is long.
  constexpr double kWidth_deg = 17.0, kTop_deg = 5.6, kMost_deg = 24.0;
  const QRectF room(0.0, 0.0, pixels(kWidth_deg - 2.0 * kMargin_deg), pixels(kMost_deg));
  const double text = QFontMetricsF(lettersOf(kLetters_deg))
                          .boundingRect(room, Qt::AlignLeft | Qt::TextWordWrap, goal)
                          .height();
  Sheet sheet(kWidth_deg, std::min(kMost_deg, kTop_deg + text / kPixelsPerDegree));
  sheet.write(title, lettersOf(kLetters_deg, true), Qt::white);
  sheet.write(time, lettersOf(1.4 * kLetters_deg, true), Qt::white);
  sheet.write(goal, lettersOf(kLetters_deg), QColor(205, 208, 212));
  EyeCard card;
  card.name = "exercise";
  card.image = sheet.take();
  card.width_m = metres(kWidth_deg);
  card.right_deg = -kAside_deg;
  return card;
}

EyeCard noteCard(const QString& words) {
  constexpr double kWidth_deg = 24.0, kHeight_deg = 3.4;
  Sheet sheet(kWidth_deg, kHeight_deg);
  sheet.write(words, lettersOf(kLetters_deg), colours::kCaution);
  EyeCard card;
  card.name = "note";
  card.image = sheet.take();
  card.width_m = metres(kWidth_deg);
  card.up_deg = -16.0;
  card.before_all = true;
  return card;
}

EyeCard markCard(int number) {
  constexpr int kPixels = 128;
  constexpr double kWidth_m = 0.04;
  QImage image(kPixels, kPixels, QImage::Format_RGBA8888);
  image.fill(Qt::transparent);
  QPainter painter(&image);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing);
  const double middle = 0.5 * kPixels;
  painter.setPen(QPen(Qt::white, 4.0));
  painter.drawLine(QPointF(middle, 12.0), QPointF(middle, kPixels - 12.0));
  painter.drawLine(QPointF(12.0, middle), QPointF(kPixels - 12.0, middle));
  painter.setPen(QPen(colours::kCaution, 3.0));
  painter.drawEllipse(QPointF(middle, middle), 40.0, 40.0);
  QFont font;
  font.setBold(true);
  font.setPixelSize(34);
  painter.setFont(font);
  painter.drawText(QRectF(middle + 6.0, 6.0, middle - 8.0, middle - 10.0), Qt::AlignCenter,
                   QString::number(number));
  painter.end();
  EyeCard card;
  card.name = "mark" + std::to_string(number);
  card.image = image;
  card.width_m = kWidth_m;
  return card;
}

}  // namespace trephine
