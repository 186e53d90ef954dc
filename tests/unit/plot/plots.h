// What holds of every picture of a plot.
#pragma once

#include <gtest/gtest.h>

#include "plot/drawing.h"

namespace trephine::plot::test {

// Each text lies within the picture, at a size that can be read, and over no other.
inline void expectTextsApart(const Drawing& drawing) {
  const QRectF picture = drawing.image.rect();
  EXPECT_GE(drawing.texts.size(), 2u);
  for (std::size_t i = 0; i < drawing.texts.size(); ++i) {
    const PlacedText& a = drawing.texts[i];
    EXPECT_TRUE(picture.contains(a.rect)) << a.text << " is cut off";
    EXPECT_GE(std::min(a.rect.width(), a.rect.height()), 5.0) << a.text;
    for (std::size_t j = 0; j < i; ++j) {
      const PlacedText& b = drawing.texts[j];
      EXPECT_FALSE(a.rect.intersects(b.rect)) << a.text << " over " << b.text;
    }
  }
}

}  // namespace trephine::plot::test
