// CT that comes in archives: read without unpacking it by hand, whatever else stands in them.
#include <zlib.h>

#include <cstdlib>
#include <cstring>

#include "imaging/codes.h"
#include "imaging/files/detail/archive.h"
#include "series_fixture.h"
#include "volume/volume_files.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;

void putBytes(std::string& bytes, std::uint64_t value, int count) {
  for (int n = 0; n < count; ++n) bytes += char(value >> (8 * n) & 0xFF);
}

// A ZIP archive of files that are stored, or deflated.
std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files, bool pack = false,
                  int flags = 0) {
  std::string all, directory;
  for (const auto& [name, bytes] : files) {
    const std::string stored = pack ? packedBy(Deflate::bare, bytes) : bytes;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size()));
    const std::size_t at = all.size();
    const auto head = [&](std::string& to) {
      putBytes(to, 20, 2);
      putBytes(to, std::uint64_t(flags), 2);
      putBytes(to, pack ? 8 : 0, 2);
      putBytes(to, 0, 4);
      putBytes(to, crc, 4);
      putBytes(to, stored.size(), 4);
      putBytes(to, bytes.size(), 4);
      putBytes(to, name.size(), 2);
    };
    all += "PK\3\4";
    head(all);
    putBytes(all, 0, 2);
    all += name + stored;
    directory += "PK\1\2";
    putBytes(directory, 20, 2);
    head(directory);
    putBytes(directory, 0, 12);
    putBytes(directory, at, 4);
    directory += name;
  }
  const std::size_t at = all.size();
  all += directory + "PK\5\6";
  putBytes(all, 0, 4);
  putBytes(all, files.size(), 2);
  putBytes(all, files.size(), 2);
  putBytes(all, directory.size(), 4);
  putBytes(all, at, 4);
  putBytes(all, 0, 2);
  return all;
}

std::string tarOf(const std::string& name, const std::string& bytes, char type = '0',
                  const std::string& link = "") {
  std::string head(512, '\0');
  const auto text = [&](std::size_t at, const std::string& what) {
    head.replace(at, what.size(), what);
  };
  char size[13];
  std::snprintf(size, sizeof size, "%011o", unsigned(bytes.size()));
  text(0, name);
  text(100, "0000644");
  text(124, size);
  text(136, "00000000000");
  text(148, "        ");
  head[156] = type;
  text(157, link);
  text(257, std::string("ustar\00000", 8));
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  char check[8];
  std::snprintf(check, sizeof check, "%06o", sum);
  text(148, std::string(check, 7) + " ");
  return head + bytes + std::string((512 - bytes.size() % 512) % 512, '\0');
}

class Archives : public SeriesFixture {
 protected:
  Archives() {
    fs::create_directories(temporary_ / "tmp");
    ::setenv("TMPDIR", (temporary_ / "tmp").c_str(), 1);
  }
  ~Archives() override { ::unsetenv("TMPDIR"); }

  // The slices of a small CT, taken out of the folder.
  std::vector<std::pair<std::string, std::string>> slices() {
    write(truth_);
    std::vector<std::pair<std::string, std::string>> files;
    for (const auto& entry : fs::directory_iterator(folder())) {
      files.emplace_back("DOE JANE/" + entry.path().filename().string(), readBytes(entry.path()));
    }
    fs::remove_all(folder());
    return files;
  }
  std::size_t left() const {
    return std::size_t(std::distance(fs::directory_iterator(temporary_ / "tmp"), {}));
  }
  void expectRead(const fs::path& path) {
    {
      CtFolder ct = scan(path);
      ASSERT_TRUE(ct.bestSeries()) << (ct.report().error ? ct.report().error->sentence() : "");
      const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
      ASSERT_TRUE(volume.ok()) << volume.error().sentence();
      EXPECT_EQ(volume->hu, truth_.hu);
      EXPECT_EQ(left(), 1u);
      for (const auto& entry : fs::recursive_directory_iterator(temporary_ / "tmp")) {
        EXPECT_EQ(entry.path().string().find("DOE"), std::string::npos);
      }
    }
    EXPECT_EQ(left(), 0u) << "what was unpacked goes with the import";
  }
  const Volume truth_ = rampVolume();
};

