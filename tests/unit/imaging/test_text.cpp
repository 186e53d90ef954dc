#include <gtest/gtest.h>

#include "imaging/common/detail/text.h"

namespace trephine {

TEST(Text, CleaningKeepsValidUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(cleanUtf8("Schädel 頭"), "Schädel 頭");
  EXPECT_EQ(cleanUtf8("a\xFFz"), "a\xEF\xBF\xBDz");
  EXPECT_EQ(cleanUtf8("cut \xE2\x82"), "cut \xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(cleanUtf8(" padded \0"), "padded");
  EXPECT_EQ(cleanUtf8("two\nlines"), "two lines");
}

TEST(Text, OverlongFormsAndSurrogatesAreNotUtf8) {
  EXPECT_FALSE(isUtf8("\xC0\xAF"));
  EXPECT_FALSE(isUtf8("\xED\xA0\x80"));
  EXPECT_FALSE(isUtf8("\xF4\x90\x80\x80"));
  EXPECT_TRUE(isUtf8("\xF4\x8F\xBF\xBF"));
}

TEST(Text, AnUndecodableTextIsReadAsLatin1) {
  EXPECT_EQ(guessUtf8("Sch\xE4"
                      "del"),
            "Schädel");
  EXPECT_EQ(guessUtf8("Schädel"), "Schädel");
}

TEST(Text, ThatTurnsTheDirectionOfReadingDoesNot) {
  EXPECT_EQ(cleanUtf8("a\xE2\x80\xAE"
                      "b\xE2\x81\xA6"
                      "c"),
            "a b c");
  EXPECT_EQ(cleanUtf8("a\xE2\x80\x93"
                      "b"),
            "a\xE2\x80\x93"
            "b");
}

TEST(Text, Iso2022TextWithoutADecoderKeepsItsPlainPart) {
  const std::string guess = guessUtf8("Head \x1B$B;3ED\x1B(B end");
  EXPECT_TRUE(isUtf8(guess));
  EXPECT_EQ(guess, "Head \xEF\xBF\xBD end");
}

TEST(Text, DecimalsAllowPaddingAndSigns) {
  EXPECT_EQ(parseDecimals("1\\ -2.5 \\+3e2"), (std::vector<double>{1.0, -2.5, 300.0}));
  EXPECT_EQ(parseDecimal(" 0.451171875 "), 0.451171875);
}

TEST(Text, WhatIsNoFiniteNumberIsNotTaken) {
  for (const char* text : {"", "1,5", "abc", "1\\", "inf", "nan", "1e999", "1 2"}) {
    EXPECT_FALSE(parseDecimals(text).has_value()) << text;
  }
  EXPECT_FALSE(parseDecimal("1\\2").has_value());
  EXPECT_FALSE(parseInteger("1.5").has_value());
  EXPECT_EQ(parseInteger("-2000"), -2000);
}

TEST(Text, FixedNumbersHaveNoMinusZero) {
  EXPECT_EQ(fixedText(-0.001, 2), "0.00");
  EXPECT_EQ(fixedText(-12.345, 1), "-12.3");
}

}  // namespace trephine
