#include "lab/import/read_floor.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support.h"

namespace trephine {
namespace {

TEST(ReadFloor, ReadsEveryByteOfEveryFile) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a") << std::string(100000, 'a');
  std::ofstream(folder / "b") << std::string(300, 'b');
  std::ofstream(folder / "c");
  const Result<ReadFloor> floor = readEveryByte(folder.path());
  ASSERT_TRUE(floor) << floor.error().sentence();
  EXPECT_EQ(floor->files, 3);
  EXPECT_EQ(floor->bytes, 100300u);
  EXPECT_GT(floor->seconds, 0.0);
  EXPECT_GT(floor->kept_seconds, 0.0);
  EXPECT_EQ(toJson(*floor)["bytes"], 100300u);
}

TEST(ReadFloor, SaysWhatItCannotRead) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readEveryByte(folder / "none").error().code.str(), "MISSING_FOLDER");
  std::filesystem::create_directory(folder / "sub");
  EXPECT_EQ(readEveryByte(folder.path()).error().code.str(), "UNREADABLE");
}

}  // namespace
}  // namespace trephine
