#include <gtest/gtest.h>

#include "base/system.h"
#include "base/utf8.h"
#include "exercise/exercise.h"
#include "shipped.h"

namespace trephine {
namespace {

using test::burrHole;
using test::burrHoleFile;

TEST(ExerciseCard, EveryShippedExerciseHasOneInBothLanguages) {
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(resourceFolder() / "scenes")) {
    if (entry.is_directory()) continue;
    const Exercise exercise = *readExercise(entry.path());
    const CardText* english = cardFor(exercise, "en");
    const CardText* chinese = cardFor(exercise, "zh_TW");
    ASSERT_TRUE(english && chinese) << entry.path();
    EXPECT_NE(english, chinese) << entry.path();
    EXPECT_EQ(english->steps.size(), chinese->steps.size()) << entry.path();
    // A hand that an arm of the exercise is for is spoken of.
    for (const ExerciseArm& arm : exercise.arms) {
      EXPECT_NE(english->hands.find(arm.name == "left" ? "Left" : "ight hand"), std::string::npos)
          << entry.path();
      EXPECT_NE(chinese->hands.find(arm.name == "left" ? "左" : "右"), std::string::npos)
          << entry.path();
    }
  }
}

TEST(ExerciseCard, IsInEnglishWhereItHasNoOtherLanguage) {
  Json json = burrHole();
  json["card"].erase("zh_TW");
  Exercise exercise = *parseExercise(json, burrHoleFile());
  EXPECT_EQ(cardFor(exercise, "zh_TW"), &exercise.card->en);
  EXPECT_EQ(cardFor(exercise, "de"), &exercise.card->en);
  exercise.card.reset();
  EXPECT_EQ(cardFor(exercise, "en"), nullptr);
}

TEST(ExerciseCard, IsWrittenAsItWasRead) {
  const Json json = burrHole();
  EXPECT_EQ(toJson(*parseExercise(json, burrHoleFile()))["card"], json["card"]);
  Json old = json;
  old["card"]["zh_TW_is_old"] = true;
  EXPECT_EQ(toJson(*parseExercise(old, burrHoleFile()))["card"], old["card"]);
  Json bare = json;
  bare.erase("card");
  EXPECT_FALSE(toJson(*parseExercise(bare, burrHoleFile())).contains("card"));
}

std::string times(const char* text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(ExerciseCard, ThatCannotBeReadAtAGlanceIsRefusedByField) {
  struct Wrong {
    const char* field;
    void (*change)(Json& card);
  };
  const Wrong all[] = {
      {"card.en", [](Json& c) { c.erase("en"); }},
      {"card.fr", [](Json& c) { c["fr"] = c["en"]; }},
      {"card.en.goal", [](Json& c) { c["en"]["goal"] = ""; }},
      {"card.en.goal", [](Json& c) { c["en"]["goal"] = times("a", 301); }},
      {"card.zh_TW.goal", [](Json& c) { c["zh_TW"]["goal"] = times("骨", 301); }},
      {"card.en.goal", [](Json& c) { c["en"]["goal"] = "two\nlines"; }},
      {"card.en.hands", [](Json& c) { c["en"]["hands"] = times("a", 301); }},
      {"card.en.hands", [](Json& c) { c["en"].erase("hands"); }},
      {"card.en.steps", [](Json& c) { c["en"]["steps"] = Json::array(); }},
      {"card.en.steps", [](Json& c) { c["en"]["steps"] = Json(13, "one"); }},
      {"card.en.steps", [](Json& c) { c["en"]["steps"][2] = times("a", 201); }},
      {"card.en.steps", [](Json& c) { c["en"]["steps"][0] = 7; }},
  };
  for (const Wrong& wrong : all) {
    Json json = burrHole();
    wrong.change(json["card"]);
    const Result<Exercise> exercise = parseExercise(json, burrHoleFile());
    ASSERT_FALSE(exercise) << wrong.field;
    EXPECT_NE(exercise.error().where.find(wrong.field), std::string::npos)
        << exercise.error().sentence();
  }
  // Characters are counted, not bytes: Chinese has as much room.
  Json json = burrHole();
  json["card"]["zh_TW"]["goal"] = times("骨", 300);
  EXPECT_TRUE(parseExercise(json, burrHoleFile()));
}

TEST(ExerciseLocks, AreReadAndWrittenAndNothingElseIsLocked) {
  Json json = burrHole();
  EXPECT_TRUE(parseExercise(json, burrHoleFile())->locks.empty());
  EXPECT_FALSE(toJson(*parseExercise(json, burrHoleFile())).contains("locks"));
  json["locks"] = {"controller", "rate"};
  const Exercise exercise = *parseExercise(json, burrHoleFile());
  EXPECT_EQ(exercise.locks, (Locks{Lock::controller, Lock::rate}));
  EXPECT_EQ(toJson(exercise)["locks"], json["locks"]);
  json["locks"] = {"everything"};
  const Result<Exercise> wrong = parseExercise(json, burrHoleFile());
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().sentence().find("everything"), std::string::npos);
  EXPECT_NE(wrong.error().next.find("controller, tissues, rate"), std::string::npos);
}

TEST(ExerciseLocks, NoShippedExerciseLocksAnything) {
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(resourceFolder() / "scenes")) {
    if (entry.is_directory()) continue;
    EXPECT_TRUE(readExercise(entry.path())->locks.empty()) << entry.path();
  }
}

}  // namespace
}  // namespace trephine
