#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "volume/phantom_file.h"

namespace trephine {
namespace {

using T = PhantomTissue;

PhantomTruth truthOf(const std::string& name) {
  return phantomTruth(name).value();
}

// Opened once: several tests look at the same volume.
const Phantom& whole(const std::string& name) {
  static std::map<std::string, Phantom> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  return made.emplace(name, openPhantom(name).value()).first->second;
}
const Volume& phantom(const std::string& name) {
  return whole(name).volume;
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
  EXPECT_LT(glm::length(head.centre_mm() - Vec3(0, 0, -5)), 1e-9) << "down to the chin";
  const GridGeometry belly = phantomGeometry("abdomen").value();
  EXPECT_EQ(belly.size, (Index3{256, 256, 160}));
  EXPECT_EQ(belly.spacing_mm, Vec3(1.4, 1.4, 1.5));
}

TEST(Phantom, AnUnknownNameIsRefusedByName) {
  EXPECT_EQ(phantomTruth("knee").error().code.str(), "UNKNOWN_PHANTOM");
  EXPECT_EQ(phantomGeometry("").error().code.str(), "UNKNOWN_PHANTOM");
  const auto made = openPhantom("knee");
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
      for (int k = g.size[2] - 3; k < g.size[2]; ++k) {
        ASSERT_EQ(truth(g.toPatient_mm({i, j, k})), T::air)
            << "nothing of the head is cut off above";
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
          // Within what the point spread reaches, there is nothing else.
          bool inner = true;
          for (int n = 0; n < 27 && inner; ++n) {
            const Vec3 way(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            for (double mm : {0.8, 1.6, 2.4}) {
              inner = inner && truth(g.toPatient_mm({i, j, k}) + way * mm) == t;
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

// The share of what lies beyond a boundary at so many mm, through a Gaussian of `spread_mm`.
double shareBeyond(double beyond_mm, double spread_mm) {
  return 0.5 * (1.0 + std::erf(beyond_mm / (spread_mm * std::sqrt(2.0))));
}

// Planes between air and bone, 1900 HU, at turned ways and places across a voxel.
double worstEdgeError(const Vec3& spacing_mm, const Vec3& spread_mm) {
  static Vec3 way;
  static double at_mm;
  const PhantomTruth plane = [](const Vec3& p) {
    return glm::dot(p, way) > at_mm ? T::bone : T::air;
  };
  GridGeometry g;
  g.size = {15, 15, 15};
  g.spacing_mm = spacing_mm;
  g.origin_mm = -7.0 * spacing_mm;
  double worst = 0.0;
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 0.2, 0.1), Vec3(1, 1, 0),
                                Vec3(-1, 1, 1), Vec3(0.3, -0.5, 1)}) {
    for (double offset : {-0.41, -0.1, 0.0, 0.17, 0.33}) {
      way = glm::normalize(direction);
      at_mm = offset;
      const double spread = glm::length(way * spread_mm);
      const Volume volume = makePhantomOn(plane, g, 0.0);
      for (int k = 5; k < 10; ++k) {
        for (int j = 5; j < 10; ++j) {
          for (int i = 5; i < 10; ++i) {
            const double beyond = glm::dot(g.toPatient_mm({i, j, k}), way) - offset;
            const double expected = -1000.0 + 1900.0 * shareBeyond(beyond, spread);
            worst = std::max(worst, std::abs(volume.at(i, j, k) - expected));
          }
        }
      }
    }
  }
  return worst;
}

TEST(Phantom, EdgesAreThoseOfAGaussianPointSpread) {
  EXPECT_LT(worstEdgeError({0.8, 0.8, 1.0}, Vec3(0.6)), 16.0) << "a hundredth of the step";
  EXPECT_LT(worstEdgeError({1.4, 1.4, 1.5}, Vec3(0.6)), 24.0);
  EXPECT_LT(worstEdgeError({0.5, 0.5, 0.5}, Vec3(0.6)), 10.0);
  // Thick slices are as wide as they are far apart.
  EXPECT_LT(worstEdgeError({1.0, 1.0, 5.0}, {0.6, 0.6, 2.0}), 45.0);
}

TEST(Phantom, AThinSheetKeepsItsShareOfAVoxel) {
  const PhantomTruth sheet = [](const Vec3& p) {
    return std::abs(p.z - 0.1) < 0.5 ? T::bone : T::air;
  };
  GridGeometry g;
  g.size = {9, 9, 9};
  g.origin_mm = Vec3(-4.0);
  const Volume volume = makePhantomOn(sheet, g, 0.0);
  double sum = 0.0;
  for (int k = 0; k < 9; ++k) sum += volume.at(4, 4, k) + 1000;
  EXPECT_NEAR(sum, 1900.0, 40.0) << "a millimetre of bone, wherever it lies";
}

TEST(Abdomen, LabelsAreTheTruthAtTheVoxelsCentresButForTheClosedCapsule) {
  const Phantom& made = whole("abdomen");
  ASSERT_TRUE(made.labels);
  EXPECT_EQ(made.labels->geometry.size, made.volume.geometry.size);
  const PhantomTruth truth = truthOf("abdomen");
  const GridGeometry& g = made.volume.geometry;
  const auto labelAt = [&](int i, int j, int k) { return made.labels->labels[g.indexOf(i, j, k)]; };
  const std::uint8_t liver = phantomLabel(T::liver), capsule = phantomLabel(T::capsule),
                     vessel = phantomLabel(T::vessel);
  EXPECT_EQ((std::set{liver, capsule, vessel}), (std::set<std::uint8_t>{1, 2, 3}));
  int closed = 0, of_liver = 0;
  for (int k = 1; k + 1 < g.size[2]; ++k) {
    for (int j = 1; j + 1 < g.size[1]; ++j) {
      for (int i = 1; i + 1 < g.size[0]; ++i) {
        const std::uint8_t label = labelAt(i, j, k);
        const T t = truth(g.toPatient_mm({i, j, k}));
        if (label != phantomLabel(t)) {
          ASSERT_EQ(t, T::liver);
          ASSERT_EQ(label, capsule);
          ++closed;
        }
        if (label != liver) continue;
        ++of_liver;
        // No way past it, not across a corner either.
        for (int n = 0; n < 27; ++n) {
          const auto next = labelAt(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1);
          ASSERT_TRUE(next == liver || next == capsule || next == vessel)
              << i << " " << j << " " << k;
        }
      }
    }
  }
  EXPECT_GT(closed, 1000);
  EXPECT_GT(of_liver, 10 * closed);
}

TEST(Abdomen, LabelsOnAnotherGridAreTheSameWhereTheVoxelsAre) {
  const Phantom& made = whole("abdomen");
  EXPECT_EQ(phantomLabelsOn(truthOf("abdomen"), made.volume.geometry).labels, made.labels->labels);
}

TEST(Cranium, HasTheBonesThatTellASkull) {
  const PhantomTruth truth = truthOf("cranium");
  const auto bone = [&](const Vec3& p) { return truth(p) == T::facialBone; };
  const auto boneAlong = [&](Vec3 from, const Vec3& to) {
    const Vec3 step = (to - from) / 200.0;
    bool met = false;
    for (int n = 0; n <= 200; ++n) met = met || bone(from + step * double(n));
    return met;
  };
  for (double side : {-1.0, 1.0}) {
    // The cheek's arch stands free: bone, muscle within it, then the braincase.
    EXPECT_TRUE(boneAlong({side * 70, -20, -43.5}, {side * 58, -20, -43.5})) << side;
    EXPECT_FALSE(bone({side * 55, -20, -42})) << side;
    EXPECT_EQ(truth({side * 31, -67, -28}), T::eye);
    EXPECT_TRUE(boneAlong({side * 31, -80, -4}, {side * 31, -60, -4})) << "brow";
    EXPECT_TRUE(boneAlong({side * 56, -55, -30}, {side * 46, -55, -30})) << "rim at the side";
    EXPECT_TRUE(bone({side * 54, 24, -50})) << "mastoid";
    EXPECT_TRUE(boneAlong({side * 56, -10, -66}, {side * 40, -10, -66})) << "jaw: ramus";
    EXPECT_EQ(truth({side * 72, 11, -35.5}), T::air) << "the ear's canal";
  }
  EXPECT_TRUE(boneAlong({0, -86, -90}, {0, -60, -90})) << "chin";
  EXPECT_EQ(truth({4, -70, -50}), T::air) << "nose";
  // All of it is covered.
  const GridGeometry g = phantomGeometry("cranium").value();
  for (int k = 4; k + 1 < g.size[2]; k += 3) {
    for (int j = 1; j + 1 < g.size[1]; j += 2) {
      for (int i = 1; i + 1 < g.size[0]; i += 2) {
        const Vec3 p = g.toPatient_mm({i, j, k});
        const bool nostrils = std::abs(p.x) < 14.0 && p.z > -70.0 && p.z < -44.0;
        if (!bone(p) || p.y > -76.0 || nostrils) continue;
        ASSERT_NE(truth(p + Vec3(0, -1.5, 0)), T::air) << p.x << " " << p.y << " " << p.z;
      }
    }
  }
}

TEST(Cranium, NoBoneIsSeenThroughTheNostrils) {
  const PhantomTruth truth = truthOf("cranium");
  // From the front and from below the nose, into both.
  for (const Vec3& way : {Vec3(0, 1, 0), Vec3(0, 1, 0.4), Vec3(0, 0.7, 0.7)}) {
    for (double x = -10.0; x <= 10.0; x += 0.5) {
      for (double z = -68.0; z <= -50.0; z += 0.5) {
        Vec3 p = Vec3(x, -88.0, z) - way * 30.0;
        const Vec3 step = glm::normalize(way) * 0.2;
        for (int air = 0; truth(p += step) == T::air && air < 400;) ++air;
        // Less soft tissue than this is an edge of HU that rise from air to bone.
        for (int n = 0; n < 17; ++n) {
          ASSERT_NE(truth(p += step), T::facialBone) << p.x << " " << p.y << " " << p.z;
        }
      }
    }
  }
}

TEST(Abdomen, VesselsReachTheKidneysWithoutAGap) {
  const PhantomTruth truth = truthOf("abdomen");
  for (double side : {-1.0, 1.0}) {
    const Vec3 way[] = {{10, 21, -28}, {34, 23, -34}, {55, 35, -37}, {60, 40, -30}};
    for (int n = 0; n < 3; ++n) {
      for (double t = 0.0; t <= 1.0; t += 0.05) {
        Vec3 p = glm::mix(way[n], way[n + 1], t);
        p.x *= side;
        EXPECT_EQ(truth(p), T::vessel) << p.x << " " << p.y << " " << p.z;
      }
    }
  }
}

TEST(Cranium, SoftTissueCoversTheBonesOfTheFaceAndLidsTheEyes) {
  const PhantomTruth truth = truthOf("cranium");
  // What lies in front of the first `tissue` on the way backwards, mm.
  const auto before = [&](T tissue, double x, double z) {
    double thick = 0.0;
    for (double y = -110.0; y < -50.0; y += 0.05) {
      const T t = truth({x, y, z});
      if (t == tissue) return thick;
      thick += t == T::air ? 0.0 : 0.05;
    }
    return 1e3;
  };
  struct Place {
    const char* name;
    double x, z;
  };
  for (const Place& at :
       {Place{"brow", 22, -4}, Place{"between the brows", 0, -8}, Place{"root of the nose", 0, -16},
        Place{"its bridge", 0, -26}, Place{"cheek bone", 45, -46}, Place{"chin", 0, -89}}) {
    const double thick = before(T::facialBone, at.x, at.z);
    EXPECT_GE(thick, 4.5) << at.name;
    EXPECT_LE(thick, 12.0) << at.name;
  }
  int seen = 0;
  for (double z = -38; z <= -18; z += 0.5) {
    for (double x = 20; x <= 42; x += 1.0) {
      const double thick = before(T::eye, x, z);
      if (thick > 100.0) continue;
      ++seen;
      ASSERT_GE(thick, 2.5) << x << " " << z;
    }
  }
  EXPECT_GT(seen, 400);
  // The closed lids meet in a furrow between two swellings.
  const auto surface = [&](double z) {
    double y = -110.0;
    while (truth({31, y, z}) == T::air) y += 0.05;
    return y;
  };
  EXPECT_GT(surface(-33.5), surface(-30.0) + 0.7);
  EXPECT_GT(surface(-33.5), 0.5 * (surface(-30.0) + surface(-37.0)) + 0.3);
}

TEST(Cranium, IsTheSameOnBothSidesButForItsFolds) {
  const PhantomTruth truth = truthOf("cranium");
  for (double z = -92; z < 80; z += 3.7) {
    for (double y = -98; y < 98; y += 3.1) {
      for (double x = 2; x < 80; x += 2.9) {
        const T left = truth({x, y, z}), right = truth({-x, y, z});
        for (T t : {T::facialBone, T::outerTable, T::diploe, T::innerTable, T::scalp, T::eye}) {
          ASSERT_EQ(left == t, right == t) << x << " " << y << " " << z;
        }
      }
    }
  }
}

TEST(Abdomen, TheLiverHasTwoLobesAndRisesToTheLeft) {
  const PhantomTruth truth = truthOf("abdomen");
  const auto lowest = [&](double x) {
    for (double z = -110; z < 110; z += 0.5) {
      for (double y = -90; y < 60; y += 2.0) {
        if (truth({x, y, z}) == T::liver) return z;
      }
    }
    return 1e3;
  };
  EXPECT_LT(lowest(-110), -30);
  EXPECT_LT(lowest(-110), lowest(-60));
  EXPECT_LT(lowest(-60), lowest(25));
  EXPECT_LT(lowest(25), lowest(60));
  // In front, the line between the lobes lies deeper than both.
  const auto front = [&](double x) {
    return surfacePoint(truth, T::capsule, {x, -130, 30}, {0, 1, 0}).y;
  };
  EXPECT_GT(front(-7.4), front(-20) + 0.5);
  EXPECT_GT(front(-7.4), front(5) + 0.5);
}

TEST(Phantom, IsTheSameEveryTime) {
  // One hash a phantom: a change of truth, noise or arithmetic must be meant, and shows here.
  EXPECT_EQ(volumeSha256(phantom("cranium")),
            "7cf66e7ed46592b8c6e1d38768c5363e1ed5e07ff564186429cf4dec371ad40e");
  EXPECT_EQ(volumeSha256(phantom("abdomen")),
            "7d810ff532357f6baa4183fb777344fc32c21cdcffad02b8d1a6b3512fa747f3");
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
