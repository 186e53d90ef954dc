#include "exercise/exercise_structures.h"

#include <gtest/gtest.h>

#include "base/system.h"
#include "exercise/codes.h"

namespace trephine {
namespace {

Exercise liverExercise() {
  return *readExercise(resourceFolder() / "scenes" / "liver.json");
}

// A block of liver under this label, with a kidney.
std::shared_ptr<const LabelMap> caseWith(int liver, const std::string& name = "Liver") {
  LabelMap map;
  map.geometry.size = {20, 20, 20};
  map.labels.resize(map.geometry.voxelCount());
  for (std::size_t v = 0; v < map.labels.size(); ++v) {
    const Index3 at = map.geometry.indicesOf(v);
    const bool inside =
        at[0] >= 5 && at[0] < 15 && at[1] >= 5 && at[1] < 15 && at[2] >= 5 && at[2] < 15;
    map.labels[v] = inside ? std::uint8_t(liver) : at[0] == 0 ? 3 : 0;
  }
  map.structures = {{liver, name, Vec3(1.0)}, {3, "kidney", Vec3(1.0)}};
  return std::make_shared<const LabelMap>(std::move(map));
}

// What is in force, with its labels.
TissueSet inForce(const Exercise& exercise, const PlacedStructures& placed) {
  TissueSet set = placed.elsewhere ? *exercise.tissues_elsewhere : exercise.tissues;
  placeTissues(set, placed.labels.get());
  return set;
}

TEST(ExerciseStructures, TissuesAreFoundByNameWhateverTheCasesNumber) {
  for (const int number : {1, 5, 200}) {
    Exercise exercise = liverExercise();
    const auto placed = placeStructures(exercise, caseWith(number));
    ASSERT_TRUE(placed) << placed.error().sentence();
    const TissueSet tissues = inForce(exercise, *placed);
    EXPECT_EQ(tissues.find("liver")->label, number);
    EXPECT_TRUE(placed->warnings.empty());
    EXPECT_TRUE(validate(tissues, "").ok());
    EXPECT_EQ(exercise, liverExercise()) << "the exercise itself stays as it is";
  }
}

TEST(ExerciseStructures, TheCapsuleIsAShellWhereTheCaseHasNone) {
  Exercise exercise = liverExercise();
  const auto of = caseWith(5);
  const auto placed = placeStructures(exercise, of);
  ASSERT_TRUE(placed);
  const Structure* capsule = placed->labels->find("capsule");
  ASSERT_TRUE(capsule);
  EXPECT_EQ(inForce(exercise, *placed).find("capsule")->label, capsule->label);
  const auto& labels = placed->labels->labels;
  EXPECT_EQ(std::count(labels.begin(), labels.end(), capsule->label), 1000 - 512);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 5), 512);
  EXPECT_EQ(of->find("capsule"), nullptr) << "the case itself stays as it is";
  EXPECT_EQ(withShells(exercise.tissues, placed->labels), placed->labels) << "there is one now";
}

TEST(ExerciseStructures, ATissueOfAStructureThatIsNotNeededIsNowhereWithoutIt) {
  Exercise exercise = liverExercise();
  const auto placed = placeStructures(exercise, caseWith(5));
  ASSERT_TRUE(placed);
  const TissueSet tissues = inForce(exercise, *placed);
  const TissueTable table = tissueTable(tissues);
  const int vessel = int(tissues.find("vessel") - tissues.tissues.data());
  for (int hu = -1000; hu < 2000; hu += 50) {
    for (const std::uint8_t label : placed->labels->labels) {
      ASSERT_NE(classify(table, hu, label), vessel);
    }
  }
}

TEST(ExerciseStructures, WithoutTheLiverTissueIsToldByHuAndThatIsSaid) {
  for (const auto& of : {std::shared_ptr<const LabelMap>(), caseWith(5, "Leber")}) {
    Exercise exercise = liverExercise();
    const auto placed = placeStructures(exercise, of);
    ASSERT_TRUE(placed);
    ASSERT_EQ(placed->warnings.size(), 1u);
    EXPECT_EQ(placed->warnings[0].code.str(), "LACKS_STRUCTURE");
    EXPECT_NE(placed->warnings[0].text.find("'liver'"), std::string::npos);
    EXPECT_TRUE(placed->elsewhere);
    for (const Tissue& t : inForce(exercise, *placed).tissues) EXPECT_TRUE(t.isAnywhere()) << t.id;
  }
}

// A row of a list without a voxel is none.
TEST(ExerciseStructures, AnEmptyStructureIsNone) {
  Exercise exercise = liverExercise();
  auto map = *caseWith(5);
  std::replace(map.labels.begin(), map.labels.end(), std::uint8_t(5), std::uint8_t(0));
  const auto placed = placeStructures(exercise, std::make_shared<const LabelMap>(map));
  ASSERT_TRUE(placed);
  EXPECT_EQ(placed->warnings.size(), 1u);
}

TEST(ExerciseStructures, WithNeitherStructureNorHuTheExerciseIsRefused) {
  Exercise exercise = liverExercise();
  exercise.tissues_elsewhere.reset();
  const auto placed = placeStructures(exercise, nullptr);
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().code.str(), "NO_STRUCTURE");
  EXPECT_NE(placed.error().what.find("'liver'"), std::string::npos);
}

TEST(ExerciseStructures, WhatIsNeededThoughNoTissueIsToldByItIsWarnedOf) {
  Exercise exercise = liverExercise();
  exercise.structures.push_back("phantom");
  const auto placed = placeStructures(exercise, caseWith(5));
  ASSERT_TRUE(placed);
  EXPECT_FALSE(placed->elsewhere);
  ASSERT_EQ(placed->warnings.size(), 1u);
  EXPECT_EQ(placed->warnings[0].code, code::kLacksStructure);
  EXPECT_NE(placed->warnings[0].text.find("'phantom', which the exercise needs"),
            std::string::npos);
}

TEST(ExerciseStructures, AFileHasNoLabelsOfACaseAndARecordingHas) {
  Exercise exercise = liverExercise();
  const auto placed = placeStructures(exercise, caseWith(5));
  ASSERT_TRUE(placed);
  EXPECT_TRUE(toJson(inForce(exercise, *placed)).dump().find("\"label\"") != std::string::npos);
  EXPECT_EQ(toJson(exercise.tissues).dump().find("\"label\""), std::string::npos);
}

// A number is one of a single label map, a name of any.
TEST(ExerciseStructures, OnlyNumbersAreLeftBehindOnAnotherCase) {
  Exercise named = liverExercise(), numbered = liverExercise();
  numbered.tissues.tissues[2].structure.clear();
  numbered.tissues.tissues[2].label = 1;
  named = onCase(named, "/some/ct");
  numbered = onCase(numbered, "/some/ct");
  EXPECT_FALSE(named.tissues.find("liver")->structure.empty());
  EXPECT_TRUE(numbered.tissues.find("liver")->isAnywhere());
}

}  // namespace
}  // namespace trephine
