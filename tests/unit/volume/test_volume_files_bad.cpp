// Files that are not what they say. Each gives one Error of the header's list: no crash, no hang,
// nothing large allocated.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>

#include "base/memory.h"
#include "file_bytes.h"
#include "support.h"
#include "volumes.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

// A MetaImage of 2x2x2 int16 with one line changed, or with `changed` empty, left out.
std::string metaImage(const std::string& key = "", const std::string& changed = "") {
  std::string text;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"ObjectType", "Image"},
                                                        {"NDims", "3"},
                                                        {"BinaryData", "True"},
                                                        {"BinaryDataByteOrderMSB", "False"},
                                                        {"CompressedData", "False"},
                                                        {"TransformMatrix", "1 0 0 0 1 0 0 0 1"},
                                                        {"Offset", "0 0 0"},
                                                        {"ElementSpacing", "1 1 1"},
                                                        {"DimSize", "2 2 2"},
                                                        {"ElementNumberOfChannels", "1"},
                                                        {"ElementType", "MET_SHORT"},
                                                        {"ElementDataFile", "LOCAL"}}) {
    if (name != key)
      text += name + " = " + value + "\n";
    else if (!changed.empty())
      text += name + " = " + changed + "\n";
  }
  return text + std::string(16, '\1');
}

class BadVolumeFiles : public ::testing::Test {
 protected:
  std::string codeOfMeta(const std::string& key, const std::string& changed) {
    writeBytes(folder / "a.mha", metaImage(key, changed));
    return codeOf(folder / "a.mha");
  }
  // A NIfTI of 4x4x4 whose bytes at `offset` are replaced by `value`.
  template <class T>
  std::string codeOfNifti(std::size_t offset, T value) {
    EXPECT_TRUE(writeVolume(patternVolume({4, 4, 4}), folder / "good.nii"));
    std::string bytes = bytesOf(folder / "good.nii");
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    writeBytes(folder / "a.nii", bytes);
    return codeOf(folder / "a.nii");
  }
  const TemporaryFolder folder;
};

TEST_F(BadVolumeFiles, MissingOrNoFileOrOfAnotherKind) {
  EXPECT_EQ(codeOf(folder / "none.mha"), "MISSING_FILE");
  fs::create_directory(folder / "folder.mha");
  EXPECT_EQ(codeOf(folder / "folder.mha"), "UNREADABLE");
  fs::create_directory(folder / "folder.nii.gz");
  EXPECT_EQ(codeOf(folder / "folder.nii.gz"), "UNREADABLE");
  writeBytes(folder / "a.stl", "solid");
  EXPECT_EQ(codeOf(folder / "a.stl"), "UNKNOWN_FORMAT");
}

TEST_F(BadVolumeFiles, EmptyTextAndRandomBytes) {
  std::string noise;
  for (unsigned i = 0, state = 1; i < 100000; ++i) {
    state = state * 1664525u + 1013904223u;
    noise.push_back(char(state >> 24));
  }
  const std::string contents[] = {"", "hello, this is a letter and no volume\n", noise,
                                  std::string(400, '\0'), "ElementDataFile = LOCAL\n"};
  for (const std::string& bytes : contents) {
    for (const char* name : {"a.mha", "a.mhd", "a.nii", "a.nii.gz", "a.nrrd", "a.nhdr"}) {
      writeBytes(folder / name, bytes);
      EXPECT_EQ(codeOf(folder / name), "UNREADABLE") << name << ", " << bytes.size() << " bytes";
    }
  }
}

TEST_F(BadVolumeFiles, CutShortAtAnyLength) {
  const Volume volume = patternVolume({16, 16, 16});
  for (const char* name : {"a.mha", "a.nii", "a.nii.gz"}) {
    ASSERT_TRUE(writeVolume(volume, folder / name));
    const std::string whole = bytesOf(folder / name);
    for (double share : {0.01, 0.03, 0.1, 0.5, 0.9, 0.999}) {
      writeBytes(folder / name, whole.substr(0, std::size_t(double(whole.size()) * share)));
      EXPECT_EQ(codeOf(folder / name), "UNREADABLE") << name << " at " << share;
    }
  }
}

