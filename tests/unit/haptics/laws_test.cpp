#include "haptics/laws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trephine {
namespace {

// One class: b 10, k 800, friction 2 N, rupture 1 N. A tool of points that all touch it, or none.
struct Case {
  TissueTable table;
  std::vector<TouchPoint> points;
  LawInput in;

  explicit Case(const Vec3& tip_m = Vec3(0.0), std::size_t count = 1) : points(count) {
    table.count = 1;
    table.classes[0] = {{10.0, 800.0, 2.0, 1.0, 0.05}, 226, 3071, 1, 0};
    for (TouchPoint& p : points) {
      p.weight = 1.0 / double(count);
      p.tissue_class = 0;
    }
    in.tip_m = tip_m;
    in.points = points;
    in.tissues = &table;
    in.tissue_class = 0;
    in.tip_class = 0;
    in.tool_direction = Vec3(0, 0, -1);
  }
  Case(const Case&) = delete;

  Case& inAir() {
    for (TouchPoint& p : points) p.tissue_class = -1;
    in.tissue_class = -1;
    in.tip_class = -1;
    return *this;
  }
};

template <class L, class... Answer>
ContactForce contactOf(L&& law, const Case& c, const Answer&... answer) {
  ContactForce force;
  law.add(c.in, answer..., force);
  return force;
}
template <class L>
Vec3 forceOf(L&& law, const Case& c) {
  return contactOf(law, c).at(c.in.velocity_m_s);
}

TEST(ViscousLaw, OpposesTheVelocityWithTheTissuesDamping) {
  Case c;
  c.in.velocity_m_s = {0.01, -0.02, 0.03};
  const Vec3 f = forceOf(ViscousLaw{}, c);
  EXPECT_DOUBLE_EQ(f.x, -0.1);
  EXPECT_DOUBLE_EQ(f.y, 0.2);
  EXPECT_DOUBLE_EQ(f.z, -0.3);
}

// Two points 10 mm above and below the tip, turning at 2 rad/s about y: their own 20 mm/s cancel in
// the force and add in the torque, 2 x 0.5 x 10 N s/m x 0.02 m/s x 0.01 m.
TEST(ViscousLaw, GivesEachPointItsOwnVelocityAndTheTorqueOfAll) {
  Case c(Vec3(0.0), 2);
  c.points[0].lever_m = {0, 0, 0.01};
  c.points[1].lever_m = {0, 0, -0.01};
  for (TouchPoint& p : c.points) p.rotational_m_s = glm::cross(Vec3(0, 2, 0), p.lever_m);
  const ContactForce turning = contactOf(ViscousLaw{}, c);
  EXPECT_NEAR(glm::length(turning.at(Vec3(0.0))), 0.0, 1e-15);
  EXPECT_NEAR(turning.torque_Nm.y, -0.002, 1e-15);
  c.points[1].tissue_class = -1;
  const ContactForce half = contactOf(ViscousLaw{}, c);
  EXPECT_NEAR(half.at(Vec3(0.0)).x, -0.1, 1e-15);
  EXPECT_DOUBLE_EQ(half.damping, 5.0);
}

// Equal power: what the arm feels at the handle is what the points feel.
TEST(Laws, TheForceAndTorqueAtTheHandleHaveThePowerOfThePoints) {
  Case c(Vec3(0.0), 5);
  const Vec3 omega(0.3, -1.1, 0.7);
  c.in.velocity_m_s = {0.02, 0.01, -0.03};
  double power_W = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    TouchPoint& p = c.points[i];
    p.lever_m = Vec3(0.001 * double(i), -0.002 * double(i), 0.004 * double(i));
    p.rotational_m_s = glm::cross(omega, p.lever_m);
    const Vec3 v = c.in.velocity_m_s + p.rotational_m_s;
    power_W += glm::dot(-10.0 * p.weight * v, v);
  }
  const ContactForce f = contactOf(ViscousLaw{}, c);
  EXPECT_NEAR(glm::dot(f.at(c.in.velocity_m_s), c.in.velocity_m_s) + glm::dot(f.torque_Nm, omega),
              power_W, 1e-15);
}

