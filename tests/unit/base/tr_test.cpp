#include "base/tr.h"

#include <gtest/gtest.h>

#include <string_view>

namespace trephine {
namespace {

// The language of these tests: of what is not in it the source stands.
std::string translated(const char* source, std::optional<int> count) {
  const std::string_view of = source;
  if (of == "{} of {} files") return "{1} Dateien, davon {0}";
  if (of == "One file") return "Eine Datei";
  if (of == "File {}") return "Datei {} {}";
  if (of == "Folder {}") return "Ordner {";
  // As a language with three forms has it.
  if (of == "{} files of {}") {
    const int last = *count % 10;
    return last == 1 ? "{} fajl od {}" : last < 5 ? "{} fajla od {}" : "{} fajlova od {}";
  }
  if (of == "{} parts") return "{1} Teile";
  return source;
}

class Translated : public ::testing::Test {
 protected:
  void SetUp() override { setTranslator(translated); }
  void TearDown() override { setTranslator(nullptr); }
};

TEST(Tr, PutsTextAndWholeNumbersInTheirPlaces) {
  EXPECT_EQ(tr("{} of {} files in {}", 2, std::size_t{30}, std::string("here")),
            "2 of 30 files in here");
  EXPECT_EQ(tr("{1} before {0}", "b", "a"), "a before b");
  EXPECT_EQ(tr("A {{brace}} stays, and so does {}", "{0}"), "A {brace} stays, and so does {0}");
  EXPECT_EQ(tr("No place"), "No place");
}

TEST(Tr, GivesTheSourceAsItIsWhereItsPlacesAreWrong) {
  EXPECT_EQ(tr("{} and {}", 1), "{} and {}");
  EXPECT_EQ(tr("{x}", 1), "{x}");
  EXPECT_EQ(tr("an end {", 1), "an end {");
}

TEST_F(Translated, SaysSentencesInTheLanguageThatWasSet) {
  EXPECT_EQ(tr("One file"), "Eine Datei");
  EXPECT_EQ(tr("{} of {} files", 2, 30), "30 Dateien, davon 2");
  EXPECT_EQ(tr(trLater("One file")), "Eine Datei");
  EXPECT_EQ(tr("A folder"), "A folder");
}

TEST(Tr, SaysOneThingAndManyThings) {
  EXPECT_EQ(trCount(1, "{} file of {}", "{} files of {}", "CT"), "1 file of CT");
  EXPECT_EQ(trCount(0, "{} file of {}", "{} files of {}", "CT"), "0 files of CT");
  EXPECT_EQ(trCount(2, "It is one", "They are {0}, {1}", "so"), "They are 2, so");
}

TEST_F(Translated, SaysNumbersOfThingsInTheFormsOfTheLanguage) {
  const auto files = [](std::uint64_t n) {
    return trCount(n, "{} file of {}", "{} files of {}", "CT");
  };
  EXPECT_EQ(files(1), "1 fajl od CT");
  EXPECT_EQ(files(21), "21 fajl od CT");
  EXPECT_EQ(files(3), "3 fajla od CT");
  EXPECT_EQ(files(5'000'000'021), "5000000021 fajl od CT");
  EXPECT_EQ(trCount(1, "{} part", "{} parts"), "1 part");
  EXPECT_EQ(trCount(1, "{} folder", "{} folders"), "1 folder");
}

TEST_F(Translated, TakesNoTranslationWhosePlacesAreNotThoseOfTheSource) {
  EXPECT_EQ(tr("File {}", "a"), "File a");
  EXPECT_EQ(tr("Folder {}", "a"), "Folder a");
}

}  // namespace
}  // namespace trephine
