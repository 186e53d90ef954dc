#include <sys/stat.h>

#include <fstream>

#include "base/system.h"
#include "exercise/exercise_fields.h"
#include "schema_page.h"
#include "support.h"

namespace trephine {
namespace {

Json shipped() {
  return *readJsonFile(resourceFolder() / "scenes" / "cranium.json");
}
std::filesystem::path shippedFile() { return resourceFolder() / "scenes" / "cranium.json"; }

TEST(Exercise, EveryShippedExerciseReads) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(resourceFolder() / "scenes")) {
    if (entry.is_directory()) continue;
    Result<Exercise> exercise = readExercise(entry.path());
    ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
    EXPECT_FALSE(exercise->operator_file.empty());
    ++count;
  }
  EXPECT_EQ(count, 7);
}

TEST(Exercise, TheCraniumExerciseHasTwoArmsWithBlades) {
  const Exercise exercise = *readExercise(shippedFile());
  ASSERT_EQ(exercise.arms.size(), 2u);
  EXPECT_EQ(exercise.findTool(exercise.arms[0].tool)->tool.made_from.kind, ToolKind::blade);
  EXPECT_EQ(exercise.laws.size(), 3u);
  EXPECT_EQ(hapticParameters(exercise).arms.size(), 2u);
}

TEST(Exercise, AnArmHasItsToolsByNumberTheFirstIsInHand) {
  const Exercise exercise = *readExercise(shippedFile());
  ASSERT_EQ(exercise.arms[1].other_tools.size(), 2u);
  EXPECT_EQ(exercise.toolOf(1, 0)->id, "blade");
  EXPECT_EQ(exercise.toolOf(1, 1)->id, "craniotome");
  EXPECT_EQ(exercise.toolOf(1, 2)->id, "burr");
  EXPECT_EQ(exercise.toolOf(1, 3), nullptr);
  const ArmParameters arm = hapticParameters(exercise).arms[1];
  EXPECT_EQ(arm.tool.made_from.kind, ToolKind::blade);
  ASSERT_EQ(arm.other_tools.size(), 2u);
  EXPECT_EQ(arm.other_tools[0].made_from.shape, BurrShape::cylinder);
  EXPECT_EQ(arm.other_tools[1].made_from.radius_mm, 3.0);
}

TEST(Exercise, SurvivesARoundTripWithoutItsFiles) {
  Exercise exercise = *readExercise(shippedFile());
  const auto landmarks = std::vector<PlacedLandmark>{
      {"vault", {Vec3(1.0 / 3.0, 2, 3), glm::angleAxis(0.3, glm::normalize(Vec3(1, 2, 3)))}}};
  exercise = withFixedMaps(exercise, landmarks);
  const Json json = *parseJson(toJson(exercise).dump(), "copy");
  const Result<Exercise> copy = parseExercise(json, "copy");
  ASSERT_TRUE(copy.ok()) << copy.error().sentence();
  for (std::size_t i = 0; i < 2; ++i) {
    const WorkspaceMap &a = *exercise.arms[i].map.fixed, &b = *copy->arms[i].map.fixed;
    EXPECT_EQ(a.centre_mm, b.centre_mm) << "to the last bit";
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(exercise.findTool("blade")->tool.points_m, copy->findTool("blade")->tool.points_m);
  }
  EXPECT_EQ(copy->arms[0].other_tools, exercise.arms[0].other_tools);
  EXPECT_EQ(toJson(*copy), toJson(exercise));
}

TEST(Exercise, ACopyNeverHoldsACasePath) {
  Exercise exercise = *readExercise(shippedFile());
  exercise.case_source = "/data/DOE^JANE/ct";
  EXPECT_EQ(toJson(exercise).dump().find("DOE"), std::string::npos);
}

TEST(Exercise, ALabelMapIsFoundBesideTheExerciseAndLeftOutOfACopy) {
  Json json = shipped();
  EXPECT_EQ(parseExercise(json, shippedFile())->labels_file, "");
  json["labels"] = "../DOE^JANE/seg.nii.gz";
  Exercise exercise = *parseExercise(json, shippedFile());
  EXPECT_EQ(exercise.labels_file,
            (resourceFolder() / "DOE^JANE" / "seg.nii.gz").lexically_normal().string());
  EXPECT_EQ(toJson(exercise).dump().find("DOE"), std::string::npos);
  EXPECT_FALSE(toJson(exercise).contains("labels"));
  json["labels"] = "/elsewhere/seg.nii.gz";
  EXPECT_EQ(parseExercise(json, shippedFile())->labels_file, "/elsewhere/seg.nii.gz");
}

