#include "base/time_left.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

using std::chrono::seconds;

TEST(TimeLeftTest, IsToldFromTheRateSoFarOnceThereIsOne) {
  TimeLeft left;
  const TimeLeft::Clock::time_point start{};
  EXPECT_FALSE(left.at(0.0, start));
  EXPECT_FALSE(left.at(0.1, start + seconds(1))) << "too early to tell";
  const auto told = left.at(0.2, start + seconds(10));
  ASSERT_TRUE(told);
  EXPECT_NEAR(*told, 40.0, 1e-9);
  EXPECT_FALSE(left.at(0.99, start + seconds(50))) << "over before it is read";
}

TEST(TimeLeftTest, BeginsAnewWithTheNextPieceOfWork) {
  TimeLeft left;
  const TimeLeft::Clock::time_point start{};
  (void)left.at(0.0, start);
  (void)left.at(1.0, start + seconds(100));
  EXPECT_FALSE(left.at(0.0, start + seconds(101)));
  EXPECT_NEAR(left.at(0.5, start + seconds(105)).value_or(0.0), 4.0, 1e-9);
}

TEST(TimeLeftTest, ReportsThatCrossDoNotBeginItAnew) {
  TimeLeft left;
  const TimeLeft::Clock::time_point start{};
  (void)left.at(0.0, start);
  (void)left.at(0.50, start + seconds(5));
  EXPECT_TRUE(left.at(0.495, start + seconds(5)));
}

TEST(TimeLeftTest, IsSaidInRoundNumbers) {
  EXPECT_EQ(timeLeftWords(3.2), "about 4 s left");
  EXPECT_EQ(timeLeftWords(41.0), "about 40 s left");
  EXPECT_EQ(timeLeftWords(185.0), "about 3 min left");
}

}  // namespace
}  // namespace trephine
