// The couch and face findings on real scans. Figures are printed: they are what README.md states.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "imaging/importer.h"
#include "imaging/steps/couch.h"
#include "imaging/steps/face.h"
#include "support.h"
#include "volume/reduce.h"
#include "volume/volume_files.h"

namespace trephine::test {

namespace {

Volume importedCt(const std::filesystem::path& folder) {
  auto ct = CtFolder::scan(folder, Progress());
  return std::move(ct->read(*ct->bestSeries(), ImportRequest(), Progress())).value();
}

template <class Work>
double milliseconds(const Work& work) {
  double best = 1e9;
  for (int n = 0; n < 5; ++n) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

void printFigures(const char* name, const Volume& volume, const CouchFinding& couch,
                  std::uint64_t gone) {
  std::printf(
      "[ figures  ] %s: couch %.0f mm long, %.0f wide, %llu voxels said, %llu gone; "
      "couch %.1f ms, face %.1f ms\n",
      name, couch.length_mm, couch.width_mm, (unsigned long long)couch.voxels,
      (unsigned long long)gone, milliseconds([&] { (void)findCouch(volume); }),
      milliseconds([&] { (void)findFace(volume); }));
  for (int factor : {2, 4}) {
    const Volume small = reduced(volume, factor).value();
    const ReductionLoss loss = reductionLoss(volume, small, factor);
    std::printf(
        "[ figures  ] %s / %d: rms %.1f HU, p99 %.0f HU, bone volume %+.1f %%, bone lost "
        "%.1f %%; %llu samples, every %d, %d, %d; reduced in %.0f ms, compared in %.0f ms\n",
        name, factor, loss.rms_hu, loss.p99_hu, loss.bone_volume_change_percent,
        loss.bone_lost_percent, (unsigned long long)loss.samples, loss.stride[0], loss.stride[1],
        loss.stride[2], milliseconds([&] { (void)reduced(volume, factor); }),
        milliseconds([&] { (void)reductionLoss(volume, small, factor); }));
  }
}

}  // namespace

TEST(RealCouch, TheSkullsHolderGoesAndTheSkullWithItsInsertsStays) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const Volume before = importedCt(data / "head-ct-plastic-skull");
  const CouchFinding finding = findCouch(before);
  EXPECT_TRUE(finding.found);
  EXPECT_NEAR(finding.length_mm, 140.0, 1.0);
  EXPECT_NEAR(finding.width_mm, 216.0, 3.0);  // with the cable beside it
  Volume after = before;
  const std::uint64_t gone = removeCouch(after, finding);
  printFigures("skull", before, finding, gone);
  EXPECT_NEAR(double(finding.voxels), double(gone), 0.25 * double(gone));
  // Bone is denser than the holder; over 700 HU nothing but bone is in view.
  std::uint64_t bone_lost = 0;
  for (std::size_t n = 0; n < before.hu.size(); ++n) {
    bone_lost += before.hu[n] > 900 && after.hu[n] == kAirHu;
  }
  EXPECT_LT(bone_lost, 100u);  // single noisy voxels and a rivet of the holder
  // The skull's lowest point in this scan, and an insert near it.
  EXPECT_EQ(after.at(256, 330, 70), before.at(256, 330, 70));
  // Nothing of the ring is left at the middle of its bottom and of its right side.
  for (int k = 2; k < 138; k += 5) {
    for (int j = 470; j < 512; ++j) ASSERT_LT(after.at(256, j, k), -300) << j << " " << k;
    for (int i = 470; i < 512; ++i) ASSERT_LT(after.at(i, 330, k), -300) << i << " " << k;
  }
  EXPECT_FALSE(findCouch(after).found);
}

TEST(RealCouch, TheAbdomensMattressGoesAndTheSkinStays) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto file = readVolume(data / "abdomen-ct-totalsegmentator/example_ct.nii.gz");
  ASSERT_TRUE(file.ok());
  const auto labels = readVolume(data / "abdomen-ct-totalsegmentator/example_seg.nii.gz");
  ASSERT_TRUE(labels.ok());
  // The labels cover the first slices of the same grid.
  ASSERT_EQ(labels->geometry.origin_mm, file->geometry.origin_mm);
  const CouchFinding finding = findCouch(*file);
  EXPECT_TRUE(finding.found);
  EXPECT_NEAR(finding.length_mm, 336.0, 1.0);
  EXPECT_NEAR(finding.width_mm, 366.0, 1.0);  // from side to side of the field, behind the patient
  Volume after = *file;
  const std::uint64_t gone = removeCouch(after, finding);
  printFigures("abdomen", *file, finding, gone);
  std::uint64_t organ_lost = 0, tissue_lost = 0;
  const GridGeometry& g = after.geometry;
  for (std::size_t n = 0; n < after.hu.size(); ++n) {
    if (after.hu[n] == file->hu[n]) continue;
    // Solid tissue: no neighbour within two voxels is lighter than fat.
    const Index3 at = g.indicesOf(n);
    if (labels->geometry.contains(at[0], at[1], at[2])) {
      organ_lost += labels->at(at[0], at[1], at[2]) != 0;
    }
    bool solid = true;
    for (int y = -2; y <= 2; ++y) {
      for (int x = -2; x <= 2; ++x) {
        solid &=
            g.contains(at[0] + x, at[1] + y, at[2]) && file->at(at[0] + x, at[1] + y, at[2]) > -300;
      }
    }
    tissue_lost += solid;
  }
  EXPECT_EQ(organ_lost, 0u);
  EXPECT_EQ(tissue_lost, 0u);
}

TEST(RealFace, NeitherABareSkullNorAnAbdomenHasOne) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const Volume skull = importedCt(data / "head-ct-plastic-skull");
  EXPECT_FALSE(findFace(skull).found);
  EXPECT_FALSE(findFace(skull, "BRAIN").found);  // what its header says
  const auto abdomen = readVolume(data / "abdomen-ct-totalsegmentator/example_ct.nii.gz");
  ASSERT_TRUE(abdomen.ok());
  EXPECT_FALSE(findFace(*abdomen).found);
}

}  // namespace trephine::test
