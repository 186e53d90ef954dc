#include "scene/arm_limits.h"

#include <gtest/gtest.h>

#include "base/system.h"
#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

const TissueNumber& number(std::string_view key) {
  for (const TissueNumber& row : kTissueNumbers) {
    if (row.key == key) return row;
  }
  throw std::runtime_error("no such number");
}

Scene cranium() {
  Scene scene = *readScene(resourceFolder() / "scenes" / "cranium.json");
  for (SceneArm& arm : scene.arms) arm.dynamics = ArmDynamics{0.045, 5.5e-5, 3.3, 0};
  return scene;
}

TEST(ArmLimits, AreOfTheWeakestArmAndNoneWithoutDynamics) {
  Scene scene = cranium();
  ASSERT_GE(scene.arms.size(), 2u);
  const ArmsLimit both = *armsLimit(scene);
  scene.arms[1].map.force_scale = 2.0;
  scene.arms[1].max_force_N = 1.0;
  const ArmsLimit weaker = *armsLimit(scene);
  EXPECT_DOUBLE_EQ(weaker.force_N, 0.5);
  EXPECT_LT(weaker.most.k_max, both.most.k_max);
  for (SceneArm& arm : scene.arms) arm.dynamics.reset();
  EXPECT_FALSE(armsLimit(scene));
}

TEST(ArmLimits, ANumberIsFeltWhereALawOfTheExerciseUsesIt) {
  const std::vector<LawKind> viscous{LawKind::viscous}, rupture{LawKind::rupture};
  EXPECT_TRUE(isFelt(number("damping_Ns_per_m"), viscous));
  EXPECT_FALSE(isFelt(number("stiffness_N_per_m"), viscous));
  EXPECT_FALSE(isFelt(number("friction_N"), viscous));
  EXPECT_FALSE(isFelt(number("rupture_N"), viscous));
  EXPECT_TRUE(isFelt(number("cutting_J_per_mm3"), viscous)) << "removal uses it";
  EXPECT_FALSE(isFelt(number("damping_Ns_per_m"), rupture));
  EXPECT_TRUE(isFelt(number("stiffness_N_per_m"), rupture));
  EXPECT_TRUE(isFelt(number("rupture_N"), rupture));
  EXPECT_FALSE(isFelt(number("friction_N"), rupture));
  EXPECT_TRUE(isFelt(number("friction_N"), {LawKind::coulomb}));
}

TEST(ArmLimits, TheMostOfANumberIsJustShownAndALittleMoreIsNot) {
  const Scene scene = cranium();
  const ArmsLimit arms = *armsLimit(scene);
  const DemandedOf demanded = [&](const Tissue& tissue) { return demandedOf(scene, tissue); };
  for (const Tissue& tissue : scene.tissues.tissues) {
    for (const char* key : {"damping_Ns_per_m", "stiffness_N_per_m"}) {
      const std::optional<double> most = mostShown(number(key), tissue, arms, demanded);
      if (!most) continue;
      Tissue at = tissue;
      number(key).set(at, {*most, "asked"});
      const Impedance felt = demanded(at);
      EXPECT_LE(felt.damping, arms.most.b_max);
      EXPECT_LE(felt.stiffness, arms.most.k_max);
      if (*most == 0.0) continue;  // the others demand too much already
      number(key).set(at, {*most * 1.001, "asked"});
      const Impedance more = demanded(at);
      EXPECT_TRUE(more.damping > arms.most.b_max || more.stiffness > arms.most.k_max)
          << tissue.id << ' ' << key << ' ' << *most;
    }
  }
}

TEST(ArmLimits, AForceIsLimitedByTheArmsAndCuttingByNone) {
  const ArmsLimit arms{{1e12, 1e12}, 3.3};
  const DemandedOf nothing = [](const Tissue&) { return Impedance{}; };
  const Tissue soft = startingSet("Mine").tissues[1];
  EXPECT_DOUBLE_EQ(*mostShown(number("friction_N"), soft, arms, nothing), 3.3);
  EXPECT_DOUBLE_EQ(*mostShown(number("rupture_N"), soft, arms, nothing), 3.3);
  EXPECT_FALSE(mostShown(number("cutting_J_per_mm3"), soft, arms, nothing));
  EXPECT_FALSE(mostShown(number("damping_Ns_per_m"), soft, arms, nothing)) << "no law uses it";
}

}  // namespace
}  // namespace trephine
