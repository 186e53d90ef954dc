#include "exercise/landmark.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

TissueSet boneOnly() {
  TissueSet set{"test", {}};
  Tissue bone;
  bone.id = "bone";
  bone.hu_min = 226;
  bone.hu_max = 3071;
  set.tissues.push_back(bone);
  return set;
}

// A ball of bone of radius 20 mm around (5, -7, 40) patient mm, on an oblique grid.
Volume ball(double angle_deg) {
  Volume v;
  GridGeometry& g = v.geometry;
  g.size = {64, 64, 40};
  g.spacing_mm = {1.0, 1.0, 1.5};
  g.direction = glm::mat3_cast(glm::angleAxis(glm::radians(angle_deg), glm::normalize(Vec3(1, 2, 3))));
  g.origin_mm = Vec3(5, -7, 40) - g.direction * (Vec3(31.5, 31.5, 19.5) * g.spacing_mm);
  v.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t i = 0; i < v.hu.size(); ++i) {
    const Index3 ijk = g.indicesOf(i);
    const Vec3 p = g.toPatient_mm(Vec3(ijk[0], ijk[1], ijk[2]));
    if (glm::length(p - Vec3(5, -7, 40)) < 20.0) v.hu[i] = 1000;
  }
  return v;
}

TEST(Landmark, LiesOnTheSurfaceWhereTheRayMeetsIt) {
  for (double angle : {0.0, 25.0}) {
    const Volume v = ball(angle);
    const auto frame = findLandmark({"top", "bone", {0.5, 0.5, 1.5}, {0.5, 0.5, 0.5}}, v, boneOnly());
    ASSERT_TRUE(frame.ok());
    EXPECT_NEAR(frame->position_mm.x, 5, 1.0);
    EXPECT_NEAR(frame->position_mm.y, -7, 1.0);
    EXPECT_NEAR(frame->position_mm.z, 60, 1.0);
    EXPECT_NEAR((frame->rotation * Vec3(0, 0, 1)).z, 1.0, 0.01) << "+z points out of the patient";
  }
}

TEST(Landmark, FindsTheBulkOfAnOrganInNoiseAndBesideSmallerLumps) {
  Volume v = ball(0);
  std::uint32_t random = 7;
  for (std::size_t i = 0; i < v.hu.size(); ++i) {
    const Index3 ijk = v.geometry.indicesOf(i);
    random = random * 1664525u + 1013904223u;
    const int noise = int(random >> 24) - 128;
    const bool lump = ijk[0] < 12 && ijk[1] < 12;
    if (v.hu[i] > 0 || lump) v.hu[i] = std::int16_t(500 + 6 * noise);
  }
  Landmark organ{"organ", "bone", {}, {}, 12.0, {0, -1, 0}, 10.0};
  const auto frame = findLandmark(organ, v, boneOnly());
  ASSERT_TRUE(frame.ok()) << frame.error().sentence();
  EXPECT_NEAR(frame->position_mm.x, 5, 5.0);
  EXPECT_NEAR(frame->position_mm.y, -27, 3.0) << "the front of the ball";
  EXPECT_NEAR(frame->position_mm.z, 40, 5.0);
}

// A scan of a few slices has no room for the ball that is looked for.
TEST(Landmark, IsInTheBulkOfAnOrganOfAThinScanToo) {
  Volume v;
  v.geometry.size = {80, 80, 12};
  v.geometry.spacing_mm = Vec3(2.0, 2.0, 3.0);
  v.hu.assign(v.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 12; ++k) {
    for (int j = 20; j < 60; ++j) {
      for (int i = 20; i < 60; ++i) v.hu[v.geometry.indexOf(i, j, k)] = 800;
    }
  }
  const Landmark organ{"organ", "bone", {}, {}, 30.0, {0, -1, 0}, 15.0};
  const auto frame = findLandmark(organ, v, boneOnly());
  ASSERT_TRUE(frame.ok()) << frame.error().sentence();
  EXPECT_NEAR(frame->position_mm.y, 39.0, 2.0);
}

TEST(Landmark, FramesAreRightHandedAndKeepTheHeadUp) {
  for (const Vec3& out : {Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(-1, 0.5, 0.3)}) {
    const Mat3 m = glm::mat3_cast(frameAlong(out));
    EXPECT_NEAR(glm::determinant(m), 1.0, 1e-12);
    EXPECT_GT(m[1].z, 0.5) << "+y towards the head";
    EXPECT_NEAR(glm::dot(m[2], glm::normalize(out)), 1.0, 1e-12);
  }
  EXPECT_LT(glm::mat3_cast(frameAlong({0, 0, 1}))[1].y, -0.9) << "along the body: towards the front";
}

TEST(Landmark, SaysWhenTheTissueIsNotThere) {
  const Volume v = ball(0);
  TissueSet set = boneOnly();
  EXPECT_EQ(findLandmark({"a", "liver", {}, {}}, v, set).error().code.str(), "NO_SUCH_TISSUE");
  set.tissues[0].hu_min = 2000;
  EXPECT_EQ(findLandmark({"a", "bone", Vec3(1), Vec3(0)}, v, set).error().code.str(),
            "TISSUE_NOT_FOUND");
  set.tissues[0].hu_min = 226;
  EXPECT_EQ(
      findLandmark({"a", "bone", {1.2, 1.2, 1.2}, {1.2, 1.2, 0.0}}, v, set).error().code.str(),
      "NO_SURFACE");
}