TEST(Laws, GiveNoForceWithoutContact) {
  const Grid air(Volume{.geometry = {.size = {4, 4, 4}}, .hu = Voxels(64)});
  for (const auto& [name, kind] : kLawNames) {
    Law law = makeLaw(kind, 1, makeNeedle(0.05), air.geometry());
    Case c({0, 0, -0.001});
    c.inAir();
    c.in.velocity_m_s = Vec3(1.0);
    ContactForce force;
    addDemanded(law, c.in, force);
    EXPECT_EQ(force.at(c.in.velocity_m_s), Vec3(0.0)) << name;
    EXPECT_EQ(force.stiffness, 0.0) << name;
  }
}

// A capsule pushes by the law of rupture where the exercise has it, and else as elastic tissue
// does.
TEST(Laws, OfWhichOneStandsInForAnotherDemandATissuesStiffnessOnce) {
  using enum LawKind;
  TissueClass capsule{{3.0, 200.0, 0.3, 0.5, 0.05}, 0, 100, 1, 0}, liver = capsule;
  liver.rupture_N = 0.0;
  EXPECT_FALSE(acts({elastic, rupture}, elastic, capsule));
  EXPECT_TRUE(acts({elastic, rupture}, rupture, capsule));
  EXPECT_TRUE(acts({elastic, rupture}, elastic, liver));
  EXPECT_TRUE(acts({viscous, elastic}, elastic, capsule));
  EXPECT_FALSE(acts({viscous}, elastic, capsule));
  EXPECT_EQ(demandedOf({elastic, rupture}, capsule).stiffness, 200.0);
  EXPECT_EQ(demandedOf({elastic, rupture}, liver).stiffness, 200.0);
  EXPECT_EQ(demandedOf({rupture}, liver).stiffness, 0.0);
  EXPECT_EQ(demandedOf({viscous, coulomb, elastic, rupture}, capsule).stiffness, 400.0);
  EXPECT_EQ(demandedOf({viscous, coulomb}, capsule).damping, 3.0);
}

TEST(CoulombLaw, HoldsAtRestWithoutDrift) {
  CoulombLaw law;
  EXPECT_EQ(forceOf(law, Case({0, 0, 0})), Vec3(0.0));
  const Vec3 held = forceOf(law, Case({0, 0, -0.001}));
  EXPECT_NEAR(held.z, 0.8, 1e-12);
  for (int i = 0; i < 100000; ++i) ASSERT_EQ(forceOf(law, Case({0, 0, -0.001})), held);
}

// An encoder that flickers by one count at rest moves the force by no more than the spring says.
TEST(CoulombLaw, DoesNotBuzzAtRestOnAFlickeringEncoder) {
  CoulombLaw law;
  forceOf(law, Case({0, 0, 0}));
  forceOf(law, Case({0, 0, -0.010}));
  for (int i = 0; i < 1000; ++i) {
    const Vec3 f = forceOf(law, Case({0, 0, -0.009 + (i % 2) * 5.5e-5}));
    ASSERT_NEAR(f.z, 1.2, 800.0 * 5.5e-5 + 1e-9);
  }
}

TEST(CoulombLaw, SlidesAtTheTissuesFrictionAndNeverAboveIt) {
  CoulombLaw law;
  forceOf(law, Case({0, 0, 0}));
  EXPECT_NEAR(glm::length(forceOf(law, Case({0, 0, -0.010}))), 2.0, 1e-12);
  // The anchor was dragged along: coming back 1 mm relieves the spring by 0.8 N.
  EXPECT_NEAR(forceOf(law, Case({0, 0, -0.009})).z, 1.2, 1e-12);
}

