// The head: a closed vault of parallel layers over an ellipsoid (each of exact thickness along the
// normal), a skull base that steps down from front to back, a face, and a brain with folds.
// Sizes of an adult's; the scan ends below the upper jaw. Patient mm, LPS, origin at its middle.
#include "volume/phantom_shapes.h"

namespace trephine {

namespace {

using namespace shapes;
using T = PhantomTissue;

constexpr double kScalp = 5.0, kOuter = 2.0, kDiploe = 3.0, kInner = 1.5, kDura = 0.5, kCsf = 2.0;
constexpr double kSkull = kOuter + kDiploe + kInner;

// The outer surface of the outer table.
const Ellipsoid kVault({0, 4, 6}, {74, 82, 62}, {74, 87, 70});

// Height of the floor that the brain rests on: anterior, middle and posterior fossa, with sella,
// petrous ridges and the groove between the orbits.
double floorHeight(const Vec3& m) {
  // The lesser wings of the sphenoid curve forwards to the sides.
  double z = -8.0 - 24.0 * ramp(-36, -23, m.y + 0.22 * m.x) - 30.0 * ramp(8, 28, m.y);
  z += 10.0 * bump(m.x / 14) * bump((m.y + 8) / 13);
  z += 13.0 * bump((m.x - 36) / 26) * bump((m.y - 12 + 0.25 * m.x) / 12);
  z -= 6.0 * bump(m.x / 9) * bump((m.y + 56) / 16);
  return z;
}

// The soft envelope, negative inside; equals distance to the scalp's surface over the vault.
double envelope(const Vec3& m, double vault) {
  static const Ellipsoid face({0, -28, -48}, {61, 53, 62});
  static const Ellipsoid ear({69, 13, -32}, {8, 14, 27});
  static const Rod nose{{0, -77, -26}, {0, -87, -57}, 5, 8};
  static const Rod wing{{7, -81, -61}, {9, -78, -61}, 6, 5.5};
  static const Rod lips{{0, -77, -76}, {14, -72, -76}, 7, 3};
  static const Rod chin{{0, -62, -94}, {10, -60, -94}, 16, 14};
  const double scalp = vault - kScalp;
  if (m.z > 0.0) return scalp;
  double d = smoothUnion(scalp, face.roughDistance(m), 10);
  if (m.z < -5) {
    const double neck = std::max(ellipseDistance(m.x, m.y - 24, 54, 54), m.z + 18);
    d = smoothUnion(d, neck, 14);
  }
  if (m.y < -50) {
    d = smoothUnion(d, std::min(nose.distance(m), wing.distance(m)), 6);
    d = smoothUnion(d, std::min(lips.distance(m), chin.distance(m)), 6);
  }
  return m.x > 54 ? smoothUnion(d, ear.roughDistance(m), 3) : d;
}

// Sulci of the cerebrum: distance from the nearest, as if from wavy sheets 17 to 21 mm apart.
double toSulcus(const Vec3& p) {
  const double u = p.y + 6.0 * wave(p.x / 53 + 0.2) + 6.0 * wave(p.z / 47) + 3.0 * wave(p.x / 23);
  const double v = p.z + 0.6 * std::abs(p.x) + 7.0 * wave(p.y / 59 + 0.1) + 3.0 * wave(p.y / 25);
  return std::min(toNearest(u, 17.0), toNearest(v, 21.0) + 1.0);
}

bool inVentricle(const Vec3& m) {
  static const Rod parts[] = {{{8, -27, 12}, {11, 2, 22}, 4.5, 5.0},
                              {{11, 2, 22}, {20, 33, 16}, 5.0, 6.5},
                              {{20, 33, 16}, {19, 55, 9}, 5.5, 2.5},
                              {{20, 33, 16}, {32, 8, -13}, 5.0, 2.5}};
  static const Ellipsoid third({0, 3, 3}, {2.2, 13, 9});
  for (const Rod& part : parts) {
    if (part.contains(m)) return true;
  }
  return third.contains(m);
}

bool inDeepGrey(const Vec3& m) {
  static const Ellipsoid thalamus({12, 8, 7}, {8, 13, 8});
  static const Ellipsoid lentiform({25, -6, 6}, {6, 15, 9});
  static const Ellipsoid caudate({14, -22, 14}, {4, 9, 7});
  return thalamus.contains(m) || lentiform.contains(m) || caudate.contains(m);
}

T cerebellum(const Vec3& m, double depth) {
  static const Ellipsoid fourth({0, 31, -30}, {6, 5, 9});
  if (fourth.contains(m)) return T::ventricle;
  // Folia: thin leaves that follow the surface.
  const double leaf = toNearest(m.z + 0.35 * m.y + 1.5 * wave(m.y / 30), 6.0);
  if (depth < 5.0 && leaf < 0.5) return T::csf;
  return depth < 7.0 && leaf < 2.0 ? T::greyMatter : depth < 2.0 ? T::greyMatter : T::whiteMatter;
}

// `depth` below the inner face of the dura.
T insideDura(const Vec3& p, const Vec3& m, double depth) {
  static const Rod stem{{0, 11, -12}, {0, 28, -50}, 12, 7};
  static const Rod stemWater{{0, 11, -14}, {0, 28, -50}, 15, 11};
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

// Air spaces of the face; `wall` is set to how far the nearest sinus is.
bool inAirway(const Vec3& p, const Vec3& m, double& wall) {
  static const Ellipsoid maxillary({27, -56, -57}, {12, 15, 12});
  static const Ellipsoid frontal({10, -75, -13}, {8, 3.5, 8});
  static const Ellipsoid sphenoid({8, -18, -36}, {7, 10, 7});
  static const Ellipsoid nose({7, -52, -50}, {6.2, 32, 15});
  static const Rod nostril{{6, -84, -63}, {6, -70, -57}, 3.0, 4.0};
  static const Rod pharynx{{0, -20, -56}, {0, -13, -96}, 8, 8};
  static const Rod ear{{82, 10, -36}, {54, 12, -37}, 3, 2.5};
  wall =
      std::min({maxillary.roughDistance(m), frontal.roughDistance(m), sphenoid.roughDistance(m)});
  if (wall < 0.0) return true;
  if (ear.contains(m) || pharynx.contains(m) || nostril.contains(m)) return true;
  if (nose.contains(m)) {
    // Septum and turbinates stay.
    static const Rod inferior{{9, -72, -58}, {9, -30, -58}, 3, 3};
    static const Rod middle{{9, -62, -47}, {9, -30, -47}, 2.5, 2.5};
    return m.x > 1.0 && !inferior.contains(m) && !middle.contains(m);
  }
  // Ethmoid cells, thin walls between.
  const bool ethmoid = m.x < 12 && m.y > -68 && m.y < -34 && m.z > -38 && m.z < -19;
  if (ethmoid) {
    wall = 0.0;
    return toNearest(m.x, 5.8) > 0.6 && toNearest(p.y, 8.0) > 0.6 && toNearest(p.z, 7.0) > 0.6;
  }
  static const Ellipsoid mastoid({55, 27, -42}, {8, 11, 14});
  if (mastoid.contains(m)) {
    return wave(p.x / 6) + wave(p.y / 7) + wave(p.z / 6) > 0.4;
  }
  return false;
}

bool inFacialBone(const Vec3& m, double sinus_wall) {
  static const Ellipsoid brow({0, -72, -11}, {34, 8, 11});
  static const Ellipsoid mastoid({55, 27, -42}, {11, 14, 18});
  static const Ellipsoid chinless({0, -46, -74}, {29, 33, 40}), palate({0, -46, -74}, {20, 25, 40});
  static const Rod rods[] = {{{34, -68, -47}, {50, -57, -47}, 5, 8},    // zygoma
                             {{50, -57, -47}, {64, -26, -43}, 6, 3},    // zygomatic arch
                             {{64, -26, -43}, {61, 2, -37}, 3, 4},      //
                             {{49, -54, -22}, {50, -57, -47}, 4, 6},    // orbit's outer rim
                             {{2, -79, -24}, {4, -83, -42}, 2.2, 1.5},  // nasal bone
                             {{14, -70, -30}, {17, -70, -66}, 3, 4},    // maxilla's frontal process
                             {{50, -3, -42}, {47, -8, -95}, 6, 6},      // mandible: ramus
                             {{46, -20, -70}, {40, -36, -98}, 6, 8},    // and angle
                             {{47, -26, -46}, {47, -16, -72}, 3, 6},    // coronoid process
                             {{22, -14, -40}, {24, -22, -68}, 3, 2.5}};  // pterygoid plate
  if (sinus_wall < 1.6) return true;
  for (const Rod& rod : rods) {
    if (rod.contains(m)) return true;
  }
  if (brow.contains(m) || mastoid.contains(m)) return true;
  if (m.z < -65 && m.z > -69 && chinless.contains(m) && m.y < -25) return true;  // hard palate
  if (m.x < 0.8 && m.y > -74 && m.y < -22 && m.z > -66 && m.z < -36) return true;
  // Alveolar arch, then teeth with a gap between neighbours.
  if (m.z > -69 || m.y > -38 || !chinless.contains(m) || palate.contains(m)) return false;
  return m.z > -78 || (toNearest(m.x + 0.55 * m.y, 7.5) > 0.5 && m.z > -89);
}

// Orbits, eyes and what moves them. True when `tissue` is set.
bool inOrbit(const Vec3& m, T& tissue) {
  static const Rod orbit{{31, -72, -28}, {15, -30, -27}, 17, 5};
  static const Ellipsoid globe({31, -67, -28}, {12, 12, 12});
  static const Rod nerve{{29, -56, -28}, {13, -26, -26}, 2.2, 2.2};
  static const Rod muscles[] = {{{44, -64, -28}, {18, -32, -27}, 1.8, 1.5},
                                {{19, -64, -28}, {13, -32, -27}, 1.8, 1.5},
                                {{31, -63, -15}, {16, -32, -24}, 1.6, 1.5},
                                {{31, -63, -41}, {16, -32, -30}, 1.6, 1.5}};
  if (m.x > 52 || m.y > -24 || m.z > -8 || m.z < -48) return false;
  if (globe.contains(m)) {
    tissue = T::eye;
    return true;
  }
  const double d = orbit.distance(m);
  if (d > 1.8) return false;
  if (d > 0.0) {
    if (m.y < -74 && m.x < 44) return false;  // the opening
    tissue = T::facialBone;
    return true;
  }
  tissue = nerve.contains(m) ? T::whiteMatter : T::fat;
  for (const Rod& muscle : muscles) {
    if (muscle.contains(m)) tissue = T::muscle;
  }
  return true;
}

// Cord, canal and upper vertebrae, below the foramen magnum. True when `tissue` is set.
bool inSpine(const Vec3& m, T& tissue) {
  if (m.z > -38) return false;
  const double canal = std::sqrt(square(m.x) + square(m.y - 29)) - 11.0;
  if (canal < 0.0) {
    tissue = canal < -5.0 ? T::whiteMatter : canal < -0.5 ? T::csf : T::dura;
    return true;
  }
  if (m.z > -57) return false;
  const double level = m.z + 66;  // vertebrae 18 mm apart
  const double gap = 6.5 - toNearest(level, 18.0);
  const double body = std::max(ellipseDistance(m.x, m.y - 9, 13, 8.5), -gap);
  const double arch = std::max(canal - 4.5, 4.0 - toNearest(level + 9, 18.0));
  const double mass = std::max(ellipseDistance(m.x - 21, m.y - 22, 9, 8), -gap);
  const double spinous =
      std::max({m.x - 3.0, m.y - 60, 40 - m.y, 4.5 - toNearest(level + 9, 18.0)});
  const double d = std::min({body, arch, mass, spinous});
  if (d >= 0.0) return false;
  tissue = longBone(d, 1.5);
  return true;
}

// Skin, fat and muscle at `depth` below the surface of face and neck.
T softTissue(const Vec3& m, double depth) {
  if (depth < 2.5) return T::scalp;
  const double fat = 3.0 + 4.0 * bump((m.x - 40) / 22) * bump((m.y + 55) / 30);
  if (depth < 2.5 + fat) return T::fat;
  static const Ellipsoid cheek({38, -52, -66}, {9, 14, 12});
  if (cheek.contains(m)) return T::fat;
  // Thin sheets of fat part the muscles.
  const double sheet = depth + 3.0 * wave(m.x / 37 + m.z / 90) + 3.0 * wave(m.y / 43);
  return toNearest(sheet, 14.0) < 0.5 ? T::fat : T::muscle;
}

}  // namespace

PhantomTissue craniumTissue(const Vec3& p) {
  const Vec3 m = mirrored(p);
  if (m.x > 80.0) return T::air;
  const double level = kVault.level(p);
  if (level < 0.3) {  // at least 28 mm below the outer table
    const double height = m.z - floorHeight(m);
    if (height > 8.0) return insideDura(p, m, 20.0);
  }
  if (m.z > 0.0 && level > 1.3) return T::air;  // over 8 mm outside
  const double vault = level < 0.3 ? kVault.roughDistance(p) : kVault.distance(p);
  const double envelope_mm = envelope(m, vault);
  if (envelope_mm > 0.0) return T::air;

  const double height = m.z - floorHeight(m);
  constexpr double kFloorBone = 5.0;
  const bool foramen = m.z < -35 && square(m.x) + square(m.y - 28) < square(13.0);
  T tissue = T::muscle;
  if (m.z < 0.0) {
    double sinus_wall = 1e3;
    const bool intracranial = vault < -kSkull && height > 0.0;
    if (!intracranial) {
      if (foramen && vault < 0.0 && inSpine(m, tissue)) return tissue;
      const bool roofed = vault >= 0.0 || height < -2.0;  // bone stays between them and the dura
      if (roofed && inAirway(p, m, sinus_wall)) return T::air;
      if (roofed && inOrbit(m, tissue)) return tissue;
      if (inFacialBone(m, sinus_wall) && envelope_mm < -3.0) return T::facialBone;
      if (inSpine(m, tissue)) return tissue;
    }
  }
  if (vault < 0.0 && height > -kFloorBone) {
    const double inside = -vault;
    if (height < 0.0) return inside < kSkull ? T::outerTable : T::facialBone;
    if (inside < kOuter) return T::outerTable;
    if (inside < kOuter + kDiploe) return T::diploe;
    if (inside < kSkull) return T::innerTable;
    const double depth = std::min(inside - kSkull, 0.9 * height);
    return depth < kDura ? T::dura : insideDura(p, m, depth - kDura);
  }
  if (vault >= 0.0 && height > -kFloorBone && envelope_mm > -kScalp - 0.01) return T::scalp;
  return softTissue(m, -envelope_mm);
}

}  // namespace trephine