TEST(Exercise, ATissueOfALabelNeedsALabelMap) {
  Exercise exercise = *readExercise(shippedFile());
  EXPECT_TRUE(checkLabels(exercise.tissues, nullptr).ok());
  exercise.tissues.tissues[1].label = 5;
  const Status status = checkLabels(exercise.tissues, nullptr);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code.str(), "NO_LABELS");
  EXPECT_NE(status.error().what.find("'" + exercise.tissues.tissues[1].id + "'"), std::string::npos);
  EXPECT_NE(status.error().what.find("label 5"), std::string::npos);
  const LabelMap map;
  EXPECT_TRUE(checkLabels(exercise.tissues, &map).ok());
  EXPECT_EQ(placeLandmarks(exercise, Volume{}).error().code.str(), "NO_LABELS");
}

struct Bad {
  const char* name;
  void (*change)(Json&);
  const char* field;
  const char* value;
};

TEST(Exercise, NamesFileFieldAndValueOfWhatIsWrong) {
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
    Result<Exercise> exercise = parseExercise(json, shippedFile());
    ASSERT_FALSE(exercise.ok()) << bad.name;
    EXPECT_NE(exercise.error().where.find("cranium.json"), std::string::npos) << bad.name;
    EXPECT_NE(exercise.error().where.find(bad.field), std::string::npos)
        << bad.name << ": " << exercise.error().sentence();
    EXPECT_NE(exercise.error().what.find(bad.value), std::string::npos)
        << bad.name << ": " << exercise.error().sentence();
  }
}

// --- The seed paper's rule of touch ---

std::filesystem::path seedFile(const char* name) {
  return resourceFolder() / "scenes" / "research" / name;
}

TEST(TouchByPoints, IsReadWrittenAndHandedToTheCoreByTheTissuesThatItNames) {
  const Exercise exercise = *readExercise(seedFile("seed-liver.json"));
  EXPECT_EQ(exercise.touch_by_points, (std::vector<std::string>{"liver", "capsule"}));
  const Json written = *parseJson(toJson(exercise).dump(), "copy");
  EXPECT_EQ(written["touch_by_points"], Json::array({"liver", "capsule"}));
  const Result<Exercise> copy = parseExercise(written, "copy");
  ASSERT_TRUE(copy.ok()) << copy.error().sentence();
  EXPECT_EQ(copy->touch_by_points, exercise.touch_by_points);
  EXPECT_TRUE(checkEdited(exercise).ok());
  for (const Exercise& of : {exercise, *copy}) {
    const HapticParameters parameters = hapticParameters(of);
    EXPECT_EQ(parameters.touch_by_points, 0b11u);
    EXPECT_TRUE(validate(parameters).ok());
  }
  Exercise elsewhere = exercise;
  elsewhere.tissues = *exercise.tissues_elsewhere;
  EXPECT_EQ(hapticParameters(elsewhere).touch_by_points, 0b10100u) << "liver and capsule there";
}

TEST(TouchByPoints, IsInNoExerciseThatDoesNotNameIt) {
  const Exercise exercise = *readExercise(shippedFile());
  EXPECT_TRUE(exercise.touch_by_points.empty());
  EXPECT_FALSE(toJson(exercise).contains("touch_by_points"));
  EXPECT_EQ(hapticParameters(exercise).touch_by_points, 0u);
}

