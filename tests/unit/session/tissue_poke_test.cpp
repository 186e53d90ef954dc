// What a tool meets in a block of a tissue, what was published of it, and what an arm's own
// friction hides.
#include "session/tissue_poke.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/system.h"
#include "device/trephine_device.h"
#include "haptics/haptic_core.h"

namespace trephine {
namespace {

constexpr double kOmniFriction_N = 0.26;

Exercise shipped(const char* name) {
  return *readExercise(resourceFolder() / "scenes" / (std::string(name) + ".json"));
}

// Its arms show the tissue's own force.
Exercise unscaled(const char* name) {
  Exercise exercise = shipped(name);
  for (ExerciseArm& arm : exercise.arms) arm.map.force_scale = 1.0;
  return exercise;
}

// Omnis with such a friction.
Rig omnis(const Exercise& exercise, double friction_N) {
  Rig rig = simulatedRig(exercise);
  for (Rig::Arm& arm : rig.arms) {
    arm.dynamics = ArmDynamics{0.045, 5.5e-5, 3.3, 0.0, 0.88, 0.0, friction_N};
  }
  return rig;
}

std::size_t placeOf(const Exercise& exercise, const char* tissue) {
  const auto& all = exercise.tissues.tissues;
  return std::size_t(std::ranges::find(all, tissue, &Tissue::id) - all.begin());
}

double forceAt(const PokeCurve& curve, double depth_mm) {
  const auto at = std::ranges::find_if(curve.points,
                                       [&](const PokePoint& p) { return p.depth_mm >= depth_mm; });
  return at->demanded_N;
}

TEST(TissuePoke, AMembraneRisesToItsRuptureForceAndLetsGoAtOnce) {
  const Exercise exercise = unscaled("liver");
  const Rig rig = omnis(exercise, kOmniFriction_N);
  const std::size_t capsule = placeOf(exercise, "capsule");
  for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
    const PokeCurve curve = pokeOf(exercise, rig, arm, capsule);
    const Tool& tool = exercise.findTool(exercise.arms[arm].tool)->tool;
    const double rupture_N =
        exercise.tissues.tissues[capsule].rupture_N->value * 2000.0 * tool.radius_m / 1.2;
    double peak_N = 0.0, drop_N = 0.0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      peak_N = std::max(peak_N, curve.points[i].demanded_N);
      drop_N = std::max(drop_N, curve.points[i - 1].demanded_N - curve.points[i].demanded_N);
    }
    EXPECT_NEAR(peak_N, rupture_N, 0.1 * rupture_N) << arm;
    EXPECT_GT(drop_N, 0.5 * rupture_N) << arm << ": in one tick";
    EXPECT_LE(curve.most_N, 3.3);
  }
}

// As the session of a poke has it.
TEST(TissuePoke, WhatRemovesNothingFeelsAMembraneGiveWayAllTheSame) {
  const Exercise exercise = unscaled("liver");
  HapticParameters parameters = hapticParameters(exercise, omnis(exercise, 0.0));
  parameters.arms.resize(1);
  parameters.removes = false;
  const std::size_t capsule = placeOf(exercise, "capsule");
  for (TissueClass& t : parameters.tissues.classes) t.hu_min = t.hu_max = -32768, t.label = 0;
  TissueClass& only = parameters.tissues.classes[capsule];
  only.hu_min = only.hu_max = 100;
  Volume volume;
  volume.geometry.size = {48, 48, 48};
  volume.geometry.origin_mm = {-23.5, -23.5, -39.5};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), 48 * 48 * 40, std::int16_t(100));
  Grid grid(std::move(volume));
  HapticCore core(parameters, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  double peak_N = 0.0, drop_N = 0.0, before_N = 0.0;
  const double scale = parameters.arms[0].map.motion_scale;
  for (double z_mm = 5.0; z_mm > -20.0; z_mm -= 0.01, ++input.tick) {
    input.journal = core.journalState();
    input.arms[0].position_m.z = 1e-3 * z_mm / scale;
    input.arms[0].flags = TREPHINE_ARM_CALIBRATED;
    core.tick(input, nullptr, 0, record);
    ASSERT_TRUE(core.carves().empty());
    const double now_N = glm::length(record.arms[0].demanded_N);
    peak_N = std::max(peak_N, now_N);
    drop_N = std::max(drop_N, before_N - now_N);
    before_N = now_N;
  }
  EXPECT_GT(drop_N, 0.3) << "it gave way";
  EXPECT_LT(peak_N, 2.0) << "and what lies behind it lets the needle through";
}

