#include <sys/stat.h>

#include <fstream>

#include "base/system.h"
#include "scene/scene_numbers.h"
#include "schema_page.h"
#include "support.h"

namespace trephine {
namespace {

Json shipped() {
  return *readJsonFile(resourceFolder() / "scenes" / "cranium.json");
}
std::filesystem::path shippedFile() { return resourceFolder() / "scenes" / "cranium.json"; }

TEST(Scene, EveryShippedSceneReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "scenes")) {
    Result<Scene> scene = readScene(entry.path());
    ASSERT_TRUE(scene.ok()) << scene.error().sentence();
    EXPECT_FALSE(scene->operator_file.empty());
    ++count;
  }
  EXPECT_EQ(count, 7);
}

TEST(Scene, TheCraniumSceneHasTwoArmsWithBlades) {
  const Scene scene = *readScene(shippedFile());
  ASSERT_EQ(scene.arms.size(), 2u);
  EXPECT_EQ(scene.findTool(scene.arms[0].tool)->tool.made_from.kind, ToolKind::blade);
  EXPECT_EQ(scene.laws.size(), 3u);
  EXPECT_EQ(hapticParameters(scene).arms.size(), 2u);
}

TEST(Scene, AnArmHasItsToolsByNumberTheFirstIsInHand) {
  const Scene scene = *readScene(shippedFile());
  ASSERT_EQ(scene.arms[1].other_tools.size(), 2u);
  EXPECT_EQ(scene.toolOf(1, 0)->id, "blade");
  EXPECT_EQ(scene.toolOf(1, 1)->id, "craniotome");
  EXPECT_EQ(scene.toolOf(1, 2)->id, "burr");
  EXPECT_EQ(scene.toolOf(1, 3), nullptr);
  const ArmParameters arm = hapticParameters(scene).arms[1];
  EXPECT_EQ(arm.tool.made_from.kind, ToolKind::blade);
  ASSERT_EQ(arm.other_tools.size(), 2u);
  EXPECT_EQ(arm.other_tools[0].made_from.shape, BurrShape::cylinder);
  EXPECT_EQ(arm.other_tools[1].made_from.radius_mm, 3.0);
}

TEST(Scene, SurvivesARoundTripWithoutItsFiles) {
  Scene scene = *readScene(shippedFile());
  const auto landmarks = std::vector<PlacedLandmark>{
      {"vault", {Vec3(1.0 / 3.0, 2, 3), glm::angleAxis(0.3, glm::normalize(Vec3(1, 2, 3)))}}};
  scene = withFixedMaps(scene, landmarks);
  const Json json = *parseJson(toJson(scene).dump(), "copy");
  const Result<Scene> copy = parseScene(json, "copy");
  ASSERT_TRUE(copy.ok()) << copy.error().sentence();
  for (std::size_t i = 0; i < 2; ++i) {
    const WorkspaceMap &a = *scene.arms[i].map.fixed, &b = *copy->arms[i].map.fixed;
    EXPECT_EQ(a.centre_mm, b.centre_mm) << "to the last bit";
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(scene.findTool("blade")->tool.points_m, copy->findTool("blade")->tool.points_m);
  }
  EXPECT_EQ(copy->arms[0].other_tools, scene.arms[0].other_tools);
  EXPECT_EQ(toJson(*copy), toJson(scene));
}

TEST(Scene, ACopyNeverHoldsACasePath) {
  Scene scene = *readScene(shippedFile());
  scene.case_source = "/data/DOE^JANE/ct";
  EXPECT_EQ(toJson(scene).dump().find("DOE"), std::string::npos);
}

TEST(Scene, ALabelMapIsFoundBesideTheSceneAndLeftOutOfACopy) {
  Json json = shipped();
  EXPECT_EQ(parseScene(json, shippedFile())->labels_file, "");
  json["labels"] = "../DOE^JANE/seg.nii.gz";
  Scene scene = *parseScene(json, shippedFile());
  EXPECT_EQ(scene.labels_file,
            (resourceFolder() / "DOE^JANE" / "seg.nii.gz").lexically_normal().string());
  EXPECT_EQ(toJson(scene).dump().find("DOE"), std::string::npos);
  EXPECT_FALSE(toJson(scene).contains("labels"));
  json["labels"] = "/elsewhere/seg.nii.gz";
  EXPECT_EQ(parseScene(json, shippedFile())->labels_file, "/elsewhere/seg.nii.gz");
}

