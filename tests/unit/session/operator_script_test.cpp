#include "session/operator_script.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session_support.h"

namespace trephine {
namespace {

using test::cranium;

Json script() {
  return *parseJson(R"({"format": "trephine.operator", "version": 1, "name": "t",
    "hand": {"stiffness_N_per_m": 500, "damping_Ns_per_m": 4},
    "arms": [{"arm": "right", "waypoints": [{"t": 1, "at_mm": [0, 0, 10]}, {"t": 2, "at_mm": [0, 0, -10]}]}],
    "commands": [{"t": 0.5, "do": "pause"}, {"t": 0.7, "do": "resume"},
                 {"t": 1.5, "do": "tissues", "tissues": {"bone": {"damping_Ns_per_m": 3}}},
                 {"t": 1.6, "do": "controller", "controller": "off"}, {"t": 2, "do": "undo"}]})",
                    "script");
}

TEST(OperatorScript, EveryShippedExerciseHasOneThatFits) {
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(resourceFolder() / "scenes")) {
    if (entry.is_directory()) continue;
    const Exercise exercise = *readExercise(entry.path());
    const auto read = readOperatorScript(exercise.operator_file, exercise);
    ASSERT_TRUE(read.ok()) << read.error().sentence();
    EXPECT_EQ(read->hands.size(), exercise.arms.size());
    EXPECT_GT(read->duration_s(), 5.0);
  }
}

TEST(ScriptOperator, MovesTheHandInStraightLinesBetweenWaypoints) {
  Exercise exercise = cranium();
  const LandmarkFrame landmark{Vec3(10, 20, 30), frameAlong({0, 0, 1})};
  exercise = withFixedMaps(exercise, {{"vault", landmark}});
  ScriptOperator oper(*parseOperatorScript(script(), "s", exercise), exercise, {landmark, landmark});
  OperatorSetPoint hands[2];
  const double off_m = exercise.arms[1].map.offset_mm.z / 1000.0;  // the workspace stands off the bone
  for (auto [tick, z_m] : {std::pair{0, 0.010}, {1000, 0.010}, {1500, 0.0}, {2000, -0.010}, {9000, -0.010}}) {
    oper.setPoints(std::uint64_t(tick), hands, 2);
    EXPECT_NEAR(hands[1].pose_m.position.z, z_m - off_m, 1e-12) << tick;
    EXPECT_EQ(hands[1].stiffness_N_per_m, 500);
    EXPECT_EQ(hands[0].pose_m.position, Vec3(0.0)) << "an arm without waypoints rests";
  }
}

TEST(ScriptOperator, GivesEachCommandOnceAtItsTime) {
  Exercise exercise = withFixedMaps(cranium(), {{"vault", {}}});
  ScriptOperator oper(*parseOperatorScript(script(), "s", exercise), exercise, {{}, {}});
  std::vector<std::pair<std::uint64_t, CommandKind>> given;
  Command command;
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    while (oper.command(tick, command)) {
      given.emplace_back(tick, command.kind);
      if (command.kind == CommandKind::tissues) {
        EXPECT_EQ(command.tissues->classes[3].damping_Ns_per_m, 3.0);
        EXPECT_EQ(command.tissues->classes[3].stiffness_N_per_m, 900.0) << "the rest stays";
      }
    }
  }
  const std::vector<std::pair<std::uint64_t, CommandKind>> expected{
      {500, CommandKind::pause},  {700, CommandKind::resume}, {1500, CommandKind::tissues},
      {1600, CommandKind::controller}, {2000, CommandKind::undo}};
  EXPECT_EQ(given, expected);
}

TEST(OperatorScript, ChangesEachNumberThatATissueHasAndNoOther) {
  const Exercise plain = cranium();
  Exercise whole = plain;
  for (const TissueNumber& number : kTissueNumbers) {
    Tissue& bone = whole.tissues.tissues[3];
    if (!number.of(bone)) number.set(bone, {1.0, "made up"});
  }
  for (const TissueNumber& number : kTissueNumbers) {
    // Of the two that say what cutting costs, a tissue has one.
    number.set(whole.tissues.tissues[3], {1.0, "made up"});
    const TissueTable before = tissueTable(whole.tissues);
    const double value = std::min(77.0, 0.5 * number.greatest);
    Json json = script();
    json["commands"][2]["tissues"] = {{"bone", {{number.key, value}}}};
    const auto read = parseOperatorScript(json, "script.json", whole);
    ASSERT_TRUE(read.ok()) << read.error().sentence();
    TissueTable expected = before;
    expected.classes[3].*number.in_tick = value;
    EXPECT_EQ(*read->commands[2].command.tissues, expected) << number.key;

    const auto plainly = parseOperatorScript(json, "script.json", plain);
    const bool has = number.of(plain.tissues.tissues[3]);
    ASSERT_EQ(plainly.ok(), has) << number.key;
    if (has) continue;
    const std::string sentence = plainly.error().sentence();
    EXPECT_NE(sentence.find(std::string("commands[2].tissues.bone.") + number.key),
              std::string::npos)
        << sentence;
  }
}

