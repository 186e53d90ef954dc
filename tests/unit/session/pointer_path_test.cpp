// The pointer's path, as the tick plays it.
#include "session/pointer_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace trephine {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A pointer at x [mm] on a plane 100 mm from the eye; the rays are parallel.
PointerInput at(std::int64_t time_ns, double x_mm, double push_N = 0.0) {
  return {{time_ns, Vec3(x_mm, 0.0, 100.0), Vec3(0.0, 0.0, -1.0), 100.0}, push_N};
}

struct Pursued {
  PointerPath path;
  std::int64_t now_ns = 0;
  std::vector<double> x_mm{};  // by tick
  double tick() {
    path.advance(now_ns, kMs, 100.0);
    now_ns += kMs;
    x_mm.push_back(path.at() ? path.at()->at.origin_mm.x : 0.0);
    return x_mm.back();
  }
};

TEST(PointerPath, IsTheSameAtAnyRateOfEventsAConstantTimeLater) {
  for (const double rate : {60.0, 125.0, 1000.0}) {
    Pursued played;
    int sent = 0;
    for (int n = 0; n < 1000; ++n) {
      while (1000.0 * sent / rate <= double(n)) {  // an event comes as it happens
        const double t_s = sent++ / rate;
        played.path.push(at(std::int64_t(t_s * 1e9), 100.0 * t_s));
      }
      const double x_mm = played.tick();
      if (n > 30) {
        EXPECT_NEAR(x_mm, 0.1 * (n - 25), 0.11) << rate << ", " << n;
      }
    }
  }
}

TEST(PointerPath, OfEventsThatComeLateAndInBurstsKeepsItsLineAtABoundedSpeed) {
  Pursued played;
  // 100 mm/s, round a corner; what happened in 50 ms comes 40 ms after, all at once.
  double furthest_mm = 0.0;
  for (int n = 0; n < 1500; ++n) {
    if (n % 50 == 40) {
      for (int k = n - 90; k < n - 40; k += 8) {
        if (k < 0 || k > 1000) continue;
        PointerInput input = at(k * kMs, std::min(0.1 * k, 50.0));
        input.at.origin_mm.y = std::max(0.0, 0.1 * k - 50.0);
        played.path.push(input);
      }
    }
    const PointerInput* before = played.path.at();
    const Vec3 was_mm = before ? before->at.origin_mm : Vec3(0.0, 0.0, 100.0);
    played.tick();
    if (!played.path.at()) continue;
    const Vec3 is_mm = played.path.at()->at.origin_mm;
    furthest_mm = std::max(furthest_mm, glm::distance(was_mm, is_mm));
    EXPECT_TRUE(is_mm.x > 49.5 || is_mm.y < 0.5) << "it cuts the corner at " << n;
  }
  EXPECT_LE(furthest_mm, 0.2) << "twice as fast as the pointer was, at most";
  EXPECT_NEAR(played.path.at()->at.origin_mm.y, 50.0, 1.0) << "and it comes to the end";
}

TEST(PointerPath, APointerThatRestedGoesOnFromThereAndDoesNotJump) {
  Pursued played;
  played.path.push(at(0, 0.0));
  for (int n = 0; n < 2000; ++n) played.tick();
  played.path.push(at(2000 * kMs, 3.0));
  double most_mm = 0.0;
  for (int n = 0; n < 60; ++n) {
    const double before_mm = played.x_mm.back();
    most_mm = std::max(most_mm, played.tick() - before_mm);
  }
  EXPECT_EQ(played.x_mm.back(), 3.0);
  EXPECT_LT(most_mm, 0.15) << "3 mm in 25 ms";
}

TEST(PointerPath, ThatWasQueuedAheadIsPlayedAsOneThatComesByItself) {
  Pursued ahead, live;
  for (int n = 0; n < 60; ++n) ahead.path.push(at(n * 16 * kMs, n < 30 ? n : 60 - n));
  for (int n = 0; n < 1100; ++n) {
    if (n % 16 == 0 && n < 960) live.path.push(at(n * kMs, n < 480 ? n / 16 : 60 - n / 16));
    EXPECT_NEAR(ahead.tick(), live.tick(), 1e-9) << n;
  }
}

TEST(PointerPath, GivesWhatIsPushedAtItsTimeAndWaitsForNoTimeThatIsYetToCome) {
  Pursued played;
  played.path.push(at(0, 0.0));
  played.path.push(at(100 * kMs, 0.0, 2.0));
  double since = -1;
  for (int n = 0; n < 300; ++n) {
    played.tick();
    if (since < 0 && played.path.at() && played.path.at()->push_N > 0.0) since = n;
  }
  EXPECT_EQ(since, 125.0);
}

TEST(PointerPath, OfAJumpIsWalked) {
  Pursued played;
  played.path.push(at(0, 0.0));
  for (int n = 0; n < 50; ++n) played.tick();
  played.path.push(at(50 * kMs, 100.0));
  int ticks = 0;
  while (played.tick() < 100.0 && ++ticks < 1000) continue;
  EXPECT_NEAR(ticks, 400, 30) << "at 250 mm/s";
}

}  // namespace
}  // namespace trephine
