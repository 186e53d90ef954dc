// Labels that change under a picture: other maps, boxes of one, other looks.
#include <random>

#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

namespace {

Tissue structure(int label, const Vec3& colour) {
  Tissue t = tissue("", -32768, 32767, colour, 0.9);
  t.id = "structure:" + std::to_string(label);
  t.label = label;
  return t;
}

TissueSet twoStructures() {
  TissueSet set = tissues();
  set.tissues.push_back(structure(4, Vec3(1, 0, 0)));
  set.tissues.push_back(structure(200, Vec3(0, 0, 1)));
  return set;
}

VoxelBox paint(LabelMap& map, const Index3& low, const Index3& high, int label) {
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) {
        map.labels[map.geometry.indexOf(i, j, k)] = std::uint8_t(label);
      }
    }
  }
  return {low, high};
}

std::shared_ptr<LabelMap> blankMap() {
  const GridGeometry g = ball().geometry;
  return std::make_shared<LabelMap>(LabelMap{g, std::vector<std::uint8_t>(g.voxelCount())});
}

Picture fresh(const std::shared_ptr<LabelMap>& labels, int most_edge = 0) {
  auto made = SceneRenderer::offscreen(kWidth, kHeight);
  SceneRenderer& renderer = **made;
  UploadProbe::limitEdges(renderer, most_edge);
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(ball(), labels);
  renderer.setTissues(twoStructures());
  renderer.setMirror(mirror);
  return renderer.picture();
}

class LabelChanges : public testing::TestWithParam<int> {};  // the longest edge of a texture

TEST_P(LabelChanges, BoxByBoxThePictureIsThatOfTheWholeMap) {
  RENDERER_OR_SKIP(renderer);
  UploadProbe::limitEdges(renderer, GetParam());
  auto mirror = std::make_shared<VolumeMirror>();
  const auto labels = blankMap();
  mirror->show(ball(), labels);
  renderer.setTissues(twoStructures());
  renderer.setMirror(mirror);
  const Picture none = renderer.picture();
  // In air too, where nothing was seen and rays leapt.
  mirror->labelsChanged(paint(*labels, {2, 2, 2}, {20, 20, 20}, 4));
  mirror->labelsChanged(paint(*labels, {30, 0, 20}, {45, 20, 40}, 200));
  const Picture made = renderer.picture();
  EXPECT_GT(difference(none, made).pixels, 200);
  EXPECT_EQ(made, fresh(labels, GetParam()));
  mirror->labelsChanged(paint(*labels, {5, 2, 2}, {18, 17, 20}, 0));
  EXPECT_EQ(renderer.picture(), fresh(labels, GetParam()));
  mirror->labelsChanged(paint(*labels, {0, 0, 0}, labels->geometry.size, 0));
  EXPECT_EQ(renderer.picture(), none);
}

TEST_P(LabelChanges, AnotherMapTakesThePlaceOfTheFirst) {
  RENDERER_OR_SKIP(renderer);
  UploadProbe::limitEdges(renderer, GetParam());
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(ball(), nullptr);
  renderer.setTissues(twoStructures());
  renderer.setMirror(mirror);
  const Picture none = renderer.picture();
  const auto first = blankMap(), second = blankMap();
  paint(*first, {2, 2, 2}, {20, 20, 20}, 4);
  paint(*second, {40, 2, 2}, {60, 20, 20}, 200);
  mirror->setLabels(first);
  EXPECT_EQ(renderer.picture(), fresh(first, GetParam()));
  mirror->setLabels(second);
  EXPECT_EQ(renderer.picture(), fresh(second, GetParam()));
  mirror->setLabels(nullptr);
  if (GetParam() == 0) {
    EXPECT_EQ(renderer.picture(), none);
  }
}

INSTANTIATE_TEST_SUITE_P(WholeAndReduced, LabelChanges, testing::Values(0, 50));

TEST(LabelChangesInTime, AWholeMapIsSpreadOverFramesAndThePictureStaysMeanwhile) {
  RENDERER_OR_SKIP(renderer);
  Volume volume = ball();
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(ball(), blankMap());
  renderer.setTissues(twoStructures());
  renderer.setMirror(mirror);
  const Picture none = renderer.picture();
  const auto labels = blankMap();
  paint(*labels, {2, 2, 2}, {40, 40, 40}, 4);
  mirror->setLabels(labels);
  renderer.paint(0, 0.0);  // no time: a slice alone
  EXPECT_FALSE(renderer.complete());
  EXPECT_EQ(UploadProbe::painted(renderer), none);
  for (int n = 0; n < 2000 && !renderer.complete(); ++n) renderer.refine(5.0);
  EXPECT_TRUE(renderer.complete());
  EXPECT_EQ(renderer.picture(), fresh(labels));
}

TEST(LabelChangesInTime, OtherLooksOfStructuresNeedNoLabelsAgain) {
  RENDERER_OR_SKIP(renderer);
  auto mirror = std::make_shared<VolumeMirror>();
  const auto labels = blankMap();
  paint(*labels, {2, 2, 2}, {20, 20, 20}, 4);
  paint(*labels, {40, 2, 2}, {60, 20, 20}, 200);
  mirror->show(ball(), labels);
  TissueSet one = twoStructures();
  one.tissues.pop_back();
  renderer.setTissues(one);
  renderer.setMirror(mirror);
  const Picture without = renderer.picture();
  renderer.setTissues(twoStructures());
  renderer.paint(0, 0.0);
  EXPECT_GT(difference(without, renderer.picture()).pixels, 100);
  EXPECT_EQ(renderer.picture(), fresh(labels));
}

}  // namespace
