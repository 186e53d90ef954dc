// Soft tissue under scripted strokes, through the real loop: the bars of touch that a person would
// notice.
#include "lab/touch/tissue_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/system.h"
#include "lab/touch/tissue_measurement.h"

namespace trephine {
namespace {

Tissue shipped(const char* set, const char* id) {
  return *readTissueSet(resourceFolder() / "tissues" / (std::string(set) + ".json"))->find(id);
}

struct Drop {
  double peak_N = 0.0, size_N = 0.0, travel_mm = 0.0, tip_from_mm = 0.0, tip_to_mm = 0.0;
};

// Falls of the force by more than a tenth of a newton from one tick to the next, on the way in.
std::vector<Drop> dropsOf(const std::vector<TissueSample>& samples, double first_mm) {
  std::vector<Drop> drops;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double before = samples[i - 1].demanded_N.z, now = samples[i].demanded_N.z;
    if (before - now < 0.1) continue;
    drops.push_back({before, before - now, first_mm - samples[i].arm_mm.z, samples[i - 1].tool_mm.z,
                     samples[i].tool_mm.z});
  }
  return drops;
}

TEST(Dura, GivesWayOnceToEachNeedleInTheTickInWhichItsTipGoesThrough) {
  const Tissue dura = shipped("cranium", "dura"), brain = shipped("cranium", "brain");
  for (double thick_mm : {0.5, 1.0, 2.0}) {
    for (double mm_per_s : {2.0, 4.0, 6.0}) {
      double peak_N = 0.0;
      for (double width_mm : {0.5, 0.9, 1.4}) {
        SCOPED_TRACE(testing::Message() << thick_mm << " mm thick, " << width_mm << " mm wide, "
                                        << mm_per_s << " mm/s");
        const Vec3 top(0.13, 0.07, 1.0), bottom(0.13, 0.07, -12.0);
        auto trace = runStroke(softStroke({{dura, thick_mm}, {brain, 20.0}}, needleOf(width_mm),
                                          {top, bottom, top, bottom}, mm_per_s));
        ASSERT_TRUE(trace) << trace.error().sentence();
        const std::size_t leg = std::size_t(1000.0 * 13.0 / mm_per_s);
        const std::vector<TissueSample> in(trace->samples.begin(),
                                           trace->samples.begin() + std::ptrdiff_t(leg));
        const std::vector<TissueSample> again(trace->samples.begin() + std::ptrdiff_t(2 * leg),
                                              trace->samples.end());
        const auto drops = dropsOf(in, firstTouch_mm(in));
        ASSERT_EQ(drops.size(), 1u);
        EXPECT_GT(drops[0].peak_N, peak_N);
        peak_N = drops[0].peak_N;
        EXPECT_GE(drops[0].travel_mm, 2.0);
        EXPECT_LE(drops[0].travel_mm, 6.0);
        // The tip was at the dura's surface, and comes out behind it.
        EXPECT_NEAR(drops[0].tip_from_mm, 0.0, 0.3);
        EXPECT_LT(drops[0].tip_to_mm, -thick_mm);
        double again_N = 0.0;
        for (const TissueSample& s : again) again_N = std::max(again_N, s.demanded_N.z);
        EXPECT_LE(again_N, 0.3 * peak_N);
      }
    }
  }
}

TEST(Needle, FeelsTheSameWhateverTheNumberOfItsPoints) {
  const Tissue capsule = shipped("abdomen", "capsule"), liver = shipped("abdomen", "liver");
  std::vector<TissueSample> reference;
  for (int points : {1, 8, 31, 120}) {
    SCOPED_TRACE(points);
    auto trace = runStroke(softStroke({{capsule, 1.0}, {liver, 40.0}}, needleOf(1.2, points),
                                      {{0.1, 0.1, 1}, {0.1, 0.1, -30}, {0.1, 0.1, 1}}, 5.0));
    ASSERT_TRUE(trace);
    if (reference.empty()) reference = trace->samples;
    double sum = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      sum += std::abs(reference[i].demanded_N.z);
      difference += std::abs(reference[i].demanded_N.z - trace->samples[i].demanded_N.z);
    }
    EXPECT_LT(difference, 0.05 * sum);
  }
}

