// What reading does to values and says of them; progress and cancel; names.
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "file_bytes.h"
#include "support.h"
#include "volumes.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::string kNrrd =
    "NRRD0004\ndimension: 3\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
    "space origin: (0,0,0)\nendian: little\nencoding: raw\n";

class VolumeFileValues : public ::testing::Test {
 protected:
  // A row of these voxels as a NRRD file.
  Result<VolumeFileReading> read(VoxelType type, const std::vector<double>& values) {
    writeBytes(folder / "a.nrrd", kNrrd + "type: " +
                                      (type == VoxelType::float32   ? "float"
                                       : type == VoxelType::float64 ? "double"
                                                                    : voxelTypeName(type)) +
                                      "\nsizes: " + std::to_string(values.size()) + " 1 1\n\n" +
                                      voxelsAs(type, values));
    return readVolumeFile(folder / "a.nrrd");
  }
  const TemporaryFolder folder;
};

TEST_F(VolumeFileValues, FractionsAreRoundedToTheNearestHuAndCounted) {
  for (VoxelType type : {VoxelType::float32, VoxelType::float64}) {
    const auto reading = read(type, {-1000, 0.25, 0.5, -0.5, -0.75, 40.5, 1e-7, 3071});
    ASSERT_TRUE(reading) << reading.error().sentence();
    EXPECT_EQ(reading->volume.hu, (Voxels{-1000, 0, 1, 0, -1, 41, 0, 3071}));
    EXPECT_EQ(reading->rounded, 5u) << "1e-7 is what a float leaves of 0";
    EXPECT_EQ(reading->clamped, 0u);
    EXPECT_EQ(reading->not_numbers, 0u);
    EXPECT_EQ(reading->hu_min, -1000.0);
    EXPECT_EQ(reading->hu_max, 3071.0);
  }
}

TEST_F(VolumeFileValues, WhatIsNoNumberBecomesAirAndIsCounted) {
  const auto reading = read(VoxelType::float32, {kNan, 5, kInfinity, -kInfinity, 6});
  ASSERT_TRUE(reading) << reading.error().sentence();
  EXPECT_EQ(reading->volume.hu, (Voxels{-1000, 5, -1000, -1000, 6}));
  EXPECT_EQ(reading->not_numbers, 3u);
  EXPECT_EQ(reading->rounded + reading->clamped, 0u);
  EXPECT_EQ(reading->hu_min, 5.0) << "of those that are numbers";
  EXPECT_EQ(reading->hu_max, 6.0);
  EXPECT_EQ(read(VoxelType::float32, {kNan, kInfinity}).error().code.str(), "NOT_HU");
}

TEST_F(VolumeFileValues, WhatSixteenBitsCannotHoldIsClampedAndCounted) {
  const auto reading = read(VoxelType::int32, {-40000, 5, 32767, -32768, 32768});
  ASSERT_TRUE(reading) << reading.error().sentence();
  EXPECT_EQ(reading->volume.hu, (Voxels{-32768, 5, 32767, -32768, 32767}));
  EXPECT_EQ(reading->clamped, 2u);
  EXPECT_EQ(reading->rounded, 0u);
  EXPECT_EQ(reading->hu_min, -40000.0) << "before clamping";
  EXPECT_EQ(reading->hu_max, 32768.0);
  // 32767.4 rounds into the range, 32767.5 does not.
  const auto edge = read(VoxelType::float64, {32767.4, 32767.5, -32768.5, 0, 0, 0});
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->clamped, 1u);
  EXPECT_EQ(edge->rounded, 2u);
}

TEST_F(VolumeFileValues, AnImageThatIsMostlyBeyondSixteenBitsIsNotHu) {
  EXPECT_TRUE(read(VoxelType::uint64, {1e18, 5, 1e18, 6}));
  const auto reading = read(VoxelType::uint64, {1e18, 5, 1e18, 1e18});
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().code.str(), "NOT_HU");
}

TEST_F(VolumeFileValues, StoredValuesThatAreNoHuShowInTheRange) {
  // Twelve bits without a rescale: the common trap. All that reading can do is say the range.
  const auto reading = read(VoxelType::uint16, {0, 24, 1064, 4095});
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->header.type, VoxelType::uint16);
  EXPECT_EQ(reading->header.slope, 1.0);
  EXPECT_EQ(reading->header.intercept, 0.0);
  EXPECT_EQ(reading->hu_min, 0.0);
  EXPECT_EQ(reading->hu_max, 4095.0);
}

TEST_F(VolumeFileValues, ProgressRisesAndReadingCanBeCancelled) {
  const Volume volume = patternVolume({100, 100, 100});
  for (const char* name : {"a.mha", "a.nii.gz"}) {
    ASSERT_TRUE(writeVolume(volume, folder / name));
    std::vector<double> fractions;
    const Progress watched(
        [&](double fraction, const std::string&) { fractions.push_back(fraction); });
    ASSERT_TRUE(readVolumeFile(folder / name, watched));
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GE(fractions.size(), 4u);
    EXPECT_EQ(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);

    int reports = 0;
    Progress* self = nullptr;
    Progress cancelled([&](double, const std::string&) {
      if (++reports == 2) self->cancel();
    });
    self = &cancelled;
    const auto reading = readVolumeFile(folder / name, cancelled);
    ASSERT_FALSE(reading);
    EXPECT_EQ(reading.error().code.str(), "CANCELLED");
    EXPECT_EQ(reports, 2);
  }
}

