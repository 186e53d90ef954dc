#include <functional>

#include "imaging/importer.h"
#include "imaging/steps/anatomy.h"
#include "support.h"
#include "volume/phantom_file.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

Volume part(const Volume& of, const Index3& low, const Index3& high) {
  Volume out;
  out.geometry = of.geometry;
  for (std::size_t a = 0; a < 3; ++a) out.geometry.size[a] = high[a] - low[a];
  out.geometry.origin_mm = of.geometry.toPatient_mm(Vec3(low[0], low[1], low[2]));
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) out.hu.push_back(of.at(i, j, k));
    }
  }
  return out;
}

// Its axes in another order, or upside down, while the header says nothing of it.
Volume turned(const Volume& of, const std::array<std::size_t, 3>& order, bool upside_down) {
  Volume out = of;
  for (std::size_t a = 0; a < 3; ++a) {
    out.geometry.size[a] = of.geometry.size[order[a]];
    out.geometry.spacing_mm[int(a)] = of.geometry.spacing_mm[int(order[a])];
  }
  for (std::size_t v = 0; v < of.hu.size(); ++v) {
    Index3 from = of.geometry.indicesOf(v), at;
    if (upside_down) from[2] = of.geometry.size[2] - 1 - from[2];
    for (std::size_t a = 0; a < 3; ++a) at[a] = from[order[a]];
    out.hu[out.geometry.indexOf(at[0], at[1], at[2])] = of.hu[v];
  }
  return out;
}

// Whole it is named; halves and turned ones are named right or not at all.
void expectNamed(const Volume& volume, BodyRegion region, const std::string& name,
                 bool whole_is_known = true) {
  const Anatomy whole = anatomyOf(volume);
  if (whole_is_known) {
    EXPECT_EQ(whole.region, region) << name;
  }
  int known = 0, wrong = 0;
  const auto look = [&](const Volume& v) {
    const BodyRegion found = anatomyOf(v).region;
    known += found == region;
    wrong += found != region && found != BodyRegion::not_sure;
  };
  const Index3& n = volume.geometry.size;
  for (std::size_t a = 0; a < 3; ++a) {
    Index3 low{0, 0, 0}, high = n;
    high[a] = n[a] / 2;
    look(part(volume, low, high));
    low[a] = n[a] / 2;
    high[a] = n[a];
    look(part(volume, low, high));
  }
  look(turned(volume, {2, 1, 0}, false));
  look(turned(volume, {0, 2, 1}, false));
  look(turned(volume, {0, 1, 2}, true));
  EXPECT_EQ(wrong, 0) << name;
  std::printf("%-32s %s, 6 halves and 3 turns: %d right, %d not sure\n", name.c_str(),
              bodyRegionName(whole.region), known, 9 - known - wrong);
}

TEST(Anatomy, OfTheBuiltInCasesIsNamedAlsoByHalvesAndTurned) {
  expectNamed(openPhantom("cranium")->volume, BodyRegion::head, "phantom:cranium");
  expectNamed(openPhantom("abdomen")->volume, BodyRegion::abdomen, "phantom:abdomen");
}

TEST(Anatomy, OfRealCtIsNamedAlsoByHalvesAndTurned) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const std::filesystem::path folder(data);
  const auto dicom = [&](const char* name) {
    auto scanned = CtFolder::scan(folder / name, Progress());
    return *scanned->read(*scanned->bestSeries(), {}, Progress());
  };
  expectNamed(dicom("head-ct-plastic-skull"), BodyRegion::head, "plastic skull");
  expectNamed(dicom("head-ct-gantry-tilt"), BodyRegion::head, "tilted skull");
  expectNamed(dicom("abdomen-ct-totalsegmentator/example_ct_dicom"), BodyRegion::abdomen,
              "abdomen, 20 slices");
  expectNamed(*readVolume(folder / "abdomen-ct-totalsegmentator/example_ct.nii.gz"),
              BodyRegion::abdomen, "abdomen");
}

TEST(Anatomy, SaysWhetherAHeadHasItsVault) {
  const Volume head = openPhantom("cranium")->volume;
  EXPECT_TRUE(anatomyOf(head).vault);
  const Index3& n = head.geometry.size;
  const Anatomy without = anatomyOf(part(head, {0, 0, 0}, {n[0], n[1], 2 * n[2] / 3}));
  EXPECT_EQ(without.region, BodyRegion::head);
  EXPECT_FALSE(without.vault);
}

TEST(Anatomy, OfNothingAndOfABallOfWaterIsNotKnown) {
  Volume volume;
  volume.geometry.size = {80, 80, 80};
  volume.geometry.spacing_mm = Vec3(4.0);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  EXPECT_EQ(anatomyOf(volume).region, BodyRegion::not_sure);
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    const Index3 at = volume.geometry.indicesOf(v);
    if (glm::length(Vec3(at[0], at[1], at[2]) - Vec3(40.0)) < 30.0) volume.hu[v] = 0;
  }
  EXPECT_EQ(anatomyOf(volume).region, BodyRegion::not_sure);
  Progress cancelled;
  cancelled.cancel();
  EXPECT_EQ(anatomyOf(openPhantom("cranium")->volume, cancelled).region, BodyRegion::not_sure);
}

}  // namespace
}  // namespace trephine