TEST(CoulombLaw, NeverGivesBackMoreEnergyThanItTook) {
  CoulombLaw law;
  double given_J = 0.0;
  Vec3 last(0.0), held(0.0);
  for (int i = 0; i < 20000; ++i) {
    const double t = i * 1e-3;
    const Vec3 x(0.004 * std::sin(3.1 * t), 0.003 * std::sin(7.7 * t), 0.005 * std::sin(5.3 * t));
    // The trapezoid of a piecewise linear motion is exact for a spring.
    const Vec3 f = forceOf(law, Case(x));
    given_J += glm::dot(0.5 * (f + held), x - last);
    ASSERT_LT(given_J, 1e-9);
    last = x;
    held = f;
  }
  EXPECT_LT(given_J, -0.01) << "dragging the anchor loses energy";
}

TEST(CoulombLaw, MakesNoEnergyWhereTheTissueTurnsStifferOrSofter) {
  CoulombLaw law;
  const auto at = [&](double z, double k) {
    Case c({0, 0, z});
    c.table.classes[0].stiffness_N_per_m = k;
    return contactOf(law, c);
  };
  at(0.0, 100.0);
  const ContactForce soft = at(-0.003, 100.0);
  EXPECT_NEAR(soft.elastic_N.z, 0.3, 1e-12);
  EXPECT_NEAR(soft.stored_J, 0.5 * 100.0 * 9e-6, 1e-12);
  const ContactForce stiff = at(-0.003, 900.0);
  EXPECT_NEAR(stiff.elastic_N.z, 0.3, 1e-12) << "the force goes on";
  EXPECT_LT(stiff.stored_J, soft.stored_J);
  const ContactForce again = at(-0.003, 100.0);
  EXPECT_LT(again.elastic_N.z, 0.04);
  EXPECT_LT(again.stored_J, stiff.stored_J);
}

TEST(CoulombLaw, ForgetsItsAnchorWhenContactEnds) {
  CoulombLaw law;
  forceOf(law, Case({0, 0, 0}));
  forceOf(law, Case({0, 0, 0.002}).inAir());
  EXPECT_EQ(forceOf(law, Case({0, 0, -0.001})), Vec3(0.0));
}

TEST(CoulombLaw, OfManyPointsIsThatOfOneWhenTheyMoveTogether) {
  CoulombLaw one(1), many(7);
  for (double z : {0.0, -0.001, -0.004, -0.003, -0.0035}) {
    EXPECT_NEAR(forceOf(one, Case({0, 0, z})).z, forceOf(many, Case({0, 0, z}, 7)).z, 1e-12);
  }
}

TEST(ElasticLaw, GivesThePushOfTheBall) {
  Case c;
  c.in.share.stiffness = 0.5;
  const ContactForce f =
      contactOf(ElasticLaw{}, c, ElasticLaw::Answer{{Vec3(0.1, 0, 0.2), 1e-4, 500.0, 0.0}});
  EXPECT_DOUBLE_EQ(f.elastic_N.z, 0.1);
  EXPECT_DOUBLE_EQ(f.stiffness, 250.0);
}

// k = 500, r = 2 mm, soft tissue below z = 0, the contact sphere's centre at z.
struct BallCase : Case {
  explicit BallCase(double z, double stiffness = 500.0) : Case({0, 0, z}) {
    answer.radius_m = 0.002;
    const double sum_N = stiffness * std::max(0.0, 0.002 - std::abs(z));
    answer.push = {Vec3(0, 0, sum_N), 1e-4, stiffness, z < 0.0 ? stiffness : 0.0};
  }
  ElasticLaw::Answer answer;
};
Vec3 forceOf(ElasticLaw& law, const BallCase& c) {
  return contactOf(law, c, c.answer).at(c.in.velocity_m_s);
}

TEST(ElasticLaw, PushesAToolThatPartsNothingByItsDepthHoweverDeepItSinks) {
  ElasticLaw law;
  for (double z = 0.0025; z > -0.010; z -= 1e-5) {
    const double depth = std::max(0.0, 0.002 - z);
    ASSERT_NEAR(forceOf(law, BallCase(z)).z, 500.0 * depth, 0.02) << "at z = " << z;
  }
}

