#include "scene/scene_edits.h"

#include <gtest/gtest.h>

#include <random>

#include "base/system.h"
#include "scene/scene_numbers.h"
#include "scene/tissue_shares.h"
#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

Scene cranium() {
  Result<Scene> scene = readScene(resourceFolder() / "scenes" / "cranium.json");
  EXPECT_TRUE(scene.ok());
  return *std::move(scene);
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

TEST(SceneHistory, TakesBackAndDoesAgainStepByStep) {
  const Scene first = cranium();
  SceneHistory history;
  history.begin(first);
  EXPECT_FALSE(history.canUndo());
  Scene second = first;
  second.tissues.tissues[0].hu_min -= 1;
  history.note(second, "a");
  Scene third = second;
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

TEST(SceneHistory, ADragIsOneStepUntilItIsClosedAndNothingIsNone) {
  const Scene first = cranium();
  SceneHistory history;
  history.begin(first);
  Scene scene = first;
  history.note(scene, "threshold");
  EXPECT_FALSE(history.canUndo());
  for (int n = 0; n < 5; ++n) {
    scene.tissues.tissues[0].hu_min -= 1;
    history.note(scene, "threshold");
  }
  history.close();
  const Scene dragged = scene;
  scene.tissues.tissues[0].hu_min -= 1;
  history.note(scene, "threshold");
  EXPECT_TRUE(history.undo() == dragged);
  EXPECT_TRUE(history.undo() == first);
}

TEST(SceneHistory, AfterAStepBackAnotherEditForgetsWhatCouldBeDoneAgain) {
  Scene scene = cranium();
  SceneHistory history;
  history.begin(scene);
  scene.rate_hz = 2000;
  history.note(scene, "rate");
  scene = history.undo();
  scene.rate_hz = 4000;
  history.note(scene, "rate");
  EXPECT_FALSE(history.canRedo());
}

TEST(Scene, IsAnotherByItsFilesMeshesAndTissuesElsewhere) {
  const Scene scene = cranium();
  ASSERT_FALSE(scene.tools.empty());
  for (const auto& change : std::vector<void (*)(Scene&)>{
           [](Scene& s) { s.operator_file += "x"; },
           [](Scene& s) { s.tools[0].look.mesh = "other.stl"; },
           [](Scene& s) { s.arms[0].map.offset_mm.z += 1.0; },
           [](Scene& s) { s.tissues_elsewhere = s.tissues; }, [](Scene& s) { s.card.reset(); },
           [](Scene& s) { s.locks.insert(Lock::tissues); }}) {
    Scene other = scene;
    change(other);
    EXPECT_NE(scene, other);
  }
}

TEST(SceneFile, IsReadAsWhatWasWrittenAndWrittenAgainInTheSameBytes) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "scenes")) {
    const Result<Scene> scene = readScene(entry.path());
    ASSERT_TRUE(scene.ok()) << entry.path();
    const std::string written = sceneFile(*scene).dump(1);
    const Result<Scene> again = parseScene(Json::parse(written), "/nowhere/scene.json");
    ASSERT_TRUE(again.ok()) << again.error().sentence();
    Scene expected = *scene;  // the file of the set for elsewhere is in it now
    EXPECT_TRUE(*again == expected) << entry.path();
    EXPECT_EQ(sceneFile(*again).dump(1), written) << entry.path();
    EXPECT_TRUE(checkEdited(*scene).ok());
    ++scenes;
  }
  EXPECT_GE(scenes, 7);
}