TEST(TissuePoke, ATissuesCurveDoesNotDependOnWhatElseTheExerciseHas) {
  Exercise exercise = unscaled("liver");
  const Rig rig = omnis(exercise, kOmniFriction_N);
  const std::size_t liver = placeOf(exercise, "liver");
  const PokeCurve among = pokeOf(exercise, rig, 0, liver);
  exercise.tissues.tissues = {exercise.tissues.tissues[liver]};
  const PokeCurve alone = pokeOf(exercise, rig, 0, 0);
  ASSERT_EQ(among.points.size(), alone.points.size());
  for (std::size_t i = 0; i < among.points.size(); ++i) {
    ASSERT_EQ(among.points[i].demanded_N, alone.points[i].demanded_N) << i;
  }
}

TEST(TissuePoke, TheForceScaleOfAnArmIsInItsCurveAndInThePublishedBand) {
  Exercise exercise = unscaled("liver");
  const std::size_t capsule = placeOf(exercise, "capsule");
  const auto bands = publishedBands(exercise, 0, capsule);
  const PokeCurve before = pokeOf(exercise, omnis(exercise, 0.0), 0, capsule);
  exercise.arms[0].map.force_scale = 0.5;
  const auto halved = publishedBands(exercise, 0, capsule);
  const PokeCurve after = pokeOf(exercise, omnis(exercise, 0.0), 0, capsule);
  ASSERT_FALSE(bands.empty());
  ASSERT_EQ(bands.size(), halved.size());
  for (std::size_t i = 0; i < bands.size(); ++i) {
    EXPECT_DOUBLE_EQ(halved[i].high_to_N, 0.5 * bands[i].high_to_N);
  }
  EXPECT_NEAR(forceAt(after, 8.0), 0.5 * forceAt(before, 8.0), 0.02 * forceAt(before, 8.0));
}

TEST(TissuePoke, ThePublishedBandIsThatOfTheNumbersForThisToolsWidth) {
  Exercise exercise = unscaled("liver");
  const std::size_t capsule = placeOf(exercise, "capsule");
  Tissue& t = exercise.tissues.tissues[capsule];
  t.rupture_N->range = SourcedNumber::Published{0.5, 2.0};
  t.rupture_mm->range = SourcedNumber::Published{2.0, 6.0};
  t.toughness_J_per_m2 = SourcedNumber{100.0, "this test"};
  t.toughness_J_per_m2->range = SourcedNumber::Published{80.0, 120.0};
  t.shaft_N_per_mm = SourcedNumber{0.01, "this test"};
  t.shaft_N_per_mm->range.reset();
  const double width_mm = 2000.0 * exercise.findTool(exercise.arms[0].tool)->tool.radius_m;
  const auto bands = publishedBands(exercise, 0, capsule);
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_EQ(bands[0].of, PublishedBand::Of::rupture);
  EXPECT_DOUBLE_EQ(bands[0].low_from_N, 0.5 * width_mm / 1.2);
  EXPECT_DOUBLE_EQ(bands[0].high_to_N, 2.0 * width_mm / 1.2);
  EXPECT_EQ(bands[0].to_mm, 6.0);
  EXPECT_EQ(bands[1].of, PublishedBand::Of::passing);
  EXPECT_NEAR(bands[1].low_from_N, 80.0 * 1e-3 * width_mm, 1e-12);
  EXPECT_NEAR(bands[1].high_to_N, 120.0 * 1e-3 * width_mm + 0.01 * 12.0, 1e-12);
  // Nothing published, or no law that goes by it: no band.
  t.rupture_N->range.reset();
  t.toughness_J_per_m2->range.reset();
  EXPECT_TRUE(publishedBands(exercise, 0, capsule).empty());
  t.rupture_N->range = SourcedNumber::Published{0.5, 2.0};
  exercise.laws = {LawKind::viscous};
  EXPECT_TRUE(publishedBands(exercise, 0, capsule).empty());
}

