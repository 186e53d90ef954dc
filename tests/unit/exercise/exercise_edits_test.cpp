#include "exercise/exercise_edits.h"

#include <gtest/gtest.h>

#include <random>

#include "base/system.h"
#include "exercise/exercise_fields.h"
#include "exercise/tissue_shares.h"
#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

Exercise cranium() {
  Result<Exercise> exercise = readExercise(resourceFolder() / "scenes" / "cranium.json");
  EXPECT_TRUE(exercise.ok());
  return *std::move(exercise);
}

TEST(MapTurn, IsTheRotationThatItCameFrom) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-180.0, 180.0);
  const auto apart = [](const Quat& a, const Quat& b) {
    return 1.0 - std::abs(glm::dot(a, b));  // q and -q are one
  };
  for (int n = 0; n < 2000; ++n) {
    const Quat rotation = rotationOf({{any(random), any(random), any(random)}});
    EXPECT_LT(apart(rotationOf(turnOf(rotation)), rotation), 1e-12);
  }
  for (const double y : {90.0, -90.0}) {
    const Quat rotation = rotationOf({{30.0, y, 50.0}});
    EXPECT_LT(apart(rotationOf(turnOf(rotation)), rotation), 1e-9);
  }
  const MapTurn turn = turnOf(rotationOf({{10.0, -20.0, 30.0}}));
  EXPECT_LT(glm::length(turn.turned_deg - Vec3(10.0, -20.0, 30.0)), 1e-9);
}

TEST(ExerciseHistory, TakesBackAndDoesAgainStepByStep) {
  const Exercise first = cranium();
  ExerciseHistory history;
  history.begin(first);
  EXPECT_FALSE(history.canUndo());
  Exercise second = first;
  second.tissues.tissues[0].hu_min -= 1;
  history.note(second, "a");
  Exercise third = second;
  third.rate_hz = 2000;
  history.note(third, "b");
  EXPECT_EQ(history.undoWhat(), "b");
  EXPECT_TRUE(history.undo() == second);
  EXPECT_TRUE(history.undo() == first);
  EXPECT_FALSE(history.canUndo());
  EXPECT_EQ(history.redoWhat(), "a");
  EXPECT_TRUE(history.redo() == second);
  EXPECT_TRUE(history.redo() == third);
  EXPECT_FALSE(history.canRedo());
}

TEST(ExerciseHistory, ADragIsOneStepUntilItIsClosedAndNothingIsNone) {
  const Exercise first = cranium();
  ExerciseHistory history;
  history.begin(first);
  Exercise exercise = first;
  history.note(exercise, "threshold");
  EXPECT_FALSE(history.canUndo());
  for (int n = 0; n < 5; ++n) {
    exercise.tissues.tissues[0].hu_min -= 1;
    history.note(exercise, "threshold");
  }
  history.close();
  const Exercise dragged = exercise;
  exercise.tissues.tissues[0].hu_min -= 1;
  history.note(exercise, "threshold");
  EXPECT_TRUE(history.undo() == dragged);
  EXPECT_TRUE(history.undo() == first);
}

TEST(ExerciseHistory, AfterAStepBackAnotherEditForgetsWhatCouldBeDoneAgain) {
  Exercise exercise = cranium();
  ExerciseHistory history;
  history.begin(exercise);
  exercise.rate_hz = 2000;
  history.note(exercise, "rate");
  exercise = history.undo();
  exercise.rate_hz = 4000;
  history.note(exercise, "rate");
  EXPECT_FALSE(history.canRedo());
}

TEST(Exercise, IsAnotherByItsFilesMeshesAndTissuesElsewhere) {
  const Exercise exercise = cranium();
  ASSERT_FALSE(exercise.tools.empty());
  for (const auto& change :
       std::vector<void (*)(Exercise&)>{[](Exercise& s) { s.operator_file += "x"; },
                                        [](Exercise& s) { s.tools[0].look.mesh = "other.stl"; },
                                        [](Exercise& s) { s.arms[0].map.offset_mm.z += 1.0; },
                                        [](Exercise& s) { s.tissues_elsewhere = s.tissues; },
                                        [](Exercise& s) { s.card.reset(); },
                                        [](Exercise& s) { s.locks.insert(Lock::tissues); }}) {
    Exercise other = exercise;
    change(other);
    EXPECT_NE(exercise, other);
  }
}

