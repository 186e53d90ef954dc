#include "machine/exercise/explain.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

// Soft tissue that was measured in part, under one arm and laws that use some of its numbers.
Exercise measuredExercise() {
  Exercise exercise;
  exercise.name = "measured";
  exercise.tissues = startingSet("Mine");
  Tissue& soft = exercise.tissues.tissues[1];
  soft.friction_N = {0.5, "a paper", {{0.2, 0.4}}, Confidence::measured, "pig, 37 degrees"};
  soft.rupture_N = SourcedNumber{2.5, "a thesis", {{2.2, 3.3}}, Confidence::second_hand};
  exercise.tools.push_back({"needle", makeBlade(0.008, 4), {}});
  ExerciseArm arm;
  arm.name = "right";
  arm.tool = "needle";
  arm.map.fixed = WorkspaceMap{};
  exercise.arms.push_back(arm);
  exercise.laws = {LawKind::coulomb};
  return exercise;
}

// What is explained of a number of the soft tissue; null: nothing.
Json explainedOf(const Exercise& exercise, const std::string& number) {
  for (const Json& item : usedNumbers(exercise)) {
    if (item["tissue"] == "soft" && item["number"] == number) return item;
  }
  return nullptr;
}

TEST(Explain, SaysOfEachNumberThatTheLawsUseWhereItComesFromAndWhatIsKnownOfIt) {
  EXPECT_EQ(explainedOf(measuredExercise(), "friction_N"),
            Json::parse(R"json({"tissue": "soft", "number": "friction_N", "unit": "N", "value": 0.5,
                            "source": "a paper", "range": [0.2, 0.4], "confidence": "measured",
                            "condition": "pig, 37 degrees",
                            "text": "Friction 0.5 N, from: a paper; outside the published 0.2 to 0.4 N, by a factor of 1.25 (measured; pig, 37 degrees)"})json"));
  EXPECT_EQ(explainedOf(measuredExercise(), "stiffness_N_per_m"),
            Json::parse(R"({"tissue": "soft", "number": "stiffness_N_per_m", "unit": "N/m",
                            "value": 120.0, "source": "tuned here, uncited", "confidence": "tuned",
                            "text": "Stiffness 120 N/m, from: tuned here, uncited"})"));
}

TEST(Explain, SaysNothingOfANumberThatNoLawUses) {
  Exercise exercise = measuredExercise();
  EXPECT_TRUE(explainedOf(exercise, "rupture_N").is_null());
  EXPECT_TRUE(explainedOf(exercise, "damping_Ns_per_m").is_null());
  EXPECT_TRUE(explainedOf(exercise, "toughness_J_per_m2").is_null()) << "nor of one not given";
  exercise.laws = {LawKind::membrane};
  EXPECT_FALSE(explainedOf(exercise, "rupture_N").is_null());
  EXPECT_TRUE(explainedOf(exercise, "friction_N").is_null());
}

TEST(Explain, SaysWhatCuttingCostsWhereRemovalGoesByIt) {
  Exercise exercise = measuredExercise();
  EXPECT_EQ(explainedOf(exercise, "cutting_J_per_mm3")["text"],
            "Cutting 0.01 mJ/mm\u00b3, from: tuned here, uncited");
  exercise.removal = RemovalKind::instant;
  EXPECT_TRUE(explainedOf(exercise, "cutting_J_per_mm3").is_null());
  exercise.removal = RemovalKind::work;
  exercise.tissues.tissues[1].cuttable = false;
  EXPECT_TRUE(explainedOf(exercise, "cutting_J_per_mm3").is_null());
}

TEST(Explain, TellsAPersonTheSameInLines) {
  Result<Json> explained = explainExercise(measuredExercise(), {});
  ASSERT_TRUE(explained.ok()) << explained.error().sentence();
  EXPECT_EQ(explained->at("numbers"), usedNumbers(measuredExercise()));
  (*explained)["locks"] = Json::array();
  (*explained)["refused"] = nullptr;
  const std::string text = explanationText(*explained);
  for (const char* line : {"    soft: Friction 0.5 N, from: a paper; outside the published 0.2 to "
                           "0.4 N, by a factor of 1.25 (measured;",
                           "    bone: Friction 2 N, from: tuned here, uncited\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace trephine
