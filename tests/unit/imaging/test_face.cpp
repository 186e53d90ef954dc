#include <gtest/gtest.h>

#include <set>

#include "imaging/steps/face.h"
#include "painted.h"
#include "volume/phantom.h"
#include "volume/reduce.h"

namespace trephine::test {

namespace {

using Tissue = PhantomTissue;

Tissue truthAt(const Vec3& p) {
  static const PhantomTruth truth = phantomTruth("cranium").value();
  return truth(p);
}

// The built-in head at half its resolution; made once.
const Volume& head() {
  static const Volume volume = makePhantomOn(phantomTruth("cranium").value(),
                                             centredGrid({128, 128, 90}, {1.6, 1.6, 2.0}), 8.0);
  return volume;
}

// Part of the head: voxels from `first` to `last`.
Volume part(const Index3& low, const Index3& high) {
  return crop(head(), {low, high}).value();
}

bool isBrain(Tissue tissue) {
  static const std::set<Tissue> brain{Tissue::greyMatter, Tissue::whiteMatter, Tissue::csf,
                                      Tissue::ventricle, Tissue::dura};
  return brain.contains(tissue);
}

}  // namespace

TEST(Face, TheBuiltInHeadHasOne) {
  const FaceFinding finding = findFace(head());
  EXPECT_TRUE(finding.found);
  EXPECT_TRUE(finding.braincase);
  // Its face is about 140 mm wide and 110 mm of it are in the scan.
  EXPECT_GT(finding.skin_cm2, 40.0);
  EXPECT_LT(finding.skin_cm2, 150.0);
}

TEST(Face, DefacingTakesEyesNoseAndMouthAndLeavesBrainVaultAndTheBackOfTheHead) {
  const FaceFinding finding = findFace(head());
  Volume after = head();
  const std::uint64_t gone = deface(after, finding);
  EXPECT_GT(gone, 70'000u);
  for (const Vec3& p : {Vec3(31, -78, -28), Vec3(0, -92, -57), Vec3(0, -80, -76), Vec3(0, -70, -86),
                        Vec3(40, -68, -60), Vec3(-50, -50, -70), Vec3(0, -80, -30)}) {
    EXPECT_TRUE(finding.clears(p)) << p.x << " " << p.y << " " << p.z;
    EXPECT_EQ(sampleHu(after, p), kAirHu) << p.x << " " << p.y << " " << p.z;
  }
  std::uint64_t brain_lost = 0, vault_lost = 0, back_lost = 0, changed = 0;
  for (std::size_t n = 0; n < after.hu.size(); ++n) {
    if (after.hu[n] == head().hu[n]) continue;
    ++changed;
    const Index3 at = after.geometry.indicesOf(n);
    const Vec3 p = after.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
    const Tissue tissue = truthAt(p);
    // Below is the cord, in front the optic nerve.
    brain_lost += isBrain(tissue) && p.z > -60.0 && !(p.y < -45.0 && p.z < -20.0);
    vault_lost += p.z > 15.0;
    back_lost += p.y > 20.0;
  }
  EXPECT_EQ(brain_lost, 0u);
  EXPECT_EQ(vault_lost, 0u);
  EXPECT_EQ(back_lost, 0u);
  EXPECT_GE(changed, gone);
}

TEST(Face, WhatIsTakenIsExactlyWhatLiesBeyondTheCut) {
  const FaceFinding finding = findFace(head());
  Volume after = head();
  deface(after, finding);
  for (std::size_t n = 0; n < after.hu.size(); n += 7) {
    const Index3 at = after.geometry.indicesOf(n);
    const bool clears = finding.clears(after.geometry.toPatient_mm(Vec3(at[0], at[1], at[2])));
    ASSERT_EQ(after.hu[n], clears ? kAirHu : head().hu[n]);
  }
}

TEST(Face, ADefacedHeadHasNoneLeft) {
  Volume after = head();
  deface(after, findFace(after));
  const FaceFinding again = findFace(after);
  EXPECT_TRUE(again.braincase);
  EXPECT_FALSE(again.found);
  EXPECT_EQ(deface(after, again), 0u);
}

TEST(Face, ItIsFoundHoweverTheVolumeIsStored) {
  const FaceFinding straight = findFace(head());
  const std::vector<std::uint8_t> none(head().hu.size());
  const Painted axial{head(), none, none};
  std::vector<Volume> stored;
  for (const std::array<int, 3>& order :
       {std::array{0, 2, 1}, std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{1, 0, 2}}) {
    stored.push_back(permuted(axial, order).volume);
  }
  // Feet first and face down: the same voxels the other way round along i and k.
  Volume turned = head();
  std::reverse(turned.hu.begin(), turned.hu.end());
  turned.geometry.direction = Mat3(-1, 0, 0, 0, -1, 0, 0, 0, -1);
  turned.geometry.origin_mm = head().geometry.toPatient_mm(Vec3(127, 127, 89));
  stored.push_back(turned);
  for (const Volume& volume : stored) {
    const FaceFinding finding = findFace(volume);
    EXPECT_TRUE(finding.found);
    EXPECT_TRUE(finding.braincase);
    EXPECT_NEAR(finding.normal.y, straight.normal.y, 0.2);
    EXPECT_NEAR(finding.back_mm, straight.back_mm, 5.0);
    EXPECT_TRUE(finding.clears({0, -90, -57}));
    EXPECT_FALSE(finding.clears({0, -60, 10}));
  }
}

TEST(Face, ABareSkullHasNone) {
  const auto bare = [](const Vec3& p) -> Matter {
    const Tissue tissue = truthAt(p);
    const int hu = phantomHu(tissue);
    return hu > 500 ? Matter{hu, Owner::patient} : Matter{};
  };
  const Volume skull = paint(head().geometry, bare).volume;
  EXPECT_FALSE(findFace(skull).found);
  EXPECT_FALSE(findFace(skull, "HEAD").found);
}

TEST(Face, OtherBodyPartsHaveNone) {
  const Volume body = paint(centredGrid({200, 160, 60}, {2.5, 2.5, 6.0}), man).volume;
  EXPECT_FALSE(findFace(body).found);
  EXPECT_FALSE(findFace(body, "ABDOMEN").found);
  GridGeometry geometry = phantomGeometry("abdomen").value();
  for (int axis = 0; axis < 3; ++axis) {
    geometry.size[axis] /= 3;
    geometry.spacing_mm[axis] *= 3.0;
  }
  EXPECT_FALSE(
      findFace(makePhantomOn(phantomTruth("abdomen").value(), geometry, kPhantomNoiseHu)).found);
}

TEST(Face, AVaultAloneShowsNone) {
  const FaceFinding finding = findFace(part({0, 0, 55}, {128, 128, 90}), "HEAD");
  EXPECT_FALSE(finding.found);
}

TEST(Face, AFaceThatTheFieldOfViewCutsOffIsNotSeen) {
  EXPECT_FALSE(findFace(part({0, 42, 0}, {128, 128, 90})).found);
}

TEST(Face, JawsWithoutABraincaseAreAFaceInDoubt) {
  const Volume jaws = part({0, 0, 0}, {128, 128, 25});
  for (const char* words : {"", "SINUS", "Orbits and facial bones"}) {
    const FaceFinding finding = findFace(jaws, words);
    EXPECT_TRUE(finding.found) << words;
    EXPECT_FALSE(finding.braincase) << words;
    EXPECT_TRUE(finding.clears({0, -92, -57})) << words;
    EXPECT_TRUE(finding.clears({0, -80, -76})) << words;
  }
}

TEST(Face, AHoleInTheSkullDoesNotHideIt) {
  Volume opened = head();
  for (std::size_t n = 0; n < opened.hu.size(); ++n) {
    const Index3 at = opened.geometry.indicesOf(n);
    const Vec3 p = opened.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
    if (opened.hu[n] > 200 && glm::distance(p, Vec3(70, -10, 25)) < 30.0) opened.hu[n] = 40;
  }
  const FaceFinding finding = findFace(opened);
  EXPECT_TRUE(finding.found);
  EXPECT_TRUE(finding.braincase);
  EXPECT_TRUE(finding.clears({0, -92, -57}));
  EXPECT_FALSE(finding.clears({0, -60, 10}));
}

TEST(Face, AChestInTheSameScanStays) {
  const FaceFinding finding = findFace(head());
  ASSERT_TRUE(finding.found);
  EXPECT_TRUE(finding.clears({0, -70, -115}));   // the chin
  EXPECT_FALSE(finding.clears({0, -90, -200}));  // the chest
  EXPECT_FALSE(finding.clears({0, 60, -100}));   // the nape
}

TEST(Face, EmptyAndTinyVolumesHaveNone) {
  EXPECT_FALSE(findFace(Volume(), "HEAD").found);
  Volume air;
  air.geometry.size = {40, 40, 40};
  air.hu.assign(air.geometry.voxelCount(), kAirHu);
  EXPECT_FALSE(findFace(air, "HEAD").found);
  Volume one;
  one.geometry.size = {1, 1, 1};
  one.hu = {40};
  EXPECT_FALSE(findFace(one, "HEAD").found);
}

}  // namespace trephine::test