TEST_F(BadVolumeFiles, VoxelsBesideAHeaderThatAreMoreThanItSaysAreNotReadShifted) {
  const std::string voxels(2 * 64, '\1');
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementSpacing = 1 1 1\n"
      "ElementType = MET_SHORT\n";
  const std::string nrrd =
      "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 4 4\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: little\n"
      "encoding: raw\ndata file: v.raw\n";
  for (const std::size_t more : {352u, 1u, 2u, 32u, 128u}) {
    writeBytes(folder / "v.raw", std::string(more, '\0') + voxels);
    writeBytes(folder / "a.mhd", meta + "ElementDataFile = v.raw\n");
    writeBytes(folder / "a.nhdr", nrrd);
    for (const char* name : {"a.mhd", "a.nhdr"}) {
      EXPECT_NE(sentenceOf(folder / name).find(std::to_string(more) + " bytes longer"),
                std::string::npos)
          << sentenceOf(folder / name);
    }
    // Where the header says that they stand in front, or at the end, they are no surprise.
    writeBytes(folder / "a.mhd", meta + "HeaderSize = " + std::to_string(more) +
                                     "\nElementDataFile = v.raw\n");
    writeBytes(folder / "a.nhdr", nrrd + "byte skip: " + std::to_string(more) + "\n");
    EXPECT_EQ(codeOf(folder / "a.mhd"), "ok");
    EXPECT_EQ(codeOf(folder / "a.nhdr"), "ok");
    writeBytes(folder / "a.mhd", meta + "HeaderSize = -1\nElementDataFile = v.raw\n");
    EXPECT_EQ(codeOf(folder / "a.mhd"), "ok");
  }
}

