// What the tools of the 3-D view compute: strips of rays, planes, the way ahead of a tool, letters.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/cast_plan.h"
#include "render/clip_tools.h"
#include "render/orientation_cue.h"
#include "render/seen_box.h"
#include "render/tool_guide.h"

using namespace trephine;

namespace {

constexpr int kWide = 640, kHigh = 480;

GridGeometry grid() {
  GridGeometry g;
  g.size = {40, 60, 80};
  g.spacing_mm = Vec3(2.0, 1.0, 0.5);
  g.origin_mm = -0.5 * Vec3(39, 59, 79) * g.spacing_mm;
  return g;
}

ViewCamera fromTheFront() {
  ViewCamera camera;
  camera.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 200.0);
  return camera;
}

bool cutAway(const std::vector<ClipPlane>& planes, const Vec3& at) {
  for (const ClipPlane& plane : planes) {
    if (glm::dot(at - plane.point_mm, plane.normal) > 0.0) return true;
  }
  return false;
}

}  // namespace

TEST(CastPlan, StripsCoverEveryPixelOnce) {
  CastPlan plan;
  plan.setWhole(50, 40);
  std::vector<int> count(50 * 40);
  while (const auto strip = plan.next(600.0)) {
    EXPECT_LE(strip->pixels(), 600.0);
    for (int y = strip->low_y; y < strip->high_y; ++y) {
      for (int x = strip->low_x; x < strip->high_x; ++x) ++count[std::size_t(y * 50 + x)];
    }
  }
  EXPECT_TRUE(plan.done());
  for (const int times : count) ASSERT_EQ(times, 1);
}

TEST(CastPlan, WhereRaysAreDearAStripIsNotAsWideAsThePicture) {
  CastPlan plan;
  plan.setWhole(1000, 100);
  const PixelRect strip = *plan.next(600.0);
  EXPECT_EQ(strip, (PixelRect{0, 92, 75, 100}));
  EXPECT_EQ(plan.next(600.0)->low_x, 75) << "the next lies beside it";
  EXPECT_EQ(plan.next(1.0)->pixels(), 512.0) << "at least";
}

TEST(CastPlan, CutsThatOverlapAreCastTogetherAndWhatLiesOutsideNotAtAll) {
  CastPlan plan;
  plan.setNone(100, 100);
  plan.add({200, 10, 300, 20});
  plan.add({-20, -20, 0, 50});
  EXPECT_TRUE(plan.done());
  plan.add({10, 10, 30, 30});
  plan.add({12, 10, 32, 30});
  EXPECT_EQ(plan.pixels(), 22.0 * 20.0);
  plan.add({80, 80, 120, 90});
  EXPECT_EQ(plan.pixels(), 22.0 * 20.0 + 20.0 * 10.0);
}

TEST(Camera, EachStandardViewShowsItsSideWithThePatientUpright) {
  ViewCamera camera = fromTheFront();
  const auto lookFrom = [&](StandardView side) {
    const ViewCamera::Direction from = ViewCamera::from(side);
    camera.lookAt(Vec3(0.0), from.forward, from.up, 200.0);
  };
  lookFrom(StandardView::left);
  EXPECT_EQ(camera.forward(), Vec3(-1, 0, 0)) << "the eye is at the patient's left, +x";
  EXPECT_NEAR(glm::distance(camera.right(), Vec3(0, 1, 0)), 0.0, 1e-12)
      << "the nose is at the left";
  lookFrom(StandardView::right);
  EXPECT_EQ(camera.forward(), Vec3(1, 0, 0));
  lookFrom(StandardView::posterior);
  EXPECT_NEAR(glm::distance(camera.right(), Vec3(-1, 0, 0)), 0.0, 1e-12);
  lookFrom(StandardView::superior);
  EXPECT_EQ(camera.forward(), Vec3(0, 0, -1));
  EXPECT_EQ(camera.up(), Vec3(0, -1, 0)) << "the face is up";
  lookFrom(StandardView::inferior);
  EXPECT_EQ(camera.forward(), Vec3(0, 0, 1));
  EXPECT_NEAR(glm::distance(camera.right(), Vec3(1, 0, 0)), 0.0, 1e-12)
      << "as in an axial slice, the patient's left is at the right";
}

TEST(Camera, WhatItTurnsAboutStaysWhereItIsInThePicture) {
  ViewCamera camera = fromTheFront();
  const Vec3 about(20, -30, 15);
  const auto before = camera.pixelOf(about, kWide, kHigh);
  for (int n = 0; n < 9; ++n) camera.orbit(10, 5, about);
  const auto after = camera.pixelOf(about, kWide, kHigh);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(before->x, after->x, 1e-6);
  EXPECT_NEAR(before->y, after->y, 1e-6);
  EXPECT_LT(camera.forward().y, 0.9) << "it has turned";
}