TEST(OperatorScript, NamesWhatIsWrong) {
  const Exercise exercise = cranium();
  struct Bad {
    void (*change)(Json&);
    const char* field;
    const char* value;
  };
  const Bad cases[] = {
      {[](Json& s) { s["arms"][0]["arm"] = "third"; }, "arms[0].arm", "third"},
      {[](Json& s) { s["arms"][0]["waypoints"][1]["t"] = 0.5; }, "waypoints[1].t", "0.5"},
      {[](Json& s) { s["arms"][0]["waypoints"] = Json::array(); }, "waypoints", "waypoint"},
      {[](Json& s) { s["commands"][0]["do"] = "dance"; }, "commands[0].do", "dance"},
      {[](Json& s) {
         s["commands"][2]["tissues"] = {{"cheese", {{"yield_N", 1}}}};
       },
       "cheese", "cheese"},
      {[](Json& s) { s["commands"][2]["tissues"]["bone"]["damping_Ns_per_m"] = -1; },
       "bone.damping_Ns_per_m", "-1"},
      {[](Json& s) { s["commands"][3]["controller"] = "pid"; }, "controller", "pid"},
      {[](Json& s) { s["arms"].push_back(s["arms"][0]); }, "arms[1].arm", "right"},
      {[](Json& s) {
         s["commands"][2]["tissues"]["bone"] = {{"hu_min", 4294967596}};
       },
       "bone.hu_min", "4294967596"},
      {[](Json& s) { s["hand"]["stiffness_N_per_m"] = 1e9; }, "hand.stiffness_N_per_m",
       "1000000000.0"},
      {[](Json& s) { s["hand"]["damping_Ns_per_m"] = -1; }, "hand.damping_Ns_per_m", "-1"},
      {[](Json& s) { s["arms"][0]["waypoints"][0]["t"] = -1; }, "waypoints[0].t", "-1"},
      {[](Json& s) { s["arms"][0]["waypoints"][1]["t"] = 1e300; }, "waypoints[1].t", "1e+300"},
      {[](Json& s) { s["arms"][0]["waypoints"][0]["at_mm"][2] = 1e308; }, "waypoints[0].at_mm",
       "1e+308"},
      {[](Json& s) { s["commands"][0]["t"] = -0.5; }, "commands[0].t", "-0.5"},
      {[](Json& s) {
         s["commands"][0] = {{"t", 0.5}, {"do", "rewind"}, {"to_s", 1}};
       },
       "commands[0].to_s", "1"},
      {[](Json& s) { s["commands"][0]["t"] = 5; }, "commands[1].t", "order"},
      {[](Json& s) { s["version"] = 9; }, "version", "9"},
  };
  for (const Bad& bad : cases) {
    Json json = script();
    bad.change(json);
    const auto read = parseOperatorScript(json, "script.json", exercise);
    ASSERT_FALSE(read.ok()) << bad.field;
    EXPECT_NE(read.error().where.find(bad.field), std::string::npos) << read.error().sentence();
    EXPECT_NE(read.error().what.find(bad.value), std::string::npos) << read.error().sentence();
  }
}