TEST_F(Archives, OfEachKindAreReadAndNothingOfThemStays) {
  const auto files = slices();
  std::string tar;
  for (const auto& [name, bytes] : files) tar += tarOf(name, bytes);
  tar += std::string(1024, '\0');
  for (const std::string& bytes :
       {zipOf(files), zipOf(files, true), tar, packedBy(Deflate::gzip, tar)}) {
    fs::remove_all(folder());
    writeBytes(folder() / "from-the-clinic", bytes);
    expectRead(folder());
    expectRead(folder() / "from-the-clinic");
  }
  // A file packed by itself, each.
  fs::remove_all(folder());
  int n = 0;
  for (const auto& [name, bytes] : files) {
    writeBytes(folder() / (std::to_string(++n) + ".dcm.gz"), packedBy(Deflate::gzip, bytes));
  }
  expectRead(folder());
  // Several, and what is no archive beside them.
  fs::remove_all(folder());
  writeBytes(folder() / "a.zip", zipOf({files.begin(), files.begin() + 3}));
  writeBytes(folder() / "b.zip", zipOf({files.begin() + 3, files.end()}));
  writeBytes(folder() / "letter.txt", "Dear Sir");
  expectRead(folder());
}

TEST_F(Archives, OfAVolumeKeepTheNamesThatItsHeaderNeeds) {
  ASSERT_TRUE(writeVolume(truth_, temporary_ / "v.mha"));
  std::string mha = readBytes(temporary_ / "v.mha");
  const std::size_t voxels = mha.find("LOCAL\n") + 6;
  writeBytes(folder() / "v.zip", zipOf({{"x/v.mhd", mha.substr(0, voxels - 6) + "v.raw\n"},
                                        {"x/v.raw", mha.substr(voxels)},
                                        {"y/v.raw", "of another folder"}}));
  expectRead(folder());
}

TEST_F(Archives, NothingInThemLeadsOutOfTheirFolder) {
  auto files = slices();
  for (const char* name : {"../../evil.nii", "/tmp/evil.nii", "..\\evil.nii", "a/../../../evil.mha",
                           "", ".", "..", ".bashrc", "a\nb.nii", "\x1b[2J.nii"}) {
    files.emplace_back(name, "evil");
  }
  writeBytes(folder() / "a.zip", zipOf(files));
  {
    const auto unpacked = unpack({folder() / "a.zip"});
    ASSERT_TRUE(unpacked.ok()) << unpacked.error().sentence();
    for (const auto& entry : fs::recursive_directory_iterator(temporary_.path())) {
      const std::string path = entry.path().string();
      if (path.find("a.zip") != path.npos) continue;
      const bool inside = path.find("trephine-unpacked-") != path.npos;
      EXPECT_TRUE(inside || path == (temporary_ / "tmp").string() || path == folder().string())
          << path;
    }
    EXPECT_EQ(fs::status(unpacked->folder.path()).permissions(), fs::perms::owner_all);
  }
  // Links and devices.
  std::string tar = tarOf("link", "", '2', "/etc/passwd") + tarOf("hard", "", '1', "link") +
                    tarOf("pipe", "", '6') + tarOf("kept", "x") + std::string(1024, '\0');
  writeBytes(folder() / "a.tar", tar);
  const auto unpacked = unpack({folder() / "a.tar"});
  ASSERT_TRUE(unpacked.ok());
  EXPECT_EQ(unpacked->files, 1u);
  for (const auto& entry : fs::recursive_directory_iterator(unpacked->folder.path())) {
    EXPECT_TRUE((entry.is_regular_file() || entry.is_directory()) && !entry.is_symlink());
  }
}