TEST_F(VolumeFileValues, MemoryIsTakenAsVoxelsComeNotAsTheHeaderPromises) {
  // 2 MB that cannot be packed any closer could, by their length, be the promised 800 MB.
  std::string noise;
  for (std::uint32_t i = 0, state = 1; i < 2000000; ++i) {
    state = state * 1664525u + 1013904223u;
    noise.push_back(char(state >> 24));
  }
  writeBytes(folder / "a.nrrd",
             "NRRD0004\ntype: short\ndimension: 3\nspace: LPS\nsizes: 1000 1000 400\n"
             "space directions: (1,0,0) (0,1,0) (0,0,1)\nendian: little\nencoding: gzip\n\n" +
                 packed(noise, Packing::gzip));
  const double before = peakResidentMb();
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE");
  EXPECT_LT(peakResidentMb() - before, 200.0) << "an address sanitizer keeps books of an eighth";
}

TEST_F(VolumeFileValues, AHeaderIsReadWithoutItsVoxels) {
  // No volume can come of it, but what it is can be told.
  writeBytes(folder / "a.nii.gz", packed("not a header", Packing::gzip));
  EXPECT_EQ(readVolumeFileHeader(folder / "a.nii.gz").error().code.str(), "UNREADABLE");
  ASSERT_TRUE(writeVolume(patternVolume({100, 100, 100}), folder / "b.nii.gz"));
  std::string bytes = bytesOf(folder / "b.nii.gz");
  bytes.resize(bytes.size() / 2);
  writeBytes(folder / "b.nii.gz", bytes);
  const auto header = readVolumeFileHeader(folder / "b.nii.gz");
  ASSERT_TRUE(header) << header.error().sentence();
  EXPECT_EQ(header->geometry.size, (Index3{100, 100, 100}));
  EXPECT_EQ(header->geometry.voxelCount(), 1000000u);
  EXPECT_EQ(codeOf(folder / "b.nii.gz"), "UNREADABLE");
}

TEST_F(VolumeFileValues, AHeaderThatPromisesTooMuchIsRefusedBeforeVoxelsAreRead) {
  const std::string head = kNrrd + "type: short\nsizes: 100 100 100\n\n";
  writeBytes(folder / "a.nrrd", head + std::string(1999999, '\0'));
  EXPECT_EQ(readVolumeFileHeader(folder / "a.nrrd").error().code.str(), "UNREADABLE");
  writeBytes(folder / "a.nrrd", head + std::string(2000000, '\0'));
  EXPECT_TRUE(readVolumeFileHeader(folder / "a.nrrd"));
  // 1,500 bytes cannot unpack to 2,000,000, whatever they are; 2,500 might.
  std::string gzip = head;
  gzip.replace(gzip.find("raw"), 3, "gzip");
  writeBytes(folder / "a.nrrd", gzip + std::string(1500, '\0'));
  EXPECT_EQ(readVolumeFileHeader(folder / "a.nrrd").error().code.str(), "UNREADABLE");
  writeBytes(folder / "a.nrrd", gzip + std::string(2500, '\0'));
  EXPECT_TRUE(readVolumeFileHeader(folder / "a.nrrd"));
}

TEST_F(VolumeFileValues, AVolumeFileIsKnownByItsNameInEitherCase) {
  for (const char* name : {"a.mha", "a.MHD", "a.nii", "a.NII.GZ", "a.nrrd", "a.Nhdr", "a.raw"}) {
    EXPECT_TRUE(isVolumeFile(folder / name)) << name;
  }
  for (const char* name : {"a", "a.gz", "a.dcm", "nii", "a.nii.zip", "a.json", ""}) {
    EXPECT_FALSE(isVolumeFile(folder / name)) << name;
  }
  writeBytes(folder / "b.RAW", "");
  EXPECT_TRUE(isVolumeFile(folder / "b.json")) << "a sidecar";
}

TEST_F(VolumeFileValues, APackedNiftiIsKnownByItsContent) {
  ASSERT_TRUE(writeVolume(patternVolume({4, 4, 4}), folder / "a.nii.gz"));
  fs::rename(folder / "a.nii.gz", folder / "b.nii");
  ASSERT_TRUE(writeVolume(patternVolume({4, 4, 4}), folder / "a.nii"));
  fs::rename(folder / "a.nii", folder / "b.nii.gz");
  for (const char* name : {"b.nii", "b.nii.gz"}) {
    const auto read = readVolume(folder / name);
    ASSERT_TRUE(read) << name << ": " << read.error().sentence();
    EXPECT_EQ(read->hu, patternVolume({4, 4, 4}).hu);
  }
}

}  // namespace
}  // namespace trephine
