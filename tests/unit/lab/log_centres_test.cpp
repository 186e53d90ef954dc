#include "lab/stability/log_centres.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trephine {
namespace {

TEST(LogCentres, AreTheValuesThemselvesWhereTheyAreFewAndApart) {
  EXPECT_EQ(logCentres({2, 0.25, 1, 2, 1}, 20), (std::vector<double>{0.25, 1, 2}));
  EXPECT_EQ(logCentres({7}, 20), std::vector<double>{7});
  EXPECT_TRUE(logCentres({}, 20).empty());
}

TEST(LogCentres, CountValuesThatDifferInTheLastDigitsAsOne) {
  EXPECT_EQ(logCentres({0.1 + 0.2, 0.3, 1.0}, 20).size(), 2u);
}

TEST(LogCentres, OfManyValuesAreEvenlySpacedAndKeepBothEnds) {
  std::vector<double> values;
  for (int i = 0; i <= 500; ++i) values.push_back(std::pow(10.0, i / 100.0));
  const std::vector<double> centres = logCentres(values, 20);
  ASSERT_EQ(centres.size(), 20u);
  EXPECT_EQ(centres.front(), values.front());
  EXPECT_EQ(centres.back(), values.back());
  for (std::size_t i = 1; i < centres.size(); ++i) {
    EXPECT_NEAR(std::log10(centres[i] / centres[i - 1]), 5.0 / 19.0, 1e-9);
  }
}

TEST(LogCentres, OfFewValuesThatLieTogetherAreEvenlySpacedToo) {
  EXPECT_EQ(logCentres({1.0, 1.01, 1000.0}, 20).size(), 20u);
}

TEST(LogCentres, GiveEachValueTheNearestCentreByItsLogarithm) {
  const std::vector<double> centres{1, 10, 100};
  EXPECT_EQ(nearestCentre(centres, 0.001), 0u);
  EXPECT_EQ(nearestCentre(centres, 3.0), 0u);
  EXPECT_EQ(nearestCentre(centres, 3.3), 1u);
  EXPECT_EQ(nearestCentre(centres, 10.0), 1u);
  EXPECT_EQ(nearestCentre(centres, 50.0), 2u);
  EXPECT_EQ(nearestCentre(centres, 1e9), 2u);
}

}  // namespace
}  // namespace trephine