TEST(Scene, ATissueOfALabelNeedsALabelMap) {
  Scene scene = *readScene(shippedFile());
  EXPECT_TRUE(checkLabels(scene.tissues, nullptr).ok());
  scene.tissues.tissues[1].label = 5;
  const Status status = checkLabels(scene.tissues, nullptr);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, "NO_LABELS");
  EXPECT_NE(status.error().what.find("'" + scene.tissues.tissues[1].id + "'"), std::string::npos);
  EXPECT_NE(status.error().what.find("label 5"), std::string::npos);
  const LabelMap map;
  EXPECT_TRUE(checkLabels(scene.tissues, &map).ok());
  EXPECT_EQ(placeLandmarks(scene, Volume{}).error().code, "NO_LABELS");
}

struct Bad {
  const char* name;
  void (*change)(Json&);
  const char* field;
  const char* value;
};

TEST(Scene, NamesFileFieldAndValueOfWhatIsWrong) {
  const Bad cases[] = {
      {"unknown key", [](Json& s) { s["colour"] = 7; }, "colour", "7"},
      {"unknown law", [](Json& s) { s["laws"][0] = "magic"; }, "laws", "magic"},
      {"unknown controller", [](Json& s) { s["controller"] = "pid"; }, "controller", "pid"},
      {"unknown tissue", [](Json& s) { s["landmarks"][0]["tissue"] = "cheese"; }, "landmarks",
       "cheese"},
      {"unknown tool", [](Json& s) { s["arms"][0]["tool"] = "spoon"; }, "arms", "spoon"},
      {"unknown other tool", [](Json& s) { s["arms"][0]["other_tools"][0] = "spoon"; }, "arms",
       "unknown tool 'spoon'"},
      {"other tool twice", [](Json& s) { s["arms"][0]["other_tools"][1] = "craniotome"; }, "arms",
       "'craniotome' twice"},
      {"the tool itself once more", [](Json& s) { s["arms"][1]["other_tools"][0] = "blade"; },
       "arms", "'blade' twice"},
      {"too many tools",
       [](Json& s) {
         s["arms"][0]["other_tools"] = {"a", "b", "c", "d"};
       },
       "arms[0].other_tools", "at most 3"},
      {"other tools that are no list", [](Json& s) { s["arms"][0]["other_tools"] = "burr"; },
       "arms[0].other_tools", "burr"},
      {"other tool that is no text", [](Json& s) { s["arms"][0]["other_tools"][0] = 7; },
       "arms[0].other_tools", "7"},
      {"bad scale", [](Json& s) { s["arms"][0]["map"]["motion_scale"] = -1; }, "motion_scale",
       "-1"},
      {"long tool", [](Json& s) { s["tools"][0]["length_mm"] = 2000; }, "tools[0].length_mm",
       "1000"},
      {"no points", [](Json& s) { s["tools"][0]["points"] = 0; }, "tools[0].points", "0"},
      {"rate", [](Json& s) { s["rate_hz"] = 5; }, "rate_hz", "5"},
      {"operator", [](Json& s) { s["operator"] = "gone.json"; }, "operator", "gone.json"},
      {"newer", [](Json& s) { s["version"] = 2; }, "version", "2"},
      {"other format", [](Json& s) { s["format"] = "trephine.tissues"; }, "format",
       "trephine.tissues"},
      {"run", [](Json& s) { s["landmarks"][0]["run_mm"] = 0; }, "landmarks[0].run_mm", "0"},
      {"view", [](Json& s) { s["view"]["distance_mm"] = 1e9; }, "view.distance_mm", "1000000000"},
      {"look of a tissue that is not there",
       [](Json& s) { s["view"]["looks"]["cheese"] = "shown"; }, "view.looks.cheese", "cheese"},
      {"unknown look", [](Json& s) { s["view"]["looks"]["bone"] = "pink"; }, "view.looks.bone",
       "pink"},
      {"look that is no text", [](Json& s) { s["view"]["looks"]["bone"] = 1; }, "view.looks.bone",
       "1"},
      {"looks that are no object", [](Json& s) { s["view"]["looks"] = "hidden"; }, "view.looks",
       "hidden"},
      {"no arms", [](Json& s) { s["arms"] = Json::array(); }, "arms", "0"},
      {"law twice", [](Json& s) { s["laws"].push_back(s["laws"][0]); }, "laws", "viscous"},
      {"tool id twice", [](Json& s) { s["tools"].push_back(s["tools"][0]); }, "tools", "blade"},
      {"landmark twice", [](Json& s) { s["landmarks"].push_back(s["landmarks"][0]); }, "landmarks",
       "vault"},
      {"ray without end", [](Json& s) { s["landmarks"][0]["from"][2] = 1e300; },
       "landmarks[0].from", "1e+300"},
      {"ray to nowhere", [](Json& s) { s["landmarks"][0]["towards"][0] = -1e300; },
       "landmarks[0].towards", "-1e+300"},
      {"far landmark",
       [](Json& s) {
         s["landmarks"][0]["from"] = {1e6, 1e6, 1e6};
       },
       "landmarks[0].from", "1000000.0"},
      {"far offset",
       [](Json& s) {
         s["arms"][0]["map"]["offset_mm"] = {0, 0, 1e308};
       },
       "arms[0].map.offset_mm", "1e+308"},
      {"far centre",
       [](Json& s) {
         s["arms"][0]["map"] = {{"centre_mm", {1e300, 0, 0}}, {"rotation_wxyz", {1, 0, 0, 0}}};
       },
       "arms[0].map.centre_mm", "1e+300"},
      {"no rotation",
       [](Json& s) {
         s["arms"][0]["map"] = {{"centre_mm", {0, 0, 0}}, {"rotation_wxyz", {0.5, 0, 0, 0}}};
       },
       "arms[0].map.rotation_wxyz", "0.5"},
      {"no force", [](Json& s) { s["arms"][0]["map"]["force_scale"] = 1e-308; },
       "arms[0].map.force_scale", "1e-308"},
      {"strong arm", [](Json& s) { s["arms"][0]["max_force_N"] = 1e300; }, "arms[0].max_force_N",
       "1e+300"},
      {"outward",
       [](Json& s) {
         s["landmarks"][0].erase("from");
         s["landmarks"][0].erase("towards");
         s["landmarks"][0]["bulk_radius_mm"] = 20;
         s["landmarks"][0]["outward"] = {0, 0, 0};
       },
       "landmarks[0].outward", "length of 0"},
      {"a ray that goes nowhere",
       [](Json& s) { s["landmarks"][0]["towards"] = s["landmarks"][0]["from"]; },
       "landmarks[0].towards", "'vault' goes nowhere"},
      {"many landmarks", [](Json& s) { s["landmarks"] = Json(100'000, s["landmarks"][0]); },
       "landmarks", "100000"},
      {"text for number", [](Json& s) { s["rate_hz"] = "fast"; }, "rate_hz", "fast"},
  };
  for (const Bad& bad : cases) {
    Json json = shipped();
    bad.change(json);
    Result<Scene> scene = parseScene(json, shippedFile());
    ASSERT_FALSE(scene.ok()) << bad.name;
    EXPECT_NE(scene.error().where.find("cranium.json"), std::string::npos) << bad.name;
    EXPECT_NE(scene.error().where.find(bad.field), std::string::npos)
        << bad.name << ": " << scene.error().sentence();
    EXPECT_NE(scene.error().what.find(bad.value), std::string::npos)
        << bad.name << ": " << scene.error().sentence();
  }
}

// Longer than the system lets names be: asking about it is an error of its own.
TEST(Scene, AFileNameThatCannotBeIsAnErrorLikeAMissingFile) {
  const std::string name = std::string(300, 'x') + ".json";
  const Bad cases[] = {
      {"operator", [](Json&) {}, "operator", ""},
      {"mesh",
       [](Json& s) {
         s["tools"][0] = {{"id", "blade"}, {"kind", "blade"}, {"length_mm", 16}, {"points", 16}};
         s["tools"][0]["mesh"] = s["operator"];
       },
       "mesh", ""},
  };
  for (const Bad& bad : cases) {
    Json json = shipped();
    json["operator"] = name;
    bad.change(json);
    if (bad.field != std::string("operator")) json.erase("operator");
    const Result<Scene> scene = parseScene(json, shippedFile());
    ASSERT_FALSE(scene.ok()) << bad.name;
    EXPECT_NE(scene.error().where.find(bad.field), std::string::npos) << scene.error().sentence();
    EXPECT_NE(scene.error().what.find(name), std::string::npos) << scene.error().sentence();
  }
}

TEST(Scene, IsWrittenWithEveryNumberThatItIsReadWith) {
  Json json = shipped();
  json["rate_hz"] = 2000.0;
  json["view"]["distance_mm"] = 123.0;
  json["landmarks"][0]["run_mm"] = 2.5;
  json["arms"][0]["max_force_N"] = 1.5;
  json["arms"][0]["map"]["motion_scale"] = 2.0;
  json["arms"][0]["map"]["force_scale"] = 0.5;
  json["arms"][0]["map"]["offset_mm"] = {1.0, 2.0, 3.0};
  const Result<Scene> scene = parseScene(json, shippedFile());
  ASSERT_TRUE(scene.ok()) << scene.error().sentence();
  const Json written = toJson(*scene);
  for (const char* at :
       {"/rate_hz", "/view/distance_mm", "/landmarks/0/run_mm", "/arms/0/max_force_N",
        "/arms/0/map/motion_scale", "/arms/0/map/force_scale", "/arms/0/map/offset_mm"}) {
    EXPECT_EQ(written.at(Json::json_pointer(at)), json.at(Json::json_pointer(at))) << at;
  }
}

TEST(Scene, SaysHowTissuesLookAndIsWrittenWithIt) {
  Json json = shipped();
  json["view"]["looks"] = {{"bone", "ghosted"}, {"brain", "shown"}, {"dura", "hidden"}};
  Result<Scene> scene = parseScene(json, shippedFile());
  ASSERT_TRUE(scene.ok()) << scene.error().sentence();
  EXPECT_EQ(scene->view.looks, (TissueLooks{{"bone", TissueLook::ghosted},
                                            {"brain", TissueLook::shown},
                                            {"dura", TissueLook::hidden}}));
  EXPECT_EQ(toJson(*scene)["view"]["looks"], json["view"]["looks"]);

  // Of the whole case, too: a view without a landmark.
  json["view"] = {{"looks", {{"bone", "hidden"}}}};
  scene = parseScene(json, shippedFile());
  ASSERT_TRUE(scene.ok()) << scene.error().sentence();
  EXPECT_EQ(scene->view.landmark, "");
  EXPECT_EQ(toJson(*scene)["view"], json["view"]);
}

TEST(Scene, ANumberThatIsNotGivenIsAsThePageSays) {
  Json json = shipped();
  for (const char* key : {"rate_hz", "view"}) json.erase(key);
  json["arms"][0].erase("max_force_N");
  const Scene scene = *parseScene(json, shippedFile());
  EXPECT_EQ(scene.rate_hz, 1000.0);
  EXPECT_EQ(scene.view.distance_mm, 350.0);
  EXPECT_EQ(scene.arms[0].max_force_N, 3.3);
}

TEST(Scene, ThePagesAreAsTheRowsAre) {
  const std::filesystem::path pages = resourceFolder() / "schemas";
  test::expectNumbers(pages / "scene.md", "scene", sceneNumbersPage());
  test::expectNumbers(pages / "tool.md", "tool", toolNumbersPage());
}

TEST(Scene, AMissingTissueFileIsNamed) {
  Json json = shipped();
  json["tissues"] = "../tissues/gone.json";
  const Result<Scene> scene = parseScene(json, shippedFile());
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().code, "MISSING_FILE");
  EXPECT_NE(scene.error().where.find("gone.json"), std::string::npos);
}

// A scene beside a tool file of its own.
class ToolFile : public testing::Test {
 protected:
  void SetUp() override {
    scene_["tools"] = Json::array({{{"id", "blade"}, {"file", "tool.json"}}});
    scene_["operator"] = "";
    scene_["tissues"] = (resourceFolder() / "tissues" / "cranium.json").string();
    for (Json& arm : scene_["arms"]) arm.erase("other_tools");
    tool_ = *readJsonFile(resourceFolder() / "tools" / "blade.json");
    tool_["mesh"] = (resourceFolder() / "tools" / "blade.stl").string();
  }
  Result<Scene> read() {
    std::ofstream(folder_ / "tool.json") << tool_.dump();
    return parseScene(scene_, folder_ / "scene.json");
  }
  void expectRefused(const char* field, const char* value) {
    const Result<Scene> scene = read();
    ASSERT_FALSE(scene.ok()) << field;
    const std::string sentence = scene.error().sentence();
    for (const char* part : {"scene.json", "tools[0].file", "tool.json", field, value}) {
      EXPECT_NE(sentence.find(part), std::string::npos) << part << ": " << sentence;
    }
  }

  test::TemporaryFolder folder_;
  Json scene_ = shipped(), tool_;
};

TEST_F(ToolFile, IsReadBesideItsScene) {
  const Result<Scene> scene = read();
  ASSERT_TRUE(scene.ok()) << scene.error().sentence();
  EXPECT_EQ(scene->tools[0].look.axis, Vec3(1, 0, 0));
}

TEST_F(ToolFile, IsRefusedWithFileFieldAndValueOfANumberOutOfRange) {
  const std::pair<const char*, Json> wrong[] = {
      {"length_mm", 1e9}, {"radius_mm", -1},         {"points", 1'000'000},
      {"motor_W", 1e300}, {"tip_mm", {0, 0, 1e300}},
  };
  const Json before = tool_;
  for (const auto& [key, value] : wrong) {
    tool_ = before;
    tool_[key] = value;
    expectRefused(key, value.is_array() ? "1e+300" : value.dump().c_str());
  }
}

TEST_F(ToolFile, ThatIsNoObjectIsRefusedThoughTheSceneSetsANumberOfItsOwn) {
  scene_["tools"][0]["length_mm"] = 20;
  for (const Json& other : {Json::array(), Json(1e300), Json("x"), Json()}) {
    tool_ = other;
    expectRefused("", "");
  }
}

TEST(Scene, FindsItsCaseBesideItselfAndABuiltInOneByName) {
  Json scene = shipped();
  EXPECT_EQ(parseScene(scene, resourceFolder() / "scenes" / "scene.json")->case_source,
            "phantom:cranium");
  scene["case"] = "../ct";
  scene["tissues"] = (resourceFolder() / "tissues" / "cranium.json").string();
  const std::filesystem::path beside = resourceFolder() / "scenes" / "scene.json";
  EXPECT_EQ(parseScene(scene, beside)->case_source, (resourceFolder() / "ct").string());
}

TEST_F(ToolFile, HasAnAxisThatPointsSomewhere) {
  tool_["axis"] = {0, 0, 0};
  expectRefused("axis", "length of 0");
  tool_["axis"] = {1e9, 0, 0};
  expectRefused("axis", "1000000000.0");
}

TEST_F(ToolFile, ThatIsAPipeIsRefusedInsteadOfWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  scene_["tools"][0]["file"] = "pipe.json";
  const Result<Scene> scene = parseScene(scene_, folder_ / "scene.json");
  ASSERT_FALSE(scene.ok());
  const std::string sentence = scene.error().sentence();
  EXPECT_NE(sentence.find("tools[0].file"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("pipe.json"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace trephine