TEST(TouchByPoints, IsRefusedByFileFieldAndValueWithWhatToDo) {
  const Bad cases[] = {
      {"unknown tissue", [](Json& s) { s["touch_by_points"][1] = "cheese"; }, "cheese", "ids"},
      {"a tissue twice", [](Json& s) { s["touch_by_points"][1] = "liver"; }, "'liver'", "each"},
      {"no tissue", [](Json& s) { s["touch_by_points"] = Json::array(); }, "[]", "take"},
      {"no list", [](Json& s) { s["touch_by_points"] = "liver"; }, "liver", "schema"},
      {"no text", [](Json& s) { s["touch_by_points"][0] = 7; }, "7", "schema"},
      {"the set for elsewhere lacks it",
       [](Json& s) {
         s["tissues_elsewhere"] = *readJsonFile(resourceFolder() / "tissues" / "abdomen.json");
         s["tissues_elsewhere"]["tissues"][4]["id"] = "skin-of-it";
       },
       "'capsule'", "both sets"},
      {"another law", [](Json& s) { s["laws"].push_back("elastic"); }, "`elastic`", "take"},
      {"distributed", [](Json& s) { s["force_at"] = "distributed"; }, "`distributed`", "take"},
      {"by work", [](Json& s) { s["removal"] = "work"; }, "`work`", "take"},
      {"by work unless said", [](Json& s) { s.erase("removal"); }, "`work`", "take"},
  };
  for (const Bad& bad : cases) {
    Json json = *readJsonFile(seedFile("seed-liver.json"));
    json["tissues"] = toJson(*readTissueSet(resourceFolder() / "tissues" / "abdomen-labels.json"));
    ASSERT_TRUE(parseExercise(json, seedFile("seed-liver.json")).ok());
    bad.change(json);
    const Result<Exercise> exercise = parseExercise(json, seedFile("seed-liver.json"));
    ASSERT_FALSE(exercise.ok()) << bad.name;
    const Error& error = exercise.error();
    EXPECT_NE(error.where.find("seed-liver.json: touch_by_points"), std::string::npos)
        << bad.name << ": " << error.sentence();
    EXPECT_NE(error.what.find(bad.field), std::string::npos)
        << bad.name << ": " << error.sentence();
    EXPECT_NE(error.next.find(bad.value), std::string::npos)
        << bad.name << ": " << error.sentence();
  }
}

// Longer than the system lets names be: asking about it is an error of its own.
TEST(Exercise, AFileNameThatCannotBeIsAnErrorLikeAMissingFile) {
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
    const Result<Exercise> exercise = parseExercise(json, shippedFile());
    ASSERT_FALSE(exercise.ok()) << bad.name;
    EXPECT_NE(exercise.error().where.find(bad.field), std::string::npos) << exercise.error().sentence();
    EXPECT_NE(exercise.error().what.find(name), std::string::npos) << exercise.error().sentence();
  }
}

TEST(Exercise, IsWrittenWithEveryNumberThatItIsReadWith) {
  Json json = shipped();
  json["rate_hz"] = 2000.0;
  json["view"]["distance_mm"] = 123.0;
  json["landmarks"][0]["run_mm"] = 2.5;
  json["arms"][0]["max_force_N"] = 1.5;
  json["arms"][0]["map"]["motion_scale"] = 2.0;
  json["arms"][0]["map"]["force_scale"] = 0.5;
  json["arms"][0]["map"]["offset_mm"] = {1.0, 2.0, 3.0};
  const Result<Exercise> exercise = parseExercise(json, shippedFile());
  ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
  const Json written = toJson(*exercise);
  for (const char* at :
       {"/rate_hz", "/view/distance_mm", "/landmarks/0/run_mm", "/arms/0/max_force_N",
        "/arms/0/map/motion_scale", "/arms/0/map/force_scale", "/arms/0/map/offset_mm"}) {
    EXPECT_EQ(written.at(Json::json_pointer(at)), json.at(Json::json_pointer(at))) << at;
  }
}

TEST(Exercise, SaysHowTissuesLookAndIsWrittenWithIt) {
  Json json = shipped();
  json["view"]["looks"] = {{"bone", "ghosted"}, {"brain", "shown"}, {"dura", "hidden"}};
  Result<Exercise> exercise = parseExercise(json, shippedFile());
  ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
  EXPECT_EQ(exercise->view.looks, (TissueLooks{{"bone", TissueLook::ghosted},
                                            {"brain", TissueLook::shown},
                                            {"dura", TissueLook::hidden}}));
  EXPECT_EQ(toJson(*exercise)["view"]["looks"], json["view"]["looks"]);

  // Of the whole case, too: a view without a landmark.
  json["view"] = {{"looks", {{"bone", "hidden"}}}};
  exercise = parseExercise(json, shippedFile());
  ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
  EXPECT_EQ(exercise->view.landmark, "");
  EXPECT_EQ(toJson(*exercise)["view"], json["view"]);
}