TEST(Camera, AFitShowsAllCornersOfTheBoxAndNotMuchMore) {
  GridGeometry of = grid();
  const VoxelBox box{{2, 3, 4}, {of.size[0] - 3, of.size[1] - 1, of.size[2] - 2}};
  ViewCamera camera;
  for (const StandardView side :
       {StandardView::anterior, StandardView::left, StandardView::superior}) {
    const ViewCamera::Direction from = ViewCamera::from(side);
    camera.fit(of, box, from.forward, from.up, kWide, kHigh);
    double most = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = [&](std::size_t axis, int bit) {
        return double(corner & bit ? box.high[axis] - 1 : box.low[axis]);
      };
      const auto pixel =
          camera.pixelOf(of.toPatient_mm(Vec3(at(0, 1), at(1, 2), at(2, 4))), kWide, kHigh);
      ASSERT_TRUE(pixel);
      most = std::max(
          {most, std::abs(2.0 * pixel->x / kWide - 1.0), std::abs(2.0 * pixel->y / kHigh - 1.0)});
    }
    EXPECT_LE(most, 1.0);
    EXPECT_GT(most, 0.9);
  }
}

TEST(SeenBox, IsAroundWhatIsShownAndNotAroundAirOrSingleVoxels) {
  Volume volume;
  volume.geometry = grid();
  volume.geometry.size = {40, 30, 20};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 6; k < 12; ++k) {
    for (int j = 5; j < 20; ++j) {
      for (int i = 10; i < 30; ++i) volume.hu[volume.geometry.indexOf(i, j, k)] = 300;
    }
  }
  volume.hu[volume.geometry.indexOf(1, 1, 1)] = 300;
  TissueSet tissues;
  tissues.tissues.resize(1);
  tissues.tissues[0].id = "bone";
  tissues.tissues[0].hu_min = 200;
  tissues.tissues[0].hu_max = 400;
  tissues.tissues[0].opacity = 1.0;
  const VoxelBox seen = seenBox(volume, nullptr, tissues);
  EXPECT_EQ(seen.low, (Index3{10, 5, 6}));
  EXPECT_EQ(seen.high, (Index3{30, 20, 12}));
  tissues.tissues[0].opacity = 0.0;
  EXPECT_EQ(seenBox(volume, nullptr, tissues).high, volume.geometry.size) << "nothing is seen";
}

TEST(OrientationCue, ALetterBehindAnotherIsLeftOut) {
  // From the front and below A lies over S and I over P: together they read as other signs.
  ViewCamera camera;
  camera.lookAt(Vec3(0.0), Vec3(0, 1, 1), Vec3(0, 0, 1), 200.0);
  ScreenLines lines, letters;
  addOrientationCue(camera, 800, 600, lines);
  addWords("LRAI", {0, 0}, 10, Vec3(1.0), 1, letters);
  constexpr std::size_t kArms = 6;
  EXPECT_EQ(lines.size(), kArms + letters.size());
}

TEST(Camera, OrthographicAPixelSpansTheSameEverywhereAndAtTheFocusWhatItDidBefore) {
  ViewCamera camera = fromTheFront();
  const double mm = camera.mmPerPixelAt(camera.focus(), kHigh);
  camera.setParallel(true);
  for (const Vec3& at : {Vec3(0.0), Vec3(10, -150, 3), Vec3(0, 900, 0), Vec3(0, -900, 0)}) {
    EXPECT_NEAR(camera.mmPerPixelAt(at, kHigh), mm, 1e-12);
    const auto pixel = camera.pixelOf(at, kWide, kHigh);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, kWide / 2.0 + at.x / mm, 1e-6);
  }
}

TEST(Camera, ARayThroughAPixelMeetsThePointThatIsDrawnThere) {
  for (const bool parallel : {false, true}) {
    ViewCamera camera = fromTheFront();
    camera.orbit(30, 20, camera.focus());
    camera.setParallel(parallel);
    const Vec3 at(12, -7, 25);
    const auto pixel = camera.pixelOf(at, kWide, kHigh);
    ASSERT_TRUE(pixel);
    const ViewCamera::Ray ray = camera.rayThrough(*pixel, kWide, kHigh);
    EXPECT_NEAR(glm::length(glm::cross(at - ray.from_mm, ray.direction)), 0.0, 1e-6);
  }
  EXPECT_FALSE(fromTheFront().pixelOf(Vec3(0, -300, 0), kWide, kHigh)) << "behind the eye";
  ViewCamera camera = fromTheFront();
  EXPECT_TRUE(isFinite(camera.mmPerPixelAt(Vec3(0.0), 0))) << "a view of no size";
}

