#include "plot/theme.h"

#include <gtest/gtest.h>

namespace trephine::plot {
namespace {

TEST(Themes, KeepEveryToneOffTheBackground) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const QColor background = coloursOf(theme).background;
    for (int tone = 0; tone < int(Tone::heat_1); ++tone) {
      const double least = Tone(tone) <= Tone::quiet ? 4.5 : 3.0;
      EXPECT_GT(contrast(colourOf(Tone(tone), theme), background), least)
          << tone << " on " << background.name().toStdString();
    }
    EXPECT_LT(contrast(coloursOf(theme).grid, background), 1.6) << "the grid stays faint";
  }
}

TEST(Themes, WriteReadablyOnEveryLevelOfAHeatMap) {
  for (int tone = int(Tone::heat_1); tone <= int(Tone::heat_5); ++tone) {
    const QColor fill = colourOf(Tone(tone), Theme::light);
    EXPECT_GT(contrast(inkOn(fill), fill), 4.5) << tone;
  }
}

TEST(Themes, TellHeatLevelsOfTheSameShapeApartByLightness) {
  // Levels 2 to 4 share a shape.
  for (int tone = int(Tone::heat_2); tone < int(Tone::heat_4); ++tone) {
    EXPECT_GT(contrast(colourOf(Tone(tone), Theme::light), colourOf(Tone(tone + 1), Theme::light)),
              1.25);
  }
}

TEST(Contrast, FollowsItsFormula) {
  EXPECT_NEAR(contrast(Qt::black, Qt::white), 21.0, 1e-6);
  EXPECT_NEAR(contrast(Qt::red, Qt::red), 1.0, 1e-12);
}

}  // namespace
}  // namespace trephine::plot
