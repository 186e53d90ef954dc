// .nii.gz: what is written, whatever the threads, the disk and a person who cancels do; and what is
// read, ours and from elsewhere, whole and damaged.
#include <gtest/gtest.h>

#include <system_error>
#include <thread>

#include "file_bytes.h"
#include "file_size_limit.h"
#include "support.h"
#include "unit/without_threads.h"
#include "volumes.h"

namespace trephine {
namespace {

// Files are compared by ==: EXPECT_EQ would look for hours where megabytes differ.
namespace fs = std::filesystem;
using namespace test;

constexpr std::size_t kHeader = 352;  // bytes before the voxels
constexpr std::size_t kPieces = 23;   // of 512 KB, in three slabs of 4 MB, and the header's

// 11 MB of which half is noise, as in a CT.
Volume ct() {
  Volume volume = patternVolume({256, 250, 90});
  std::uint32_t state = 1;
  for (auto& hu : volume.hu) {
    state = state * 1664525u + 1013904223u;
    hu = std::int16_t(hu % 16 * 60 + int(state >> 27));
  }
  return volume;
}

// What gzip's first member holds, and how many bytes of `file` it takes; zlib checks it.
std::string firstMember(const std::string& file, std::size_t& taken) {
  z_stream zlib{};
  EXPECT_EQ(inflateInit2(&zlib, 31), Z_OK);
  std::string out(std::size_t(16) << 20, '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(file.data()));
  zlib.avail_in = uInt(file.size());
  zlib.next_out = reinterpret_cast<Bytef*>(out.data());
  zlib.avail_out = uInt(out.size());
  EXPECT_EQ(inflate(&zlib, Z_FINISH), Z_STREAM_END);
  out.resize(zlib.total_out);
  taken = zlib.total_in;
  inflateEnd(&zlib);
  return out;
}

// Where the pieces of a file of ours end: behind the empty block that brings each to a whole byte.
std::vector<std::size_t> pieceEnds(const std::string& file) {
  const std::string block("\0\0\xff\xff", 4);
  std::vector<std::size_t> ends;
  for (auto at = file.find(block); at != std::string::npos; at = file.find(block, at + 1)) {
    ends.push_back(at + block.size());
  }
  return ends;
}

class GzippedVolumes : public ::testing::Test {
 protected:
  // The bytes of the file that is written.
  std::string written(const Volume& of, const char* name = "a.nii.gz") {
    EXPECT_TRUE(writeVolume(of, folder / name));
    return bytesOf(folder / name);
  }
  std::string codeOfBytes(const std::string& bytes) {
    writeBytes(folder / "b.nii.gz", bytes);
    return codeOf(folder / "b.nii.gz");
  }
  const TemporaryFolder folder;
  const Volume volume = ct();
};

TEST_F(GzippedVolumes, AreOneMemberSinceSomeReadersTakeTheFirstAlone) {
  const std::string file = written(volume);
  std::size_t taken = 0;
  const std::string unpacked = firstMember(file, taken);
  EXPECT_EQ(taken, file.size());
  EXPECT_TRUE(unpacked == written(volume, "a.nii")) << "what is packed is the file without packing";
  EXPECT_EQ(pieceEnds(file).size(), kPieces);
  EXPECT_TRUE(readVolume(folder / "a.nii.gz").value().hu == volume.hu);
}

TEST_F(GzippedVolumes, AreTheSameBytesWithAndWithoutASecondThread) {
  const std::string first = written(volume);
  EXPECT_TRUE(written(volume) == first);
  const WithoutThreads alone;
  EXPECT_THROW(std::thread([] {}).join(), std::system_error);
  EXPECT_TRUE(written(volume) == first);
}

TEST_F(GzippedVolumes, AreAtMostATenthLargerThanAtZlibsUsualLevel) {
  const std::string usual = packed(written(volume, "a.nii"), Packing::gzip);
  EXPECT_LT(double(written(volume).size()), 1.1 * double(usual.size()));
}

TEST_F(GzippedVolumes, OfALeftHandedVolumeKeepEveryVoxelsPlace) {
  Volume left = volume;
  left.geometry.direction[2] = -left.geometry.direction[2];
  written(left);
  const Volume read = readVolume(folder / "a.nii.gz").value();
  EXPECT_GT(glm::determinant(read.geometry.direction), 0.0);
  int wrong = 0;
  for (int k = 0; k < 90; ++k) {
    for (int j = 0; j < 250; ++j) {
      for (int i = 0; i < 256; ++i) wrong += read.at(i, j, 89 - k) != left.at(i, j, k);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(read.geometry.toPatient_mm({0, 0, 89}), left.geometry.toPatient_mm({0, 0, 0}));
}

TEST_F(GzippedVolumes, DamagedInAnyPieceAreRefused) {
  const std::string file = written(volume);
  std::size_t begin = 10;  // gzip's header
  for (const std::size_t end : pieceEnds(file)) {
    std::string bytes = file;
    const std::size_t at = (begin + end) / 2;
    bytes[at] = char(bytes[at] ^ 0x10);
    EXPECT_EQ(codeOfBytes(bytes), "UNREADABLE") << at;
    begin = end;
  }
  for (std::size_t from_end = 1; from_end <= 10; ++from_end) {
    std::string bytes = file;
    bytes[bytes.size() - from_end] = char(bytes[bytes.size() - from_end] ^ 0x01);
    EXPECT_EQ(codeOfBytes(bytes), "UNREADABLE") << from_end << " before the end";
  }
  EXPECT_EQ(codeOfBytes(file), "ok");
}

TEST_F(GzippedVolumes, CutShortAreRefusedAlsoWhereAPieceEnds) {
  const std::string file = written(volume);
  for (const std::size_t end : pieceEnds(file)) {
    EXPECT_EQ(codeOfBytes(file.substr(0, end)), "UNREADABLE") << end;
  }
  for (std::size_t missing = 1; missing <= 12; ++missing) {
    EXPECT_EQ(codeOfBytes(file.substr(0, file.size() - missing)), "UNREADABLE") << missing;
  }
}

TEST_F(GzippedVolumes, OfSeveralMembersFromElsewhereAreReadAndEachIsChecked) {
  const std::string plain = written(volume, "a.nii");
  // The header, two of voxels, an empty one as bgzip ends with.
  const std::size_t middle = kHeader + 3000001;
  const std::string members[] = {packed(plain.substr(0, kHeader), Packing::gzip),
                                 packed(plain.substr(kHeader, middle - kHeader), Packing::gzip),
                                 packed(plain.substr(middle), Packing::gzip),
                                 packed("", Packing::gzip)};
  const std::string whole = members[0] + members[1] + members[2] + members[3];
  ASSERT_EQ(codeOfBytes(whole), "ok");
  EXPECT_TRUE(readVolume(folder / "b.nii.gz").value().hu == volume.hu);

  const std::size_t second = members[0].size(), third = second + members[1].size(),
                    fourth = third + members[2].size();
  for (const std::size_t at : {second, second + 2, (second + third) / 2, third - 8, third - 1,
                               third + 1, (third + fourth) / 2, fourth - 8, fourth - 1}) {
    std::string bytes = whole;
    bytes[at] = char(bytes[at] ^ 0x10);
    EXPECT_EQ(codeOfBytes(bytes), "UNREADABLE") << at;
  }
  for (const std::size_t length : {second, second + 5, third - 1, third, fourth - 8, fourth - 1}) {
    EXPECT_EQ(codeOfBytes(whole.substr(0, length)), "UNREADABLE") << length;
  }
  // As gzip itself does: what follows the last voxel's member is nobody's.
  EXPECT_EQ(codeOfBytes(whole.substr(0, fourth) + "more"), "ok");
}

TEST_F(GzippedVolumes, SayHowFarTheyAreAndCanBeCancelled) {
  const Volume old = patternVolume({4, 4, 4});
  for (const char* name : {"a.nii", "a.nii.gz"}) {
    const std::string before = written(old, name);
    std::vector<double> fractions;
    const Progress watched(
        [&](double fraction, const std::string&) { fractions.push_back(fraction); });
    ASSERT_TRUE(writeVolume(slabsOf(volume), folder / "whole.nii.gz", watched));
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.size(), 4u) << "every 4 MB";
    EXPECT_EQ(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
    fs::remove(folder / "whole.nii.gz");

    int reports = 0;
    Progress* self = nullptr;
    Progress cancelled([&](double, const std::string&) {
      if (++reports == 2) self->cancel();
    });
    self = &cancelled;
    const Status status = writeVolume(slabsOf(volume), folder / name, cancelled);
    ASSERT_FALSE(status) << name;
    EXPECT_EQ(status.error().code.str(), "CANCELLED");
    EXPECT_EQ(reports, 2) << name << ": it went on";
    EXPECT_TRUE(bytesOf(folder / name) == before) << name << ": what was there is still there";
    fs::remove(folder / name);
    EXPECT_TRUE(fs::is_empty(folder.path())) << name << ": nothing half-written stays";
  }
}

TEST_F(GzippedVolumes, NoticeAFullDiskAsItHappens) {
  for (const char* name : {"a.nii", "a.nii.gz"}) {
    int slabs = 0;
    const Progress watched([&](double, const std::string&) { ++slabs; });
    const Status status = [&] {
      const test::FileSizeLimit full(1 << 20);  // within the first slab
      return writeVolume(slabsOf(volume), folder / name, watched);
    }();
    ASSERT_FALSE(status) << name;
    EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
    EXPECT_EQ(slabs, 1) << name << ": it went on";
    EXPECT_TRUE(fs::is_empty(folder.path())) << name;
  }
}

}  // namespace
}  // namespace trephine