TEST(ExerciseFile, IsReadAsWhatWasWrittenAndWrittenAgainInTheSameBytes) {
  int exercises = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(resourceFolder() / "scenes")) {
    if (entry.is_directory()) continue;
    const Result<Exercise> exercise = readExercise(entry.path());
    ASSERT_TRUE(exercise.ok()) << entry.path();
    const std::string written = exerciseFile(*exercise).dump(1);
    const Result<Exercise> again = parseExercise(Json::parse(written), "/nowhere/scene.json");
    ASSERT_TRUE(again.ok()) << again.error().sentence();
    Exercise expected = *exercise;  // the file of the set for elsewhere is in it now
    EXPECT_TRUE(*again == expected) << entry.path();
    EXPECT_EQ(exerciseFile(*again).dump(1), written) << entry.path();
    EXPECT_TRUE(checkEdited(*exercise).ok());
    ++exercises;
  }
  EXPECT_GE(exercises, 7);
}

TEST(ExerciseFile, AnEditIsHeldToTheRulesOfAFile) {
  const Exercise exercise = cranium();
  const auto wrong = [&](void (*edit)(Exercise&)) {
    Exercise edited = exercise;
    edit(edited);
    const Status status = checkEdited(edited);
    EXPECT_FALSE(status.ok());
    return status ? std::string() : status.error().where + ": " + status.error().what;
  };
  EXPECT_NE(wrong([](Exercise& s) { s.arms[0].map.motion_scale = 1e4; }).find("motion_scale"),
            std::string::npos);
  EXPECT_NE(wrong([](Exercise& s) { s.arms[0].tool = "spoon"; }).find("spoon"), std::string::npos);
  EXPECT_NE(wrong([](Exercise& s) { s.tools[0].look.mesh = "/nowhere.stl"; }).find("nowhere"),
            std::string::npos);
  EXPECT_NE(wrong([](Exercise& s) { s.view.landmark = "moon"; }).find("moon"), std::string::npos);
  EXPECT_NE(wrong([](Exercise& s) { s.card->en.goal = ""; }).find("goal"), std::string::npos);
  Exercise edited = exercise;
  edited.arms[1].name = edited.arms[0].name;
  const Error error = checkEdited(edited).error();
  EXPECT_EQ(error.next.find("schema"), std::string::npos) << "nobody wrote a file: " << error.next;
}

TEST(MovedTo, AnArmThatIsFixedStaysWhereItIsAndBackAtItsLandmarkAsWell) {
  Exercise exercise = cranium();
  exercise.arms[0].map.offset_mm = Vec3(3.0, -4.0, 12.0);
  const LandmarkFrame frame{Vec3(10.0, 20.0, 30.0), glm::angleAxis(0.7, Vec3(0.0, 1.0, 0.0))};
  const LandmarkFrame other{Vec3(1.0, 2.0, 3.0), glm::angleAxis(0.2, Vec3(1.0, 0.0, 0.0))};
  const std::vector<PlacedLandmark> placed{{"vault", frame}, {"side", other}};
  const Vec3 at_mm = withFixedMaps(exercise, placed).arms[0].map.fixed->centre_mm;
  exercise.arms[0].map = movedTo(exercise, 0, "", placed);
  ASSERT_TRUE(exercise.arms[0].map.fixed);
  EXPECT_TRUE(exercise.arms[0].map.landmark.empty());
  EXPECT_EQ(exercise.arms[0].map.fixed->centre_mm, at_mm);
  EXPECT_TRUE(checkEdited(exercise).ok());
  const Result<Exercise> read = parseExercise(exerciseFile(exercise), "x.json");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(exerciseFile(*read).dump(), exerciseFile(exercise).dump()) << "byte for byte";
  exercise.arms[0].map = movedTo(exercise, 0, "side", placed);
  EXPECT_FALSE(exercise.arms[0].map.fixed);
  const Vec3 back_mm = withFixedMaps(exercise, placed).arms[0].map.fixed->centre_mm;
  EXPECT_LT(glm::length(back_mm - at_mm), 1e-9);
  // From a landmark to another it goes along.
  const Vec3 offset_mm = exercise.arms[0].map.offset_mm;
  exercise.arms[0].map = movedTo(exercise, 0, "vault", placed);
  EXPECT_EQ(exercise.arms[0].map.offset_mm, offset_mm);
}

