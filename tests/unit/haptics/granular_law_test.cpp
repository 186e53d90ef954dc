// Grains before a tool.
#include "haptics_support.h"

namespace trephine {
namespace {

// b 10, k 800, friction 2 N: loose grains yield at 0.8 N, packed ones at 3 N.
struct Grains {
  TissueTable table = test::boneTable();
  GranularLaw law;

  ContactForce at(double x_m, int tissue_class = 0) {
    TouchPoint point;
    point.tissue_class = tissue_class;
    LawInput in;
    in.tip_m = {x_m, 0.0, 0.0};
    in.points = {&point, 1};
    in.tissues = &table;
    in.tissue_class = in.tip_class = tissue_class;
    ContactForce out;
    law.add(in, out);
    return out;
  }
  // Ploughs from one place to another; the force there.
  double plough(double from_m, double to_m) {
    double force_N = 0.0;
    for (int n = 0; n <= 1000; ++n) force_N = at(from_m + (to_m - from_m) * n / 1000.0).elastic_N.x;
    return force_N;
  }
};

TEST(GranularLaw, HoldsAToolThatRestsAndYieldsWhileLoose) {
  Grains grains;
  grains.at(0.0);
  EXPECT_NEAR(grains.at(0.001).elastic_N.x, -0.64, 1e-12) << "0.8 of 800 N/m";
  EXPECT_NEAR(grains.at(0.001).elastic_N.x, -0.64, 1e-12);
  EXPECT_NEAR(grains.at(0.0014).elastic_N.x, -0.8, 1e-12);
}

TEST(GranularLaw, PacksOnTheWayAndLoosensOnTheWayBack) {
  Grains grains;
  const double soon_N = -grains.plough(0.0, 0.003), packed_N = -grains.plough(0.003, 0.03);
  EXPECT_GT(soon_N, 0.9);
  EXPECT_GT(packed_N, 2.0 * soon_N);
  EXPECT_LT(packed_N, 3.0);
  EXPECT_LT(grains.plough(0.03, 0.018), 0.5 * packed_N) << "back";
}

TEST(GranularLaw, IsLooseAgainWhereTheToolWasInAir) {
  Grains grains;
  grains.plough(0.0, 0.03);
  EXPECT_EQ(grains.at(0.03, -1).elastic_N, Vec3(0.0));
  grains.at(0.0);
  EXPECT_NEAR(grains.at(0.002).elastic_N.x, -0.8, 0.2);
}

TEST(GranularLaw, TakesEnergyOnAClosedWay) {
  Grains grains;
  double taken_J = 0.0, last_N = 0.0, last_m = 0.0;
  for (int n = 0; n <= 4000; ++n) {
    const double x_m = 0.01 * std::sin(2.0 * M_PI * n / 1000.0);
    const double force_N = grains.at(x_m).elastic_N.x;
    taken_J -= 0.5 * (force_N + last_N) * (x_m - last_m);
    last_N = force_N;
    last_m = x_m;
  }
  EXPECT_GT(taken_J, 0.02);
}

TEST(GranularLaw, IsFeltThroughTheCoreByItsNameAlone) {
  HapticParameters p = test::oneArm();
  for (const auto& [name, law] : kLawNames) {
    if (name == "granular") p.laws = {law};
  }
  ASSERT_EQ(p.laws, std::vector{kLawKind<GranularLaw>});
  p.tissues.classes[0].cuttable = 0;
  test::Bench bench(p);
  EXPECT_GT(bench.push({0, 0, 5}, {0, 0, -5}, 1000), 0.5);
}

}  // namespace
}  // namespace trephine