TEST(Exercise, ANumberThatIsNotGivenIsAsThePageSays) {
  Json json = shipped();
  for (const char* key : {"rate_hz", "view"}) json.erase(key);
  json["arms"][0].erase("max_force_N");
  const Exercise exercise = *parseExercise(json, shippedFile());
  EXPECT_EQ(exercise.rate_hz, 1000.0);
  EXPECT_EQ(exercise.view.distance_mm, 350.0);
  EXPECT_EQ(exercise.arms[0].max_force_N, 3.3);
}

TEST(Exercise, ThePagesAreAsTheRowsAre) {
  const std::filesystem::path pages = resourceFolder() / "schemas";
  test::expectNumbers(pages / "scene.md", "scene", exerciseFieldsPage());
  test::expectNumbers(pages / "tool.md", "tool", toolFieldsPage());
}

TEST(Exercise, AMissingTissueFileIsNamed) {
  Json json = shipped();
  json["tissues"] = "../tissues/gone.json";
  const Result<Exercise> exercise = parseExercise(json, shippedFile());
  ASSERT_FALSE(exercise.ok());
  EXPECT_EQ(exercise.error().code.str(), "MISSING_FILE");
  EXPECT_NE(exercise.error().where.find("gone.json"), std::string::npos);
}

// An exercise beside a tool file of its own.
class ToolFile : public testing::Test {
 protected:
  void SetUp() override {
    exercise_["tools"] = Json::array({{{"id", "blade"}, {"file", "tool.json"}}});
    exercise_["operator"] = "";
    exercise_["tissues"] = (resourceFolder() / "tissues" / "cranium.json").string();
    for (Json& arm : exercise_["arms"]) arm.erase("other_tools");
    tool_ = *readJsonFile(resourceFolder() / "tools" / "blade.json");
    tool_["mesh"] = (resourceFolder() / "tools" / "blade.stl").string();
  }
  Result<Exercise> read() {
    std::ofstream(folder_ / "tool.json") << tool_.dump();
    return parseExercise(exercise_, folder_ / "scene.json");
  }
  void expectRefused(const char* field, const char* value) {
    const Result<Exercise> exercise = read();
    ASSERT_FALSE(exercise.ok()) << field;
    const std::string sentence = exercise.error().sentence();
    for (const char* part : {"scene.json", "tools[0].file", "tool.json", field, value}) {
      EXPECT_NE(sentence.find(part), std::string::npos) << part << ": " << sentence;
    }
  }

  test::TemporaryFolder folder_;
  Json exercise_ = shipped(), tool_;
};

TEST_F(ToolFile, IsReadBesideItsExercise) {
  const Result<Exercise> exercise = read();
  ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
  EXPECT_EQ(exercise->tools[0].look.axis, Vec3(1, 0, 0));
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

TEST_F(ToolFile, ThatIsNoObjectIsRefusedThoughTheExerciseSetsANumberOfItsOwn) {
  exercise_["tools"][0]["length_mm"] = 20;
  for (const Json& other : {Json::array(), Json(1e300), Json("x"), Json()}) {
    tool_ = other;
    expectRefused("", "");
  }
}

TEST(Exercise, FindsItsCaseBesideItselfAndABuiltInOneByName) {
  Json exercise = shipped();
  EXPECT_EQ(parseExercise(exercise, resourceFolder() / "scenes" / "scene.json")->case_source,
            "phantom:cranium");
  exercise["case"] = "../ct";
  exercise["tissues"] = (resourceFolder() / "tissues" / "cranium.json").string();
  const std::filesystem::path beside = resourceFolder() / "scenes" / "scene.json";
  EXPECT_EQ(parseExercise(exercise, beside)->case_source, (resourceFolder() / "ct").string());
}

TEST_F(ToolFile, HasAnAxisThatPointsSomewhere) {
  tool_["axis"] = {0, 0, 0};
  expectRefused("axis", "length of 0");
  tool_["axis"] = {1e9, 0, 0};
  expectRefused("axis", "1000000000.0");
}

TEST_F(ToolFile, ThatIsAPipeIsRefusedInsteadOfWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  exercise_["tools"][0]["file"] = "pipe.json";
  const Result<Exercise> exercise = parseExercise(exercise_, folder_ / "scene.json");
  ASSERT_FALSE(exercise.ok());
  const std::string sentence = exercise.error().sentence();
  EXPECT_NE(sentence.find("tools[0].file"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("pipe.json"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace trephine
