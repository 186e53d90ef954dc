#include "scene/scene_structures.h"

#include <gtest/gtest.h>

#include "base/system.h"

namespace trephine {
namespace {

Scene liverScene() {
  return *readScene(resourceFolder() / "scenes" / "liver.json");
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
TissueSet inForce(const Scene& scene, const PlacedStructures& placed) {
  TissueSet set = placed.elsewhere ? *scene.tissues_elsewhere : scene.tissues;
  placeTissues(set, placed.labels.get());
  return set;
}

TEST(SceneStructures, TissuesAreFoundByNameWhateverTheCasesNumber) {
  for (const int number : {1, 5, 200}) {
    Scene scene = liverScene();
    const auto placed = placeStructures(scene, caseWith(number));
    ASSERT_TRUE(placed) << placed.error().sentence();
    const TissueSet tissues = inForce(scene, *placed);
    EXPECT_EQ(tissues.find("liver")->label, number);
    EXPECT_TRUE(placed->warnings.empty());
    EXPECT_TRUE(validate(tissues, "").ok());
    EXPECT_EQ(scene, liverScene()) << "the exercise itself stays as it is";
  }
}

TEST(SceneStructures, TheCapsuleIsAShellWhereTheCaseHasNone) {
  Scene scene = liverScene();
  const auto of = caseWith(5);
  const auto placed = placeStructures(scene, of);
  ASSERT_TRUE(placed);
  const Structure* capsule = placed->labels->find("capsule");
  ASSERT_TRUE(capsule);
  EXPECT_EQ(inForce(scene, *placed).find("capsule")->label, capsule->label);
  const auto& labels = placed->labels->labels;
  EXPECT_EQ(std::count(labels.begin(), labels.end(), capsule->label), 1000 - 512);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 5), 512);
  EXPECT_EQ(of->find("capsule"), nullptr) << "the case itself stays as it is";
  EXPECT_EQ(withShells(scene.tissues, placed->labels), placed->labels) << "there is one now";
}

TEST(SceneStructures, ATissueOfAStructureThatIsNotNeededIsNowhereWithoutIt) {
  Scene scene = liverScene();
  const auto placed = placeStructures(scene, caseWith(5));
  ASSERT_TRUE(placed);
  const TissueSet tissues = inForce(scene, *placed);
  const TissueTable table = tissueTable(tissues);
  const int vessel = int(tissues.find("vessel") - tissues.tissues.data());
  for (int hu = -1000; hu < 2000; hu += 50) {
    for (const std::uint8_t label : placed->labels->labels) {
      ASSERT_NE(classify(table, hu, label), vessel);
    }
  }
}

TEST(SceneStructures, WithoutTheLiverTissueIsToldByHuAndThatIsSaid) {
  for (const auto& of : {std::shared_ptr<const LabelMap>(), caseWith(5, "Leber")}) {
    Scene scene = liverScene();
    const auto placed = placeStructures(scene, of);
    ASSERT_TRUE(placed);
    ASSERT_EQ(placed->warnings.size(), 1u);
    EXPECT_EQ(placed->warnings[0].code, "LACKS_STRUCTURE");
    EXPECT_NE(placed->warnings[0].text.find("'liver'"), std::string::npos);
    EXPECT_TRUE(placed->elsewhere);
    for (const Tissue& t : inForce(scene, *placed).tissues) EXPECT_TRUE(t.isAnywhere()) << t.id;
  }
}

// A row of a list without a voxel is none.
TEST(SceneStructures, AnEmptyStructureIsNone) {
  Scene scene = liverScene();
  auto map = *caseWith(5);
  std::replace(map.labels.begin(), map.labels.end(), std::uint8_t(5), std::uint8_t(0));
  const auto placed = placeStructures(scene, std::make_shared<const LabelMap>(map));
  ASSERT_TRUE(placed);
  EXPECT_EQ(placed->warnings.size(), 1u);
}

TEST(SceneStructures, WithNeitherStructureNorHuTheExerciseIsRefused) {
  Scene scene = liverScene();
  scene.tissues_elsewhere.reset();
  const auto placed = placeStructures(scene, nullptr);
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().code, "NO_STRUCTURE");
  EXPECT_NE(placed.error().what.find("'liver'"), std::string::npos);
}

TEST(SceneStructures, AFileHasNoLabelsOfACaseAndARecordingHas) {
  Scene scene = liverScene();
  const auto placed = placeStructures(scene, caseWith(5));
  ASSERT_TRUE(placed);
  EXPECT_TRUE(toJson(inForce(scene, *placed)).dump().find("\"label\"") != std::string::npos);
  EXPECT_EQ(toJson(scene.tissues).dump().find("\"label\""), std::string::npos);
}

// A number is one of a single label map, a name of any.
TEST(SceneStructures, OnlyNumbersAreLeftBehindOnAnotherCase) {
  Scene named = liverScene(), numbered = liverScene();
  numbered.tissues.tissues[2].structure.clear();
  numbered.tissues.tissues[2].label = 1;
  named = onCase(named, "/some/ct");
  numbered = onCase(numbered, "/some/ct");
  EXPECT_FALSE(named.tissues.find("liver")->structure.empty());
  EXPECT_TRUE(numbered.tissues.find("liver")->isAnywhere());
}

}  // namespace
}  // namespace trephine
