// What NRRD headers may say, and what is refused by name.
#include "file_bytes.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

const std::vector<double> kValues{1, 2, 3, 4, -5, 600, 7, -1000};

class NrrdFile : public ::testing::Test {
 protected:
  // A NRRD header of 2x2x2 int16 with one field changed, left out (`changed` empty) or added.
  static std::string header(const std::string& key = "", const std::string& changed = "") {
    std::string text = "NRRD0004\n";
    bool found = key.empty();
    for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
             {"type", "short"},
             {"dimension", "3"},
             {"space", "left-posterior-superior"},
             {"sizes", "2 2 2"},
             {"space directions", "(1,0,0) (0,1,0) (0,0,1)"},
             {"kinds", "domain domain domain"},
             {"endian", "little"},
             {"encoding", "raw"},
             {"space origin", "(7,8,9)"}}) {
      const bool it = name == key;
      found = found || it;
      if (!it || !changed.empty()) text += name + ": " + (it ? changed : value) + "\n";
    }
    return text + (found ? "" : key + ": " + changed + "\n");
  }
  fs::path write(const std::string& head, const std::string& rest) {
    writeBytes(folder / "a.nrrd", head + "\n" + rest);
    return folder / "a.nrrd";
  }
  std::string code(const std::string& key, const std::string& changed) {
    return codeOf(write(header(key, changed), voxels));
  }
  std::string sentence(const std::string& key, const std::string& changed) {
    return sentenceOf(write(header(key, changed), voxels));
  }
  void expectValues(const fs::path& file) {
    const auto read = readVolume(file);
    ASSERT_TRUE(read) << read.error().sentence();
    EXPECT_EQ(std::vector<double>(read->hu.begin(), read->hu.end()), kValues);
  }
  const std::string voxels = voxelsAs(VoxelType::int16, kValues);
  const TemporaryFolder folder;
};

TEST_F(NrrdFile, BytesAndLinesBeforeTheVoxelsAreSkipped) {
  expectValues(write(header("byte skip", "5"), "#####" + voxels));
  expectValues(write(header("byteskip", "-1"), "whatever comes before" + voxels));
  expectValues(write(header("line skip", "2"), "one\n\n" + voxels));
  expectValues(write(header("lineskip", "1") + "byte skip: 3\n", "one\nabc" + voxels));
  // In gzip lines are skipped before unpacking and bytes after it.
  const std::string gzip = header("encoding", "gzip");
  expectValues(write(gzip + "byte skip: 5\n", packed("#####" + voxels, Packing::gzip)));
  expectValues(write(gzip + "line skip: 1\n", "one\n" + packed(voxels, Packing::gzip)));
  EXPECT_EQ(codeOf(write(gzip + "byte skip: -1\n", packed(voxels, Packing::gzip))),
            "UNKNOWN_FORMAT");
  for (const char* bad : {"-2", "two", "1e300", "17", ""}) {
    EXPECT_EQ(codeOf(write(header() + "byte skip: " + bad + "\n", voxels)), "UNREADABLE") << bad;
  }
  for (const char* bad : {"-1", "9", "nan"}) {
    EXPECT_EQ(codeOf(write(header("line skip", bad), voxels)), "UNREADABLE") << bad;
  }
}

TEST_F(NrrdFile, GzipInSeveralPiecesIsOneAndADamagedOneIsNoticed) {
  const std::string gzip = header("encoding", "GZ") + "\n";
  const std::string first = packed(voxels.substr(0, 5), Packing::gzip);
  const std::string second = packed(voxels.substr(5), Packing::gzip);
  writeBytes(folder / "a.nrrd", gzip + first + second);
  expectValues(folder / "a.nrrd");
  for (std::size_t cut = 1; cut < 9; ++cut) {
    writeBytes(folder / "a.nrrd", gzip + first + second.substr(0, second.size() - cut));
    EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE") << cut;
  }
  std::string damaged = first + second;
  damaged[damaged.size() - 8] ^= 1;  // the checksum
  writeBytes(folder / "a.nrrd", gzip + damaged);
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE");
}

TEST_F(NrrdFile, HeadersAreReadAsTheFormatAllows) {
  std::string windows = header() + "\n";
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) {
    windows.replace(at, 1, "\r\n");
  }
  writeBytes(folder / "a.nrrd", windows + voxels);
  expectValues(folder / "a.nrrd");
  expectValues(write(header("type", "Signed Short INT"), voxels));
  expectValues(write(header("encoding", "RAW"), voxels));
  expectValues(write(header("sizes", "  2\t2  2 "), voxels));
  expectValues(write(header("space directions", "( 1 , 0, 0)(0,+1,0)   (0,0,1e0)"), voxels));
  expectValues(write(header("kinds", "space space space"), voxels));
  expectValues(write(header("kinds", ""), voxels));
  expectValues(write(header("content", "what: ever:= it is"), voxels));
  expectValues(write(header() + "# sizes: 9 9 9\nsizes:=9 9 9\ncontent: \n", voxels));
  expectValues(write(header("spacings", "nan nan nan"), voxels));
}