TEST(ElasticLaw, ForgetsTheDepthOnceTheBallsCentreIsOut) {
  ElasticLaw law;
  for (double z = 0.0025; z > -0.004; z -= 1e-5) forceOf(law, BallCase(z));
  for (double z = -0.004; z < 0.001; z += 1e-5) forceOf(law, BallCase(z));
  EXPECT_NEAR(forceOf(law, BallCase(0.001)).z, 0.5, 1e-9);
}

// What a voxel at the sphere's centre is must not flip the push up and down again.
TEST(ElasticLaw, MakesNoEnergyWhereTheTissueAtTheCentreChanges) {
  ElasticLaw law;
  for (double z = 0.0025; z > -0.004; z -= 1e-5) forceOf(law, BallCase(z));
  EXPECT_NEAR(forceOf(law, BallCase(-0.004)).z, 3.0, 0.02);
  EXPECT_NEAR(forceOf(law, BallCase(-0.004, 250.0)).z, 1.5, 0.02) << "softer: the push falls";
  EXPECT_NEAR(forceOf(law, BallCase(-0.004)).z, 1.5, 0.02) << "firmer again: it does not rise";
}

TEST(ElasticLaw, FadesBeforeASharpToolThatHasPartedTheTissue) {
  ElasticLaw law;
  const auto at = [&](double z) {
    BallCase c(z);
    c.answer.parts = true;
    return forceOf(law, c).z;
  };
  EXPECT_NEAR(at(0.0005), 0.75, 1e-9);
  EXPECT_NEAR(at(-0.001), 0.5, 1e-9);
  EXPECT_NEAR(at(-0.0015), 0.25, 1e-9);
  EXPECT_NEAR(at(-0.001), 0.25, 1e-9) << "it does not come back on the way out";
}

