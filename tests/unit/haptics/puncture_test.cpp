// A needle through layers: what its force trace shows, against the sum by hand.
#include <algorithm>
#include <cmath>
#include <functional>

#include "haptics_support.h"

namespace trephine {
namespace {

struct Layer {
  const char* name;
  std::int16_t hu;
  double thick_mm;
  TissueClass tissue;
};

TissueClass tissueOf(std::int16_t hu, double b, double k, double friction, double rupture) {
  return {{b, k, friction, rupture, 1.0}, hu - 10, hu + 10, 0, 0};
}

// Skin, fat, capsule, liver; scalp, bone, dura.
const std::vector<Layer> kBelly{{"skin", 20, 3.0, tissueOf(20, 3.0, 400.0, 0.3, 0.6)},
                                {"fat", -100, 5.0, tissueOf(-100, 1.5, 60.0, 0.1, 0.0)},
                                {"capsule", 95, 1.5, tissueOf(95, 6.0, 700.0, 0.4, 0.7)},
                                {"liver", 50, 8.0, tissueOf(50, 4.0, 120.0, 0.35, 0.0)}};
const std::vector<Layer> kHead{{"scalp", -20, 4.0, tissueOf(-20, 3.0, 150.0, 0.3, 0.0)},
                               {"bone", 1000, 6.0, tissueOf(1000, 12.0, 900.0, 1.5, 0.0)},
                               {"dura", 100, 2.0, tissueOf(100, 3.0, 900.0, 0.5, 0.8)}};

// Layers below z = 0, in voxels of 0.25 mm; the plane z = 0 lies between two slices.
Volume layered(const std::vector<Layer>& layers) {
  constexpr double kSpacing_mm = 0.25;
  Volume volume;
  volume.geometry.size = {8, 8, 120};
  volume.geometry.spacing_mm = Vec3(kSpacing_mm);
  volume.geometry.origin_mm = {-1.0, -1.0, -24.875};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  double top_mm = 0.0;
  for (const Layer& layer : layers) {
    for (int k = 0; k < 120; ++k) {
      const double depth_mm = -(volume.geometry.origin_mm.z + kSpacing_mm * k);
      if (depth_mm < top_mm || depth_mm >= top_mm + layer.thick_mm) continue;
      std::fill_n(volume.hu.begin() + 64 * k, 64, layer.hu);
    }
    top_mm += layer.thick_mm;
  }
  return volume;
}

struct Puncture {
  std::vector<double> depth_mm, force_N;
};
// At 10 mm/s straight down; the force out of the body.
Puncture puncture(const std::vector<Layer>& layers, double to_mm) {
  HapticParameters p = test::oneArm();
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::rupture};
  p.tissues = {};
  for (const Layer& layer : layers) p.tissues.classes[std::size_t(p.tissues.count++)] = layer.tissue;
  test::Bench bench(p, layered(layers));
  Puncture out;
  for (double depth_mm = -2.0; depth_mm <= to_mm; depth_mm += 0.01) {
    const ArmRecord& arm = bench.at({0, 0, -depth_mm});
    out.depth_mm.push_back(depth_mm);
    out.force_N.push_back(arm.demanded_N.z);
  }
  return out;
}

// The same by hand. A tip whose solid has a radius of 0.6 mm touches that much and half a voxel earlier, but
// only from air. In each layer: b v; friction, whose spring of the layer's k is stretched to F / k
// at most, and which goes on with its force into a stiffer layer, with its stretch into a softer
// one; from the entry of a
// capsule k times the way since, until that reaches the rupture force.
std::vector<double> byHand(const std::vector<Layer>& layers, const std::vector<double>& depths_mm) {
  constexpr double kSpeed_m_s = 0.01, kInset_mm = 0.6 + 0.125;
  std::vector<double> force;
  double anchor_mm = 0.0, stiffness = 0.0;
  int stretched = -1;
  double entry_mm = 0.0;
  std::uint32_t ruptured = 0;
  bool anchored = false;
  for (double depth_mm : depths_mm) {
    int now = -1;
    double top_mm = 0.0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const double from_mm = i == 0 ? top_mm - kInset_mm : top_mm;
      if (depth_mm >= from_mm && depth_mm < top_mm + layers[i].thick_mm) now = int(i);
      top_mm += layers[i].thick_mm;
    }
    if (now < 0) {
      force.push_back(0.0);
      continue;
    }
    const TissueClass& t = layers[std::size_t(now)].tissue;
    if (!anchored) anchor_mm = depth_mm;
    if (anchored && t.stiffness_N_per_m > stiffness) {
      anchor_mm = depth_mm - (depth_mm - anchor_mm) * stiffness / t.stiffness_N_per_m;
    }
    anchored = true;
    stiffness = t.stiffness_N_per_m;
    const double limit_mm = 1000.0 * t.friction_N / t.stiffness_N_per_m;
    anchor_mm = std::max(anchor_mm, depth_mm - limit_mm);
    double f = t.damping_Ns_per_m * kSpeed_m_s +
               t.stiffness_N_per_m * (depth_mm - anchor_mm) / 1000.0;
    if (stretched < 0 && t.rupture_N > 0.0 && !(ruptured >> now & 1u)) {
      stretched = now;
      entry_mm = depth_mm;
    }
    if (stretched >= 0) {
      const TissueClass& s = layers[std::size_t(stretched)].tissue;
      const double spring_N = s.stiffness_N_per_m * (depth_mm - entry_mm) / 1000.0;
      if (spring_N >= s.rupture_N) {
        ruptured |= 1u << stretched;
        stretched = -1;
      } else {
        f += spring_N;
      }
    }
    force.push_back(f);
  }
  return force;
}

