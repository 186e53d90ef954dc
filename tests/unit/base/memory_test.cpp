#include "base/memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support.h"

namespace trephine {
namespace {

// A folder of control groups as the kernel shows it.
class ControlGroups : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text << '\n';
  }
  std::optional<double> left_mb(const std::string& membership) {
    write("membership", membership);
    return controlGroupMemoryMb(folder_ / "membership", folder_.path());
  }

  test::TemporaryFolder folder_;
};

TEST_F(ControlGroups, OfVersionTwoLeaveWhatTheTightestOfThemDoes) {
  write("a/memory.max", "1048576000");  // 1000 MB
  write("a/memory.current", "524288000");
  write("a/memory.stat", "anon 1\nactive_file 104857600\ninactive_file 0\nfile 7");
  write("a/b/memory.max", "max");
  write("a/b/memory.current", "1");
  EXPECT_DOUBLE_EQ(left_mb("0::/a/b").value(), 600.0) << "pages of files can be dropped";
  write("a/b/memory.max", "209715200");
  write("a/b/memory.current", "104857600");
  write("a/b/memory.stat", "anon 104857600");
  EXPECT_DOUBLE_EQ(left_mb("0::/a/b").value(), 100.0);
  write("a/b/memory.current", "999999999999");
  EXPECT_DOUBLE_EQ(left_mb("0::/a/b").value(), 0.0);
}

TEST_F(ControlGroups, OfVersionOneAreThoseOfMemoryAlone) {
  write("memory/x/memory.limit_in_bytes", "314572800");
  write("memory/x/memory.usage_in_bytes", "209715200");
  write("memory/x/memory.stat", "cache 5\ntotal_active_file 0\ntotal_inactive_file 52428800");
  write("memory/memory.limit_in_bytes", "9223372036854771712");  // none
  write("memory/memory.usage_in_bytes", "209715200");
  EXPECT_DOUBLE_EQ(left_mb("9:cpu,memory:/x\n8:pids:/y").value(), 150.0);
  EXPECT_FALSE(left_mb("8:pids:/x").has_value());
  EXPECT_FALSE(left_mb("9:memory:/").has_value()) << "nothing has a limit there";
}

TEST_F(ControlGroups, OfAContainerAreSeenFromItsRoot) {
  write("memory/memory.limit_in_bytes", "104857600");
  write("memory/memory.usage_in_bytes", "0");
  EXPECT_DOUBLE_EQ(left_mb("4:memory:/docker/0123").value(), 100.0);
}

TEST_F(ControlGroups, ThatCannotBeReadSayNothing) {
  EXPECT_FALSE(left_mb("").has_value());
  EXPECT_FALSE(left_mb("nonsense").has_value());
  write("a/memory.max", "garbage");
  EXPECT_FALSE(left_mb("0::/a").has_value());
  EXPECT_FALSE(controlGroupMemoryMb("/nowhere", folder_.path()).has_value());
}

TEST(Memory, ThatALimitOnDataForbidsIsNotAvailable) {
  const double before_mb = availableMemoryMb();
  EXPECT_GT(before_mb, 10.0);
  const test::DataLimit limit(200.0);
  EXPECT_NEAR(availableMemoryMb(), 200.0, 10.0);
  EXPECT_NEAR(usableMemoryMb(), 136.0, 10.0) << "others need some, too";
}

TEST(Memory, ThatIsTooLittleIsSaidWithBothFigures) {
  EXPECT_TRUE(enoughMemory(900.0, "Reading", "x", 1000.0).ok());
  const Status enough = enoughMemory(1234.4, "Reading the series", "the case", 1000.0);
  ASSERT_FALSE(enough.ok());
  EXPECT_EQ(enough.error().code.str(), "OUT_OF_MEMORY");
  EXPECT_EQ(enough.error().where, "the case");
  EXPECT_EQ(enough.error().what,
            "Reading the series needs 1234 MB of memory, and 1000 MB can be had");
  EXPECT_FALSE(enoughMemory(10.0, "Reading", "x", 0.0).ok());
}

}  // namespace
}  // namespace trephine
