#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "file_bytes.h"
#include "file_size_limit.h"
#include "support.h"
#include "volumes.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// The largest difference of any element, relative to the size of the volume.
double affineDifference(const GridGeometry& a, const GridGeometry& b) {
  double largest = 0.0;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      largest = std::max(largest, std::abs(a.voxelToPatient()[c][r] - b.voxelToPatient()[c][r]));
    }
  }
  return largest;
}

TEST(VolumeFiles, AnObliqueMetaImageComesBackExactly) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume({13, 9, 7});
  ASSERT_TRUE(writeVolume(volume, folder / "a.mha"));
  const auto read = readVolume(folder / "a.mha");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_EQ(read->geometry, volume.geometry) << "to the last bit";
  EXPECT_EQ(read->hu, volume.hu);
}

TEST(VolumeFiles, AnObliqueNiftiComesBackToFloatPrecision) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume({13, 9, 7});
  for (const char* name : {"a.nii", "a.nii.gz"}) {
    ASSERT_TRUE(writeVolume(volume, folder / name)) << name;
    const auto read = readVolume(folder / name);
    ASSERT_TRUE(read) << name << ": " << read.error().sentence();
    EXPECT_EQ(read->geometry.size, volume.geometry.size);
    EXPECT_LT(affineDifference(read->geometry, volume.geometry), 1e-4) << name;
    EXPECT_EQ(read->hu, volume.hu) << name;
  }
  EXPECT_LT(fs::file_size(folder / "a.nii.gz"), fs::file_size(folder / "a.nii"));
}

TEST(VolumeFiles, ALeftHandedVolumeKeepsEveryVoxelsPlace) {
  const TemporaryFolder folder;
  Volume volume = obliqueVolume({5, 4, 6});
  volume.geometry.direction[2] = -volume.geometry.direction[2];
  for (const char* name : {"a.mha", "a.nii", "a.nii.gz"}) {
    ASSERT_TRUE(writeVolume(volume, folder / name));
    const auto read = readVolume(folder / name);
    ASSERT_TRUE(read) << read.error().sentence();
    EXPECT_GT(glm::determinant(read->geometry.direction), 0.0);
    for (int k = 0; k < 6; ++k) {
      const Vec3 there = volume.geometry.toPatient_mm({1, 2, k});
      EXPECT_LT(glm::distance(read->geometry.toPatient_mm({1, 2, 5 - k}), there), 1e-4);
      EXPECT_EQ(read->at(1, 2, 5 - k), volume.at(1, 2, k));
    }
  }
}

TEST(VolumeFiles, NiftiIsRasOnDiskInSformAndQform) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume({13, 9, 7});
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  const std::string bytes = bytesOf(folder / "a.nii");
  EXPECT_EQ(bytes.substr(344, 3), "n+1");
  EXPECT_EQ(at<std::int16_t>(bytes, 40), 3);
  EXPECT_EQ(at<std::int16_t>(bytes, 42), 13);
  EXPECT_EQ(at<std::int16_t>(bytes, 46), 7);
  EXPECT_EQ(at<std::int16_t>(bytes, 70), 4) << "int16";
  EXPECT_EQ(bytes[123] & 7, 2) << "mm";
  EXPECT_GT(at<std::int16_t>(bytes, 252), 0) << "qform code";
  EXPECT_GT(at<std::int16_t>(bytes, 254), 0) << "sform code";
  const Mat4 lps = volume.geometry.voxelToPatient();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double ras = (row < 2 ? -1 : 1) * lps[column][row];
      EXPECT_NEAR(at<float>(bytes, std::size_t(280 + 16 * row + 4 * column)), ras, 1e-4);
    }
  }
  const double b = at<float>(bytes, 256), c = at<float>(bytes, 260), d = at<float>(bytes, 264);
  const Quat q(std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d)), b, c, d);
  const Mat3 ras = glm::mat3_cast(q);
  EXPECT_NEAR(at<float>(bytes, 76), 1.0, 0) << "qfac";
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(at<float>(bytes, std::size_t(80 + 4 * axis)), volume.geometry.spacing_mm[axis],
                1e-6);
    for (int row = 0; row < 3; ++row) {
      const double expected = (row < 2 ? -1 : 1) * volume.geometry.direction[axis][row];
      EXPECT_NEAR(ras[axis][row], expected, 1e-5);
    }
  }
  EXPECT_EQ(at<std::int16_t>(bytes, 352 + 2 * 5), volume.hu[5]) << "voxels in our order";
}