TEST_F(Archives, ThatWouldFillTheDiskAreGivenUp) {
  const std::string one = packedBy(Deflate::gzip, std::string(std::size_t{64} << 20, 'x'));
  std::string bomb;
  for (int n = 0; n < 6; ++n) bomb += one;  // 384 MB in 0.4
  writeBytes(folder() / "bomb.gz", bomb);
  const CtFolder ct = scan();
  ASSERT_TRUE(ct.report().error);
  EXPECT_NE(ct.report().error->sentence().find("unpack"), std::string::npos);
  EXPECT_TRUE(std::ranges::any_of(ct.report().skipped, [](const SkippedFiles& s) {
    return s.reason.find("far more than it should") != std::string::npos;
  }));
  EXPECT_EQ(left(), 0u);
}

// What an interrupted download leaves: the slices that are there are no whole CT.
TEST_F(Archives, OfWhichAPartIsLostAreRefused) {
  const auto files = slices();
  const auto expectNotWhole = [&](const std::string& bytes, const char* what) {
    SCOPED_TRACE(what);
    fs::remove_all(folder());
    writeBytes(folder() / "from-the-clinic", bytes);
    const Finding finding = expectRefused("ARCHIVE_NOT_WHOLE");
    EXPECT_NE(finding.text.find("some of its slices"), std::string::npos);
    EXPECT_EQ(refusal({{code::kMissingSlices, "fill"}}).code.str(), "ARCHIVE_NOT_WHOLE");
  };
  for (const bool pack : {false, true}) {
    const std::string zip = zipOf(files, pack);
    expectNotWhole(zip.substr(0, zip.size() * 6 / 10), "cut anywhere");
    expectNotWhole(zip.substr(0, zip.find("PK\1\2")), "cut before its directory");
    std::string spoilt = zip;
    spoilt[zip.find("PK\3\4", 4) + 200] ^= 1;
    expectNotWhole(spoilt, "one byte of one file");
  }
  std::string locked = zipOf(files);
  const std::size_t second = locked.find("PK\3\4", 4);
  locked[second + 6] |= 1;
  const std::size_t in_directory = locked.find("PK\1\2", locked.find("PK\1\2") + 4);
  locked[in_directory + 8] |= 1;
  expectNotWhole(locked, "one file is locked");
  std::string tar;
  for (const auto& [name, bytes] : files) {
    if (name != files.back().first) tar += tarOf(name, bytes);
  }
  expectNotWhole(tar, "a tar without its end");
  const std::string packed = packedBy(Deflate::gzip, tar + std::string(1024, '\0'));
  fs::remove_all(folder());
  writeBytes(folder() / "a.tgz", packed.substr(0, packed.size() * 7 / 10));
  EXPECT_FALSE(scan().bestSeries());
  // What another one holds is whole.
  fs::remove_all(folder());
  const std::string other = zipOf({{"a", std::string(5000, 'x')}, {"b", std::string(5000, 'y')}});
  writeBytes(folder() / "a.zip", zipOf(files));
  writeBytes(folder() / "b.zip", other.substr(0, other.size() / 2));
  EXPECT_EQ(import().hu, truth_.hu);
}

TEST_F(Archives, ThatAreLockedSaySo) {
  const auto files = slices();
  writeBytes(folder() / "a.zip", zipOf(files, false, 1));
  const CtFolder locked = scan();
  EXPECT_TRUE(std::ranges::any_of(locked.report().skipped, [](const SkippedFiles& s) {
    return s.reason.find("password") != std::string::npos;
  })) << (locked.report().skipped.empty() ? "" : locked.report().skipped[0].reason);
}

TEST_F(Archives, CanBeCancelledWhileTheyAreUnpacked) {
  writeBytes(folder() / "a.zip", zipOf(slices()));
  Progress progress;
  progress.cancel();
  EXPECT_EQ(unpack({folder() / "a.zip"}, progress).error().code.str(), "CANCELLED");
  EXPECT_EQ(left(), 0u);
}

}  // namespace
}  // namespace trephine::test
