// Raw voxels and the sidecar that says what they are (resources/schemas/raw.md).
#include "file_bytes.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

class RawFile : public ::testing::Test {
 protected:
  std::string codeWith(const std::string& sidecar) {
    writeBytes(folder / "ct.json", sidecar);
    return codeOf(folder / "ct.raw");
  }
  std::string sentenceWith(const std::string& sidecar) {
    writeBytes(folder / "ct.json", sidecar);
    return sentenceOf(folder / "ct.raw");
  }
  void SetUp() override {
    writeBytes(folder / "ct.raw", voxelsAs(VoxelType::int16, {1, -2, 3, 4, 5, 600}));
  }
  const std::string smallest =
      R"({"size": [3, 2, 1], "spacing_mm": [0.5, 0.6, 0.7], "type": "int16",)"
      R"( "byte_order": "little")";
  const TemporaryFolder folder;
};

TEST_F(RawFile, TheSmallestSidecarIsEnoughAndEitherFileOpensIt) {
  writeBytes(folder / "ct.json", smallest + "}");
  for (const char* name : {"ct.raw", "ct.json"}) {
    const auto reading = readVolumeFile(folder / name);
    ASSERT_TRUE(reading) << reading.error().sentence();
    EXPECT_EQ(reading->volume.hu, (Voxels{1, -2, 3, 4, 5, 600}));
    EXPECT_EQ(reading->volume.geometry.spacing_mm, Vec3(0.5, 0.6, 0.7));
    EXPECT_EQ(reading->volume.geometry.direction, Mat3(1.0));
    EXPECT_EQ(reading->header.format, "raw");
    EXPECT_EQ(reading->header.notes.size(), 2u) << "origin and direction are taken, and it is said";
  }
}

TEST_F(RawFile, EveryFieldCounts) {
  writeBytes(folder / "ct.raw",
             "header" + voxelsAs(VoxelType::uint16, {0, 1000, 2, 3, 4, 5}, true));
  writeBytes(folder / "ct.json",
             R"({"size": [3, 2, 1], "spacing_mm": [1, 2, 3], "type": "uint16", "byte_order": "big",
                 "header_bytes": 6, "slope": 2, "intercept": -1024, "origin_mm": [10, 20, 30],
                 "direction": [0, -1, 0, 1, 0, 0, 0, 0, 1]})");
  const auto reading = readVolumeFile(folder / "ct.json");
  ASSERT_TRUE(reading) << reading.error().sentence();
  EXPECT_EQ(reading->volume.hu,
            (Voxels{-1024, 976, -1020, -1018, -1016, -1014}));
  EXPECT_EQ(reading->volume.geometry.toPatient_mm({1, 0, 0}), Vec3(10, 21, 30)) << "i runs to +y";
  EXPECT_EQ(reading->volume.geometry.toPatient_mm({0, 1, 0}), Vec3(8, 20, 30)) << "j runs to -x";
  EXPECT_TRUE(reading->header.notes.empty());
}

TEST_F(RawFile, WithoutASidecarOneSentenceSaysWhatToWrite) {
  EXPECT_EQ(codeOf(folder / "ct.raw"), "NO_SIDECAR");
  const std::string sentence = sentenceOf(folder / "ct.raw");
  EXPECT_NE(sentence.find("ct.json"), std::string::npos);
  // The example in the sentence is one that works.
  const std::size_t open = sentence.find('{'), close = sentence.rfind('}');
  ASSERT_NE(open, std::string::npos);
  std::string example = sentence.substr(open, close - open + 1);
  const std::string size = "[512, 512, 300]";
  ASSERT_NE(example.find(size), std::string::npos);
  example.replace(example.find(size), size.size(), "[3, 2, 1]");
  EXPECT_EQ(codeWith(example), "ok") << example;
}

TEST_F(RawFile, TheVoxelsOfAnotherFormatLeadToItsHeader) {
  writeBytes(folder / "ct.mhd", "");
  EXPECT_EQ(codeOf(folder / "ct.raw"), "NO_SIDECAR");
  EXPECT_NE(sentenceOf(folder / "ct.raw").find("Open ct.mhd"), std::string::npos);
}