TEST(Blade, CutsTheSameWithEveryArmGridAndRate) {
  const Tissue liver = shipped("abdomen", "liver");
  const Tool blade = *makeTool({ToolKind::blade, 16.0, 16, 0.6});
  double reference_mm3 = 0.0;
  struct Case {
    double spacing_mm, rate_hz, peak_N;
  };
  for (const Case& c : {Case{0.25, 1000, 3.3}, Case{0.5, 1000, 3.3}, Case{0.25, 1000, 5.0},
                        Case{0.25, 1000, 20.0}, Case{0.25, 500, 3.3}, Case{0.25, 4000, 3.3}}) {
    SCOPED_TRACE(testing::Message()
                 << c.spacing_mm << " mm, " << c.rate_hz << " Hz, " << c.peak_N << " N");
    TissueStroke stroke = softStroke({{liver, 20.0}}, blade,
                                     {{-8, 0.1, 1}, {-8, 0.1, -8}, {8, 0.1, -8}, {8, 0.1, 1}}, 8.0);
    stroke.wide_mm = 36.0;
    stroke.spacing_mm = c.spacing_mm;
    stroke.rate_hz = c.rate_hz;
    stroke.peak_force_N = c.peak_N;
    auto trace = runStroke(stroke);
    ASSERT_TRUE(trace);
    if (reference_mm3 == 0.0) reference_mm3 = trace->removed_mm3;
    EXPECT_GT(trace->removed_mm3, 50.0);
    EXPECT_NEAR(trace->removed_mm3, reference_mm3, 0.05 * reference_mm3);
  }
}

// A way through random places at random speeds.
std::function<Vec3(double)> wander(std::mt19937& random, double& seconds) {
  const auto of = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<std::pair<double, Vec3>> places{{0.0, Vec3(of(-5, 5), of(-1, 1), 3.0)}};
  for (int n = 0; n < 14; ++n) {
    const Vec3 next(of(-6, 6), of(-1.5, 1.5), of(-16, 2));
    const double length = glm::length(next - places.back().second);
    places.emplace_back(places.back().first + length / of(2.0, 80.0), next);
  }
  seconds = places.back().first;
  return [places](double t_s) {
    for (std::size_t n = 1; n < places.size(); ++n) {
      const auto& [from_s, from] = places[n - 1];
      const auto& [to_s, to] = places[n];
      if (t_s < to_s) return from + ((t_s - from_s) / (to_s - from_s)) * (to - from);
    }
    return places.back().second;
  };
}

// What was cut never cost more than the hand had put in by then, at the model's own force; and
// never does the hand get back more than it put in.
TEST(SoftTissue, TakesTheWorkThatItsCutsCostAndGivesNoneOut) {
  const Tissue capsule = shipped("abdomen", "capsule"), liver = shipped("abdomen", "liver"),
               vessel = shipped("abdomen", "vessel");
  std::mt19937 random(7);
  double most_cut_J = 0.0;
  for (int run = 0; run < 16; ++run) {
    SCOPED_TRACE(run);
    const Tool tool = run % 2 ? needleOf(1.2) : *makeTool({ToolKind::blade, 16.0, 16, 0.6});
    TissueStroke stroke = softStroke({{capsule, 1.0}, {liver, 7.0}, {vessel, 4.0}, {liver, 10.0}},
                                     tool, {{}, {}}, 1.0);
    stroke.laws.push_back(LawKind::relaxation);
    stroke.way = wander(random, stroke.seconds);
    stroke.wide_mm = 30.0;
    auto trace = runStroke(stroke);
    ASSERT_TRUE(trace);
    const double voxel_m2 = 1e-6 * std::pow(stroke.spacing_mm, 3.0) / 1.2;
    double in_J = 0.0, cut_J = 0.0;
    std::size_t carve = 0;
    for (std::size_t i = 1; i < trace->samples.size(); ++i) {
      const TissueSample& s = trace->samples[i];
      // The force of a tick acts until the next.
      in_J -= 0.001 *
              glm::dot(trace->samples[i - 1].demanded_N, s.arm_mm - trace->samples[i - 1].arm_mm);
      for (; carve < trace->carves.size() && trace->carves[carve].tick <= i; ++carve) {
        const auto layer = std::size_t(trace->carves[carve].tissue_class);
        cut_J += voxel_m2 * stroke.layers[layer].tissue.toughness_J_per_m2->value;
      }
      // A fast arm goes on by so much while a force is held.
      ASSERT_LE(cut_J, in_J + 2e-4) << "at " << s.t_s << " s";
    }
    most_cut_J = std::max(most_cut_J, cut_J);
  }
  EXPECT_GT(most_cut_J, 0.01);
}

// The force along z at the n-th fall by more than a tenth of a newton.
std::vector<Drop> dropsAlong(const std::vector<TissueLayer>& layers, const Tool& tool,
                             const std::vector<Vec3>& places, double mm_per_s = 5.0) {
  auto trace = runStroke(softStroke(layers, tool, places, mm_per_s));
  return trace ? dropsOf(trace->samples, firstTouch_mm(trace->samples)) : std::vector<Drop>();
}