void expectByHand(const std::vector<Layer>& layers, double to_mm) {
  const Puncture p = puncture(layers, to_mm);
  const std::vector<double> hand = byHand(layers, p.depth_mm);
  int apart = 0;
  for (std::size_t n = 0; n < hand.size(); ++n) {
    // A tick early or late at the edge of a layer moves the trace by one step of 0.01 mm.
    const bool same = std::abs(p.force_N[n] - hand[n]) <= 0.012;
    if (!same && ++apart <= 3) {
      ADD_FAILURE() << "at " << p.depth_mm[n] << " mm: " << p.force_N[n] << ", by hand " << hand[n];
    }
  }
  EXPECT_LE(apart, 0);
}

TEST(Puncture, OfSkinFatCapsuleAndLiverIsTheSumByHand) { expectByHand(kBelly, 16.0); }
TEST(Puncture, OfScalpBoneAndDuraIsTheSumByHand) { expectByHand(kHead, 11.8); }

// What a trainee feels: skin and capsule give way with a drop, and the layers differ.
TEST(Puncture, ShowsItsLayers) {
  const Puncture p = puncture(kBelly, 16.0);
  const auto mean = [&](double from_mm, double to_mm) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t n = 0; n < p.depth_mm.size(); ++n) {
      if (p.depth_mm[n] < from_mm || p.depth_mm[n] >= to_mm) continue;
      sum += p.force_N[n];
      ++count;
    }
    return sum / count;
  };
  const auto drop = [&](double from_mm, double to_mm) {
    double largest = 0.0;
    for (std::size_t n = 1; n < p.depth_mm.size(); ++n) {
      if (p.depth_mm[n] < from_mm || p.depth_mm[n] >= to_mm) continue;
      largest = std::max(largest, p.force_N[n - 1] - p.force_N[n]);
    }
    return largest;
  };
  EXPECT_EQ(mean(-2.0, -0.8), 0.0);
  EXPECT_GT(drop(0.0, 3.0), 0.55) << "the skin";
  EXPECT_GT(drop(8.0, 9.5), 0.65) << "the capsule";
  EXPECT_LT(drop(10.0, 16.0), 0.02) << "the liver has no capsule inside";
  EXPECT_GT(mean(1.5, 2.9), 2.0 * mean(4.5, 7.9)) << "skin against fat";
  EXPECT_GT(mean(12.0, 16.0), 2.0 * mean(4.5, 7.9)) << "liver against fat";
}

}  // namespace
}  // namespace trephine
