#include "haptics/laws.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

LawInput inBone(const Vec3& tip_m) {
  return {tip_m, Contact{0, 1}, TissueClass{226, 3071, 10.0, 800.0, 2.0, 1, 0}};
}

template <class L>
Vec3 forceOf(L&& law, const LawInput& in, const Vec3& velocity_m_s = Vec3(0.0)) {
  ContactForce force;
  law.add(in, force);
  return force.at(velocity_m_s);
}

TEST(ViscousLaw, OpposesTheVelocityWithTheTissuesDamping) {
  const Vec3 f = forceOf(ViscousLaw{}, inBone(Vec3(0.0)), {0.01, -0.02, 0.03});
  EXPECT_DOUBLE_EQ(f.x, -0.1);
  EXPECT_DOUBLE_EQ(f.y, 0.2);
  EXPECT_DOUBLE_EQ(f.z, -0.3);
}

TEST(Laws, GiveNoForceWithoutContact) {
  LawInput air = inBone({0, 0, -0.001});
  air.contact = Contact{};
  EXPECT_EQ(forceOf(ViscousLaw{}, air, {1, 1, 1}), Vec3(0.0));
  EXPECT_EQ(forceOf(ElasticLaw{}, air, {1, 1, 1}), Vec3(0.0));
}

TEST(ElasticLaw, PushesBackTowardsWhereContactBegan) {
  ElasticLaw law;
  EXPECT_EQ(forceOf(law, inBone({0, 0, 0})), Vec3(0.0));
  EXPECT_NEAR(forceOf(law, inBone({0, 0, -0.001})).z, 0.8, 1e-12);
  EXPECT_NEAR(forceOf(law, inBone({0, 0, -0.001})).z, 0.8, 1e-12) << "holds at rest";
}

TEST(ElasticLaw, GivesWayAtTheYieldForceAndNeverExceedsIt) {
  ElasticLaw law;
  forceOf(law, inBone({0, 0, 0}));
  EXPECT_NEAR(glm::length(forceOf(law, inBone({0, 0, -0.010}))), 2.0, 1e-12);
  // The anchor was dragged along: coming back 1 mm relieves the spring by 0.8 N.
  EXPECT_NEAR(forceOf(law, inBone({0, 0, -0.009})).z, 1.2, 1e-12);
}

TEST(ElasticLaw, NeverGivesBackMoreEnergyThanItTook) {
  ElasticLaw law;
  double given_J = 0.0;
  Vec3 last(0.0), held(0.0);
  for (int i = 0; i < 20000; ++i) {
    const double t = i * 1e-3;
    const Vec3 x(0.004 * std::sin(3.1 * t), 0.003 * std::sin(7.7 * t), 0.005 * std::sin(5.3 * t));
    // The trapezoid of a piecewise linear motion is exact for a spring.
    const Vec3 f = forceOf(law, inBone(x));
    given_J += glm::dot(0.5 * (f + held), x - last);
    ASSERT_LT(given_J, 1e-9);
    last = x;
    held = f;
  }
  EXPECT_LT(given_J, -0.01) << "dragging the anchor loses energy";
}

TEST(ElasticLaw, ForgetsItsAnchorWhenContactEnds) {
  ElasticLaw law;
  forceOf(law, inBone({0, 0, 0}));
  LawInput air = inBone({0, 0, 0.002});
  air.contact = Contact{};
  forceOf(law, air);
  EXPECT_EQ(forceOf(law, inBone({0, 0, -0.001})), Vec3(0.0));
}

TEST(Laws, AreMadeByName) {
  EXPECT_TRUE(std::holds_alternative<ElasticLaw>(makeLaw(LawKind::elastic)));
  EXPECT_TRUE(std::holds_alternative<ViscousLaw>(makeLaw(LawKind::viscous)));
}

}  // namespace
}  // namespace trephine
