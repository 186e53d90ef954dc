#include <gtest/gtest.h>

#include "render/pick.h"
#include "volume/phantom.h"

namespace trephine {
namespace {

// Blocks of 20 mm along y, 40 mm wide, around x = z = 0: HU 100 from y = 20 on, 1000 from y = 60
// on.
Volume blocks() {
  Volume volume;
  volume.geometry.size = {50, 120, 40};
  volume.geometry.spacing_mm = Vec3(0.8, 0.8, 1.0);
  volume.geometry.origin_mm = Vec3(-20.0, 0.0, -20.0);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 v = volume.geometry.indicesOf(n);
    const double y = 0.8 * v[1];
    if (y >= 20.0 && y < 40.0) volume.hu[n] = 100;
    if (y >= 60.0 && y < 80.0) volume.hu[n] = 1000;
  }
  return volume;
}

TissueSet softAndBone() {
  TissueSet set;
  for (const auto& [id, low, high] : {std::tuple{"soft", 50, 200}, std::tuple{"bone", 500, 2000}}) {
    Tissue tissue;
    tissue.id = tissue.name = id;
    tissue.hu_min = low;
    tissue.hu_max = high;
    tissue.opacity = 0.9;
    set.tissues.push_back(tissue);
  }
  return set;
}

const ViewCamera::Ray kFromTheFront{Vec3(1.0, -300.0, 2.0), Vec3(0.0, 1.0, 0.0)};

class Pick : public testing::Test {
 protected:
  // Along y; none: nothing is met.
  std::optional<double> y(const TissueLooks& looks = {}, const std::vector<ClipPlane>& clip = {}) {
    const auto picked = pick(volume_, labels_ ? &*labels_ : nullptr, set_, looks, clip, ray_);
    if (picked) inside_y_ = picked->inside_mm.y;
    return picked ? std::optional(picked->at_mm.y) : std::nullopt;
  }
  Volume volume_ = blocks();
  std::optional<LabelMap> labels_;
  TissueSet set_ = softAndBone();
  ViewCamera::Ray ray_ = kFromTheFront;
  double inside_y_ = 0.0;
};

TEST_F(Pick, FindsTheFirstVoxelThatIsSeen) {
  EXPECT_NEAR(*y(), 20.0, 0.8);
  ray_ = {Vec3(1.0, 300.0, 2.0), Vec3(0.0, -1.0, 0.0)};
  EXPECT_NEAR(*y(), 80.0, 0.8);
  ray_ = {Vec3(100.0, -300.0, 2.0), Vec3(0.0, 1.0, 0.0)};
  EXPECT_FALSE(y()) << "beside the volume";
}

TEST_F(Pick, PassesWhatIsHiddenAndWhatIsAGhost) {
  EXPECT_NEAR(*y({{"soft", TissueLook::hidden}}), 60.0, 0.8);
  EXPECT_NEAR(*y({{"soft", TissueLook::ghosted}}), 60.0, 0.8);
  EXPECT_FALSE(y({{"soft", TissueLook::hidden}, {"bone", TissueLook::ghosted}}));
}

TEST_F(Pick, PassesWhatAPlaneTakesAway) {
  EXPECT_NEAR(*y({}, {{Vec3(0.0, 30.0, 0.0), Vec3(0.0, -1.0, 0.0)}}), 30.0, 0.8) << "the face";
  EXPECT_NEAR(*y({}, {{Vec3(0.0, 45.0, 0.0), Vec3(0.0, -1.0, 0.0)}}), 60.0, 0.8);
  EXPECT_FALSE(y({}, {{Vec3(0.0, 10.0, 0.0), Vec3(0.0, 1.0, 0.0)}}));
  EXPECT_FALSE(y({}, {{Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)}})) << "along the ray";
}

TEST_F(Pick, LooksThroughAVeilAtWhatIsOpaque) {
  set_.tissues[0].opacity = 0.01;
  EXPECT_NEAR(*y(), 60.0, 0.8);
  EXPECT_NEAR(*y({{"bone", TissueLook::hidden}}), 20.0, 0.8) << "a veil alone is seen";
}

TEST_F(Pick, KnowsAStructureByItsLabel) {
  labels_.emplace(LabelMap{volume_.geometry, std::vector<std::uint8_t>(volume_.hu.size())});
  for (std::size_t n = 0; n < volume_.hu.size(); ++n) {
    if (volume_.geometry.indicesOf(n)[1] >= 35 && volume_.hu[n] == 100) labels_->labels[n] = 7;
  }
  Tissue structure;
  structure.id = "structure:7";
  structure.hu_min = -32768;
  structure.hu_max = 32767;
  structure.label = 7;
  structure.opacity = 0.9;
  set_.tissues.push_back(structure);
  EXPECT_NEAR(*y({{"soft", TissueLook::hidden}}), 28.0, 0.8);
  EXPECT_NEAR(*y({{"soft", TissueLook::hidden}, {"structure:7", TissueLook::hidden}}), 60.0, 0.8);
}

TEST_F(Pick, GoesInsideAsFarAsTheTissueDoes) {
  EXPECT_NEAR(*y(), 20.0, 0.8);
  EXPECT_NEAR(inside_y_, 20.0 + kInside_mm, 1.2);
  for (std::size_t n = 0; n < volume_.hu.size(); ++n) {
    if (volume_.geometry.indicesOf(n)[1] >= 29) volume_.hu[n] = kAirHu;
  }
  EXPECT_NEAR(*y(), 20.0, 0.8);
  EXPECT_NEAR(inside_y_, 22.8, 0.8) << "it is thin";
}

TEST_F(Pick, GoesInsideThroughNoise) {
  set_.tissues[0].hu_min = 85;
  set_.tissues[0].hu_max = 115;
  unsigned noise = 1;
  for (std::int16_t& hu : volume_.hu) {
    noise = noise * 1664525u + 1013904223u;
    hu = std::int16_t(hu + int(noise >> 26) - 32);  // over half of it is out of its range
  }
  EXPECT_NEAR(*y(), 20.0, 4.0);
  EXPECT_GT(inside_y_, 24.0);
}

TEST_F(Pick, FindsTheSkullsSurfaceWithinAVoxel) {
  GridGeometry coarse = *phantomGeometry("cranium");
  for (int axis = 0; axis < 3; ++axis) {
    coarse.size[std::size_t(axis)] /= 3;
    coarse.spacing_mm[axis] *= 3.0;
  }
  volume_ = makePhantomOn(*phantomTruth("cranium"), coarse, kPhantomNoiseHu);
  set_ = {"bone", {softAndBone().tissues[1]}};
  const Vec3 middle = volume_.geometry.centre_mm();
  int met = 0;
  for (int n = 0; n < 40; ++n) {
    const Vec3 way = glm::normalize(Vec3(std::sin(0.9 * n), std::cos(0.9 * n), -0.3 - 0.01 * n));
    ray_ = {middle - 400.0 * way, way};
    const auto picked = pick(volume_, nullptr, set_, {}, {}, ray_);
    // By small steps along the same ray.
    double t = 0.0;
    while (t < 800.0 && sampleHu(volume_, ray_.from_mm + ray_.direction * t) < 500.0) t += 0.05;
    ASSERT_EQ(picked.has_value(), t < 800.0);
    if (!picked) continue;
    ++met;
    const double at = glm::dot(picked->at_mm - ray_.from_mm, ray_.direction);
    EXPECT_LT(std::abs(at - t), glm::length(volume_.geometry.spacing_mm));
  }
  EXPECT_GT(met, 30);
}

}  // namespace
}  // namespace trephine
