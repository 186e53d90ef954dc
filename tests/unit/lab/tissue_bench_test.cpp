// Soft tissue under scripted strokes, through the real loop: the bars of touch that a person would
// notice.
#include "lab/touch/tissue_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/system.h"
#include "lab/touch/tissue_measurement.h"

namespace trephine {
namespace {

const std::vector<LawKind> kLaws{LawKind::viscous, LawKind::friction, LawKind::elastic,
                                 LawKind::membrane, LawKind::cutting};

Tissue shipped(const char* set, const char* id) {
  return *readTissueSet(resourceFolder() / "tissues" / (std::string(set) + ".json"))->find(id);
}

Tool needle(double width_mm, int points = 1) {
  return *makeTool({ToolKind::needle, 60.0, points, 0.5 * width_mm});
}

TissueStroke strokeOf(std::vector<TissueLayer> layers, const Tool& tool,
                      const std::vector<Vec3>& places, double mm_per_s) {
  TissueStroke stroke;
  stroke.layers = std::move(layers);
  stroke.tool = tool;
  stroke.laws = kLaws;
  stroke.wide_mm = 16.0;
  stroke.peak_force_N = 20.0;
  stroke.way = wayThrough(places, mm_per_s);
  stroke.seconds = secondsThrough(places, mm_per_s);
  return stroke;
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
    drops.push_back({before, before - now, first_mm - samples[i].arm_mm.z,
                     samples[i - 1].tool_mm.z, samples[i].tool_mm.z});
  }
  return drops;
}

double firstTouch_mm(const std::vector<TissueSample>& samples) {
  for (const TissueSample& s : samples) {
    if (s.demanded_N.z > 0.0) return s.arm_mm.z;
  }
  return 0.0;
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
        auto trace = runStroke(strokeOf({{dura, thick_mm}, {brain, 20.0}}, needle(width_mm),
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
    auto trace =
        runStroke(strokeOf({{capsule, 1.0}, {liver, 40.0}}, needle(1.2, points),
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
    SCOPED_TRACE(testing::Message() << c.spacing_mm << " mm, " << c.rate_hz << " Hz, " << c.peak_N
                                    << " N");
    TissueStroke stroke = strokeOf({{liver, 20.0}}, blade,
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
    std::printf("%g mm %g Hz %g N: %.1f mm3\n", c.spacing_mm, c.rate_hz, c.peak_N,
                trace->removed_mm3);
  }
}

}  // namespace
}  // namespace trephine
