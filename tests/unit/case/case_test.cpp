// A case, and an exercise placed on it: without a session.
#include "case/case.h"

#include <gtest/gtest.h>

#include "base/system.h"
#include "case/placement.h"
#include "shells.h"

namespace trephine {
namespace {

Exercise cranium() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

TEST(Case, CanBeCancelledWhileItsLandmarksAreFound) {
  Progress* running = nullptr;
  Progress progress([&](double, const std::string&) { running->cancel(); });
  running = &progress;
  const Case of = caseOf(std::make_shared<const Volume>(test::shells(50, 2.0, {{44, -20}, {39, 1200}, {32, 35}})));
  Exercise exercise = cranium();
  const auto placed = place(exercise, of, progress);
  ASSERT_FALSE(placed.ok());
  EXPECT_EQ(placed.error().code.str(), "CANCELLED");
}

// Of a liver's exercise the landmark is the middle of a ball of 30 mm.
TEST(Case, ThatIsTooThinForTheLandmarksBallIsBegunAtItsSurface) {
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Volume thin;
  thin.geometry.size = {100, 80, 10};
  thin.geometry.spacing_mm = {2.0, 2.0, 3.0};
  thin.hu.assign(thin.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 10; ++k) {
    for (int j = 20; j < 60; ++j) {
      for (int i = 20; i < 80; ++i) thin.hu[thin.geometry.indexOf(i, j, k)] = 200;
    }
  }
  const Placement of = *place(exercise, caseOf(std::make_shared<const Volume>(std::move(thin))));
  ASSERT_FALSE(of.error) << of.error->sentence();
  ASSERT_EQ(of.warnings.size(), 2u);
  EXPECT_EQ(of.warnings[0].code.str(), "LACKS_STRUCTURE");
  EXPECT_EQ(of.warnings[1].code.str(), "NO_LANDMARK");
  // In front, y towards the back.
  EXPECT_NEAR(of.landmarks[0].frame.position_mm.y, 39.0, 2.0);
  EXPECT_GT(-(of.landmarks[0].frame.rotation * Vec3(0, 0, 1)).y, 0.7);
}

TEST(Case, ThatIsMissingIsNamed) {
  EXPECT_EQ(readCase("").error().code.str(), "NO_CASE");
  EXPECT_EQ(readCase("phantom:foot").error().code.str(), "UNKNOWN_PHANTOM");
  const auto missing = readCase("/no/such/folder");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().where.find("/no/such/folder"), std::string::npos);
}

TEST(Placement, LeavesTheExerciseAsItIsAndFollowsItsEdits) {
  const Exercise liver = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Exercise document = liver;
  const Placement placed = *place(document, *readCase("phantom:abdomen"));
  ASSERT_FALSE(placed.error) << placed.error->sentence();
  EXPECT_EQ(document, liver);
  EXPECT_FALSE(placed.elsewhere);
  EXPECT_FALSE(document.tissues.find("liver")->label) << "a label is the case's";
  EXPECT_EQ(placed.exercise.tissues.find("liver")->label, placed.labels->find("liver")->label);
  for (const ExerciseArm& arm : placed.exercise.arms) EXPECT_TRUE(arm.map.fixed);
  for (Tissue& tissue : document.tissues.tissues) tissue.opacity = 0.25;
  document.arms[0].map.offset_mm.z += 5.0;
  const Exercise edited = placedExercise(document, placed);
  EXPECT_EQ(edited.tissues.find("liver")->opacity, 0.25);
  EXPECT_EQ(edited.tissues.find("liver")->label, placed.exercise.tissues.find("liver")->label);
  EXPECT_NEAR(glm::length(edited.arms[0].map.fixed->centre_mm -
                          placed.exercise.arms[0].map.fixed->centre_mm),
              5.0, 1e-9);
  EXPECT_EQ(placedExercise(liver, placed), placed.exercise);
}

TEST(Placement, WithoutAStructureTheOtherSetIsInForceAndItsEditsAre) {
  const Exercise liver = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Case bare = *readCase("phantom:abdomen");
  bare.structures = nullptr;
  const Placement placed = *place(liver, bare);
  ASSERT_FALSE(placed.error) << placed.error->sentence();
  EXPECT_TRUE(placed.elsewhere);
  EXPECT_EQ(placed.exercise.tissues, *liver.tissues_elsewhere);
  Exercise document = liver;
  for (Tissue& tissue : document.tissues.tissues) tissue.opacity = 0.25;
  EXPECT_EQ(placedExercise(document, placed).tissues, *liver.tissues_elsewhere);
  for (Tissue& tissue : document.tissues_elsewhere->tissues) tissue.opacity = 0.5;
  EXPECT_EQ(placedExercise(document, placed).tissues.tissues.front().opacity, 0.5);
}

TEST(Exercise, OnAnotherCaseHasNoLabelMapOfItsOwn) {
  Exercise exercise = cranium();
  exercise.case_source = "phantom:cranium";
  exercise.labels_file = "labels.nii";
  exercise = onCase(exercise, "phantom:cranium");
  EXPECT_EQ(exercise.labels_file, "labels.nii");
  exercise = onCase(exercise, "");
  EXPECT_EQ(exercise.labels_file, "");
  EXPECT_FALSE(toJson(exercise).contains("case")) << "a recording must not name another case";
  exercise.labels_file = "of the case that is given.nii";
  exercise = onCase(exercise, "head.mha");
  EXPECT_EQ(exercise.labels_file, "of the case that is given.nii");
}

}  // namespace
}  // namespace trephine