PokeCurve steady(double newtons) {
  PokeCurve curve;
  for (int i = 0; i < 1200; ++i) curve.points.push_back({0.01 * i, newtons, newtons});
  curve.most_N = newtons;
  return curve;
}

TEST(TissuePoke, WhatAnArmsFrictionHidesIsNotFeltAndWhatDiffersByLessIsNotToldApart) {
  EXPECT_FALSE(isFeltThrough(steady(0.2), 0.26));
  EXPECT_TRUE(isFeltThrough(steady(0.3), 0.26));
  EXPECT_TRUE(isFeltThrough(steady(0.001), 0.0)) << "not known: nothing is said";
  EXPECT_FALSE(areToldApart(steady(0.3), steady(0.5), 0.26));
  EXPECT_TRUE(areToldApart(steady(0.3), steady(0.6), 0.26));
  // Nor is a tissue told apart from itself a little deeper.
  PokeCurve steep = steady(0.3), deeper = steep;
  for (int i = 0; i < 400; ++i) {
    steep.points[std::size_t(400 + i)].sent_N = 0.3 + 0.01 * i;
    deeper.points[std::size_t(450 + i)].sent_N = 0.3 + 0.01 * i;
  }
  EXPECT_FALSE(areToldApart(steep, deeper, 0.26));
  // A click of a tenth of a millimetre is nothing that is felt as a tissue.
  PokeCurve click = steady(0.1);
  for (int i = 500; i < 510; ++i) click.points[std::size_t(i)].sent_N = 2.0;
  EXPECT_FALSE(isFeltThrough(click, 0.26));
}

// As wide as a tool may be, and on tissues that no point touches.
TEST(TissuePoke, IsThatOfAnyToolAndOfNothingWhereNoPointTouches) {
  Exercise exercise = unscaled("liver");
  const std::size_t bone = placeOf(exercise, "bone"), liver = placeOf(exercise, "liver");
  for (ExerciseTool& tool : exercise.tools) {
    tool.tool = *makeTool({ToolKind::needle, 100.0, 1, 12.0});
  }
  const Rig rig = omnis(exercise, 0.26);
  EXPECT_GT(pokeOf(exercise, rig, 0, bone).most_N, 3.0);
  EXPECT_GT(pokeOf(exercise, rig, 0, liver).most_N, 1.0);
  const Exercise seed = *readExercise(resourceFolder() / "scenes" / "research" / "seed-liver.json");
  ASSERT_EQ(std::ranges::count(seed.touch_by_points, "bone"), 0);
  const PokeCurve none = pokeOf(seed, omnis(seed, 0.26), 0, placeOf(seed, "bone"));
  EXPECT_EQ(none.most_N, 0.0);
  EXPECT_GT(pokeOf(seed, omnis(seed, 0.26), 0, placeOf(seed, "liver")).most_N, 0.0);
}

TEST(TissuePoke, OnAnOmniTheSentenceNamesWhatIsNotFelt) {
  for (const char* name : {"liver", "cranium", "burr-hole"}) {
    const Exercise exercise = shipped(name);
    for (const double friction_N : {0.0, kOmniFriction_N, 5.0}) {
      const auto pokes = *pokesOf(exercise, omnis(exercise, friction_N));
      ASSERT_EQ(pokes.size(), exercise.arms.size());
      for (const ArmPokes& of : pokes) {
        for (std::size_t t = 0; t < of.curves.size(); ++t) {
          const auto words = hiddenWords(exercise, of, t);
          if (friction_N == 0.0) EXPECT_TRUE(words.empty()) << words.front();
          if (friction_N == 5.0) {
            ASSERT_EQ(words.size(), 1u) << "no arm gives 5 N";
            EXPECT_NE(words[0].find("is lost in"), std::string::npos) << words[0];
            EXPECT_NE(words[0].find(exercise.tissues.tissues[t].name), std::string::npos);
          }
          if (friction_N == kOmniFriction_N) {
            std::printf("%-9s %-6s %-8s most %.2f N%s\n", name, exercise.arms[of.arm].tool.c_str(),
                        exercise.tissues.tissues[t].id.c_str(), of.curves[t].most_N,
                        words.empty() ? "" : (" | " + words.front()).c_str());
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace trephine
