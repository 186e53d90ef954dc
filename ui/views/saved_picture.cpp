#include "ui/views/saved_picture.h"

#include <QFontMetrics>
#include <QImage>
#include <QPainter>
#include <algorithm>

#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kSmallest_px = 6, kLeast_px = 12, kMost_px = 30;
constexpr int kOfHeight = 55;  // a letter is that part of the picture's height
const QColor kBehind(0x1b, 0x1d, 0x20), kWords(0xe4, 0xe6, 0xea);  // whatever the theme: a file

QFont fontWithin(int width, int height, const QString& words) {
  QFont font;
  int size = std::clamp(height / kOfHeight, kLeast_px, kMost_px);
  for (font.setPixelSize(size); size > kSmallest_px; font.setPixelSize(--size)) {
    if (QFontMetrics(font).horizontalAdvance(words) + size <= width) break;
  }
  return font;
}

}  // namespace

Picture withPurpose(const Picture& picture) {
  const std::size_t row = std::size_t(std::max(picture.width, 0)) * 3;
  if (picture.width <= 0 || picture.height <= 0 ||
      picture.rgb.size() != row * std::size_t(picture.height)) {
    return picture;
  }
  const QString words = purposeText();
  const QFont font = fontWithin(picture.width, picture.height, words);
  QImage strip(picture.width, QFontMetrics(font).height() + 4, QImage::Format_RGB888);
  strip.fill(kBehind);
  QPainter painter(&strip);
  painter.setFont(font);
  painter.setPen(kWords);
  painter.drawText(strip.rect(), Qt::AlignCenter, words);
  painter.end();

  Picture out{picture.width, picture.height + strip.height(), picture.rgb};
  out.rgb.reserve(row * std::size_t(out.height));
  for (int y = 0; y < strip.height(); ++y) {
    const uchar* line = strip.constScanLine(y);
    out.rgb.insert(out.rgb.end(), line, line + row);
  }
  return out;
}

}  // namespace trephine
