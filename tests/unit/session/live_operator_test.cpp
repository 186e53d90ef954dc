// The window's hands, as the haptic thread takes them.
#include "session/live_operator.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

struct Window {
  rt::ParameterSet<LiveHands> live;
  LiveHands hands;
  LiveOperator oper{nullptr, live, 0.001};
  std::uint64_t tick = 0;

  Window() {
    hands.hands[0] = {true, Vec3(0.0, 0.0, -0.010), 600.0, 4.0};
    live.write(hands);
  }
  double z() {
    std::array<OperatorSetPoint, kMaxArms> points{};
    oper.setPoints(tick++, points.data(), 1);
    return points[0].pose_m.position.z;
  }
  void hold(bool held) {
    hands.hands[0].held = held;
    hands.hands[0].held_m = Vec3(0.0, 0.0, -0.004);
    live.write(hands);
  }
};

TEST(LiveOperator, HasTheHandWhereTheWindowWantsIt) {
  Window window;
  EXPECT_EQ(window.z(), -0.010);
}

TEST(LiveOperator, HoldsAHandInAPauseAndBringsItBackWithTheForce) {
  Window window;
  (void)window.z();
  window.hold(true);
  EXPECT_EQ(window.z(), -0.004);
  window.hold(false);
  double last = -0.004;
  for (int i = 0; i < 200; ++i) {
    const double now = window.z();
    EXPECT_LT(now, last);
    EXPECT_GT(now, last - 0.0001) << "6 mm in 0.2 s";
    last = now;
  }
  EXPECT_NEAR(window.z(), -0.010, 1e-12);
}

}  // namespace
}  // namespace trephine
