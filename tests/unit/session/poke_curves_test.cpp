#include "session/poke_curves.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

constexpr double kRate_hz = 1000.0;

// A tool that points down, its tip `depth_mm` below a surface at z = 0 that pushes back.
TickRecord pressedTo(double depth_mm, double N_per_mm, std::int32_t tissue = 2) {
  TickRecord record;
  ArmRecord& arm = record.arms[0];
  arm.patient_position_mm = Vec3(0.0, 0.0, -depth_mm);
  arm.tissue_class = depth_mm > 0.0 ? tissue : -1;
  const double force_N = std::max(0.0, depth_mm) * N_per_mm;
  arm.demanded_N = Vec3(0.0, 0.0, 2.0 * force_N);
  arm.sent_N = Vec3(0.0, 0.0, force_N);
  return record;
}

// Down to a depth and out again, then in the air for 0.2 s.
void poke(PokeCurves& curves, double to_mm, double N_per_mm, std::int32_t tissue = 2) {
  for (double d = -0.5; d < to_mm; d += 0.01) curves.tick(pressedTo(d, N_per_mm, tissue));
  for (double d = to_mm; d > -0.5; d -= 0.01) curves.tick(pressedTo(d, N_per_mm, tissue));
  for (int n = 0; n < 200; ++n) curves.tick(pressedTo(-0.5, N_per_mm, tissue));
}

TEST(PokeCurves, HoldForceAgainstDepthAlongTheTool) {
  PokeCurves curves(1, kRate_hz);
  poke(curves, 3.0, 0.5);
  ASSERT_EQ(curves.curves().size(), 1u);
  const PokeCurve& curve = curves.curves()[0];
  EXPECT_TRUE(curve.ended);
  EXPECT_EQ(curve.tissue, 2);
  double deepest = 0.0;
  for (const PokePoint& p : curve.points) {
    EXPECT_NEAR(p.sent_N, 0.5 * std::max(0.0, p.depth_mm), 0.02);
    EXPECT_NEAR(p.demanded_N, 2.0 * p.sent_N, 1e-9);
    deepest = std::max(deepest, p.depth_mm);
  }
  EXPECT_NEAR(deepest, 3.0, 0.05);
}

TEST(PokeCurves, ThreeThatHaveEndedAreKeptAndTheOneThatGoesOn) {
  PokeCurves curves(1, kRate_hz);
  for (int tissue = 0; tissue < 5; ++tissue) poke(curves, 2.0, 0.5, tissue);
  for (double d = -0.5; d < 1.0; d += 0.01) curves.tick(pressedTo(d, 0.5, 7));
  ASSERT_EQ(curves.curves().size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(curves.curves()[i].ended);
    EXPECT_EQ(curves.curves()[i].tissue, int(i) + 2);
  }
  EXPECT_FALSE(curves.curves()[3].ended);
}

TEST(PokeCurves, NamesTheTissueWhereItPushedBackMost) {
  PokeCurves curves(1, kRate_hz);
  const auto through = [](double depth_mm) {
    return pressedTo(depth_mm, depth_mm < 1.0 ? 0.1 : 1.0, depth_mm < 1.0 ? 0 : 3);
  };
  for (double d = -0.5; d < 2.0; d += 0.01) curves.tick(through(d));
  for (double d = 2.0; d > -0.5; d -= 0.01) curves.tick(through(d));
  for (int n = 0; n < 200; ++n) curves.tick(through(-0.5));
  ASSERT_EQ(curves.curves().size(), 1u);
  EXPECT_EQ(curves.curves()[0].tissue, 3) << "not the skin above it";
}

TEST(PokeCurves, AGrazeIsNoPokeAndAToolThatWaitsBeginsNone) {
  PokeCurves curves(1, kRate_hz);
  poke(curves, 0.1, 0.5);
  EXPECT_TRUE(curves.curves().empty());
  for (int n = 0; n < 100; ++n) {
    TickRecord record = pressedTo(2.0, 0.5);
    record.arms[0].tool_state = kToolWaits;
    curves.tick(record);
  }
  EXPECT_TRUE(curves.curves().empty());
}

TEST(PokeCurves, AnHourInTissueKeepsItsBounds) {
  PokeCurves curves(1, kRate_hz);
  for (int n = 0; n < 100'000; ++n) curves.tick(pressedTo(n % 2 == 0 ? 1.0 : 3.0, 0.5));
  ASSERT_EQ(curves.curves().size(), 1u);
  EXPECT_LE(curves.curves()[0].points.size(), PokeCurves::kMostPoints);
  EXPECT_GT(curves.curves()[0].points.size(), PokeCurves::kMostPoints / 4);
}

TEST(PokeCurves, EachArmHasItsOwnAndWhatIsNoNumberIsNoPoint) {
  PokeCurves curves(2, kRate_hz);
  for (double d = -0.5; d < 2.0; d += 0.01) {
    TickRecord record = pressedTo(d, 0.5);
    record.arms[1] = pressedTo(2.0 * d, 0.25, 1).arms[0];
    if (d > 1.0) record.arms[1].patient_position_mm.x = std::nan("");
    curves.tick(record);
  }
  ASSERT_EQ(curves.curves().size(), 2u);
  for (const PokeCurve& curve : curves.curves()) {
    EXPECT_EQ(curve.tissue, curve.arm == 0 ? 2 : 1);
    for (const PokePoint& p : curve.points) EXPECT_TRUE(std::isfinite(p.depth_mm));
  }
}

}  // namespace
}  // namespace trephine