TEST(ElasticLaw, PullsTheArmToTheProxyThatSolidTissueHolds) {
  Case c;
  c.in.pull = {Vec3(0, 0, 2.0), Vec3(0.1, 0, 0), 400.0, 900.0};
  c.in.share.stiffness = 0.5;
  const ContactForce f = contactOf(ElasticLaw{}, c, ElasticLaw::Answer{});
  EXPECT_NEAR(f.elastic_N.z, 0.5 * 900.0 * 0.002, 1e-12);
  EXPECT_NEAR(f.torque_Nm.x, 0.5 * 900.0 * 400e-6 * 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(f.solid_stiffness, 450.0);
  EXPECT_DOUBLE_EQ(f.stiffness, 0.0) << "across the pull nothing holds it";
  EXPECT_NEAR(f.stored_J, 0.5 * 450.0 * (4e-6 + 400e-6 * 0.01), 1e-12);
}

TEST(RuptureLaw, IsElasticUpToTheRuptureForceAndThenDrops) {
  RuptureLaw law;
  Case entry({0, 0, 0});
  entry.in.velocity_m_s = {0, 0, -0.01};
  EXPECT_EQ(contactOf(law, entry).elastic_N, Vec3(0.0));
  EXPECT_NEAR(contactOf(law, Case({0, 0, -0.001})).elastic_N.z, 0.8, 1e-12);
  EXPECT_NEAR(contactOf(law, Case({0, 0, -0.00124})).elastic_N.z, 0.992, 1e-12);
  EXPECT_EQ(contactOf(law, Case({0, 0, -0.00126})).elastic_N, Vec3(0.0));
  EXPECT_EQ(contactOf(law, Case({0, 0, -0.0005})).elastic_N, Vec3(0.0)) << "stays ruptured";
}

TEST(RuptureLaw, ACapsuleFromWhichTheTipDrewBackIsWholeAgain) {
  RuptureLaw law;
  contactOf(law, Case({0, 0, 0}));
  contactOf(law, Case({0, 0, -0.001}));
  EXPECT_EQ(contactOf(law, Case({0, 0, 0.0001})).elastic_N, Vec3(0.0));
  contactOf(law, Case({0, 0, 0}));
  EXPECT_NEAR(contactOf(law, Case({0, 0, -0.001})).elastic_N.z, 0.8, 1e-12);
}

TEST(RuptureLaw, IsWholeAgainAfterTheToolLeftAllTissue) {
  RuptureLaw law;
  contactOf(law, Case({0, 0, 0}));
  contactOf(law, Case({0, 0, -0.002}));
  EXPECT_EQ(contactOf(law, Case({0, 0, -0.001})).elastic_N, Vec3(0.0));
  contactOf(law, Case({0, 0, 0.01}).inAir());
  contactOf(law, Case({0, 0, 0}));
  EXPECT_NEAR(contactOf(law, Case({0, 0, -0.001})).elastic_N.z, 0.8, 1e-12);
}

// An arm that renders half the stiffness feels half the force and the same rupture.
TEST(RuptureLaw, GivesWayAtTheSamePlaceWhateverTheArmRenders) {
  RuptureLaw law;
  const auto at = [&](double z) {
    Case c({0, 0, z});
    c.in.share.stiffness = 0.5;
    return contactOf(law, c).elastic_N.z;
  };
  at(0.0);
  EXPECT_NEAR(at(-0.00124), 0.496, 1e-12);
  EXPECT_EQ(at(-0.00126), 0.0);
}

TEST(Laws, EachSayWhatTheyAreCalledAndDo) {
  ASSERT_EQ(kLawNames.size(), kLawTraits.size());
  for (const auto& [name, law] : kLawNames) {
    const LawWords& words = wordsOf(law);
    EXPECT_EQ(name, words.id);
    EXPECT_EQ(std::count_if(kLawNames.begin(), kLawNames.end(),
                            [&](const auto& other) { return other.first == words.id; }),
              1)
        << words.id;
    EXPECT_GT(std::string_view(words.name).size(), 0u) << words.id;
    EXPECT_TRUE(std::string_view(words.meaning).ends_with('.')) << words.id;
    EXPECT_FALSE(kLawTraits[std::size_t(law)].numbers.empty()) << words.id;
  }
}

TEST(Laws, FeelANumberThatTheyUseWhereTheTissueHasTheOthers) {
  TickNumbers tissue;
  tissue.stiffness_N_per_m = 800.0;
  const auto felt = [&](LawKind law, double TickNumbers::*number) {
    return feels(law, number, tissue);
  };
  EXPECT_TRUE(felt(LawKind::viscous, &TickNumbers::damping_Ns_per_m));
  EXPECT_FALSE(felt(LawKind::viscous, &TickNumbers::stiffness_N_per_m));
  EXPECT_TRUE(felt(LawKind::elastic, &TickNumbers::stiffness_N_per_m));
  EXPECT_FALSE(felt(LawKind::coulomb, &TickNumbers::stiffness_N_per_m)) << "nothing rubs";
  EXPECT_TRUE(felt(LawKind::coulomb, &TickNumbers::friction_N));
  EXPECT_TRUE(felt(LawKind::rupture, &TickNumbers::rupture_N));
  tissue.friction_N = 1.0;
  EXPECT_TRUE(felt(LawKind::coulomb, &TickNumbers::stiffness_N_per_m));
}

TEST(Laws, AreMadeByName) {
  const Tool tool = makeNeedle(0.05);
  const GridGeometry geometry;
  const auto made = [&](LawKind kind) { return makeLaw(kind, 3, tool, geometry); };
  EXPECT_TRUE(std::holds_alternative<LawOfTool<ViscousLaw>>(made(LawKind::viscous)));
  const Law coulomb = made(LawKind::coulomb);
  EXPECT_EQ(std::get<LawOfTool<CoulombLaw>>(coulomb).rendered.springs.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<LawOfTool<ElasticLaw>>(made(LawKind::elastic)));
  EXPECT_TRUE(std::holds_alternative<LawOfTool<RuptureLaw>>(made(LawKind::rupture)));
}

}  // namespace
}  // namespace trephine