TEST(WithTissues, ALandmarkWhoseTissueIsGoneTakesASolidOneAndThatIsSaid) {
  const Exercise exercise = cranium();
  ASSERT_FALSE(exercise.landmarks.empty());
  TissueSet set = startingSet("Mine");
  set.tissues[0].id = "hard";
  set.tissues[0].name = "Hard";
  const NewTissues changed = withTissues(exercise, set);
  for (const Landmark& landmark : changed.exercise.landmarks) EXPECT_EQ(landmark.tissue, "hard");
  ASSERT_EQ(changed.notes.size(), exercise.landmarks.size());
  EXPECT_NE(changed.notes[0].find("Hard"), std::string::npos);
  for (const auto& [id, look] : changed.exercise.view.looks) EXPECT_TRUE(set.find(id));
  // What one reads is an exercise again.
  EXPECT_TRUE(parseExercise(toJson(changed.exercise), resourceFolder() / "scenes" / "x.json").ok());
  EXPECT_TRUE(withTissues(exercise, exercise.tissues).notes.empty());
}

TEST(WithTissues, WhatWasTouchedByPointsAndIsGoneIsSaid) {
  const auto file = resourceFolder() / "scenes" / "research" / "seed-liver.json";
  Exercise exercise = *readExercise(file);
  const auto without = [](const Exercise& of, const std::string& id) {
    TissueSet set = of.tissues;
    std::erase_if(set.tissues, [&](const Tissue& tissue) { return tissue.id == id; });
    return withTissues(of, set);
  };
  const NewTissues fewer = without(exercise, "capsule");
  EXPECT_EQ(fewer.exercise.touch_by_points, std::vector<std::string>{"liver"});
  EXPECT_EQ(std::ranges::count(fewer.notes, "Tools touch fewer tissues by their points now"), 1);
  EXPECT_TRUE(checkEdited(fewer.exercise).ok());
  const NewTissues none = without(fewer.exercise, "liver");
  EXPECT_TRUE(none.exercise.touch_by_points.empty());
  EXPECT_EQ(
      std::ranges::count(none.notes, "Tools touch all tissues now, and not by their points alone"),
      1);
  EXPECT_TRUE(withTissues(exercise, exercise.tissues).notes.empty());
}

TEST(WithTissues, WhatLayInsideOfATissueThatIsGoneIsSaid) {
  const Exercise exercise = cranium();
  const TissueSet& set = exercise.tissues;
  const auto wall = std::ranges::find(set.tissues, set.find("brain")->within, &Tissue::id);
  ASSERT_NE(wall, set.tissues.end());
  const auto less = withoutTissue(set, std::size_t(wall - set.tissues.begin()));
  ASSERT_TRUE(less);
  const std::vector<std::string> notes = withTissues(exercise, *less).notes;
  const auto said = std::ranges::count_if(notes, [&](const std::string& note) {
    return note.find("inside of " + wall->name) != std::string::npos;
  });
  const auto inside = std::ranges::count(set.tissues, wall->id, &Tissue::within);
  EXPECT_GT(inside, 0);
  EXPECT_EQ(said, inside);
}

TEST(TissueShares, EachVoxelIsOfOneTissueAndALabelGoesBeforeAnyVoxel) {
  HuHistogram histogram;
  histogram.low_hu = 0;
  histogram.high_hu = 3;
  histogram.voxel_mm3 = 500.0;
  histogram.voxels = 100;
  histogram.rows = {{0, {40, 30, 0, 10}}, {5, {0, 20, 0, 0}}};
  Tissue any, labelled;
  any.id = "any";
  any.hu_min = 1;
  any.hu_max = 3;
  labelled.id = "labelled";
  labelled.hu_min = 0;
  labelled.hu_max = 3;
  labelled.label = 5;
  const TissueShares shares = sharesOf({"", {any, labelled}}, histogram);
  EXPECT_EQ(shares.voxels, (std::vector<std::uint64_t>{40, 20}));
  EXPECT_EQ(shares.none, 40u);
  EXPECT_DOUBLE_EQ(shares.percent(0), 40.0);
  EXPECT_DOUBLE_EQ(shares.millilitres(1), 10.0);
}

}  // namespace
}  // namespace trephine
