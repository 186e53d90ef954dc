// Text from elsewhere, before it is shown or printed.
#include "base/utf8.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

TEST(CleanUtf8, MakesABlankOfWhatATerminalObeys) {
  EXPECT_EQ(cleanUtf8("a\x1b[2Jb"), "a [2Jb");
  EXPECT_EQ(cleanUtf8("bell\a and \x7f"), "bell  and");
  EXPECT_EQ(cleanUtf8("a\u009b2Jb"), "a 2Jb") << "C1 as UTF-8";
  EXPECT_EQ(cleanUtf8("a\x9b"
                      "2Jb"),
            "a\uFFFD2Jb")
      << "C1 as a byte";
  EXPECT_EQ(cleanUtf8("two\nlines\u2028three"), "two lines three");
  EXPECT_EQ(cleanUtf8("a\u202Eb\u2066c"), "a b c") << "what turns the direction";
}

TEST(CleanUtf8, LeavesOutWhatNobodySees) {
  EXPECT_EQ(cleanUtf8("li\u200Bver\uFEFF"), "liver");
  EXPECT_EQ(cleanUtf8("li\u00ADver\u2060\U000E0041"), "liver");
}

TEST(CleanUtf8, KeepsNamesOfAnyScript) {
  for (const char* name : {"Sch\u00E4del", "\u982D", "\u0393\u03B9\u03CE\u03C1\u03B3\u03BF\u03C2",
                           "\U0001F9E0 3 mm", "a <b> & \"c\""}) {
    EXPECT_EQ(cleanUtf8(name), name);
  }
}

TEST(CleanUtf8, KeepsWhatTellsHowLettersAreJoinedAndATerminalDoesNot) {
  EXPECT_EQ(cleanUtf8("\u0645\u06CC\u200C\u062E"), "\u0645\u06CC\u200C\u062E");
  EXPECT_EQ(cleanLines("a\u200Db"), "ab");
}

TEST(IsOneLine, IsNoTextThatATerminalObeysOrThatEndsALine) {
  for (const char* text :
       {"a\nb", "a\r", "\x1b[2J", "a\u009b2J", "a\u2028b", "a\u202Eb", "a\x9b", "\t"}) {
    EXPECT_FALSE(isOneLine(text)) << text;
  }
  for (const char* text : {"", " a  b ", "Sch\u00E4del \u982D", "\u0645\u06CC\u200C\u062E"}) {
    EXPECT_TRUE(isOneLine(text)) << text;
  }
}

TEST(CleanLines, KeepsLinesTabsAndBlanks) {
  EXPECT_EQ(cleanLines("  a\tb\n\x1b]0;c\ad\r\n"), "  a\tb\n ]0;c d \n");
}

}  // namespace
}  // namespace trephine
