#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "volume/phantom.h"

namespace trephine {
namespace {

using T = PhantomTissue;

PhantomTruth truthOf(const std::string& name) {
  return phantomTruth(name).value();
}

// Made once: several tests look at the same volume.
const Volume& phantom(const std::string& name) {
  static std::map<std::string, Volume> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  return made.emplace(name, makePhantom(name).value()).first->second;
}

// A straight path through the truth as (tissue, length in mm) pieces.
struct Layer {
  T tissue;
  double thickness_mm;
};
std::vector<Layer> layersAlong(PhantomTruth truth, Vec3 at, const Vec3& direction,
                               double length_mm) {
  constexpr double kStep = 0.02;
  std::vector<Layer> layers;
  for (double s = 0; s < length_mm; s += kStep) {
    const T tissue = truth(at + direction * s);
    if (layers.empty() || layers.back().tissue != tissue) layers.push_back({tissue, 0.0});
    layers.back().thickness_mm += kStep;
  }
  return layers;
}

// Where a ray from outside first meets `tissue`.
Vec3 surfacePoint(PhantomTruth truth, T tissue, const Vec3& from, const Vec3& direction) {
  double s = 0.0;
  while (s < 300.0 && truth(from + direction * s) != tissue) s += 0.5;
  double low = s - 0.5, high = s;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (truth(from + direction * middle) == tissue ? high : low) = middle;
  }
  return from + direction * high;
}

// The outward normal of the head's surface, from three rays beside each other.
Vec3 surfaceNormal(PhantomTruth truth, const Vec3& from, const Vec3& direction) {
  const Vec3 u = glm::normalize(glm::cross(direction, Vec3(0.3, 0.5, 0.8)));
  const Vec3 v = glm::cross(direction, u);
  const auto at = [&](double a, double b) {
    return surfacePoint(truth, T::scalp, from + u * a + v * b, direction);
  };
  const Vec3 normal = glm::normalize(glm::cross(at(2, 0) - at(-2, 0), at(0, 2) - at(0, -2)));
  return glm::dot(normal, direction) < 0 ? normal : -normal;
}

TEST(Phantom, GeometryIsAsTheCasesAreDescribed) {
  const GridGeometry head = phantomGeometry("cranium").value();
  EXPECT_EQ(head.size, (Index3{256, 256, 180}));
  EXPECT_EQ(head.spacing_mm, Vec3(0.8, 0.8, 1.0));
  EXPECT_EQ(head.direction, Mat3(1.0));
  EXPECT_LT(glm::length(head.centre_mm()), 1e-9);
  const GridGeometry belly = phantomGeometry("abdomen").value();
  EXPECT_EQ(belly.size, (Index3{256, 256, 160}));
  EXPECT_EQ(belly.spacing_mm, Vec3(1.4, 1.4, 1.5));
}

TEST(Phantom, AnUnknownNameIsRefusedByName) {
  EXPECT_EQ(phantomTruth("knee").error().code, "UNKNOWN_PHANTOM");
  EXPECT_EQ(phantomGeometry("").error().code, "UNKNOWN_PHANTOM");
  const auto made = makePhantom("knee");
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("knee"), std::string::npos);
}

TEST(Phantom, NamesAreTheirOwnAndHuAreWithinAScanners) {
  std::set<std::string> names;
  for (int t = 0; t <= int(T::spleen); ++t) {
    EXPECT_TRUE(names.insert(phantomTissueName(T(t))).second);
    EXPECT_GE(phantomHu(T(t)), -1000);
    EXPECT_LE(phantomHu(T(t)), 3000);
  }
  // What a trainee cuts can be told apart by HU alone, three noise deviations each side.
  const T apart[] = {T::fat, T::scalp, T::greyMatter, T::capsule, T::vessel, T::marrow, T::diploe};
  for (std::size_t i = 1; i < std::size(apart); ++i) {
    EXPECT_GT(phantomHu(apart[i]) - phantomHu(apart[i - 1]), 6 * kPhantomNoiseHu);
  }
}