// Two balls of the same HU: a label tells them apart.
TEST(Landmark, LooksForATissueWhereItsLabelIs) {
  Volume v;
  GridGeometry& g = v.geometry;
  g.size = {80, 40, 40};
  v.hu.assign(g.voxelCount(), kAirHu);
  LabelMap labels{g, std::vector<std::uint8_t>(g.voxelCount())};
  for (std::size_t i = 0; i < v.hu.size(); ++i) {
    const Index3 at = g.indicesOf(i);
    const Vec3 p(at[0], at[1], at[2]);
    const bool left = glm::length(p - Vec3(20, 20, 20)) < 15.0;
    const bool right = glm::length(p - Vec3(60, 20, 20)) < 10.0;
    if (left || right) v.hu[i] = 1000;
    if (right) labels.labels[i] = 5;
  }
  TissueSet set = boneOnly();
  set.tissues[0].label = 5;
  set.tissues[0].hu_min = -1000;
  const Landmark from_above{"top", "bone", {0.5, 0.5, 1.5}, {0.5, 0.5, 0.5}};
  const Landmark bulk{"bulk", "bone", {}, {}, 6.0, {0, 0, 1}, 4.0};
  for (const Landmark& landmark : {from_above, bulk}) {
    const auto frame = findLandmark(landmark, v, set, &labels);
    ASSERT_TRUE(frame.ok()) << frame.error().sentence();
    EXPECT_NEAR(glm::length(frame->position_mm - Vec3(60, 20, 30)), 0.0, 3.0) << landmark.id;
  }
  std::fill(labels.labels.begin(), labels.labels.end(), std::uint8_t(6));
  EXPECT_EQ(findLandmark(from_above, v, set, &labels).error().code.str(), "TISSUE_NOT_FOUND");

  // What a tissue with the label holds is not the other's.
  Tissue any = set.tissues[0];
  any.id = "any";
  any.label.reset();
  set.tissues.push_back(any);
  std::fill(labels.labels.begin(), labels.labels.end(), std::uint8_t(5));
  EXPECT_EQ(findLandmark({"a", "any", Vec3(1), Vec3(0)}, v, set, &labels).error().code.str(),
            "TISSUE_NOT_FOUND");
}

TEST(Landmark, IsFoundAtOnceHoweverFarAwayTheRayBegins) {
  const Volume v = ball(0);
  const auto near = findLandmark({"top", "bone", {0.5, 0.5, 1.5}, {0.5, 0.5, 0.5}}, v, boneOnly());
  const auto far = findLandmark({"top", "bone", {0.5, 0.5, 1e6}, {0.5, 0.5, -1e6}}, v, boneOnly());
  ASSERT_TRUE(near.ok() && far.ok());
  EXPECT_NEAR(glm::length(near->position_mm - far->position_mm), 0.0, 0.5);
  for (double miles : {1e6, 1e12, 1e300}) {
    const Landmark aside{"aside", "bone", {miles, 0.5, 1.5}, {miles, 0.5, -miles}};
    EXPECT_EQ(findLandmark(aside, v, boneOnly()).error().code.str(), "NO_SURFACE") << miles;
  }
}

TEST(Landmark, SaysHowFarItIsAndCanBeCancelled) {
  const Volume v = ball(0);
  const Landmark from_above{"top", "bone", {0.5, 0.5, 1.5}, {0.5, 0.5, 0.5}};
  const Landmark bulk{"organ", "bone", {}, {}, 12.0, {0, -1, 0}, 10.0};
  for (const Landmark& landmark : {from_above, bulk}) {
    double last = -1.0;
    int reports = 0;
    Progress* running = nullptr;
    Progress progress([&](double fraction, const std::string&) {
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      if (++reports == 5) running->cancel();
    });
    running = &progress;
    const auto frame = findLandmark(landmark, v, boneOnly(), nullptr, progress);
    ASSERT_FALSE(frame.ok()) << landmark.id;
    EXPECT_EQ(frame.error().code.str(), "CANCELLED") << landmark.id;
    EXPECT_EQ(reports, 5) << "it gives up at once";
  }
}

TEST(Landmark, IgnoresARunShorterThanAsked) {
  Volume v = ball(0);
  // A sheet of one voxel above the ball.
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 64; ++i) v.hu[v.geometry.indexOf(i, j, 36)] = 1000;
  }
  const auto frame = findLandmark({"top", "bone", {0.5, 0.5, 1.5}, {0.5, 0.5, 0.5}, 0.0, {}, 8.0}, v, boneOnly());
  ASSERT_TRUE(frame.ok());
  EXPECT_NEAR(frame->position_mm.z, 60, 1.0);
}

}  // namespace
}  // namespace trephine