TEST(ScaleBar, ItsLengthIsRoundAndFitsTheRoomThereIs) {
  for (const double mm : {0.013, 0.2, 0.37, 1.0, 4.2}) {
    const std::optional<double> bar = scaleBar_mm(mm, 150.0);
    ASSERT_TRUE(bar);
    EXPECT_LE(*bar / mm, 150.0 + 1e-9);
    EXPECT_GE(*bar / mm, 150.0 / 2.5 - 1e-9);
    const double digit = *bar / std::pow(10.0, std::floor(std::log10(*bar) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 ||
                std::abs(digit - 5) < 1e-6);
  }
  EXPECT_FALSE(scaleBar_mm(std::nan(""), 150.0));
  EXPECT_FALSE(scaleBar_mm(0.0, 150.0));
}

TEST(ScaleBar, TheBarThatIsDrawnIsAsLongAsItSaysInTheFocussPlane) {
  const ViewCamera camera = fromTheFront();
  ScreenLines lines;
  addScaleBar(camera, camera.focus(), kWide, kHigh, lines);
  ASSERT_GT(lines.size(), 3U);
  const double pixels = glm::distance(lines[0].from, lines[0].to);
  EXPECT_NEAR(pixels * camera.mmPerPixelAt(camera.focus(), kHigh),
              *scaleBar_mm(camera.mmPerPixelAt(camera.focus(), kHigh), 0.22 * kWide), 1e-6);
  ScreenLines none;
  addScaleBar(camera, camera.focus(), 100, 100, none);
  EXPECT_TRUE(none.empty()) << "no room";
}

TEST(ClipTools, ABoxCutsNothingUntilAFaceIsDragged) {
  ClipTools tools;
  tools.setVolume(grid());
  tools.showBox(true);
  EXPECT_TRUE(tools.planes().empty());
  EXPECT_EQ(tools.handles().size(), 6U);

  // The patient's left face, at the picture's right, 20 mm inwards.
  const ViewCamera camera = fromTheFront();
  ClipTools::Handle left;
  for (const ClipTools::Handle& handle : tools.handles()) {
    if (handle.face == 1) left = handle;
  }
  EXPECT_NEAR(left.at_mm.x, 40.0, 1e-9) << "half a voxel beyond the last one's middle";
  const double mm = camera.mmPerPixelAt(left.at_mm, kHigh);
  tools.drag(left, {-20.0 / mm, 33.0}, camera, kWide, kHigh);
  const std::vector<ClipPlane> planes = tools.planes();
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_NEAR(planes[0].point_mm.x, 20.0, 0.2);
  EXPECT_TRUE(cutAway(planes, Vec3(25, 0, 0)));
  EXPECT_FALSE(cutAway(planes, Vec3(15, 0, 0)));

  // Never beyond the opposite face, nor out of the volume.
  tools.drag(left, {-1e6, 0.0}, camera, kWide, kHigh);
  EXPECT_GT(tools.planes()[0].point_mm.x, -40.0);
  tools.drag(left, {1e6, 0.0}, camera, kWide, kHigh);
  EXPECT_TRUE(tools.planes().empty());
  tools.drag(left, {std::nan(""), 0.0}, camera, kWide, kHigh);
  EXPECT_TRUE(tools.planes().empty());
}

TEST(ClipTools, AHandleIsFoundWhereItIsDrawn) {
  ClipTools tools;
  tools.setVolume(grid());
  tools.showBox(true);
  const ViewCamera camera = fromTheFront();
  for (const ClipTools::Handle& handle : tools.handles()) {
    const auto at = camera.pixelOf(handle.at_mm, kWide, kHigh);
    const auto found = tools.handleAt(*at + glm::dvec2(4, 4), camera, kWide, kHigh, 10.0);
    ASSERT_TRUE(found);
    // Those of the front and the back lie on each other: the front one is taken.
    EXPECT_EQ(found->face, handle.face == 3 ? 2 : handle.face);
  }
  EXPECT_FALSE(tools.handleAt({3, 3}, camera, kWide, kHigh, 10.0));
}

TEST(ClipTools, APlaneThroughTheToolTakesWhatLiesBetweenItAndTheEye) {
  ClipTools tools;
  tools.setVolume(grid());
  const ViewCamera camera = fromTheFront();
  const Vec3 tip(5, -3, 8);
  tools.planeThrough(tip, Vec3(0.0), camera);
  EXPECT_TRUE(cutAway(tools.planes(), Vec3(5, -10, 8)));
  EXPECT_FALSE(cutAway(tools.planes(), Vec3(5, 4, 8)));
  const Vec3 axis = glm::normalize(Vec3(0.2, -0.5, 1.0));
  tools.planeThrough(tip, axis, camera);
  ASSERT_EQ(tools.planes().size(), 1U);
  EXPECT_NEAR(glm::dot(tools.planes()[0].normal, axis), 0.0, 1e-12) << "it contains the axis";
  EXPECT_TRUE(cutAway(tools.planes(), tip + (camera.eye() - tip) * 0.1));
  tools.movePlane(-4.0);
  EXPECT_FALSE(cutAway(tools.planes(), tip + axis * 20.0 - tools.planes()[0].normal * 5.0));
  tools.movePlane(1e9);
  EXPECT_LT(glm::length(tools.planes()[0].point_mm), 1000.0) << "it stays at the volume";
  tools.reset();
  EXPECT_TRUE(tools.planes().empty());
}

TEST(ClipTools, AnotherVolumeStartsWithoutCutsTheSamePlaceKeepsThem) {
  ClipTools tools;
  tools.setVolume(grid());
  tools.showPlane(true, fromTheFront());
  tools.setVolume(grid());
  EXPECT_TRUE(tools.planeShown());
  GridGeometry other = grid();
  other.origin_mm.x += 1.0;
  tools.setVolume(other);
  EXPECT_FALSE(tools.cutsAnything());
}

TEST(Light, ItFollowsTheHandAndNeverGoesBehind) {
  Vec3 light(0, 0, 1);
  light = draggedLight(light, {100, 0}, kHigh);
  EXPECT_GT(light.x, 0.3);
  EXPECT_NEAR(glm::length(light), 1.0, 1e-9);
  light = draggedLight(light, {1e9, 1e9}, kHigh);
  EXPECT_GT(light.z, 0.1);
  EXPECT_EQ(draggedLight(Vec3(0.0), {1, 1}, kHigh), Vec3(0, 0, 1));
}

TEST(ToolGuide, TheRingOfContactHasTheColourOfItsArm) {
  ToolView tool;
  tool.length_mm = 20.0;
  tool.contact = true;
  tool.colour = Vec3(0.1, 0.6, 0.9);
  ScreenLines lines;
  std::vector<WordsBox> words;
  addGuide(tool, 30.0, fromTheFront(), kWide, kHigh, false, words, lines);
  ASSERT_FALSE(lines.empty());
  for (const ScreenLine& line : lines) EXPECT_EQ(line.colour, tool.colour);
}

TEST(ToolGuide, TheWayToASurfaceIsMeasuredAlongTheTool) {
  const ViewCamera camera = fromTheFront();
  // A wall facing the eye, 230 mm from it.
  DepthPatch wall;
  wall.rays = {0, 0, kWide, kHigh};
  wall.depth_mm.assign(std::size_t(kWide * kHigh), 230.0F);
  ToolView tool;
  tool.length_mm = 20.0;
  tool.pose_mm.position = Vec3(0, 0, 0);
  tool.pose_mm.orientation = glm::angleAxis(glm::radians(90.0), Vec3(1, 0, 0));  // points away
  EXPECT_NEAR(*surfaceAhead_mm(tool, wall, camera, kWide, kHigh), 30.0, 0.3);
  ScreenLines lines;
  std::vector<WordsBox> words;
  addGuide(tool, 30.0, camera, kWide, kHigh, false, words, lines);
  EXPECT_GT(lines.size(), 5U) << "a line, a square, and words";
  // Words at the right, or at the left.
  const auto middle = [](const ScreenLines& drawn) {
    double sum = 0.0;
    for (const ScreenLine& line : drawn) sum += line.from.x / double(drawn.size());
    return sum;
  };
  ScreenLines at_left;
  addGuide(tool, 30.0, camera, kWide, kHigh, true, words, at_left);
  EXPECT_GT(middle(lines), kWide / 2.0 + 5.0);
  EXPECT_LT(middle(at_left), kWide / 2.0 - 5.0);
  // Those of a second tool at the same place stand below.
  ScreenLines below;
  addGuide(tool, 30.0, camera, kWide, kHigh, false, words, below);
  ASSERT_EQ(words.size(), 3U);
  EXPECT_FALSE(words[2].overlaps(words[0]));
  EXPECT_LT(words[2].high.y, words[0].low.y + 1.0);
  // Hidden behind the wall there is no way to show, nor where the tool points past it.
  tool.pose_mm.position = Vec3(0, 50, 0);
  EXPECT_FALSE(surfaceAhead_mm(tool, wall, camera, kWide, kHigh));
  tool.pose_mm.position = Vec3(0, 0, 0);
  tool.pose_mm.orientation = Quat(1, 0, 0, 0);
  EXPECT_FALSE(surfaceAhead_mm(tool, wall, camera, kWide, kHigh));
  tool.pose_mm.position.x = std::nan("");
  EXPECT_FALSE(surfaceAhead_mm(tool, wall, camera, kWide, kHigh));
  EXPECT_TRUE(guideReach(tool, camera, kWide, kHigh).empty());
}
