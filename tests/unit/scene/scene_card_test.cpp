#include <gtest/gtest.h>

#include "base/system.h"
#include "base/utf8.h"
#include "scene/scene.h"
#include "shipped.h"

namespace trephine {
namespace {

using test::burrHole;
using test::burrHoleFile;

TEST(SceneCard, EveryShippedSceneHasOneInBothLanguages) {
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "scenes")) {
    const Scene scene = *readScene(entry.path());
    const CardText* english = cardFor(scene, "en");
    const CardText* chinese = cardFor(scene, "zh_TW");
    ASSERT_TRUE(english && chinese) << entry.path();
    EXPECT_NE(english, chinese) << entry.path();
    EXPECT_EQ(english->steps.size(), chinese->steps.size()) << entry.path();
    // A hand that an arm of the scene is for is spoken of.
    for (const SceneArm& arm : scene.arms) {
      EXPECT_NE(english->hands.find(arm.name == "left" ? "Left" : "ight hand"), std::string::npos)
          << entry.path();
      EXPECT_NE(chinese->hands.find(arm.name == "left" ? "左" : "右"), std::string::npos)
          << entry.path();
    }
  }
}

TEST(SceneCard, IsInEnglishWhereItHasNoOtherLanguage) {
  Json json = burrHole();
  json["card"].erase("zh_TW");
  Scene scene = *parseScene(json, burrHoleFile());
  EXPECT_EQ(cardFor(scene, "zh_TW"), &scene.card->en);
  EXPECT_EQ(cardFor(scene, "de"), &scene.card->en);
  scene.card.reset();
  EXPECT_EQ(cardFor(scene, "en"), nullptr);
}

TEST(SceneCard, IsWrittenAsItWasRead) {
  const Json json = burrHole();
  EXPECT_EQ(toJson(*parseScene(json, burrHoleFile()))["card"], json["card"]);
  Json bare = json;
  bare.erase("card");
  EXPECT_FALSE(toJson(*parseScene(bare, burrHoleFile())).contains("card"));
}

std::string times(const char* text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(SceneCard, ThatCannotBeReadAtAGlanceIsRefusedByField) {
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
    const Result<Scene> scene = parseScene(json, burrHoleFile());
    ASSERT_FALSE(scene) << wrong.field;
    EXPECT_NE(scene.error().where.find(wrong.field), std::string::npos) << scene.error().sentence();
  }
  // Characters are counted, not bytes: Chinese has as much room.
  Json json = burrHole();
  json["card"]["zh_TW"]["goal"] = times("骨", 300);
  EXPECT_TRUE(parseScene(json, burrHoleFile()));
}

TEST(SceneLocks, AreReadAndWrittenAndNothingElseIsLocked) {
  Json json = burrHole();
  EXPECT_TRUE(parseScene(json, burrHoleFile())->locks.empty());
  EXPECT_FALSE(toJson(*parseScene(json, burrHoleFile())).contains("locks"));
  json["locks"] = {"controller", "rate"};
  const Scene scene = *parseScene(json, burrHoleFile());
  EXPECT_EQ(scene.locks, (Locks{Lock::controller, Lock::rate}));
  EXPECT_EQ(toJson(scene)["locks"], json["locks"]);
  json["locks"] = {"everything"};
  const Result<Scene> wrong = parseScene(json, burrHoleFile());
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().sentence().find("everything"), std::string::npos);
  EXPECT_NE(wrong.error().next.find("controller, tissues, rate"), std::string::npos);
}

TEST(SceneLocks, NoShippedSceneLocksAnything) {
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "scenes")) {
    EXPECT_TRUE(readScene(entry.path())->locks.empty()) << entry.path();
  }
}

}  // namespace
}  // namespace trephine
