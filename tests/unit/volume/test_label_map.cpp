#include "volume/label_map.h"

#include <fstream>

#include "support.h"
#include "volume/volume_files.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::obliqueVolume;

std::uint8_t labelOf(std::size_t voxel) {
  return std::uint8_t(voxel * 37 % 251);
}

// Another label in every voxel than in its neighbours.
LabelMap patternOn(const GridGeometry& geometry) {
  LabelMap map{geometry, std::vector<std::uint8_t>(geometry.voxelCount())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) map.labels[i] = labelOf(i);
  return map;
}

// The same voxels as a file with its axes in another order and direction has them: its axis n is
// axis order[n] of `map`, backwards where flipped.
LabelMap reordered(const LabelMap& map, const std::array<int, 3>& order, int flips) {
  const GridGeometry& from = map.geometry;
  LabelMap out;
  GridGeometry& g = out.geometry;
  Vec3 first(0.0);
  for (int n = 0; n < 3; ++n) {
    const int axis = order[std::size_t(n)];
    const bool flipped = flips >> n & 1;
    g.size[std::size_t(n)] = from.size[std::size_t(axis)];
    g.spacing_mm[n] = from.spacing_mm[axis];
    g.direction[n] = flipped ? -from.direction[axis] : from.direction[axis];
    if (flipped) first[axis] = from.size[std::size_t(axis)] - 1;
  }
  g.origin_mm = from.toPatient_mm(first);
  out.labels.resize(map.labels.size());
  for (std::size_t i = 0; i < out.labels.size(); ++i) {
    const Index3 at = g.indicesOf(i);
    Index3 there{};
    for (int n = 0; n < 3; ++n) {
      const auto axis = std::size_t(order[std::size_t(n)]);
      const int step = at[std::size_t(n)];
      there[axis] = flips >> n & 1 ? from.size[axis] - 1 - step : step;
    }
    out.labels[i] = map.labels[from.indexOf(there[0], there[1], there[2])];
  }
  return out;
}

TEST(LabelMap, IsWrittenAsBytesAndReadBackTheSame) {
  const test::TemporaryFolder folder;
  const LabelMap map = patternOn(obliqueVolume({6, 5, 4}).geometry);
  for (const char* name : {"a.nii.gz", "a.nii", "a.mha"}) {
    for (const bool reversed : {false, true}) {
      ASSERT_TRUE(writeLabelMap(map, folder / name, reversed));
      const auto header = readVolumeFileHeader(folder / name);
      ASSERT_TRUE(header) << header.error().sentence();
      EXPECT_EQ(header->type, VoxelType::uint8);
      EXPECT_EQ(header->reversed_slices, reversed) << name;
      const auto back = readLabelMap(folder / name);
      ASSERT_TRUE(back) << back.error().sentence();
      EXPECT_EQ(back->labels, map.labels) << name;
      const Vec3 corner(5, 4, 3);
      EXPECT_LT(
          glm::length(back->geometry.toPatient_mm(corner) - map.geometry.toPatient_mm(corner)),
          1e-3);
    }
  }
  EXPECT_EQ(writeLabelMap(map, folder / "a.png").error().code.str(), "UNKNOWN_FORMAT");
}

TEST(LabelMap, ReadsTheLabelsOfEveryVolumeFile) {
  const test::TemporaryFolder folder;
  Volume volume = obliqueVolume({6, 5, 4});
  for (std::size_t i = 0; i < volume.hu.size(); ++i) volume.hu[i] = labelOf(i);
  volume.hu[0] = 0;
  volume.hu[1] = 255;
  for (const char* name : {"a.nii.gz", "a.nii", "a.mha"}) {
    ASSERT_TRUE(writeVolume(volume, folder / name));
    const Result<LabelMap> map = readLabelMap(folder / name);
    ASSERT_TRUE(map.ok()) << map.error().sentence();
    EXPECT_EQ(Voxels(map->labels.begin(), map->labels.end()), volume.hu);
    EXPECT_NEAR(glm::length(map->geometry.origin_mm - volume.geometry.origin_mm), 0.0, 1e-4);
  }
}

TEST(LabelMap, RefusesAFileWhoseValuesAreNoLabelsAndNamesTheValue) {
  const test::TemporaryFolder folder;
  for (int value : {-1, -7, -1024}) {
    Volume volume = obliqueVolume({6, 5, 4});
    std::fill(volume.hu.begin(), volume.hu.end(), std::int16_t(1));
    volume.hu[77] = std::int16_t(value);
    ASSERT_TRUE(writeVolume(volume, folder / "a.mha"));
    const Result<LabelMap> map = readLabelMap(folder / "a.mha");
    ASSERT_FALSE(map.ok()) << value;
    EXPECT_EQ(map.error().code.str(), "NOT_LABELS");
    EXPECT_NE(map.error().what.find(std::to_string(value)), std::string::npos);
  }
}

TEST(LabelMap, RefusesVoxelsThatAreNoWholeNumbers) {
  const test::TemporaryFolder folder;
  for (float value : {5.0f, 5.5f, std::nanf("")}) {
    std::vector<float> voxels(8, 1.0f);
    voxels[3] = value;
    std::ofstream(folder / "a.mha", std::ios::binary)
        << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
           "ElementSpacing = 1 1 1\nDimSize = 2 2 2\nElementType = MET_FLOAT\n"
           "ElementDataFile = LOCAL\n"
        << std::string(reinterpret_cast<const char*>(voxels.data()), 32);
    const Result<LabelMap> map = readLabelMap(folder / "a.mha");
    ASSERT_EQ(map.ok(), value == 5.0f) << "as whole numbers, floats are labels too";
    if (map) {
      EXPECT_EQ(map->labels[3], 5);
    } else {
      EXPECT_EQ(map.error().code.str(), "NOT_LABELS");
      EXPECT_NE(map.error().what.find("1 of the voxels"), std::string::npos) << map.error().what;
    }
  }
  EXPECT_EQ(readLabelMap(folder / "none.mha").error().code.str(), "MISSING_FILE");
}