TEST_F(NrrdFile, TheUnitOfLengthCounts) {
  for (const auto& [unit, mm] : {std::pair("mm", 1.0), {"cm", 10.0}, {"m", 1000.0}}) {
    const std::string quote = '"' + std::string(unit) + '"';
    const auto read =
        readVolume(write(header("space units", quote + " " + quote + " " + quote), voxels));
    ASSERT_TRUE(read) << read.error().sentence();
    EXPECT_DOUBLE_EQ(read->geometry.spacing_mm.y, mm);
    EXPECT_DOUBLE_EQ(read->geometry.origin_mm.z, 9.0 * mm);
  }
  EXPECT_EQ(code("space units", R"("um" "um" "um")"), "BAD_GEOMETRY");  // finer than any scan
  EXPECT_EQ(code("space units", R"("inch" "inch" "inch")"), "BAD_GEOMETRY");
  EXPECT_EQ(code("space units", R"("mm" "mm" "cm")"), "BAD_GEOMETRY");
  EXPECT_EQ(code("space units", R"("mm)"), "ok");
}

TEST_F(NrrdFile, AnIncompletePlaceIsRefusedInAClearSentence) {
  const std::string spacings =
      header("space", "")
          .replace(header("space", "").find("space directions: (1,0,0) (0,1,0) (0,0,1)"), 41,
                   "spacings: 1 1 1");
  EXPECT_EQ(codeOf(write(spacings, voxels)), "BAD_GEOMETRY");
  EXPECT_NE(sentenceOf(folder / "a.nrrd").find("voxel size but not how the image lies"),
            std::string::npos);
  EXPECT_EQ(code("space", ""), "BAD_GEOMETRY");
  EXPECT_EQ(code("space directions", ""), "BAD_GEOMETRY");
  for (const char* space : {"scanner-xyz", "3D-right-handed", "3D-left-handed", "LPI"}) {
    EXPECT_EQ(code("space", space), "BAD_GEOMETRY");
    EXPECT_NE(sentence("space", space).find(space), std::string::npos) << "by name";
  }
  for (const char* directions :
       {"(1,0,0) (0,1,0)", "(1,0) (0,1)", "1 0 0 0 1 0 0 0 1", "(1,0,0) (0,1,0) (0,0,x)",
        "(1,0,0) (0,1,0) (0,0,0)", "(1,0,0) (0,1,0) (0,0.5,1)", "(1,0,0) (1,0,0) (0,0,1)",
        "(1,0,0) (0,1,0) (nan,nan,nan)", "(1,0,0) (0,1,0) (0,0,1", "(1,0,0) (0,1,0) (0,0,inf)",
        "(1,0,0) (0,1,0) (0,0,1) (0,0,1)", "(1 0 0) (0 1 0) (0 0 1)"}) {
    EXPECT_EQ(code("space directions", directions), "BAD_GEOMETRY") << directions;
  }
  for (const char* origin : {"7 8 9", "(7,8)", "(7,8,nan)", "none", "(7,8,9) (1,1,1)"}) {
    EXPECT_EQ(code("space origin", origin), "BAD_GEOMETRY") << origin;
  }
  const auto without = readVolumeFile(write(header("space origin", ""), voxels));
  ASSERT_TRUE(without);
  ASSERT_EQ(without->header.notes.size(), 1u) << "what is taken instead is said";
  EXPECT_EQ(without->volume.geometry.origin_mm, Vec3(0.0));
}

TEST_F(NrrdFile, WhatIsNotOneNumberAVoxelIsRefusedByName) {
  EXPECT_EQ(codeOf(write("NRRD0005\ntype: short\ndimension: 4\nspace: LPS\nsizes: 3 2 2 2\n"
                         "space directions: none (1,0,0) (0,1,0) (0,0,1)\nendian: little\n"
                         "encoding: raw\nkinds: vector domain domain domain\n",
                         voxels + voxels + voxels)),
            "NOT_HU");
  EXPECT_NE(sentenceOf(folder / "a.nrrd").find("4 dimensions"), std::string::npos);
  EXPECT_EQ(code("dimension", "2"), "UNREADABLE");
  EXPECT_EQ(code("dimension", "many"), "UNREADABLE");
  for (const char* kind : {"vector", "RGB-color", "complex", "time", "list", "3D-matrix"}) {
    EXPECT_EQ(code("kinds", std::string(kind) + " domain domain"), "NOT_HU");
  }
  EXPECT_NE(sentence("kinds", "RGB-color domain domain").find("rgb-color"), std::string::npos);
  EXPECT_EQ(code("space directions", "none (1,0,0) (0,1,0)"), "NOT_HU");
  EXPECT_EQ(code("type", "block"), "NOT_HU");
  EXPECT_EQ(code("type", "char"), "NOT_HU");
  EXPECT_NE(sentence("type", "block").find("block"), std::string::npos);
  EXPECT_EQ(code("old min", "0"), "NOT_HU");
}

TEST_F(NrrdFile, OtherEncodingsAreRefusedByName) {
  for (const char* encoding : {"ascii", "text", "txt", "hex", "bzip2", "bz2", "zrl", "zip"}) {
    EXPECT_EQ(code("encoding", encoding), "UNKNOWN_FORMAT");
    EXPECT_NE(sentence("encoding", encoding).find(encoding), std::string::npos);
  }
  std::string text = header("endian", "");  // as text has none
  text.replace(text.find("raw"), 3, "ascii");
  EXPECT_EQ(codeOf(write(text, "1 2 3 4 -5 600 7 -1000\n")), "UNKNOWN_FORMAT");
}

TEST_F(NrrdFile, HeadersThatCannotBe) {
  EXPECT_EQ(code("", ""), "ok");
  for (const char* needed : {"type", "dimension", "sizes", "encoding", "endian"}) {
    EXPECT_EQ(code(needed, ""), "UNREADABLE") << needed;
    EXPECT_NE(sentence(needed, "").find(needed), std::string::npos) << "by name";
  }
  EXPECT_EQ(code("endian", "middle"), "UNREADABLE");
  for (const char* sizes : {"2 2", "2 2 2 1", "2 2 0", "2 2 -2", "2 2 2.5", "2 2 two", "2 2 3",
                            "1000 1000 1000", "nan 2 2"}) {
    EXPECT_EQ(code("sizes", sizes), "UNREADABLE") << sizes;
  }
  EXPECT_EQ(code("sizes", "99999999999 99999999999 9"), "TOO_LARGE");
  EXPECT_EQ(code("flavour", "sweet"), "UNREADABLE");
  EXPECT_NE(sentence("flavour", "sweet").find("flavour"), std::string::npos);
  EXPECT_EQ(codeOf(write(header() + "endian: big\n", voxels)), "UNREADABLE") << "twice";
  EXPECT_EQ(codeOf(write(header() + "just words\n", voxels)), "UNREADABLE");
  writeBytes(folder / "a.nrrd", "NRRD00.01\n\n" + voxels);
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE");
  writeBytes(folder / "a.nrrd", "");
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE");
  writeBytes(folder / "a.nrrd", header());
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE") << "a header alone";
  writeBytes(folder / "a.nrrd", "NRRD0004\n" + std::string(2000000, '#'));
  EXPECT_EQ(codeOf(folder / "a.nrrd"), "UNREADABLE") << "a header without end";
  EXPECT_EQ(sentence("kinds", std::string(1000, 'x') + "\x1b[31m").find('\x1b'), std::string::npos);
}

TEST_F(NrrdFile, ADetachedHeaderLeadsToAFileBesideItOnly) {
  const auto detached = [&](const std::string& data) {
    writeBytes(folder / "a.nhdr", header("data file", data));
    return codeOf(folder / "a.nhdr");
  };
  writeBytes(folder / "b.raw", voxels);
  EXPECT_EQ(detached("b.raw"), "ok") << "no blank line is needed at its end";
  expectValues(folder / "a.nhdr");
  EXPECT_EQ(detached("./b.raw"), "ok");
  writeBytes(folder / "b c.raw", voxels);
  EXPECT_EQ(detached("b c.raw"), "ok");
  EXPECT_EQ(detached("gone.raw"), "MISSING_FILE");
  EXPECT_EQ(detached("LIST"), "UNKNOWN_FORMAT");
  EXPECT_EQ(detached("LIST\nb.raw\nb.raw"), "UNKNOWN_FORMAT");
  EXPECT_EQ(detached("b%03d.raw 1 2 1"), "UNKNOWN_FORMAT");

  const TemporaryFolder elsewhere;
  writeBytes(elsewhere / "secret.raw", voxels);
  EXPECT_EQ(detached((elsewhere / "secret.raw").string()), "UNREADABLE");
  EXPECT_EQ(detached("../" + elsewhere.path().filename().string() + "/secret.raw"), "UNREADABLE");
  EXPECT_NE(sentenceOf(folder / "a.nhdr").find("outside"), std::string::npos);
  fs::create_symlink(elsewhere / "secret.raw", folder / "link.raw");
  EXPECT_EQ(detached("link.raw"), "UNREADABLE");
  fs::create_directory(folder / "below");
  writeBytes(folder / "below" / "b.raw", voxels);
  EXPECT_EQ(detached("below/b.raw"), "UNREADABLE");
  EXPECT_EQ(detached("below"), "MISSING_FILE");
  EXPECT_EQ(detached("."), "UNREADABLE");

  writeBytes(folder / "b.raw", voxels.substr(1));
  EXPECT_EQ(detached("b.raw"), "UNREADABLE") << "cut short";
}

TEST_F(NrrdFile, ADetachedHeaderIsFoundFromTheWorkingFolderToo) {
  writeBytes(folder / "a.nhdr", header("data file", "b.raw"));
  writeBytes(folder / "b.raw", voxels);
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  expectValues("a.nhdr");
  fs::current_path(before);
}

}  // namespace
}  // namespace trephine