TEST(Cranium, LayersOfTheVaultAreAsThickAsStatedAlongTheNormal) {
  const PhantomTruth truth = truthOf("cranium");
  const Vec3 centre(0, 4, 20);
  const Vec3 ways[] = {{0.05, 0.1, -1},  {0.5, 0.2, -1},  {-0.6, 0.1, -0.8}, {-1, 0.1, -0.1},
                       {1, 0.05, -0.2},  {0.2, -1, -0.5}, {-0.2, 1, -0.3},   {0.7, 0.7, -0.6},
                       {-0.6, -0.7, -1}, {0.3, 1, -0.05}};
  for (const Vec3& way : ways) {
    const Vec3 inward = glm::normalize(way);
    const Vec3 from = centre - inward * 140.0;
    const Vec3 surface = surfacePoint(truth, T::scalp, from, inward);
    const Vec3 normal = surfaceNormal(truth, from, inward);
    const auto layers = layersAlong(truth, surface + normal * 0.5, -normal, 16.0);
    const std::vector<Layer> expected = {{T::scalp, 5.0},  {T::outerTable, 2.0},
                                         {T::diploe, 3.0}, {T::innerTable, 1.5},
                                         {T::dura, 0.5},   {T::csf, 2.0}};
    ASSERT_GE(layers.size(), expected.size() + 1) << way.x << " " << way.y << " " << way.z;
    EXPECT_EQ(layers[0].tissue, T::air);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(layers[i + 1].tissue, expected[i].tissue) << i;
      if (expected[i].tissue == T::csf) {
        EXPECT_GE(layers[i + 1].thickness_mm, 1.7) << "deeper over a sulcus";
      } else {
        EXPECT_NEAR(layers[i + 1].thickness_mm, expected[i].thickness_mm, 0.3)
            << phantomTissueName(expected[i].tissue);
      }
    }
  }
}

TEST(Cranium, TheVaultIsAClosedShellWithAirAllAround) {
  const PhantomTruth truth = truthOf("cranium");
  // Every ray upwards or sideways out of the brain crosses inner table, diploe, outer table, scalp.
  for (int a = 0; a < 40; ++a) {
    for (int b = 0; b <= 10; ++b) {
      const double angle = a * 0.157079632679;
      const Vec3 out = glm::normalize(Vec3(std::cos(angle), std::sin(angle), 0.04 + b * 0.25));
      std::vector<T> shell;
      for (const Layer& layer : layersAlong(truth, Vec3(0, 4, 10), out, 140.0)) {
        const T t = layer.tissue;
        if (t == T::innerTable || t == T::diploe || t == T::outerTable || t == T::scalp ||
            t == T::air) {
          shell.push_back(t);
        }
      }
      EXPECT_EQ(shell, (std::vector<T>{T::innerTable, T::diploe, T::outerTable, T::scalp, T::air}))
          << a << " " << b;
    }
  }
  const GridGeometry g = phantomGeometry("cranium").value();
  for (int j = 0; j < g.size[1]; ++j) {
    for (int i = 0; i < g.size[0]; ++i) {
      for (int k = g.size[2] - 8; k < g.size[2]; ++k) {
        ASSERT_EQ(truth(g.toPatient_mm({i, j, k})), T::air) << "room for the tool above the head";
      }
    }
    for (int k = 90; k < g.size[2]; ++k) {
      ASSERT_EQ(truth(g.toPatient_mm({0, j, k})), T::air);
      ASSERT_EQ(truth(g.toPatient_mm({g.size[0] - 1, j, k})), T::air);
    }
  }
}

TEST(Cranium, HasWhatAHeadHas) {
  const PhantomTruth truth = truthOf("cranium");
  EXPECT_EQ(truth({31, -67, -28}), T::eye);
  EXPECT_EQ(truth({-31, -67, -28}), T::eye);
  EXPECT_EQ(truth({27, -56, -57}), T::air) << "maxillary sinus";
  EXPECT_EQ(truth({8, -18, -36}), T::air) << "sphenoid sinus";
  EXPECT_EQ(truth({10, 0, 21}), T::ventricle);
  EXPECT_EQ(truth({0, 29, -70}), T::whiteMatter) << "cord";
  EXPECT_EQ(truth({0, 10, -66}), T::marrow) << "vertebra";
  EXPECT_EQ(truth({12, 8, 7}), T::greyMatter) << "thalamus";
  std::map<T, double> ml;
  const Volume& v = phantom("cranium");
  const GridGeometry& g = v.geometry;
  for (int k = 0; k < g.size[2]; k += 2) {
    for (int j = 0; j < g.size[1]; j += 2) {
      for (int i = 0; i < g.size[0]; i += 2) {
        ml[truth(g.toPatient_mm({i, j, k}))] += 8 * g.voxelVolume_mm3() / 1000.0;
      }
    }
  }
  // Grey and white together 950 to 1500 ml, each a good part of it.
  const double brain = ml[T::greyMatter] + ml[T::whiteMatter];
  EXPECT_GT(brain, 950);
  EXPECT_LT(brain, 1500);
  EXPECT_GT(ml[T::greyMatter], 0.3 * brain);
  EXPECT_GT(ml[T::whiteMatter], 0.25 * brain);
  EXPECT_GT(ml[T::facialBone], 60);
}