TEST(LabelMap, FitsExactlyWhateverTheOrderAndDirectionOfItsAxes) {
  const GridGeometry ct = obliqueVolume({7, 5, 4}).geometry;
  const LabelMap map = patternOn(ct);
  for (const std::array<int, 3>& order : {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0},
                                          {2, 0, 1}, {2, 1, 0}}) {
    for (int flips = 0; flips < 8; ++flips) {
      const Result<LabelMap> fitted = fitTo(reordered(map, order, flips), ct);
      ASSERT_TRUE(fitted.ok()) << fitted.error().sentence();
      EXPECT_EQ(fitted->labels, map.labels) << order[0] << order[1] << order[2] << " " << flips;
      EXPECT_EQ(fitted->geometry, ct);
    }
  }
}

TEST(LabelMap, FitsExactlyWhenAFileRoundedItsPlace) {
  const GridGeometry ct = obliqueVolume({7, 5, 4}).geometry;
  LabelMap map = patternOn(ct);
  for (int n = 0; n < 3; ++n) {
    map.geometry.origin_mm[n] = float(ct.origin_mm[n]) + 2e-4f;
    for (int m = 0; m < 3; ++m) map.geometry.direction[n][m] = float(ct.direction[n][m]);
  }
  EXPECT_EQ(fitTo(map, ct)->labels, patternOn(ct).labels);
}

TEST(LabelMap, TakesTheNearestLabelWhereTheGridIsAnother) {
  GridGeometry coarse, fine;
  coarse.size = {4, 4, 4};
  coarse.spacing_mm = Vec3(2.0);
  fine.size = {8, 8, 8};
  fine.origin_mm = Vec3(-0.5);  // two to a coarse voxel on each axis
  const LabelMap map = patternOn(coarse);
  const Result<LabelMap> fitted = fitTo(map, fine);
  ASSERT_TRUE(fitted.ok());
  for (std::size_t i = 0; i < fitted->labels.size(); ++i) {
    const Index3 at = fine.indicesOf(i);
    ASSERT_EQ(fitted->labels[i], map.labels[coarse.indexOf(at[0] / 2, at[1] / 2, at[2] / 2)]) << i;
  }
}

// Every second centre lies just between two of the label map's voxels, on oblique grids where
// rounding differs from voxel to voxel.
TEST(LabelMap, SendsAllCentresBetweenTwoVoxelsToTheSameSide) {
  for (double angle : {0.1, 0.7, 1.3, 2.9}) {
    GridGeometry fine = obliqueVolume({21, 19, 17}).geometry;
    fine.direction = glm::mat3_cast(glm::angleAxis(angle, glm::normalize(Vec3(1, 2, -3))));
    GridGeometry coarse = fine;
    coarse.size[0] = 11;
    coarse.spacing_mm.x *= 2.0;
    LabelMap map{coarse, std::vector<std::uint8_t>(coarse.voxelCount())};
    for (std::size_t i = 0; i < map.labels.size(); ++i) {
      map.labels[i] = std::uint8_t(coarse.indicesOf(i)[0]);
    }
    const Result<LabelMap> fitted = fitTo(map, fine);
    ASSERT_TRUE(fitted.ok());
    for (std::size_t i = 0; i < fitted->labels.size(); ++i) {
      ASSERT_EQ(fitted->labels[i], (fine.indicesOf(i)[0] + 1) / 2) << angle << " " << i;
    }
  }
}

TEST(LabelMap, HasNoLabelWhereItDoesNotReach) {
  GridGeometry ct = obliqueVolume({6, 5, 8}).geometry, part = ct;
  part.size[2] = 3;
  part.origin_mm = ct.toPatient_mm({0, 0, 4});
  LabelMap map{part, std::vector<std::uint8_t>(part.voxelCount(), 9)};
  const Result<LabelMap> fitted = fitTo(map, ct);
  ASSERT_TRUE(fitted.ok());
  for (std::size_t i = 0; i < fitted->labels.size(); ++i) {
    const int k = ct.indicesOf(i)[2];
    ASSERT_EQ(fitted->labels[i], k >= 4 && k < 7 ? 9 : 0) << i;
  }
}

TEST(LabelMap, OfAnotherPlaceIsRefused) {
  const GridGeometry ct = obliqueVolume({6, 5, 4}).geometry;
  LabelMap map = patternOn(ct);
  map.geometry.origin_mm = ct.toPatient_mm({0, 0, 4});
  const Result<LabelMap> fitted = fitTo(map, ct);
  ASSERT_FALSE(fitted.ok());
  EXPECT_EQ(fitted.error().code.str(), "LABELS_ELSEWHERE");
}

TEST(LabelMap, IsKnownByTheSha256OfItsLabels) {
  LabelMap map{{}, {0, 1, 2}};
  EXPECT_EQ(labelsSha256(map),
            "ae4b3280e56e2faf83f414a6e3dabe9d5fbe18976544c05fed121accb85b53fc");
}

}  // namespace
}  // namespace trephine
