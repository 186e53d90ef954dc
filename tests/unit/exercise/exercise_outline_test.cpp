#include <gtest/gtest.h>

#include "base/system.h"
#include "exercise/exercise.h"
#include "shipped.h"

namespace trephine {
namespace {

using test::burrHole;
using test::burrHoleFile;

// A ball of bone of this radius around `centre_mm`, in air.
Volume ball(const Vec3& centre_mm, double radius_mm) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {100, 100, 100};
  g.spacing_mm = Vec3(1.0);
  g.origin_mm = centre_mm - Vec3(49.5);
  volume.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    const double r = glm::length(g.toPatient_mm(Vec3(at[0], at[1], at[2])) - centre_mm);
    // A soft edge, half of it at the radius: the surface is where bone begins.
    volume.hu[n] = std::int16_t(std::clamp(226.0 + 500.0 * (radius_mm - r), -1000.0, 1500.0));
  }
  return volume;
}

// An exercise with an outline of its own around the top of that ball.
constexpr double kRadius_mm = 40.0;
const Vec3 kCentre_mm(10, -20, 30);

Exercise onBall(double above_mm) {
  Exercise exercise = *parseExercise(burrHole(), burrHoleFile());
  const auto placed = *placeLandmarks(exercise, ball(kCentre_mm, kRadius_mm));
  exercise.outline->frame = {"vault", placed[0].frame};
  exercise.outline->points_mm.clear();
  for (const Vec3& at : {Vec3(8, 8, 0), Vec3(-8, 8, 0), Vec3(-8, -8, 0), Vec3(8, -8, 0)}) {
    exercise.outline->points_mm.push_back(placed[0].frame.toPatient_mm(at + Vec3(0, 0, above_mm)));
  }
  return exercise;
}

void expectOnBall(const std::vector<Vec3>& points, const Vec3& centre_mm, double radius_mm) {
  for (const Vec3& p : points) EXPECT_NEAR(glm::length(p - centre_mm), radius_mm, 0.3);
}

TEST(Outline, IsDrawnInStepsOfAMillimetreOnTheSurfaceAboveOrBelowIt) {
  const Volume volume = ball(kCentre_mm, kRadius_mm);
  for (const double above_mm : {-3.0, 0.0, 12.0}) {
    const Exercise exercise = onBall(above_mm);
    const auto drawn = outlineOn(exercise, *placeLandmarks(exercise, volume), volume);
    EXPECT_EQ(drawn.size(), 64u) << "4 edges of 16 mm, closed without a point of its own";
    expectOnBall(drawn, kCentre_mm, kRadius_mm);
  }
}

TEST(Outline, GoesWithItsLandmarkToAnotherPatient) {
  const Exercise exercise = onBall(0.0);
  const Vec3 elsewhere(-60, 35, 80);
  const Volume other = ball(elsewhere, 35.0);
  const auto drawn = outlineOn(exercise, *placeLandmarks(exercise, other), other);
  ASSERT_EQ(drawn.size(), 64u);
  expectOnBall(drawn, elsewhere, 35.0);
  // Also where a person clicked: on the side, turned.
  Exercise clicked = exercise;
  clicked.landmarks[0].is_place = true;
  clicked.landmarks[0].at_mm = elsewhere + Vec3(35, 0, 0);
  clicked.landmarks[0].outward = Vec3(1, 0, 0);
  const auto aside = outlineOn(clicked, *placeLandmarks(clicked, other), other);
  expectOnBall(aside, elsewhere, 35.0);
  for (const Vec3& p : aside) EXPECT_GT(p.x - elsewhere.x, 30.0);
}

TEST(Outline, KeepsItsPlaceWhereThereIsNoSurface) {
  Exercise exercise = onBall(0.0);
  // Beside the ball, and so far above it that it was not drawn there.
  exercise.outline->points_mm = {kCentre_mm + Vec3(60, 0, 40), kCentre_mm + Vec3(60, 5, 40),
                                 kCentre_mm + Vec3(0, 0, kRadius_mm + 60.0)};
  exercise.outline->closed = false;
  const auto placed = *placeLandmarks(exercise, ball(kCentre_mm, kRadius_mm));
  const auto drawn = outlineOn(exercise, placed, ball(kCentre_mm, kRadius_mm));
  EXPECT_LT(glm::length(drawn.front() - exercise.outline->points_mm.front()), 1e-9);
  EXPECT_LT(glm::length(drawn.back() - exercise.outline->points_mm.back()), 1e-9);
}