TEST(Cranium, NoAirTouchesTheBrainsSpace) {
  const PhantomTruth truth = truthOf("cranium");
  const auto intracranial = [](T t) { return t == T::dura || t == T::csf || t == T::greyMatter; };
  for (double z = -60; z < 80; z += 1.3) {
    for (double y = -90; y < 95; y += 1.3) {
      for (double x = -75; x < 75; x += 1.3) {
        if (!intracranial(truth({x, y, z}))) continue;
        for (const Vec3& step : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
          ASSERT_NE(truth(Vec3(x, y, z) + step), T::air) << x << " " << y << " " << z;
          ASSERT_NE(truth(Vec3(x, y, z) - step), T::air) << x << " " << y << " " << z;
        }
      }
    }
  }
}

TEST(Abdomen, TheLiverLiesUnderTheRightRibsInItsCapsule) {
  const PhantomTruth truth = truthOf("abdomen");
  const GridGeometry g = phantomGeometry("abdomen").value();
  double liver_ml = 0, vessel_ml = 0;
  Vec3 centre(0.0);
  for (int k = 0; k < g.size[2]; k += 2) {
    for (int j = 0; j < g.size[1]; j += 2) {
      for (int i = 0; i < g.size[0]; i += 2) {
        const Vec3 p = g.toPatient_mm({i, j, k});
        const T t = truth(p);
        if (t != T::liver) continue;
        const double ml = 8 * g.voxelVolume_mm3() / 1000.0;
        liver_ml += ml;
        centre += p * ml;
        for (const Vec3& step : {Vec3(0.45, 0, 0), Vec3(0, 0.45, 0), Vec3(0, 0, 0.45)}) {
          for (double sign : {-1.0, 1.0}) {
            const T next = truth(p + step * sign);
            ASSERT_TRUE(next == T::liver || next == T::capsule || next == T::vessel)
                << phantomTissueName(next) << " touches liver";
            vessel_ml += next == T::vessel ? ml / 6 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(liver_ml, 1000);
  EXPECT_LT(liver_ml, 2000);
  EXPECT_GT(vessel_ml, 1);
  centre /= liver_ml;
  EXPECT_LT(centre.x, -30) << "on the patient's right";
  EXPECT_GT(centre.z, 0);
  // From the right, level with the liver: skin, fat, a wall with bone in some places, liver.
  bool rib = false, gap = false;
  for (double z = -20; z < 60; z += 1) {
    const auto layers = layersAlong(truth, {-170, -10, z}, {1, 0, 0}, 100);
    std::set<T> seen;
    for (const Layer& layer : layers) seen.insert(layer.tissue);
    EXPECT_TRUE(seen.count(T::skin) && seen.count(T::fat) && seen.count(T::muscle)) << z;
    rib = rib || seen.count(T::bone);
    gap = gap || !seen.count(T::bone);
  }
  EXPECT_TRUE(rib && gap);
}

TEST(Abdomen, TheCapsuleIsAMillimetreThick) {
  const PhantomTruth truth = truthOf("abdomen");
  // From inside the right lobe outwards, where the surface is met squarely.
  for (const Vec3& way : {Vec3(-0.5, -1, 0), Vec3(-0.3, -1, 0.15), Vec3(-0.2, 0.1, 1)}) {
    double thickness = 0;
    for (const Layer& layer : layersAlong(truth, {-85, -10, 30}, glm::normalize(way), 110)) {
      if (layer.tissue == T::capsule) thickness += layer.thickness_mm;
    }
    EXPECT_GT(thickness, 0.85);
    EXPECT_LT(thickness, 1.7) << "a ray that is not square to it";
  }
}

TEST(Abdomen, HasWhatAnAbdomenHas) {
  const PhantomTruth truth = truthOf("abdomen");
  EXPECT_EQ(truth({78, 46, -40}), T::kidney);
  EXPECT_EQ(truth({-78, 46, -40}), T::kidney);
  EXPECT_EQ(truth({0, 47, -6}), T::marrow) << "vertebral body";
  EXPECT_EQ(truth({0, 47, 11}), T::muscle) << "disc";
  EXPECT_EQ(truth({0, 74, 0}), T::whiteMatter) << "cord";
  EXPECT_EQ(truth({9, 21, 0}), T::vessel) << "aorta";
  EXPECT_EQ(truth({-34, 8, 8}), T::vessel) << "portal vein";
  EXPECT_EQ(truth({0, -150, 0}), T::air);
}

TEST(Phantom, PixelsFollowTheTruthWithTheStatedNoise) {
  for (const char* name : {"cranium", "abdomen"}) {
    const Volume& volume = phantom(name);
    const PhantomTruth truth = truthOf(name);
    const GridGeometry& g = volume.geometry;
    std::map<T, std::array<double, 3>> sums;  // count, sum, sum of squares
    for (int k = 2; k < g.size[2] - 2; k += 5) {
      for (int j = 2; j < g.size[1] - 2; j += 4) {
        for (int i = 2; i < g.size[0] - 2; i += 4) {
          const T t = truth(g.toPatient_mm({i, j, k}));
          bool inner = true;
          for (int n = 0; n < 8 && inner; ++n) {
            const Vec3 corner(n & 1 ? 0.5 : -0.5, n & 2 ? 0.5 : -0.5, n & 4 ? 0.5 : -0.5);
            inner = truth(g.toPatient_mm(Vec3(i, j, k) + corner)) == t;
          }
          for (int axis = 0; axis < 3 && inner; ++axis) {
            for (double side : {-1.0, 1.0}) {
              Vec3 next(i, j, k);
              next[axis] += side;
              inner = inner && truth(g.toPatient_mm(next)) == t;
            }
          }
          if (!inner) continue;
          const double off = volume.at(i, j, k) - phantomHu(t);
          ASSERT_LT(std::abs(off), 6 * kPhantomNoiseHu) << phantomTissueName(t);
          auto& s = sums[t];
          s[0] += 1;
          s[1] += off;
          s[2] += off * off;
        }
      }
    }
    for (const auto& [tissue, s] : sums) {
      if (s[0] < 3000) continue;
      // Air is cut off at -1024, three deviations below.
      EXPECT_NEAR(s[1] / s[0], 0.0, 0.5) << phantomTissueName(tissue);
      EXPECT_NEAR(std::sqrt(s[2] / s[0]), kPhantomNoiseHu, 0.4) << phantomTissueName(tissue);
    }
    EXPECT_GE(sums.size(), 8u);
  }
}

TEST(Phantom, EdgesArePartialVolumes) {
  // A plane at x = 0.3 between air and bone, on a grid of 1 mm: the voxel over it holds 80 % bone.
  const PhantomTruth plane = [](const Vec3& p) { return p.x > 0.3 ? T::bone : T::air; };
  GridGeometry g;
  g.size = {7, 3, 3};
  g.origin_mm = {-3, 0, 0};
  const Volume volume = makePhantomOn(plane, g, 0.0);
  EXPECT_EQ(volume.at(2, 1, 1), -1000);
  EXPECT_EQ(volume.at(4, 1, 1), 900);
  const double share = (volume.at(3, 1, 1) + 1000) / 1900.0;
  EXPECT_NEAR(share, 0.2, 0.17) << "three samples across a voxel";
  EXPECT_GT(share, 0.0);
}

TEST(Phantom, IsTheSameEveryTime) {
  // One hash a phantom: a change of truth, noise or arithmetic must be meant, and shows here.
  EXPECT_EQ(volumeSha256(phantom("cranium")),
            "afc51610d1785978181d9483b275cff0ec6ef4d66b7d77d3d7466bdf19fa27f9");
  EXPECT_EQ(volumeSha256(phantom("abdomen")),
            "57fa00bb85f06d9eeb82f094416b43e5718a046dfe64b5828528d67a043790b6");
}

TEST(Phantom, ReportsProgressAndCanBeCancelled) {
  double last = -1.0;
  int reports = 0;
  Progress* self = nullptr;
  Progress progress([&](double fraction, const std::string& step) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    EXPECT_FALSE(step.empty());
    last = fraction;
    if (++reports == 20) self->cancel();
  });
  self = &progress;
  const auto made = makePhantom("abdomen", progress);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, "CANCELLED");
  EXPECT_EQ(reports, 20) << "no work goes on after it";
}

TEST(Phantom, TheSameTruthOnACoarserObliqueGridAgrees) {
  const PhantomTruth truth = truthOf("cranium");
  GridGeometry g;
  g.size = {24, 24, 24};
  g.spacing_mm = Vec3(7.0);
  g.direction = glm::mat3_cast(glm::angleAxis(0.4, glm::normalize(Vec3(1, 2, 3))));
  g.origin_mm = -(g.direction * Vec3(80.0));
  const Volume volume = makePhantomOn(truth, g, 0.0);
  int bone = 0;
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 24; ++i) {
        bone += volume.at(i, j, k) > 300;
        const bool air = truth(g.toPatient_mm({i, j, k})) == T::air;
        EXPECT_TRUE(!air || volume.at(i, j, k) < 1000);
      }
    }
  }
  EXPECT_GT(bone, 300);
}

}  // namespace
}  // namespace trephine