TEST(SceneFile, AnEditIsHeldToTheRulesOfAFile) {
  const Scene scene = cranium();
  const auto wrong = [&](void (*edit)(Scene&)) {
    Scene edited = scene;
    edit(edited);
    const Status status = checkEdited(edited);
    EXPECT_FALSE(status.ok());
    return status ? std::string() : status.error().where + ": " + status.error().what;
  };
  EXPECT_NE(wrong([](Scene& s) { s.arms[0].map.motion_scale = 1e4; }).find("motion_scale"),
            std::string::npos);
  EXPECT_NE(wrong([](Scene& s) { s.arms[0].tool = "spoon"; }).find("spoon"), std::string::npos);
  EXPECT_NE(wrong([](Scene& s) { s.tools[0].look.mesh = "/nowhere.stl"; }).find("nowhere"),
            std::string::npos);
  EXPECT_NE(wrong([](Scene& s) { s.view.landmark = "moon"; }).find("moon"), std::string::npos);
  EXPECT_NE(wrong([](Scene& s) { s.card->en.goal = ""; }).find("goal"), std::string::npos);
  Scene edited = scene;
  edited.arms[1].name = edited.arms[0].name;
  const Error error = checkEdited(edited).error();
  EXPECT_EQ(error.next.find("schema"), std::string::npos) << "nobody wrote a file: " << error.next;
}

TEST(MovedTo, AnArmThatIsFixedStaysWhereItIsAndBackAtItsLandmarkAsWell) {
  Scene scene = cranium();
  scene.arms[0].map.offset_mm = Vec3(3.0, -4.0, 12.0);
  const LandmarkFrame frame{Vec3(10.0, 20.0, 30.0), glm::angleAxis(0.7, Vec3(0.0, 1.0, 0.0))};
  const LandmarkFrame other{Vec3(1.0, 2.0, 3.0), glm::angleAxis(0.2, Vec3(1.0, 0.0, 0.0))};
  const std::vector<PlacedLandmark> placed{{"vault", frame}, {"side", other}};
  const Vec3 at_mm = withFixedMaps(scene, placed).arms[0].map.fixed->centre_mm;
  scene.arms[0].map = movedTo(scene, 0, "", placed);
  ASSERT_TRUE(scene.arms[0].map.fixed);
  EXPECT_TRUE(scene.arms[0].map.landmark.empty());
  EXPECT_EQ(scene.arms[0].map.fixed->centre_mm, at_mm);
  EXPECT_TRUE(checkEdited(scene).ok());
  const Result<Scene> read = parseScene(sceneFile(scene), "x.json");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(sceneFile(*read).dump(), sceneFile(scene).dump()) << "byte for byte";
  scene.arms[0].map = movedTo(scene, 0, "side", placed);
  EXPECT_FALSE(scene.arms[0].map.fixed);
  const Vec3 back_mm = withFixedMaps(scene, placed).arms[0].map.fixed->centre_mm;
  EXPECT_LT(glm::length(back_mm - at_mm), 1e-9);
  // From a landmark to another it goes along.
  const Vec3 offset_mm = scene.arms[0].map.offset_mm;
  scene.arms[0].map = movedTo(scene, 0, "vault", placed);
  EXPECT_EQ(scene.arms[0].map.offset_mm, offset_mm);
}

TEST(WithTissues, ALandmarkWhoseTissueIsGoneTakesASolidOneAndThatIsSaid) {
  const Scene scene = cranium();
  ASSERT_FALSE(scene.landmarks.empty());
  TissueSet set = startingSet("Mine");
  set.tissues[0].id = "hard";
  set.tissues[0].name = "Hard";
  const NewTissues changed = withTissues(scene, set);
  for (const Landmark& landmark : changed.scene.landmarks) EXPECT_EQ(landmark.tissue, "hard");
  ASSERT_EQ(changed.notes.size(), scene.landmarks.size());
  EXPECT_NE(changed.notes[0].find("Hard"), std::string::npos);
  for (const auto& [id, look] : changed.scene.view.looks) EXPECT_TRUE(set.find(id));
  // What one reads is a scene again.
  EXPECT_TRUE(parseScene(toJson(changed.scene), resourceFolder() / "scenes" / "x.json").ok());
  EXPECT_TRUE(withTissues(scene, scene.tissues).notes.empty());
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