TEST(Outline, WithoutAFrameIsOfOnePatientAndLeftOutOnAnother) {
  Json json = burrHole();
  json["outline"].erase("frame");
  Exercise exercise = *parseExercise(json, burrHoleFile());
  const Volume volume = ball(kCentre_mm, kRadius_mm);
  const auto drawn = outlineOn(exercise, {}, volume);
  EXPECT_EQ(drawn.front(), exercise.outline->points_mm.front());
  exercise = onCase(exercise, "phantom:cranium");
  EXPECT_TRUE(exercise.outline) << "its own case";
  exercise = onCase(exercise, "/data/ct");
  EXPECT_FALSE(exercise.outline);

  Exercise framed = *parseExercise(burrHole(), burrHoleFile());
  framed = onCase(framed, "/data/ct");
  EXPECT_TRUE(framed.outline);
  EXPECT_TRUE(outlineOn(framed, {}, volume).empty()) << "its landmark has no place there";
}

TEST(Outline, IsRecordedWhereItLiesInThisPatient) {
  const Exercise exercise = onBall(0.0);
  const Volume other = ball(Vec3(-60, 35, 80), 35.0);
  const auto landmarks = *placeLandmarks(exercise, other);
  const Exercise fixed = withFixedMaps(exercise, landmarks);
  const Vec3 moved = landmarks[0].frame.toPatient_mm(Vec3(8, 8, 0));
  EXPECT_LT(glm::length(fixed.outline->points_mm[0] - moved), 1e-9);
  const Result<Exercise> copy = parseExercise(*parseJson(toJson(fixed).dump(), "copy"), "copy");
  ASSERT_TRUE(copy) << copy.error().sentence();
  EXPECT_EQ(toJson(*copy), toJson(fixed));
  EXPECT_EQ(copy->outline->points_mm, fixed.outline->points_mm) << "to the last bit";
  // Drawn from the recording it is the same line.
  EXPECT_EQ(outlineOn(*copy, *placeLandmarks(*copy, other), other),
            outlineOn(fixed, landmarks, other));
}

TEST(Outline, ThatCannotBeIsRefusedByField) {
  struct Wrong {
    const char* field;
    void (*change)(Json& outline);
  };
  const Wrong all[] = {
      {"outline.points", [](Json& o) { o["points"] = Json(1, o["points"][0]); }},
      {"outline.points", [](Json& o) { o["points"] = Json(257, o["points"][0]); }},
      {"outline.points", [](Json& o) { o["points"] = 3; }},
      {"outline.points", [](Json& o) { o.erase("points"); }},
      {"outline.points[2]",
       [](Json& o) {
         o["points"][2] = {1, 2};
       }},
      {"outline.points[2]", [](Json& o) { o["points"][2] = "there"; }},
      {"outline.points[2]",
       [](Json& o) {
         o["points"][2] = {1, 2, 1e300};
       }},
      {"outline.points",
       [](Json& o) {
         o["points"][2] = {0, 0, 9000};
       }},
      {"outline.width_mm", [](Json& o) { o["width_mm"] = 0.1; }},
      {"outline.width_mm", [](Json& o) { o["width_mm"] = 11; }},
      {"outline.closed", [](Json& o) { o["closed"] = 1; }},
      {"outline.colour", [](Json& o) { o["colour"] = "red"; }},
      {"outline", [](Json& o) { o["frame"]["landmark"] = "nose"; }},
      {"outline.frame.rotation_wxyz",
       [](Json& o) {
         o["frame"]["rotation_wxyz"] = {0.5, 0, 0, 0};
       }},
      {"outline.frame.centre_mm", [](Json& o) { o["frame"].erase("centre_mm"); }},
  };
  for (const Wrong& wrong : all) {
    Json json = burrHole();
    wrong.change(json["outline"]);
    const Result<Exercise> exercise = parseExercise(json, burrHoleFile());
    ASSERT_FALSE(exercise) << wrong.field;
    EXPECT_NE(exercise.error().where.find(wrong.field), std::string::npos)
        << exercise.error().sentence();
  }
}

}  // namespace
}  // namespace trephine