TEST_F(BadVolumeFiles, MetaImageHeadersThatCannotBe) {
  EXPECT_EQ(codeOfMeta("", ""), "ok");
  EXPECT_EQ(codeOfMeta("NDims", "2"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", ""), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "2 2"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "2 2 -2"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "2 2 two"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "2 2 3"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "1000 1000 1000"), "UNREADABLE");
  EXPECT_EQ(codeOfMeta("DimSize", "99999999999 99999999999 9"), "TOO_LARGE");
  EXPECT_EQ(codeOfMeta("ElementSpacing", ""), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementSpacing", "1 0 1"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementSpacing", "1 1 -1"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementSpacing", "1 1 nan"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementSpacing", "1e9 1e9 1e9"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementSpacing", "1e-9 1e-9 1e-9"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("Offset", "1e12 0 0"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("TransformMatrix", "1 0 0 0 1 0 0 0.5 1"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("TransformMatrix", "2 0 0 0 1 0 0 0 1"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("TransformMatrix", "0 0 0 0 0 0 0 0 0"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("TransformMatrix", "1 0 0 0 1 0"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("Offset", "1e999 0 0"), "BAD_GEOMETRY");
  EXPECT_EQ(codeOfMeta("ElementType", "MET_FLOAT"), "UNREADABLE") << "too few bytes";
  EXPECT_EQ(codeOfMeta("ElementType", "MET_LONG"), "NOT_HU");
  EXPECT_EQ(codeOfMeta("ElementType", ""), "NOT_HU");
  EXPECT_EQ(codeOfMeta("ElementNumberOfChannels", "3"), "NOT_HU");
  EXPECT_EQ(codeOfMeta("BinaryData", "False"), "UNKNOWN_FORMAT");
  EXPECT_EQ(codeOfMeta("ElementDataFile", "LIST"), "UNKNOWN_FORMAT");
  EXPECT_EQ(codeOfMeta("ElementDataFile", "slice%03d.raw 1 2 1"), "UNKNOWN_FORMAT");
  EXPECT_EQ(codeOfMeta("ElementDataFile", "gone.raw"), "MISSING_FILE");
  EXPECT_EQ(codeOfMeta("ElementDataFile", "/etc/hostname"), "UNREADABLE") << "another folder";
  EXPECT_EQ(codeOfMeta("ElementDataFile", "../a.raw"), "UNREADABLE");
}

TEST_F(BadVolumeFiles, CompressedVoxelsThatAreNone) {
  std::string text = metaImage("CompressedData", "True");
  writeBytes(folder / "a.mha", text);
  EXPECT_EQ(codeOf(folder / "a.mha"), "UNREADABLE");
}

TEST_F(BadVolumeFiles, ValuesBeyondSixteenBits) {
  writeBytes(folder / "a.mha", metaImage("ElementType", "MET_INT") + std::string(16, '\1'));
  EXPECT_EQ(codeOf(folder / "a.mha"), "NOT_HU");
  EXPECT_EQ(codeOfNifti(112, 1000.0f), "NOT_HU") << "slope";
  EXPECT_EQ(codeOfNifti(116, std::numeric_limits<float>::quiet_NaN()), "ok") << "slope 0";
  EXPECT_EQ(codeOfNifti(112, std::array{1.0f, std::numeric_limits<float>::infinity()}), "NOT_HU");
  EXPECT_EQ(readVolumeFileHeader(folder / "a.nii").error().code.str(), "NOT_HU");
}

TEST_F(BadVolumeFiles, NiftiHeadersThatCannotBe) {
  EXPECT_EQ(codeOfNifti(148, 'x'), "ok") << "a description is not read";
  EXPECT_EQ(codeOfNifti(344, std::uint32_t(0)), "UNREADABLE") << "magic";
  EXPECT_EQ(codeOfNifti(42, std::int16_t(-4)), "UNREADABLE");
  EXPECT_EQ(codeOfNifti(42, std::int16_t(0)), "UNREADABLE");
  EXPECT_EQ(codeOfNifti(46, std::int16_t(5)), "UNREADABLE") << "one slice too many";
  EXPECT_EQ(codeOfNifti(40, std::int16_t(2)), "UNREADABLE") << "two dimensions";
  EXPECT_EQ(codeOfNifti(40, std::int16_t(30000)), "UNREADABLE");
  EXPECT_EQ(codeOfNifti(70, std::int32_t(16 | 32 << 16)), "UNREADABLE") << "float: too few bytes";
  EXPECT_EQ(codeOfNifti(70, std::int32_t(128 | 24 << 16)), "NOT_HU") << "rgb";
  EXPECT_EQ(codeOfNifti(70, std::int32_t(32 | 64 << 16)), "NOT_HU") << "complex";
  EXPECT_EQ(codeOfNifti(70, std::int32_t(1536 | 128 << 16)), "NOT_HU") << "float128";
  EXPECT_EQ(codeOfNifti(108, 300.0f), "UNREADABLE") << "voxels inside of the header";
  EXPECT_EQ(codeOfNifti(108, -352.0f), "UNREADABLE");
  EXPECT_EQ(codeOfNifti(108, 354.0f), "UNREADABLE") << "two bytes too few";
  EXPECT_EQ(codeOfNifti(108, 0.0f), "ok") << "where voxels start by custom";
  EXPECT_EQ(codeOfNifti(280, 3.0f), "FORMS_DIFFER") << "another step than that of the qform";
  // Of the two forms one alone can be a place, and a person may choose it.
  EXPECT_EQ(codeOfNifti(284, 0.5f), "FORMS_DIFFER") << "shear";
  // One that says nothing contradicts nothing.
  EXPECT_EQ(codeOfNifti(280, 0.0f), "ok") << "no first axis";
  EXPECT_EQ(codeOfNifti(292, std::numeric_limits<float>::infinity()), "ok");
  EXPECT_EQ(codeOfNifti(252, std::int32_t(0)), "BAD_GEOMETRY") << "neither sform nor qform";
  EXPECT_EQ(codeOfNifti(254, std::int16_t(0)), "ok") << "the qform alone";
  EXPECT_EQ(codeOfNifti(76, std::array{1.0f, 0.0f, 1.0f, 1.0f}), "ok")
      << "a qform over voxels of no size";
}

TEST_F(BadVolumeFiles, AQformOverVoxelsOfNoSizeIsRefused) {
  ASSERT_TRUE(writeVolume(patternVolume({4, 4, 4}), folder / "a.nii"));
  std::string bytes = bytesOf(folder / "a.nii");
  bytes.replace(84, 4, 4, '\0');   // pixdim[2]
  bytes.replace(254, 2, 2, '\0');  // no sform
  writeBytes(folder / "a.nii", bytes);
  EXPECT_EQ(codeOf(folder / "a.nii"), "BAD_GEOMETRY");
}

TEST_F(BadVolumeFiles, AHugeHeaderOnLittleDataAllocatesNothingLarge) {
  const double before = residentMb();
  const auto start = std::chrono::steady_clock::now();
  struct Sizes {
    std::int16_t x = 2000, y = 2000, z = 2000;
  };
  EXPECT_EQ(codeOfNifti(42, Sizes{}), "UNREADABLE");
  EXPECT_EQ(codeOfNifti(42, Sizes{32767, 32767, 32767}), "TOO_LARGE");
  ASSERT_TRUE(writeVolume(patternVolume({4, 4, 4}), folder / "z.nii.gz"));
  EXPECT_EQ(codeOfMeta("DimSize", "2000 2000 2000"), "UNREADABLE");
  EXPECT_LT(residentMb() - before, 50.0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(BadVolumeFiles, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  codeOfMeta("DimSize", "2 2 3");
  codeOfNifti(46, std::int16_t(5));
  codeOfNifti(344, std::uint32_t(0));
  writeBytes(folder / "c.mha", metaImage("CompressedData", "True"));
  codeOf(folder / "c.mha");
  ASSERT_TRUE(writeVolume(patternVolume({16, 16, 16}), folder / "c.nii.gz"));
  const std::string whole = bytesOf(folder / "c.nii.gz");
  writeBytes(folder / "c.nii.gz", whole.substr(0, whole.size() / 2));
  codeOf(folder / "c.nii.gz");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace trephine
