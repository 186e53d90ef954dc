#include "plot/theme.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trephine::plot {

namespace {

struct Pair {
  QRgb light, dark;
};

// In the order of Tone.
constexpr std::array<Pair, 13> kTones{{
    {qRgb(0, 0, 0), qRgb(0xe4, 0xe6, 0xea)},       // ink
    {qRgb(90, 90, 90), qRgb(0xa2, 0xa8, 0xb2)},    // quiet
    {qRgb(0, 92, 175), qRgb(0x5a, 0xa9, 0xf0)},    // series_1
    {qRgb(150, 45, 140), qRgb(0xd9, 0x8a, 0xd0)},  // series_2
    {qRgb(110, 60, 0), qRgb(0xd9, 0xa0, 0x66)},    // series_3
    {qRgb(0, 115, 145), qRgb(0x4f, 0xc0, 0xd0)},   // series_4
    {qRgb(20, 140, 95), qRgb(0x4f, 0xb3, 0x77)},   // good
    {qRgb(165, 15, 38), qRgb(0xe8, 0x75, 0x6d)},   // bad
    {qRgb(46, 170, 125), qRgb(46, 170, 125)},      // heat_1
    {qRgb(255, 239, 170), qRgb(255, 239, 170)},    // heat_2
    {qRgb(252, 202, 70), qRgb(252, 202, 70)},      // heat_3
    {qRgb(240, 145, 25), qRgb(240, 145, 25)},      // heat_4
    {qRgb(165, 15, 38), qRgb(165, 15, 38)},        // heat_5
}};
static_assert(kTones.size() == std::size_t(Tone::heat_5) + 1);

double luminance(const QColor& colour) {
  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) +
         0.0722 * linear(colour.blueF());
}

}  // namespace

Colours coloursOf(Theme theme) {
  if (theme == Theme::light) return {QColor(Qt::white), QColor(225, 225, 225), QColor(60, 60, 60)};
  return {QColor(0x1b, 0x1d, 0x20), QColor(0x32, 0x35, 0x3b), QColor(0x8a, 0x90, 0x9a)};
}

QColor colourOf(Tone tone, Theme theme) {
  const Pair& pair = kTones[std::size_t(tone)];
  return QColor(theme == Theme::light ? pair.light : pair.dark);
}

QColor bandFill(QColor tone) {
  tone.setAlphaF(0.2f);
  return tone;
}

QColor inkOn(const QColor& fill) {
  const QColor black(Qt::black), white(Qt::white);
  return contrast(fill, black) >= contrast(fill, white) ? black : white;
}

double contrast(const QColor& a, const QColor& b) {
  const double la = luminance(a), lb = luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

}  // namespace trephine::plot
