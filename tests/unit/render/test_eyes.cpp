// Pictures for two eyes, which look past the middle of what they see: against crops of wider
// pictures, and against where theory puts a marker.
#include "scenes.h"

namespace trephine {
namespace {

using test::tissues;

// A ball as ever, and a marker with a HU of its own.
Volume ballWithMarker(const Vec3& at_mm) {
  Volume volume = test::ball();
  const GridGeometry& g = volume.geometry;
  for (std::size_t index = 0; index < g.voxelCount(); ++index) {
    const Index3 v = g.indicesOf(index);
    if (glm::distance(g.toPatient_mm(Vec3(v[0], v[1], v[2])), at_mm) < 4.0) volume.hu[index] = 2800;
  }
  return volume;
}

TissueSet withMarker() {
  TissueSet set = tissues();
  set.tissues[1].hu_max = 2000;
  set.tissues.push_back(test::tissue("marker", 2400, 3000, Vec3(1.0, 0.0, 0.0), 1.0));
  return set;
}

// Of what is mostly red.
std::optional<glm::dvec2> redCentre(const Picture& picture) {
  glm::dvec2 sum(0.0);
  double count = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p =
          picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
      if (p[0] < std::max(p[1], p[2]) + 40) continue;
      sum += glm::dvec2(x + 0.5, picture.height - y - 0.5);
      count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

Picture crop(const Picture& of, int x0, int y0, int width, int height) {
  Picture part;
  part.width = width;
  part.height = height;
  for (int y = y0; y < y0 + height; ++y) {
    const auto row = of.rgb.begin() + 3 * (std::ptrdiff_t(y) * of.width + x0);
    part.rgb.insert(part.rgb.end(), row, row + 3 * width);
  }
  return part;
}

// From the front: outside the volume, inside its box, deep inside it.
constexpr double kDistances_mm[] = {150.0, 26.0, 8.0};

EyeView eyeAt(double aside_mm, double distance_mm, const FieldOfView& sees) {
  // Looks along +y, up is z.
  const Quat turn = glm::quat_cast(Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)));
  return {{Vec3(aside_mm, -distance_mm, 0.0), turn}, sees};
}

TEST(Eyes, APictureThatLooksPastItsMiddleIsACropOfAWiderOne) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ballWithMarker(Vec3(6, 12, 4))));
  renderer.setTissues(withMarker());
  for (const double distance_mm : kDistances_mm) {
    for (const double aside_mm : {-31.5, 31.5}) {
      constexpr int kPerUnit = 80;  // pixels for a tangent of 1
      const FieldOfView sees = aside_mm < 0.0 ? FieldOfView{-1.0, 0.75, -1.0, 0.75}
                                              : FieldOfView{-0.75, 1.0, -1.0, 0.75};
      const Picture part = renderer.eyePicture(eyeAt(aside_mm, distance_mm, sees),
                                               int(1.75 * kPerUnit), int(1.75 * kPerUnit));
      const Picture whole = renderer.eyePicture(
          eyeAt(aside_mm, distance_mm, {-1.0, 1.0, -1.0, 1.0}), 2 * kPerUnit, 2 * kPerUnit);
      const Picture of_whole =
          crop(whole, aside_mm < 0.0 ? 0 : kPerUnit / 4, kPerUnit / 4, part.width, part.height);
      EXPECT_GE(psnr_dB(of_whole, part), 60.0) << distance_mm;
    }
  }
}

TEST(Eyes, AMarkerIsSeenWhereTheoryPutsItWithItsDisparityAndNothingUpOrDown) {
  RENDERER_OR_SKIP(renderer);
  const Vec3 marker_mm(6, 12, 4);
  renderer.setVolume(Grid(ballWithMarker(marker_mm)));
  TissueSet only = withMarker();
  only.tissues[0].opacity = only.tissues[1].opacity = 0.0;
  renderer.setTissues(only);
  for (const double distance_mm : kDistances_mm) {
    constexpr int kSize = 160;
    glm::dvec2 seen[2], expected[2];
    for (const int eye : {0, 1}) {
      const EyeView view = eyeAt(
          eye == 0 ? -3.0 : 3.0, distance_mm,
          eye == 0 ? FieldOfView{-1.0, 0.75, -1.0, 0.75} : FieldOfView{-0.75, 1.0, -1.0, 0.75});
      const auto found = redCentre(renderer.eyePicture(view, kSize, kSize));
      ASSERT_TRUE(found) << distance_mm;
      seen[eye] = *found;
      ViewCamera camera;
      camera.lookThrough(view);
      expected[eye] = *camera.pixelOf(marker_mm, kSize, kSize);
      const FieldOfView& of = view.sees;
      const double depth = marker_mm.y + distance_mm;
      const double x = (marker_mm.x - view.pose.position.x) / depth, y = marker_mm.z / depth;
      EXPECT_NEAR(expected[eye].x, kSize * (x - of.left) / (of.right - of.left), 1e-9);
      EXPECT_NEAR(expected[eye].y, kSize * (y - of.down) / (of.up - of.down), 1e-9);
    }
    EXPECT_NEAR(seen[0].x - seen[1].x, expected[0].x - expected[1].x, 0.5) << distance_mm;
    EXPECT_NEAR(seen[0].y, seen[1].y, 0.2) << distance_mm;
  }
}

TEST(Eyes, ThePanelKeepsItsPictureWhileEyesAreDrawn) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(test::ball()));
  renderer.setTissues(tissues());
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 150.0);
  const Picture before = renderer.picture();
  renderer.eyePicture(eyeAt(10.0, 60.0, {-0.9, 0.6, -0.5, 0.7}), 96, 72);
  EXPECT_EQ(UploadProbe::painted(renderer), before);
  EXPECT_EQ(renderer.picture(), before);
}

TEST(Eyes, ACardStandsInThemAndTissueBeforeItHidesIt) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(test::ball()));
  renderer.setTissues(tissues(1.0, 1.0));
  Card card;
  card.name = "card";
  card.width_mm = 200.0;
  card.width = card.height = 8;
  card.rgba.assign(8 * 8 * 4, 255);
  for (std::size_t i = 0; i < card.rgba.size(); i += 4) card.rgba[i + 1] = card.rgba[i + 2] = 0;
  const EyeView eye = eyeAt(0.0, 120.0, {-1.0, 1.0, -1.0, 1.0});
  card.pose_mm.orientation = eye.pose.orientation;
  const auto red = [&](double y_mm, double x, double y) {
    card.pose_mm.position = Vec3(0.0, y_mm, 0.0);
    renderer.setCards({card});
    const Picture picture = renderer.eyePicture(eye, 100, 100);
    const std::uint8_t* p = picture.rgb.data() + 3 * (std::size_t(y) * 100 + std::size_t(x));
    return p[0] > 200 && p[1] < 50;
  };
  EXPECT_TRUE(red(-60.0, 50, 50)) << "before the ball";
  EXPECT_TRUE(red(-60.0, 5, 5)) << "as wide as it is";
  EXPECT_FALSE(red(60.0, 50, 50)) << "behind the ball";
  EXPECT_TRUE(red(60.0, 75, 50)) << "beside it";
  EXPECT_FALSE(red(-200.0, 50, 50)) << "behind the eye";
  renderer.setCards({});
  const Picture without = renderer.eyePicture(eye, 100, 100);
  for (const std::size_t pixel : {50u * 100u + 75u, 5u * 100u + 5u}) {
    EXPECT_LT(without.rgb[3 * pixel], 100) << "no card, no red";
  }
}

}  // namespace
}  // namespace trephine