TEST(VolumeFiles, TheQformAloneGivesTheSameAffine) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume({6, 5, 4});
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  bytes[254] = bytes[255] = 0;  // no sform
  for (std::size_t i = 280; i < 328; ++i) bytes[i] = 0;
  writeBytes(folder / "q.nii", bytes);
  const auto read = readVolume(folder / "q.nii");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_LT(affineDifference(read->geometry, volume.geometry), 1e-4);
  EXPECT_EQ(read->hu, volume.hu);
}

TEST(VolumeFiles, AHalfTurnInAQformIsNotOffByWhatFloatsLeaveOfIt) {
  const TemporaryFolder folder;
  Volume volume = patternVolume({6, 5, 4});
  volume.geometry.direction = Mat3(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0));  // coronal
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  bytes[254] = bytes[255] = 0;  // no sform
  writeBytes(folder / "q.nii", bytes);
  const auto read = readVolume(folder / "q.nii");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_LT(affineDifference(read->geometry, volume.geometry), 1e-6);
}

TEST(VolumeFiles, AQformWithANegativeQfacIsReadWithItsSlicesReversed) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume({6, 5, 4});
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  const float qfac = -1.0f;
  std::memcpy(bytes.data() + 76, &qfac, 4);
  bytes[254] = bytes[255] = 0;
  writeBytes(folder / "q.nii", bytes);
  const auto read = readVolume(folder / "q.nii");
  ASSERT_TRUE(read) << read.error().sentence();
  // The file's slice k lies k steps against the normal, and is our slice 3 - k.
  GridGeometry in_file = volume.geometry;
  in_file.direction[2] = -in_file.direction[2];
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(
        glm::distance(read->geometry.toPatient_mm({1, 2, 3 - k}), in_file.toPatient_mm({1, 2, k})),
        1e-3);
    EXPECT_EQ(read->at(1, 2, 3 - k), volume.at(1, 2, k));
  }
}

TEST(VolumeFiles, NiftiRescaleAndUnitAreHonoured) {
  const TemporaryFolder folder;
  Volume volume = patternVolume({4, 4, 4});
  for (std::size_t i = 0; i < volume.hu.size(); ++i) volume.hu[i] = std::int16_t(i);
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  const float slope = 2.5f, intercept = -1024.0f;
  std::memcpy(bytes.data() + 112, &slope, 4);
  std::memcpy(bytes.data() + 116, &intercept, 4);
  bytes[123] = char((bytes[123] & ~7) | 1);  // metres
  writeBytes(folder / "s.nii", bytes);
  const auto read = readVolume(folder / "s.nii");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_EQ(read->hu[10], 25 - 1024);
  EXPECT_EQ(read->hu[1], -1021) << "2.5 - 1024, rounded";
  EXPECT_NEAR(read->geometry.spacing_mm.x, 1000.0, 1e-2);
}