TEST(OperatorScript, ChangesNothingThatIsLocked) {
  const Exercise exercise = cranium();
  Json json = script();
  json["commands"] = Json::array({{{"t", 0.5}, {"do", "controller"}, {"controller", "off"}}});
  const auto off = *parseOperatorScript(json, "script.json", exercise);
  EXPECT_TRUE(checkLocks(off, {}));
  EXPECT_TRUE(checkLocks(off, {Lock::tissues, Lock::rate}));
  ASSERT_FALSE(checkLocks(off, {Lock::controller}));
  EXPECT_EQ(checkLocks(off, {Lock::controller}).error().code.str(), "LOCKED");
  json["commands"] = Json::array(
      {{{"t", 0.5}, {"do", "tissues"}, {"tissues", {{"bone", {{"damping_Ns_per_m", 1}}}}}}});
  const auto softer = *parseOperatorScript(json, "script.json", exercise);
  EXPECT_TRUE(checkLocks(softer, {Lock::controller, Lock::rate}));
  EXPECT_FALSE(checkLocks(softer, {Lock::tissues}));
  json["commands"] = Json::array({{{"t", 0.5}, {"do", "undo"}}});
  EXPECT_TRUE(checkLocks(*parseOperatorScript(json, "script.json", exercise),
                         {Lock::controller, Lock::tissues, Lock::rate}));
}

TEST(OperatorScript, ClutchesAnArmAndTurnsItsMapInLandmarkAxes) {
  Exercise exercise = withFixedMaps(cranium(), {{"vault", {}}});
  Json json = script();
  json["commands"] = *parseJson(
      R"([{"t": 1, "do": "clutch_on", "arm": "right"},
          {"t": 2, "do": "clutch_off", "arm": "right", "rotation_xyzw": [0, 0, 0.6, 0.8]},
          {"t": 3, "do": "clutch_off", "arm": "left"}, {"t": 4, "do": "recentre", "arm": "left"}])",
      "commands");
  const auto read = parseOperatorScript(json, "s", exercise);
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  const LandmarkFrame turned{Vec3(0.0), Quat(0.8, 0.0, 0.0, 0.6)};
  ScriptOperator oper(*read, exercise, {turned, turned});
  std::vector<Command> given;
  Command command;
  while (oper.command(5000, command)) given.push_back(command);
  ASSERT_EQ(given.size(), 4u);
  EXPECT_EQ(given[0].kind, CommandKind::clutch_on);
  EXPECT_EQ(given[0].arm, 1);
  EXPECT_EQ(given[1].value, 1);
  EXPECT_NEAR(given[1].rotation.z, 2.0 * 0.6 * 0.8, 1e-12) << "of the landmark, then its own";
  EXPECT_EQ(given[2].kind, CommandKind::clutch_off);
  EXPECT_EQ(given[2].value, 0) << "keeps its rotation";
  EXPECT_EQ(given[3].kind, CommandKind::recentre);
  EXPECT_EQ(given[3].arm, 0);
}

TEST(OperatorScript, GivesAnArmAnotherOfItsToolsByName) {
  Json json = script();
  json["commands"] = *parseJson(
      R"([{"t": 1, "do": "tool", "arm": "right", "tool": "burr"},
          {"t": 2, "do": "tool", "arm": "right", "tool": "blade"}])",
      "commands");
  const auto read = parseOperatorScript(json, "s", cranium());
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  ASSERT_EQ(read->commands.size(), 2u);
  EXPECT_EQ(read->commands[0].command.kind, CommandKind::tool);
  EXPECT_EQ(read->commands[0].command.arm, 1);
  EXPECT_EQ(read->commands[0].command.value, 2);
  EXPECT_EQ(read->commands[1].command.value, 0);
  for (const char* wrong : {R"([{"t": 1, "do": "tool", "arm": "right", "tool": "spoon"}])",
                            R"([{"t": 1, "do": "tool", "arm": "third", "tool": "blade"}])",
                            R"([{"t": 1, "do": "tool", "arm": "right"}])"}) {
    json["commands"] = *parseJson(wrong, "commands");
    EXPECT_FALSE(parseOperatorScript(json, "s", cranium()).ok()) << wrong;
  }
}

TEST(OperatorScript, RefusesAClutchOfNoArmAndARotationThatIsNone) {
  const Exercise exercise = cranium();
  for (const char* wrong :
       {R"([{"t": 1, "do": "clutch_on"}])", R"([{"t": 1, "do": "clutch_on", "arm": "third"}])",
        R"([{"t": 1, "do": "clutch_off", "arm": "left",
                                 "rotation_xyzw": [0, 0, 0, 0.5]}])"}) {
    Json json = script();
    json["commands"] = *parseJson(wrong, "commands");
    EXPECT_FALSE(parseOperatorScript(json, "s", exercise).ok()) << wrong;
  }
}

}  // namespace
}  // namespace trephine
