#include "exercise/arm_limits.h"

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

Exercise shippedCranium() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

Rig omnis(const Exercise& exercise) {
  Rig rig = simulatedRig(exercise);
  for (Rig::Arm& arm : rig.arms) arm.dynamics = ArmDynamics{0.045, 5.5e-5, 3.3, 0};
  return rig;
}

TEST(ArmLimits, AreOfTheWeakestArmAndNoneWithoutDynamics) {
  Exercise exercise = shippedCranium();
  ASSERT_GE(exercise.arms.size(), 2u);
  const ArmsLimit both = *armsLimit(exercise, omnis(exercise));
  exercise.arms[1].map.force_scale = 2.0;
  exercise.arms[1].max_force_N = 1.0;
  const ArmsLimit weaker = *armsLimit(exercise, omnis(exercise));
  EXPECT_DOUBLE_EQ(weaker.force_N, 0.5);
  EXPECT_LT(weaker.most.k_max, both.most.k_max);
  EXPECT_FALSE(armsLimit(exercise, simulatedRig(exercise)));
}

TEST(ArmLimits, ANumberIsFeltWhereALawOfTheExerciseUsesIt) {
  Tissue tissue = startingSet("Mine").tissues[1];
  tissue.stiffness_N_per_m.value = 300.0;
  tissue.friction_N.value = 0.2;
  tissue.rupture_N = SourcedNumber{2.0, "here"};
  const auto felt = [&](const char* key, const std::vector<LawKind>& laws,
                        RemovalKind removal = RemovalKind::work) {
    return isFelt(number(key), tissue, laws, removal);
  };
  const std::vector<LawKind> viscous{LawKind::viscous}, rupture{LawKind::rupture},
      coulomb{LawKind::coulomb};
  EXPECT_TRUE(felt("damping_Ns_per_m", viscous));
  EXPECT_FALSE(felt("stiffness_N_per_m", viscous));
  EXPECT_FALSE(felt("friction_N", viscous));
  EXPECT_FALSE(felt("rupture_N", viscous));
  EXPECT_FALSE(felt("damping_Ns_per_m", rupture));
  EXPECT_TRUE(felt("stiffness_N_per_m", rupture));
  EXPECT_TRUE(felt("rupture_N", rupture));
  EXPECT_FALSE(felt("friction_N", rupture));
  EXPECT_TRUE(felt("friction_N", coulomb));
  EXPECT_TRUE(felt("stiffness_N_per_m", coulomb));
  for (const char* key : {"damping_Ns_per_m", "stiffness_N_per_m", "friction_N", "rupture_N"}) {
    EXPECT_FALSE(felt(key, {})) << key << ": there is no law";
  }
  // Each law needs more than one number.
  tissue.friction_N.value = 0.0;
  EXPECT_FALSE(felt("stiffness_N_per_m", coulomb));
  tissue.rupture_N.reset();
  EXPECT_FALSE(felt("stiffness_N_per_m", rupture));
  tissue.stiffness_N_per_m.value = 0.0;
  EXPECT_FALSE(felt("friction_N", coulomb));
  EXPECT_FALSE(felt("rupture_N", rupture));
  EXPECT_TRUE(felt("stiffness_N_per_m", {LawKind::elastic}));
  // Removal, not a law.
  tissue.cuttable = true;
  EXPECT_TRUE(felt("cutting_J_per_mm3", {}));
  EXPECT_FALSE(felt("cutting_J_per_mm3", {}, RemovalKind::instant));
  EXPECT_FALSE(felt("toughness_J_per_m2", {})) << "it is not given";
  number("toughness_J_per_m2").set(tissue, {75.8, "a paper"});
  EXPECT_TRUE(felt("toughness_J_per_m2", {}));
  EXPECT_FALSE(felt("toughness_J_per_m2", {}, RemovalKind::instant));
  EXPECT_FALSE(felt("cutting_J_per_mm3", {})) << "the toughness has taken its place";
  number("cutting_J_per_mm3").set(tissue, {1e-5, "a paper"});
  tissue.cuttable = false;
  EXPECT_FALSE(felt("cutting_J_per_mm3", {}));
}

TEST(ArmLimits, DampingAndStiffnessAreBoundedEachByItself) {
  const ArmsLimit arms{{20.0, 1000.0}, 3.3};
  const DemandedOf demanded = [](const Tissue& tissue) {
    return Impedance{tissue.damping_Ns_per_m.value, tissue.stiffness_N_per_m.value};
  };
  Tissue firm = startingSet("Mine").tissues[1];
  firm.stiffness_N_per_m.value = 4000.0;
  firm.damping_Ns_per_m.value = 400.0;
  firm.rupture_N = SourcedNumber{2.0, "here"};
  EXPECT_NEAR(*mostShown(number("damping_Ns_per_m"), firm, arms, demanded), 20.0, 1e-6);
  EXPECT_NEAR(*mostShown(number("stiffness_N_per_m"), firm, arms, demanded), 1000.0, 1e-4);
  EXPECT_TRUE(isWeaker(number("rupture_N"), firm, arms, demanded));
  EXPECT_FALSE(isWeaker(number("friction_N"), firm, arms, demanded));
  firm.stiffness_N_per_m.value = 900.0;
  EXPECT_FALSE(isWeaker(number("rupture_N"), firm, arms, demanded));
}

TEST(ArmLimits, NoMoreIsSentThanTheDeviceGivesWhateverTheExerciseAllows) {
  Exercise exercise = shippedCranium();
  for (ExerciseArm& arm : exercise.arms) arm.max_force_N = 50.0;
  EXPECT_DOUBLE_EQ(armsLimit(exercise, omnis(exercise))->force_N, 3.3);
}

TEST(ArmLimits, TheMostOfANumberIsJustShownAndALittleMoreIsNot) {
  const Exercise exercise = shippedCranium();
  const ArmsLimit arms = *armsLimit(exercise, omnis(exercise));
  const DemandedOf demanded = [&](const Tissue& tissue) { return demandedOf(exercise, tissue); };
  for (const Tissue& tissue : exercise.tissues.tissues) {
    for (const char* key : {"damping_Ns_per_m", "stiffness_N_per_m"}) {
      const std::optional<double> most = mostShown(number(key), tissue, arms, demanded);
      if (!most) continue;
      Tissue at = tissue;
      number(key).set(at, {*most, "asked"});
      const Impedance felt = demanded(at);
      number(key).set(at, {*most * 1.001, "asked"});
      const Impedance more = demanded(at);
      ASSERT_GT(*most, 0.0) << tissue.id << ' ' << key;
      if (std::string_view(key).starts_with("damping")) {
        EXPECT_LE(felt.damping, arms.most.b_max);
        EXPECT_GT(more.damping, arms.most.b_max) << tissue.id << ' ' << *most;
      } else {
        EXPECT_LE(felt.stiffness, arms.most.k_max);
        EXPECT_GT(more.stiffness, arms.most.k_max) << tissue.id << ' ' << *most;
      }
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