TEST_F(RawFile, MissingUnknownAndImpossibleFieldsAreNamed) {
  EXPECT_EQ(codeWith(smallest + "}"), "ok");
  EXPECT_EQ(codeWith("voxels"), "BAD_JSON");
  EXPECT_EQ(codeWith("[]"), "BAD_FIELD");
  for (const char* field : {"size", "spacing_mm", "type", "byte_order"}) {
    std::string without = smallest + "}";
    without.replace(without.find(field), std::string(field).size(), "x");
    EXPECT_EQ(codeWith(without), "BAD_FIELD");
    EXPECT_NE(sentenceWith(without).find(field), std::string::npos) << field;
  }
  const std::pair<const char*, const char*> more[] = {{"colour", "\"red\""},
                                                      {"header_bytes", "-1"},
                                                      {"header_bytes", "1.5"},
                                                      {"slope", "\"one\""},
                                                      {"intercept", "null"},
                                                      {"origin_mm", "[1, 2]"},
                                                      {"direction", "[1, 0, 0]"},
                                                      {"direction", "\"LPS\""},
                                                      {"direction", "[1,0,0,0,1,0,0,0,\"1\"]"}};
  for (const auto& [field, value] : more) {
    const std::string sidecar = smallest + ", \"" + field + "\": " + value + "}";
    EXPECT_EQ(codeWith(sidecar), "BAD_FIELD") << sidecar;
    EXPECT_NE(sentenceWith(sidecar).find(field), std::string::npos) << sidecar;
  }
  const std::string type = "\"int16\"";
  for (const char* name : {"\"short\"", "\"\"", "7"}) {
    std::string sidecar = smallest + "}";
    sidecar.replace(sidecar.find(type), type.size(), name);
    EXPECT_EQ(codeWith(sidecar), "BAD_FIELD") << name;
  }
  std::string order = smallest + "}";
  order.replace(order.find("little"), 6, "middle");
  EXPECT_EQ(codeWith(order), "BAD_FIELD");
}

TEST_F(RawFile, OneByteAVoxelNeedsNoByteOrder) {
  writeBytes(folder / "ct.raw", "\x01\x02\xff");
  EXPECT_EQ(codeWith(R"({"size": [3, 1, 1], "spacing_mm": [1, 1, 1], "type": "uint8"})"), "ok");
}

TEST_F(RawFile, TheLengthHasToFitExactly) {
  const auto sized = [&](const std::string& size) {
    std::string sidecar = smallest + "}";
    sidecar.replace(sidecar.find("[3, 2, 1]"), 9, size);
    return codeWith(sidecar);
  };
  EXPECT_EQ(sized("[6, 1, 1]"), "ok");
  EXPECT_EQ(sized("[3, 2, 2]"), "UNREADABLE");
  EXPECT_EQ(sized("[3, 1, 1]"), "UNREADABLE");
  EXPECT_NE(sentenceOf(folder / "ct.raw").find("12 bytes"), std::string::npos);
  EXPECT_EQ(sized("[0, 2, 1]"), "BAD_FIELD");
  EXPECT_EQ(sized("[-3, -2, 1]"), "BAD_FIELD");
  EXPECT_EQ(sized("[3000000000, 2, 1]"), "BAD_FIELD");
  EXPECT_EQ(sized("[1000000, 1000000, 1000000]"), "TOO_LARGE");
  EXPECT_EQ(codeWith(smallest + ", \"header_bytes\": 1}"), "UNREADABLE");
  EXPECT_EQ(codeWith(smallest + ", \"header_bytes\": 9000000000000000000}"), "BAD_FIELD");
}

TEST_F(RawFile, ImpossibleGeometryIsRefused) {
  EXPECT_EQ(codeWith(smallest + R"(, "direction": [1, 0, 0, 0, 1, 0, 0, 0.5, 1]})"),
            "BAD_GEOMETRY");
  std::string flat = smallest + "}";
  flat.replace(flat.find("0.6"), 3, "0.0");
  EXPECT_EQ(codeWith(flat), "BAD_FIELD");
  EXPECT_NE(sentenceWith(flat).find("spacing_mm"), std::string::npos);
}

TEST_F(RawFile, ASidecarWithoutVoxelsIsNamed) {
  writeBytes(folder / "other.json", smallest + "}");
  EXPECT_EQ(codeOf(folder / "other.json"), "MISSING_FILE");
}

}  // namespace
}  // namespace trephine
