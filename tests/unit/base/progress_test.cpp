#include "base/progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace trephine {
namespace {

TEST(Progress, OfAPartLiesBetweenItsFractionsAndIsCancelledWithTheWhole) {
  std::vector<double> seen;
  Progress whole([&](double fraction, const std::string&) { seen.push_back(fraction); });
  const Progress part(whole, 0.5, 0.7);
  part.at(0.0, "a");
  part.at(0.5, "b");
  part.at(1.0, "c");
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_DOUBLE_EQ(seen[0], 0.5);
  EXPECT_DOUBLE_EQ(seen[1], 0.6);
  EXPECT_DOUBLE_EQ(seen[2], 0.7);
  EXPECT_FALSE(part.cancelled());
  whole.cancel();
  EXPECT_TRUE(part.cancelled());
}

}  // namespace
}  // namespace trephine