TEST(VolumeFiles, ANiftiSlopeThatIsNoNumberMeansNoneAndIsNoted) {
  const TemporaryFolder folder;
  const Volume volume = patternVolume({4, 4, 4});
  ASSERT_TRUE(writeVolume(volume, folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  std::string nan;
  append(nan, std::numeric_limits<float>::quiet_NaN());
  writeBytes(folder / "a.nii", bytes.replace(112, 8, nan + nan));
  const auto reading = readVolumeFile(folder / "a.nii");
  ASSERT_TRUE(reading) << reading.error().sentence();
  EXPECT_EQ(reading->volume.hu, volume.hu);
  EXPECT_EQ(reading->header.notes.size(), 1u);
}

TEST(VolumeFiles, AMetaImageFromElsewhereIsReadInItsConvention) {
  // As ITK and 3D Slicer write it: the axes one after another. Here i runs to the back (+y), j to
  // the left's opposite (-x), k up; big-endian, in a file of its own.
  const TemporaryFolder folder;
  writeBytes(folder / "a.mhd",
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\n"
             "CompressedData = False\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 6 7\n"
             "CenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\nElementSpacing = 2 3 4\n"
             "DimSize = 2 2 1\nElementType = MET_SHORT\nElementDataFile = a.raw\n");
  writeBytes(folder / "a.raw", std::string("\x00\x01\x00\x02\xff\xfe\x0b\xb8", 8));
  const auto read = readVolume(folder / "a.mhd");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_EQ(read->geometry.toPatient_mm({1, 0, 0}), Vec3(5, 8, 7));
  EXPECT_EQ(read->geometry.toPatient_mm({0, 1, 0}), Vec3(2, 6, 7));
  EXPECT_EQ(read->hu, (Voxels{1, 2, -2, 3000}));
}

TEST(VolumeFiles, ACompressedMetaImageIsReadAndADamagedOneNoticed) {
  const TemporaryFolder folder;
  // 2x2x2 big-endian int16, 1 to 8, packed by zlib.
  const unsigned char packed[] = {120, 218, 99, 96, 100, 96,  98, 96, 102, 96,  97, 96,
                                  101, 96,  99, 96, 103, 224, 0,  0,  0,   220, 0,  37};
  std::string file =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\n"
      "CompressedData = True\nCompressedDataSize = " +
      std::to_string(sizeof packed) +
      "\nElementSpacing = 1 1 1\nDimSize = 2 2 2\nElementType = MET_SHORT\n"
      "ElementDataFile = LOCAL\n";
  const std::size_t header = file.size();
  file.append(reinterpret_cast<const char*>(packed), sizeof packed);
  writeBytes(folder / "a.mha", file);
  const auto read = readVolume(folder / "a.mha");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_EQ(read->hu, (Voxels{1, 2, 3, 4, 5, 6, 7, 8}));
  file[header + 7] = char(file[header + 7] ^ 0x15);
  writeBytes(folder / "b.mha", file);
  EXPECT_EQ(readVolume(folder / "b.mha").error().code.str(), "UNREADABLE");
  writeBytes(folder / "c.mha", file.substr(0, file.size() - 2));
  EXPECT_EQ(readVolume(folder / "c.mha").error().code.str(), "UNREADABLE");
}

TEST(VolumeFiles, EndingsAreReadInEitherCase) {
  const TemporaryFolder folder;
  const Volume volume = patternVolume({5, 4, 3});
  for (const char* ending : {".mha", ".nii", ".nii.gz"}) {
    ASSERT_TRUE(writeVolume(volume, folder / (std::string("a") + ending)));
    std::string upper = std::string("B") + ending;
    for (char& c : upper) c = char(std::toupper(c));
    fs::rename(folder / (std::string("a") + ending), folder / upper);
    const auto read = readVolume(folder / upper);
    ASSERT_TRUE(read) << read.error().sentence();
    EXPECT_EQ(read->hu, volume.hu);
    EXPECT_EQ(writeVolume(volume, folder / upper).error().code.str(), "UNKNOWN_FORMAT");
  }
}

TEST(VolumeFiles, MetaImagesOfOtherWholeNumberTypesAreRead) {
  const TemporaryFolder folder;
  const std::string head =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "ElementSpacing = 1 1 1\nDimSize = 2 1 1\n";
  writeBytes(folder / "u8.mha",
             head + "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n\x07\xff");
  writeBytes(folder / "i32.mha", head + "ElementType = MET_INT\nElementDataFile = LOCAL\n" +
                                     std::string("\x18\xfc\xff\xff\x00\x01\x00\x00", 8));
  writeBytes(folder / "u16.mha",
             head +
                 "ElementToIntensityFunctionSlope = 1\nElementToIntensityFunctionOffset = -1024\n"
                 "ElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
                 std::string("\x00\x00\x00\x04", 4));
  EXPECT_EQ(readVolume(folder / "u8.mha").value().hu, (Voxels{7, 255}));
  EXPECT_EQ(readVolume(folder / "i32.mha").value().hu, (Voxels{-1000, 256}));
  EXPECT_EQ(readVolume(folder / "u16.mha").value().hu, (Voxels{-1024, 0}));
}

TEST(VolumeFiles, AMetaImagesVoxelsMayStandBehindAForeignHeader) {
  const TemporaryFolder folder;
  const std::string head =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "ElementSpacing = 1 1 1\nDimSize = 2 1 1\nElementType = MET_SHORT\n";
  writeBytes(folder / "a.raw", "seven b" + voxelsAs(VoxelType::int16, {5, -6}));
  for (const char* size : {"7", "-1"}) {  // -1: the voxels are the end of the file
    writeBytes(folder / "a.mhd", head + "HeaderSize = " + size + "\nElementDataFile = a.raw\n");
    const auto read = readVolume(folder / "a.mhd");
    ASSERT_TRUE(read) << read.error().sentence();
    EXPECT_EQ(read->hu, (Voxels{5, -6})) << size;
  }
  for (const char* size : {"8", "-2", "1e20", "many"}) {
    writeBytes(folder / "a.mhd", head + "HeaderSize = " + size + "\nElementDataFile = a.raw\n");
    EXPECT_EQ(codeOf(folder / "a.mhd"), "UNREADABLE") << size;
  }
}

TEST(VolumeFiles, NothingOfASourceIsInAWrittenFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeVolume(patternVolume({2, 2, 2}), folder / "Doe^Jane.mha"));
  ASSERT_TRUE(writeVolume(patternVolume({2, 2, 2}), folder / "Doe^Jane.nii"));
  EXPECT_EQ(bytesOf(folder / "Doe^Jane.mha").find("Doe"), std::string::npos);
  EXPECT_EQ(bytesOf(folder / "Doe^Jane.nii").find("Doe"), std::string::npos);
}

TEST(VolumeFiles, AFullDiskIsAnErrorAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  const Volume old = patternVolume({8, 8, 8});
  Volume larger = patternVolume({64, 64, 64});
  std::uint32_t state = 1;  // noise, so that gzip cannot make it fit
  for (auto& hu : larger.hu) hu = std::int16_t((state = state * 1664525u + 1013904223u) >> 16);
  const TemporaryFolder other;
  for (const char* name : {"a.mha", "a.nii", "a.nii.gz"}) {
    const fs::path file = folder / name;
    ASSERT_TRUE(writeVolume(larger, other / name));
    const auto whole = fs::file_size(other / name);
    for (const auto room : {rlim_t(40000), rlim_t(whole - 20)}) {
      ASSERT_TRUE(writeVolume(old, file));
      const Status status = [&] {
        const test::FileSizeLimit full(room);
        return writeVolume(larger, file);
      }();
      ASSERT_FALSE(status) << name;
      EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE") << name;
      const auto read = readVolume(file);
      ASSERT_TRUE(read) << name;
      EXPECT_EQ(read->hu, old.hu) << name << ": what was there is still there";
      fs::remove(file);
      EXPECT_TRUE(fs::is_empty(folder.path())) << name << ": nothing half-written stays";
    }
  }
}

TEST(VolumeFiles, AFolderThatIsNotThereIsAnError) {
  const TemporaryFolder folder;
  for (const char* name : {"no/such/a.mha", "no/such/a.nii", "no/such/a.nii.gz"}) {
    const Status status = writeVolume(patternVolume({4, 4, 4}), folder / name);
    ASSERT_FALSE(status) << name;
    EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
    EXPECT_NE(status.error().where.find("a."), std::string::npos);
  }
}

TEST(VolumeFiles, WhatCannotBeWrittenIsRefused) {
  const TemporaryFolder folder;
  const Volume good = patternVolume({4, 4, 4});
  EXPECT_EQ(writeVolume(good, folder / "a.dcm").error().code.str(), "UNKNOWN_FORMAT");
  EXPECT_EQ(writeVolume(good, folder / "a.mhd").error().code.str(), "UNKNOWN_FORMAT");
  Volume flat = good;
  flat.geometry.spacing_mm.z = 0.0;
  EXPECT_EQ(writeVolume(flat, folder / "a.mha").error().code.str(), "BAD_GEOMETRY");
  EXPECT_EQ(writeVolume(Volume{}, folder / "a.mha").error().code.str(), "BAD_SIZE");
  EXPECT_EQ(writeVolume(patternVolume({2, 32768, 1}), folder / "a.nii").error().code.str(),
            "CANNOT_WRITE");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(VolumeFiles, ARealAbdomenIsReadAsOtherToolsReadIt) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto ct = readVolume(data / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz");
  ASSERT_TRUE(ct) << ct.error().sentence();
  EXPECT_EQ(ct->geometry.size, (Index3{122, 101, 112}));
  EXPECT_LT(glm::length(ct->geometry.spacing_mm - Vec3(3.0)), 1e-6);
  // RAS with axes along +x, +y: in LPS they run the other way.
  EXPECT_EQ(ct->geometry.direction[0], Vec3(-1, 0, 0));
  EXPECT_EQ(ct->geometry.direction[1], Vec3(0, -1, 0));
  EXPECT_EQ(ct->geometry.direction[2], Vec3(0, 0, 1));
  EXPECT_NEAR(ct->geometry.origin_mm.x, 177.95632934570312, 1e-6);
  EXPECT_NEAR(ct->geometry.origin_mm.y, -11.319000244140625, 1e-6);
  EXPECT_NEAR(ct->geometry.origin_mm.z, 94.3017578125, 1e-6);
  // The int32 voxels as int16, hashed by numpy.
  EXPECT_EQ(volumeSha256(*ct), "dedfbdb72fb24a5cb908a1171353e4457eeb6569cddc874af02a04a4f29f5489");

  // A label map whose header is left-handed (qfac -1): slices reversed.
  const auto seg = readVolume(data / "abdomen-ct-totalsegmentator" / "example_seg_dicom.nii.gz");
  ASSERT_TRUE(seg) << seg.error().sentence();
  EXPECT_EQ(volumeSha256(*seg), "f40b29a0f379cf2658105636c6ebfbab9bddaf4875a9bda212690fd3f5573cab");
  EXPECT_GT(glm::determinant(seg->geometry.direction), 0.0);
  EXPECT_NEAR(seg->geometry.origin_mm.x, -249.51171875, 1e-4);
  EXPECT_NEAR(seg->geometry.origin_mm.z, -804.5 + 19 * 2.0, 1e-4);
}

}  // namespace
}  // namespace trephine
