#include "haptics/laws.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

LawInput inBone(const Vec3& tip_m, const Vec3& velocity = Vec3(0.0)) {
  return {tip_m, velocity, Contact{0, 1}, TissueClass{226, 3071, 10.0, 800.0, 2.0, 1, 0}};
}

TEST(ViscousLaw, OpposesTheVelocityWithTheTissuesDamping) {
  const Vec3 f = ViscousLaw{}.force(inBone(Vec3(0.0), {0.01, -0.02, 0.03}));
  EXPECT_DOUBLE_EQ(f.x, -0.1);
  EXPECT_DOUBLE_EQ(f.y, 0.2);
  EXPECT_DOUBLE_EQ(f.z, -0.3);
}

TEST(Laws, GiveNoForceWithoutContact) {
  LawInput air = inBone({0, 0, -0.001}, {1, 1, 1});
  air.contact = Contact{};
  EXPECT_EQ(ViscousLaw{}.force(air), Vec3(0.0));
  EXPECT_EQ(ElasticLaw{}.force(air), Vec3(0.0));
}

TEST(ElasticLaw, PushesBackTowardsWhereContactBegan) {
  ElasticLaw law;
  EXPECT_EQ(law.force(inBone({0, 0, 0})), Vec3(0.0));
  EXPECT_NEAR(law.force(inBone({0, 0, -0.001})).z, 0.8, 1e-12);
  EXPECT_NEAR(law.force(inBone({0, 0, -0.001})).z, 0.8, 1e-12) << "holds at rest";
}

TEST(ElasticLaw, GivesWayAtTheYieldForceAndNeverExceedsIt) {
  ElasticLaw law;
  law.force(inBone({0, 0, 0}));
  EXPECT_NEAR(glm::length(law.force(inBone({0, 0, -0.010}))), 2.0, 1e-12);
  // The anchor was dragged along: coming back 1 mm relieves the spring by 0.8 N.
  EXPECT_NEAR(law.force(inBone({0, 0, -0.009})).z, 1.2, 1e-12);
}

TEST(ElasticLaw, NeverGivesBackMoreEnergyThanItTook) {
  ElasticLaw law;
  double given_J = 0.0;
  Vec3 last(0.0), held(0.0);
  for (int i = 0; i < 20000; ++i) {
    const double t = i * 1e-3;
    const Vec3 x(0.004 * std::sin(3.1 * t), 0.003 * std::sin(7.7 * t), 0.005 * std::sin(5.3 * t));
    // The trapezoid of a piecewise linear motion is exact for a spring.
    const Vec3 f = law.force(inBone(x));
    given_J += glm::dot(0.5 * (f + held), x - last);
    ASSERT_LT(given_J, 1e-9);
    last = x;
    held = f;
  }
  EXPECT_LT(given_J, -0.01) << "dragging the anchor loses energy";
}

TEST(ElasticLaw, ForgetsItsAnchorWhenContactEnds) {
  ElasticLaw law;
  law.force(inBone({0, 0, 0}));
  LawInput air = inBone({0, 0, 0.002});
  air.contact = Contact{};
  law.force(air);
  EXPECT_EQ(law.force(inBone({0, 0, -0.001})), Vec3(0.0));
}

TEST(Laws, AreMadeByName) {
  EXPECT_TRUE(std::holds_alternative<ElasticLaw>(makeLaw(LawKind::elastic)));
  EXPECT_TRUE(std::holds_alternative<ViscousLaw>(makeLaw(LawKind::viscous)));
}

}  // namespace
}  // namespace trephine
