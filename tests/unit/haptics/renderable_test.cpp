// The firmest tissue that an arm renders.
#include "bounded_support.h"
#include "haptics/arm_dynamics.h"

namespace trephine {
namespace {

using test::arm;
using test::kOmniStep_m;

TEST(Renderable, FallsWithDelayAndPeriodAndRisesWithMass) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (double rate_hz : {500.0, 1000.0, 4000.0}) {
      for (double delay : {0.0, 0.3, 1.0, 1.2, 3.0, 15.0}) {
        for (double step : {0.0, kOmniStep_m, 0.2e-3}) {
          const Renderable here = renderable(arm(mass, step), rate_hz, delay, {});
          const Renderable later = renderable(arm(mass, step), rate_hz, delay + 0.1, {});
          const Renderable slower = renderable(arm(mass, step), rate_hz / 2.0, delay, {});
          const Renderable heavier = renderable(arm(2.0 * mass, step), rate_hz, delay, {});
          EXPECT_LT(later.b_max, here.b_max);
          EXPECT_LT(slower.b_max, here.b_max);
          EXPECT_GT(heavier.b_max, here.b_max);
          // A count of a coarse encoder may be what bounds k, whatever the rest.
          EXPECT_LE(later.k_max, here.k_max);
          EXPECT_LE(slower.k_max, here.k_max);
          EXPECT_GE(heavier.k_max, here.k_max);
          if (step == 0.0) {
            EXPECT_LT(later.k_max, here.k_max);
            EXPECT_LT(slower.k_max, here.k_max);
            EXPECT_GT(heavier.k_max, here.k_max);
          } else {
            EXPECT_LT(here.k_max, renderable(arm(mass, 0.0), rate_hz, delay, {}).k_max);
          }
        }
      }
    }
  }
}

TEST(Renderable, IsBoundByTheCountsOfTheEncoderWhereTheArmIsHeavy) {
  for (double step : {kOmniStep_m, 0.2e-3}) {
    const double heavy = renderable(arm(2.0, step), 4000.0, 0, {}).k_max;
    EXPECT_EQ(heavy, renderable(arm(4.0, step), 4000.0, 0, {}).k_max);
    EXPECT_LT(heavy * step, 1.0) << "one count must not change the force by a newton";
    EXPECT_DOUBLE_EQ(renderable(arm(2.0, 2.0 * step), 4000.0, 0, {}).k_max, heavy / 2.0);
  }
}

TEST(Renderable, TakesItsDelayFromTheArgument) {
  const double none = renderable(arm(0.045, 0.0, 5), 1000.0, 0, {}).k_max;
  EXPECT_EQ(none, renderable(arm(0.045, 0.0), 1000.0, 0, {}).k_max);
  EXPECT_GT(none, renderable(arm(0.045, 0.0), 1000.0, kMaxDelayTicks, {}).k_max);
}

TEST(Renderable, IsInThePatientsMetresAndNewtons) {
  WorkspaceMap map;
  map.motion_scale = 3.0;
  map.force_scale = 0.25;
  const Renderable at_arm = renderable(arm(0.045, kOmniStep_m), 1000.0, 1, {});
  const Renderable in_patient = renderable(arm(0.045, kOmniStep_m), 1000.0, 1, map);
  // A tissue's b and k are g s b and g s k at the arm.
  EXPECT_DOUBLE_EQ(3.0 * 0.25 * in_patient.b_max, at_arm.b_max);
  EXPECT_DOUBLE_EQ(3.0 * 0.25 * in_patient.k_max, at_arm.k_max);
}

}  // namespace
}  // namespace trephine