TEST(Membrane, GivesWayAgainBesideItsHoleAndNotInIt) {
  const Tissue dura = shipped("cranium", "dura"), brain = shipped("cranium", "brain");
  const std::vector<TissueLayer> layers{{dura, 1.0}, {brain, 20.0}};
  const Vec3 down(0, 0, -11);
  const auto twice = [&](const Vec3& second) {
    const Vec3 first(0.1, 0.1, 1.0);
    return dropsAlong(layers, needleOf(0.9), {first, first + down, first, second, second + down});
  };
  EXPECT_EQ(twice({0.1, 0.1, 1.0}).size(), 1u);
  EXPECT_EQ(twice({0.4, 0.1, 1.0}).size(), 1u);
  EXPECT_EQ(twice({5.0, 0.1, 1.0}).size(), 2u);
}

TEST(Membrane, OfAnotherPieceBehindTheFirstGivesWayOnItsOwn) {
  const Tissue dura = shipped("cranium", "dura"), brain = shipped("cranium", "brain");
  const auto drops = dropsAlong({{dura, 1.0}, {brain, 8.0}, {dura, 1.0}, {brain, 12.0}},
                                needleOf(0.9), {{0.1, 0.1, 1.0}, {0.1, 0.1, -19.0}});
  EXPECT_EQ(drops.size(), 2u);
}

TEST(Membrane, IsWholeAfterATipThatDrewBack) {
  const Tissue dura = shipped("cranium", "dura"), brain = shipped("cranium", "brain");
  const Vec3 top(0.1, 0.1, 1.0), pressed(0.1, 0.1, -2.0), through(0.1, 0.1, -9.0);
  const auto drops =
      dropsAlong({{dura, 1.0}, {brain, 20.0}}, needleOf(0.9), {top, pressed, top, through});
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_GT(drops[0].peak_N, 0.5);
}

TEST(Membrane, HasAPeakWhereATipComesOutOfAThickOne) {
  const Tissue skin = shipped("abdomen", "skin");
  std::vector<Drop> peaks;
  for (const Drop& drop :
       dropsAlong({{skin, 16.0}}, needleOf(0.9), {{0.1, 0.1, 1.0}, {0.1, 0.1, -26.0}})) {
    if (drop.size_N > 0.8) peaks.push_back(drop);  // more than an edge slips by
  }
  ASSERT_EQ(peaks.size(), 2u);
  EXPECT_NEAR(peaks[0].tip_from_mm, 0.0, 0.3);
  EXPECT_NEAR(peaks[1].tip_from_mm, -15.0, 1.5);
}

TEST(Relaxation, TakesItsShareOfAHeldForceWhereTheLawIsNamed) {
  Tissue dura = shipped("cranium", "dura");
  dura.relaxation_share = SourcedNumber{0.4, "of this test"};
  dura.relaxation_s = SourcedNumber{0.5, "of this test"};
  TissueStroke stroke = softStroke({{dura, 3.0}}, needleOf(0.9), {{}, {}}, 1.0);
  stroke.way = [](double t_s) { return Vec3(0.1, 0.1, std::max(-2.0, 1.0 - 5.0 * t_s)); };
  stroke.seconds = 4.0;
  const auto heldAndLater = [&] {
    auto trace = runStroke(stroke);
    return std::pair(trace->samples[650].demanded_N.z, trace->samples.back().demanded_N.z);
  };
  const auto [still_N, still_later_N] = heldAndLater();
  EXPECT_NEAR(still_later_N, still_N, 1e-6);
  stroke.laws.push_back(LawKind::relaxation);
  const auto [held_N, later_N] = heldAndLater();
  EXPECT_LT(later_N, 0.7 * held_N);
  EXPECT_GT(later_N, 0.0);
}

TEST(Shaft, IsHeldAgainstEveryMotionAndNeverPushedOut) {
  const Tissue liver = shipped("abdomen", "liver"), capsule = shipped("abdomen", "capsule");
  const Vec3 top(0.1, 0.1, 1.0), bottom(0.1, 0.1, -25.0);
  for (bool cut : {false, true}) {
    SCOPED_TRACE(cut);
    Tissue parted = liver;
    parted.cuttable = cut;
    auto trace = runStroke(
        softStroke({{capsule, 1.0}, {parted, 40.0}}, needleOf(1.2), {top, bottom, top}, 5.0));
    ASSERT_TRUE(trace);
    const std::size_t leg = trace->samples.size() / 2;
    // After the spring has turned round.
    for (std::size_t i = leg + 700; i < trace->samples.size(); ++i) {
      ASSERT_LE(trace->samples[i].demanded_N.z, 1e-9) << trace->samples[i].arm_mm.z;
    }
    EXPECT_EQ(trace->samples.back().demanded_N, Vec3(0.0));
  }
}

}  // namespace
}  // namespace trephine
