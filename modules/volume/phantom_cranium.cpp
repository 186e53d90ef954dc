// The head: a closed vault of parallel layers over an ellipsoid (each of exact thickness along the
// normal), a skull base that steps down from front to back, a face (phantom_skull.cpp), and a brain
// with folds. Sizes of an adult's. Patient mm, LPS, origin in the middle of the brain.
#include "volume/phantom_skull.h"

namespace trephine {

namespace {

using namespace shapes;
using T = PhantomTissue;

constexpr double kScalp = 5.0, kOuter = 2.0, kDiploe = 3.0, kInner = 1.5, kDura = 0.5, kCsf = 2.0;
constexpr double kSkull = kOuter + kDiploe + kInner;
constexpr double kFloorBone = 5.0, kSinusWall = 1.4, kCover = 4.6;

// The outer surface of the outer table.
constexpr Ellipsoid kVault({0, 4, 6}, {74, 82, 62}, {74, 87, 70});

// Height of the floor that the brain rests on: anterior, middle and posterior fossa, with sella,
// petrous ridges and the groove between the orbits.
double floorHeight(const Vec3& m) {
  // The lesser wings of the sphenoid curve forwards to the sides.
  double z = -8.0 - 24.0 * ramp(-36, -23, m.y + 0.22 * m.x) - 30.0 * ramp(8, 28, m.y);
  z += 10.0 * bump(m.x / 14) * bump((m.y + 8) / 13);
  z += 13.0 * bump((m.x - 36) / 26) * bump((m.y - 12 + 0.25 * m.x) / 12);
  z -= 6.0 * bump(m.x / 9) * bump((m.y + 56) / 16);
  z += 15.0 * square(m.x / 64) * ramp(-50, -20, m.y);  // towards the temples
  return z;
}

// Sulci of the cerebrum: distance from the nearest, as if from wavy sheets 17 to 21 mm apart.
double toSulcus(const Vec3& p) {
  const double u = p.y + 6.0 * wave(p.x / 53 + 0.2) + 6.0 * wave(p.z / 47) + 3.0 * wave(p.x / 23);
  const double v = p.z + 0.6 * std::abs(p.x) + 7.0 * wave(p.y / 59 + 0.1) + 3.0 * wave(p.y / 25);
  return std::min(toNearest(u, 17.0), toNearest(v, 21.0) + 1.0);
}

bool inVentricle(const Vec3& m) {
  static constexpr Rod parts[] = {{{8, -27, 12}, {11, 2, 22}, 4.5, 5.0},
                                  {{11, 2, 22}, {20, 33, 16}, 5.0, 6.5},
                                  {{20, 33, 16}, {19, 55, 9}, 5.5, 2.5},
                                  {{20, 33, 16}, {32, 8, -13}, 5.0, 2.5}};
  static constexpr Ellipsoid third({0, 3, 3}, {2.2, 13, 9});
  for (const Rod& part : parts) {
    if (part.contains(m)) return true;
  }
  return third.contains(m);
}

bool inDeepGrey(const Vec3& m) {
  static constexpr Ellipsoid thalamus({12, 8, 7}, {8, 13, 8});
  static constexpr Ellipsoid lentiform({25, -6, 6}, {6, 15, 9});
  static constexpr Ellipsoid caudate({14, -22, 14}, {4, 9, 7});
  return thalamus.contains(m) || lentiform.contains(m) || caudate.contains(m);
}

T cerebellum(const Vec3& m, double depth) {
  static constexpr Ellipsoid fourth({0, 31, -30}, {6, 5, 9});
  if (fourth.contains(m)) return T::ventricle;
  // Folia: thin leaves that follow the surface.
  const double leaf = toNearest(m.z + 0.35 * m.y + 1.5 * wave(m.y / 30), 6.0);
  if (depth < 5.0 && leaf < 0.5) return T::csf;
  return depth < 7.0 && leaf < 2.0 ? T::greyMatter : depth < 2.0 ? T::greyMatter : T::whiteMatter;
}

// `depth` below the inner face of the dura.
T insideDura(const Vec3& p, const Vec3& m, double depth) {
  static constexpr Rod stem{{0, 11, -12}, {0, 28, -50}, 12, 7};
  static constexpr Rod stemWater{{0, 11, -14}, {0, 28, -50}, 15, 11};
  const double below = depth - kCsf;
  if (stem.contains(m)) return T::whiteMatter;
  if (m.z < -8 && stemWater.contains(m)) return T::csf;
  // The tentorium roofs the posterior fossa.
  const double roof = m.z - (-4.0 - 0.22 * m.x - 0.12 * (m.y - 30));
  if (m.y > 14 && roof < 2.0) {
    if (std::abs(roof) < 0.3) return T::dura;
    if (roof > -1.5 || below < 0.0 || m.y < 17) return T::csf;
    return cerebellum(m, std::min(below, -roof - 1.5));
  }
  if (below < 0.0) return T::csf;
  // The falx parts the hemispheres down to the corpus callosum.
  const double beyond_callosum = square((m.y - 4) / 46) + square((m.z - 4) / 26) - 1.0;
  const bool fissure = beyond_callosum > 0.0;
  if (fissure && m.x < 1.2) return m.x < 0.3 && beyond_callosum > 0.3 ? T::dura : T::csf;
  if (inVentricle(m)) return T::ventricle;
  if (inDeepGrey(m)) return T::greyMatter;
  const double surface = fissure ? std::min(below, m.x - 1.2) : below;
  const double sulcus = toSulcus(p);
  if (below < 13.0 && sulcus < 1.1 * (1.0 - below / 13.0)) return T::csf;
  const double ribbon = 3.0 + 0.5 * wave(p.x / 13) * wave(p.z / 11);
  if (surface < ribbon || (below < 15.0 && sulcus < ribbon + 0.7)) return T::greyMatter;
  return T::whiteMatter;
}

// Air in the bones of face and base; `wall` is how far a sinus is that is near.
bool inSinus(const Vec3& p, const Vec3& m, double& wall) {
  static constexpr Ellipsoid maxillary({25, -53, -53}, {11, 14, 9.5});
  static constexpr Ellipsoid frontal({10, -74, -6}, {7, 2.6, 6});
  static constexpr Ellipsoid sphenoid({8, -18, -36}, {7, 10, 7});
  wall = 1e3;
  for (const Ellipsoid* sinus : {&maxillary, &frontal, &sphenoid}) {
    if (!sinus->isBeyond(m, kSinusWall)) wall = std::min(wall, sinus->roughDistance(m));
  }
  if (wall < 0.0) return true;
  // Ethmoid cells, thin walls between.
  static constexpr Ellipsoid ethmoid({3, -50, -27.5}, {8.5, 16, 9});
  if (ethmoid.contains(m)) {
    wall = 0.0;
    return ethmoid.roughDistance(m) < -1.0 && toNearest(m.x, 5.8) > 0.6 &&
           toNearest(p.y, 8.0) > 0.6 && toNearest(p.z, 7.0) > 0.6;
  }
  static constexpr Ellipsoid mastoid({54, 25, -42}, {6.5, 9, 13});
  return mastoid.contains(m) && wave(m.x / 6) + wave(p.y / 7) + wave(p.z / 6) > 0.4;
}

// Eyes and what moves them. True when `tissue` is set.
bool inOrbit(const Vec3& m, T& tissue) {
  static constexpr Ellipsoid globe({31, -64.5, -28}, {12, 12, 12});
  static constexpr Rod nerve{{29, -56, -28}, {13, -26, -26}, 2.2, 2.2};
  static constexpr Rod muscles[] = {{{44, -62, -28}, {17, -32, -27}, 1.8, 1.5},
                                    {{19, -64, -28}, {13, -32, -27}, 1.8, 1.5},
                                    {{31, -62, -15}, {16, -32, -24}, 1.6, 1.5},
                                    {{31, -62, -41}, {16, -32, -30}, 1.6, 1.5}};
  if (m.x > 54 || m.y > -24 || m.y < -84 || m.z > -8 || m.z < -50) return false;
  if (globe.contains(m)) {
    tissue = T::eye;
    return true;
  }
  if (skull::orbit(m) > 0.0 || m.y < -66.0) return false;
  tissue = nerve.contains(m) ? T::whiteMatter : T::fat;
  for (const Rod& muscle : muscles) {
    if (muscle.contains(m)) tissue = T::muscle;
  }
  return true;
}

// Distance to the canal of the cord.
double canalDistance(const Vec3& m) {
  return std::sqrt(square(m.x) + square(m.y - 29)) - 11.0;
}

// What runs in the canal.
T inCanal(double canal) {
  return canal < -5.0 ? T::whiteMatter : canal < -0.5 ? T::csf : T::dura;
}

// Skin, fat and muscle at `depth` below the surface of face and neck.
T softTissue(const Vec3& m, double depth) {
  if (depth < 2.5) return T::scalp;
  const double fat = 3.0 + 4.0 * bump((m.x - 40) / 22) * bump((m.y + 55) / 30);
  if (depth < 2.5 + fat) return T::fat;
  static constexpr Ellipsoid cheek({40, -56, -68}, {9, 14, 12});
  if (cheek.contains(m)) return T::fat;
  // Thin sheets of fat part the muscles.
  const double sheet = depth + 3.0 * wave(m.x / 37 + m.z / 90) + 3.0 * wave(m.y / 43);
  return toNearest(sheet, 14.0) < 0.5 ? T::fat : T::muscle;
}

}  // namespace

PhantomTissue craniumTissue(const Vec3& p) {
  const Vec3 m = mirrored(p);
  if (m.x > 93.0) return T::air;
  const double level = kVault.level(p);
  // No floor is as high as 36 mm, and what lies 24 mm above it does not depend on it.
  const double height = m.z > 60.0 ? m.z - 36.0 : m.z - floorHeight(m);
  // At least 28 mm below the outer table.
  if (level < 0.3 && height > 8.0) return insideDura(p, m, 20.0);
  if (m.z > 14.0 && level > 1.4) return T::air;  // over 10 mm outside

  const bool far_below = level > 1.6 && m.z < 0.0;
  double vault = level < 0.3 || far_below ? kVault.roughDistance(p) : kVault.distance(p);
  if (level > 0.6 && level < 1.6) vault -= skull::relief(m);
  const double scalp = vault - kScalp;
  if (m.z > 16.0 && scalp > 0.0) return T::air;
  const double within = -vault - kSkull;  // of the inner table
  if (within > 0.0 && height > 0.0) {
    const double depth = std::min(within, 0.9 * height);
    return depth < kDura ? T::dura : insideDura(p, m, depth - kDura);
  }
  // The vault's own bone lies under its scalp, and nothing else reaches into it.
  const bool in_vault = vault < 0.0 && height >= -2.0;
  if (in_vault && m.z < -35.0) {
    const double canal = canalDistance(m);
    if (canal < 0.0) return inCanal(canal);
  }
  if (m.z < 16.0 && !in_vault) {
    double envelope = skull::skin(m, scalp);
    if (envelope > 12.0) return T::air;
    const double braincase = smoothIntersection(vault, -0.8 * (height + kFloorBone), 10.0);
    double bone = skull::bones(m, braincase);
    // Soft tissue covers all bone, five millimetres thick over the face.
    envelope = smoothUnion(envelope, bone - kCover, 0.1 + 5.0 * ramp(16, 0, m.z));
    if (envelope > 0.0) return T::air;
    T tissue = T::muscle;
    const double canal = canalDistance(m);
    if (m.z < -35.0 && canal < 0.0) return inCanal(canal);
    static constexpr Rod nostril{{5.5, -90, -62}, {4.8, -83, -53}, 2.7, 2.4};
    static constexpr Rod pharynx{{0, -20, -56}, {0, -12, -126}, 8, 8};
    double sinus_wall = 1e3;
    const bool airway = m.z < 2.0 && inSinus(p, m, sinus_wall);
    if (airway && bone < -0.0) return T::air;
    if (sinus_wall < kSinusWall && m.z < 2.0) bone = std::min(bone, sinus_wall - kSinusWall);
    if (m.z < -46.0 && m.y > -10.0 && m.y < 72.0 && m.x < 42.0) {
      const double vertebra = skull::vertebrae(m, canal);
      if (vertebra < 0.0 && bone > 0.0) return longBone(vertebra, 1.5);
    }
      const bool shell = vault < 0.0 && vault > -kSkull && height > 0.0;
      if (bone < 0.0 && envelope < -2.5 && !shell) return T::facialBone;
      if (bone >= 0.0) {
        if (skull::earCanal(m) < -0.8 && m.x > 52.0) return T::air;
        // Nostrils end blind, so that no bone is seen through them.
        if ((nostril.contains(m) && bone > kCover) || pharynx.contains(m)) return T::air;
        if (skull::nose(m) < -1.0 && m.y > -76.0 && m.y < -22.0) return T::air;
        if (inOrbit(m, tissue)) return tissue;
        return vault >= 0.0 && height > -kFloorBone && envelope > -kScalp
                   ? T::scalp
                   : softTissue(m, -envelope);
      }
  }
  const double groove = skull::suture(m);
  if (vault >= -groove) return T::scalp;
  if (vault > -kOuter || height < 0.0) return T::outerTable;
  return vault > -kOuter - kDiploe ? T::diploe : T::innerTable;
}

}  // namespace trephine
