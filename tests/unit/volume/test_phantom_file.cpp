#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "base/file.h"
#include "support.h"
#include "volume/phantom_file.h"

namespace trephine {
namespace {

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// What the build painted, and what the painter makes now.
TEST(PaintedCase, IsOpenedAsItIsPainted) {
  for (const std::string& name : phantomNames()) {
    const auto opened = openPhantom(name);
    const auto painted = makePhantom(name);
    ASSERT_TRUE(opened && painted) << name;
    EXPECT_EQ(opened->volume.geometry.size, painted->volume.geometry.size);
    EXPECT_EQ(opened->volume.geometry.origin_mm, painted->volume.geometry.origin_mm);
    EXPECT_TRUE(opened->volume.hu == painted->volume.hu) << name;
    ASSERT_EQ(opened->labels.has_value(), painted->labels.has_value());
    if (!opened->labels) continue;
    EXPECT_TRUE(opened->labels->labels == painted->labels->labels) << name;
    EXPECT_EQ(opened->labels->structures, painted->labels->structures);
  }
}

TEST(PhantomFile, ReportsProgressAndCanBeCancelled) {
  double last = -1.0;
  const Progress progress([&](double fraction, const std::string& step) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    EXPECT_FALSE(step.empty());
    last = fraction;
  });
  EXPECT_TRUE(openPhantom("cranium", progress));
  EXPECT_EQ(last, 1.0);
  Progress cancelled;
  cancelled.cancel();
  EXPECT_EQ(openPhantom("abdomen", cancelled).error().code.str(), "CANCELLED");
}

TEST(PhantomFile, OneThatIsMissingIsSaid) {
  const test::TemporaryFolder folder;
  const auto read = readPhantomFile("cranium", folder.path() / "none.case");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code.str(), "CANNOT_READ");
  EXPECT_NE(read.error().sentence().find("none.case"), std::string::npos);
}

TEST(PhantomFile, ASpoiltOneIsRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "abdomen.case";
  const std::string whole = bytesOf(phantomFile("abdomen"));
  ASSERT_GT(whole.size(), 1'000'000u);
  std::string flipped = whole, renamed = whole, longer = whole + '\0', length = whole;
  flipped[whole.size() / 2] = char(flipped[whole.size() / 2] ^ 1);
  renamed[0] = 't';
  length[8] = char(length[8] + 1);
  for (const std::string& spoilt :
       {std::string(), whole.substr(0, 10), whole.substr(0, whole.size() / 2),
        whole.substr(0, whole.size() - 1), flipped, renamed, longer, length,
        bytesOf(phantomFile("cranium"))}) {
    ASSERT_TRUE(writeTextFile(file, spoilt));
    const auto read = readPhantomFile("abdomen", file);
    ASSERT_FALSE(read) << spoilt.size();
    EXPECT_EQ(read.error().code.str(), "DAMAGED");
  }
}

}  // namespace
}  // namespace trephine
