// The upper abdomen, lying on the back: a wall of skin, fat and muscle with ribs in it, spine,
// liver with its capsule and vessels under the right ribs, kidneys, stomach, colon, lung bases
// above the diaphragm. Patient mm, LPS, origin at the volume's middle; the patient's right is -x.
#include <array>
#include <vector>

#include "volume/phantom_shapes.h"

namespace trephine {

namespace {

using namespace shapes;
using T = PhantomTissue;

constexpr double kSkin = 2.0, kMuscleWall = 13.0, kCapsule = 1.0;
constexpr double kDeep = 60.0;  // a depth that is past every wall

constexpr Ellipsoid kBody({0, 0, -10}, {160, 112, 560}, {160, 106, 520});

// Fat under the skin: thick in front, thin at the back.
double fatThickness(const Vec3& p) {
  return 13.0 - 0.06 * p.y;
}

// Height of the diaphragm's underside: a right dome over the liver, a lower left one.
double diaphragm(const Vec3& p) {
  const double right = square((p.x + 72) / 92) + square((p.y + 5) / 92);
  const double left = square((p.x - 76) / 84) + square((p.y - 5) / 88);
  const double middle = 66.0 - 40.0 * square(p.x / 60) - 30.0 * square((p.y + 5) / 95);
  const auto higher = [](double a, double b) { return -smoothUnion(-a, -b, 24.0); };
  return higher(higher(104.0 - 85.0 * right, middle), 92.0 - 85.0 * left);
}

// Distance, seen from in front, to a line of the chest wall from (ax, az) to (bx, bz).
double lineDistance(const Vec3& m, double ax, double az, double bx, double bz) {
  const double dx = bx - ax, dz = bz - az;
  const double t = std::clamp(((m.x - ax) * dx + (m.z - az) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
  return std::sqrt(square(m.x - ax - t * dx) + square(m.z - az - t * dz));
}

// Twelve pairs of ribs, one every 25 mm, sinking forwards; a rib is an ellipse of 13 x 8 mm in the
// wall, with a round end where its cartilage begins.
double ribDistance(const Vec3& m, double depth, double fat) {
  if (m.y > 86 || m.x < 14) return 1e3;
  const double forwards = std::clamp((80.0 - m.y) / 180.0, 0.0, 1.0);
  const double sunk = m.z + 105.0 * forwards * (1.35 - forwards) - 2.0;
  const double number = std::floor(sunk / 25.0 + 0.5);  // 0 is the twelfth rib
  if (number < 0) return 1e3;
  static constexpr double kEnds[] = {0.32, 0.54, 0.76, 0.82, 0.85, 0.87, 0.88, 0.89};
  const double end = kEnds[std::size_t(std::min(number, 7.0))];
  const double across = (sunk - 25.0 * number) / 1.25;
  const double d = ellipseDistance(across, depth - fat - 8.0, 6.0, 4.2);
  return smoothIntersection(smoothIntersection(d, 130.0 * (forwards - end), 7.0), 17.0 - m.x, 6.0);
}

// Breast bone and the cartilages that join the ribs to it; those of the seventh to tenth form the
// arch below which the belly is soft.
double cartilageDistance(const Vec3& m, double depth, double fat) {
  if (m.y > -40 || m.z < -12) return 1e3;
  struct Line {
    double ax, az, bx, bz;
  };
  static constexpr Line kLines[] = {{110, 8, 84, 26}, {84, 26, 58, 46},   {98, 33, 76, 38},
                                    {76, 38, 48, 54}, {58, 46, 34, 64},   {92, 58, 62, 58},
                                    {62, 58, 34, 64}, {34, 64, 14, 84},   {84, 86, 52, 78},
                                    {52, 78, 14, 90}, {80, 112, 46, 100}, {46, 100, 14, 110}};
  const double deep = square((depth - fat - 8.0) / 0.85);
  double d = 1e3;
  for (const Line& line : kLines) {
    const double aside = lineDistance(m, line.ax, line.az, line.bx, line.bz);
    d = smoothUnion(d, std::sqrt(aside * aside + deep) - 5.2, 4);
  }
  // The breast bone and its sword-shaped end.
  const double flat =
      std::sqrt(square(std::max(m.x - 12.0, 0.0)) + square(std::max(78.0 - m.z, 0.0)) + deep) - 5.5;
  const double aside = lineDistance(m, 0, 78, 0, 52);
  return smoothUnion(d, smoothUnion(flat, std::sqrt(aside * aside + deep) - 5.0, 8), 6);
}

// The wings of the hip bones: a crest, and a plate below it.
double hipDistance(const Vec3& m) {
  if (m.z > -84 || m.x < 30) return 1e3;
  static constexpr double kCrest[][3] = {{42, 78, -122}, {70, 70, -104},   {100, 50, -95},
                                         {122, 18, -97}, {126, -10, -110}, {118, -28, -128}};
  double d = 1e3;
  for (std::size_t n = 0; n + 1 < std::size(kCrest); ++n) {
    const auto& a = kCrest[n];
    const auto& b = kCrest[n + 1];
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double t =
        std::clamp(((m.x - a[0]) * dx + (m.y - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    const double above = std::max(m.z - (a[2] + t * (b[2] - a[2])), 0.0);
    const double down = std::min(m.z - (a[2] + t * (b[2] - a[2])), 0.0);
    const double thick = 4.0 + 3.0 * ramp(-16.0, 0.0, down);
    d = std::min(
        d, std::sqrt(square(m.x - a[0] - t * dx) + square(m.y - a[1] - t * dy) + above * above) -
               thick);
  }
  return d;
}

double spineDistance(const Vec3& m, double canal) {
  const double level = m.z + 6.0;  // vertebrae 34 mm apart, discs of 8 mm between
  const double number = std::floor(level / 34.0 + 0.5);
  const double high = level - 34.0 * number, end = std::abs(high);
  // Waisted bodies with rounded rims.
  const double waist = 3.5 * bump(end / 13.0);
  double d =
      smoothIntersection(ellipseDistance(m.x, m.y - 47, 25 - waist, 18 - waist), end - 13.2, 5);
  const Vec3 local{m.x, m.y, high};
  static constexpr Rod pedicle{{13, 56, 4}, {15, 72, 2}, 6, 6.5};
  static constexpr Rod transverse{{15, 70, 2}, {42, 77, 3}, 5.5, 4};
  static constexpr Rod facet{{16, 72, 12}, {15, 76, -16}, 6, 6};
  static constexpr Rod lamina{{14, 74, 0}, {3, 86, -6}, 5.5, 5};
  static constexpr Rod spinous[] = {{{0, 85, -3}, {0, 100, -8}, 5, 5.5}};
  d = smoothUnion(d, pedicle.distance(local), 5);
  double back = smoothUnion(transverse.distance(local), facet.distance(local), 5);
  back = smoothUnion(back, lamina.distance(local), 5);
  // A process is a plate: higher than thick.
  back = smoothUnion(back, spinous[0].distance({1.5 * local.x, local.y, 0.6 * local.z}), 5);
  return smoothIntersection(smoothUnion(d, back, 4), -canal, 2);
}

// Psoas, the muscles beside the spine, and quadratus lumborum.
double deepMuscleDistance(const Vec3& m) {
  static constexpr Rod psoas{{30, 46, 10}, {52, 42, -130}, 10, 23};
  static constexpr Ellipsoid erector({31, 82, -10}, {25, 17, 400});
  static constexpr Ellipsoid quadratus({66, 70, -90}, {20, 9, 62});
  return std::min({psoas.distance(m), erector.roughDistance(m), quadratus.roughDistance(m)});
}

// The liver: a right and a left lobe, cut by the abdominal wall, the diaphragm and its own visceral
// surface, which rises to the left, so that the left lobe thins to a wedge. The falciform
// ligament's fissure parts the lobes in front; on the visceral side those of the round and venous
// ligaments, gallbladder and porta set off the quadrate lobe in front and the caudate behind.
// Negative inside.
double liverDistance(const Vec3& p, double depth, double fat) {
  static constexpr Ellipsoid right({-70, -4, 24}, {88, 90, 86}, {82, 88, 74});
  static constexpr Ellipsoid left({4, -36, 40}, {70, 56, 40}, {76, 48, 38});
  static constexpr Ellipsoid gallbladder({-52, -52, -22}, {15, 26, 22});
  static constexpr Ellipsoid kidneyBed({-66, 47, -34}, {34, 36, 58});
  static constexpr Ellipsoid caudate({-20, 30, 20}, {13, 15, 24});
  static constexpr Rod round_ligament{{-8, -110, -10}, {-14, -14, 8}, 7, 4};
  static constexpr Rod venous_ligament{{-10, 0, 20}, {-6, 34, 58}, 4, 5};
  double d = smoothUnion(right.roughDistance(p), left.roughDistance(p), 36);
  if (d > 30.0) return d;
  const double visceral =
      (0.42 * (p.x + 118) + 0.16 * p.y - 42.0 - p.z + 7.0 * bump((p.x + 20) / 40)) / 1.097;
  const double porta = 12.0 - glm::length(Vec3(0.5 * (p.x + 28), p.y - 10, p.z + 2));
  d = smoothIntersection(d, visceral, 16);
  d = smoothUnion(d, caudate.roughDistance(p), 6);
  d = smoothIntersection(d, fat + kMuscleWall + 8.0 - depth, 12);
  d = smoothIntersection(d, 0.62 * (p.z - diaphragm(p) + 4.0), 14);
  d = smoothIntersection(d, -kidneyBed.roughDistance(p), 8);
  d = smoothIntersection(d, -gallbladder.roughDistance(p), 6);
  d = smoothIntersection(d, porta, 8);
  d = smoothIntersection(d, -round_ligament.distance(p), 7);
  d = smoothIntersection(d, -venous_ligament.distance(p), 5);
  if (d > 12.0) return d;
  // The falciform ligament's line on the front and the dome.
  const double falciform = p.x + 8.0 - 0.06 * (p.z - 20.0);
  if (p.y < 30.0 && std::abs(falciform) < 9.0) d += 3.0 * bump(falciform / 9.0);
  d = smoothIntersection(d, 2.0 - deepMuscleDistance(mirrored(p)), 8);
  // Room for spine and great vessels.
  return smoothIntersection(d, 36.0 - glm::length(glm::dvec2(p.x - 4, p.y - 50)), 10);
}

// A tree of tapered vessels: every branch parts into two in turning planes, each a step thinner
// (the cubes of the radii add up, Murray's law for equal daughters: 2^(-1/3)).
struct VesselTree {
  std::vector<Rod> rods;
  Ellipsoid bounds{{0, 0, 0}, {1, 1, 1}};

  void grow(const Vec3& from, const Vec3& towards, const Vec3& side, double length, double radius,
            int generations) {
    const double thinner = radius * 0.794;
    const Vec3 to = from + towards * length;
    rods.push_back({from, to, radius, thinner});
    if (generations == 0) return;
    const Vec3 normal = unit(glm::cross(towards, side));
    for (double turn : {-1.0, 1.0}) {
      const Vec3 next = unit(towards * 0.80 + side * (0.62 * turn) + normal * 0.12);
      grow(to, next, normal, length * 0.80, thinner, generations - 1);
    }
  }
  static Vec3 unit(const Vec3& v) { return v / std::sqrt(glm::dot(v, v)); }
};

std::vector<Rod> makeLiverVessels() {
  VesselTree tree;
  // Portal vein: the trunk enters at the porta, then a right and a left branch.
  const Vec3 porta{-34, 8, 8};
  tree.rods.push_back({{2, 22, -34}, porta, 7.5, 7.0});
  tree.grow(porta, VesselTree::unit({-0.86, 0.02, 0.25}), VesselTree::unit({0.2, 0.55, 0.8}), 34,
            5.6, 5);
  tree.grow(porta, VesselTree::unit({0.35, -0.72, 0.60}), VesselTree::unit({0.9, 0.1, -0.3}), 32,
            4.4, 4);
  // Hepatic veins: right, middle and left, from the vena cava below the diaphragm.
  const Vec3 cava{-24, 32, 62};
  tree.grow(cava, VesselTree::unit({-0.86, -0.1, -0.22}), VesselTree::unit({0.0, 0.9, -0.4}), 36,
            4.8, 4);
  tree.grow(cava, VesselTree::unit({-0.45, -0.85, -0.15}), VesselTree::unit({0.6, 0.0, 0.8}), 36,
            4.4, 4);
  tree.grow(cava, VesselTree::unit({0.30, -0.92, -0.05}), VesselTree::unit({0.5, 0.1, 0.8}), 34,
            4.0, 3);
  return tree.rods;
}

// Vessels in boxes of 16 mm, so that a point looks only at those near it.
class VesselMap {
 public:
  VesselMap() : rods_(makeLiverVessels()), cells_(std::size_t(kCells * kCells * kCells)) {
    for (std::size_t r = 0; r < rods_.size(); ++r) {
      const Rod& rod = rods_[r];
      const double reach = std::max(rod.r0, rod.r1);
      const Index3 low = cellOf(glm::min(rod.a, rod.b) - Vec3(reach));
      const Index3 high = cellOf(glm::max(rod.a, rod.b) + Vec3(reach));
      for (int k = low[2]; k <= high[2]; ++k) {
        for (int j = low[1]; j <= high[1]; ++j) {
          for (int i = low[0]; i <= high[0]; ++i) cells_[number(i, j, k)].push_back(int(r));
        }
      }
    }
  }
  bool contains(const Vec3& p) const {
    const Index3 c = cellOf(p);
    for (int r : cells_[number(c[0], c[1], c[2])]) {
      if (rods_[std::size_t(r)].contains(p)) return true;
    }
    return false;
  }

 private:
  static constexpr int kCells = 16;
  static Index3 cellOf(const Vec3& p) {
    const Vec3 c = (p - Vec3(-180, -128, -110)) / 16.0;
    Index3 cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = int(std::clamp(std::floor(c[axis]), 0.0, double(kCells - 1)));
    }
    return cell;
  }
  static std::size_t number(int i, int j, int k) {
    return std::size_t((k * kCells + j) * kCells + i);
  }

  std::vector<Rod> rods_;
  std::vector<std::vector<int>> cells_;
};

bool inLiverVessel(const Vec3& p) {
  static const VesselMap vessels;
  return vessels.contains(p);
}

// Aorta with its branches to the kidneys, vena cava, trunk of the portal vein.
bool inGreatVessel(const Vec3& p) {
  static constexpr Rod vessels[] = {{{9, 20, -130}, {9, 22, 130}, 8.5, 10.5},
                                    {{-16, 20, -130}, {-19, 24, 20}, 10.0, 11.0},
                                    {{-19, 24, 20}, {-24, 30, 90}, 11.0, 11.0},
                                    {{-24, 30, 90}, {-22, 22, 130}, 11.0, 12.0},
                                    {{2, 22, -34}, {-34, 8, 8}, 7.5, 7.0}};
  // In front of the psoas to the kidney's opening, and within.
  static constexpr Rod of_kidney[] = {{{10, 21, -28}, {34, 23, -34}, 3.8, 3.6},
                                      {{34, 23, -34}, {55, 35, -37}, 3.6, 3.4},
                                      {{55, 35, -37}, {62, 42, -26}, 3.2, 2.6},
                                      {{55, 35, -37}, {62, 42, -46}, 3.2, 2.6}};
  for (const Rod& vessel : vessels) {
    if (vessel.contains(p)) return true;
  }
  const Vec3 m = mirrored(p);
  for (const Rod& vessel : of_kidney) {
    if (vessel.contains(m)) return true;
  }
  return false;
}

// True when `tissue` is set. A kidney leans out downwards and opens inwards at its sinus.
bool inKidney(const Vec3& m, T& tissue) {
  static constexpr Ellipsoid sinus({51, 40, -36}, {15, 9, 24});
  const double lean = 0.18 * (m.z + 36);
  const Vec3 upright{m.x + lean, m.y - 0.10 * (m.z + 36), m.z};
  static constexpr Ellipsoid whole({66, 43, -36}, {26, 22, 54});
  if (!whole.contains(upright)) return false;
  if (sinus.contains(upright)) {
    tissue = T::fat;
  } else {
    tissue = T::kidney;
  }
  return true;
}

// Hollow organs: a muscle wall around gas, and around food where it has settled.
bool inGut(const Vec3& p, T& tissue) {
  static constexpr Ellipsoid stomach({62, -30, 34}, {44, 38, 44});
  static constexpr Rod antrum{{40, -48, 8}, {-4, -50, -8}, 21, 13};
  static constexpr Rod colon[] = {{{-104, -2, -130}, {-104, -16, -66}, 23, 21},
                                  {{-98, -38, -62}, {-40, -72, -58}, 19, 17},
                                  {{-40, -72, -58}, {40, -72, -54}, 17, 17},
                                  {{40, -72, -54}, {98, -22, -22}, 17, 18},
                                  {{104, -4, -30}, {106, 6, -130}, 18, 17}};
  const double belly = smoothUnion(stomach.roughDistance(p), antrum.distance(p), 16);
  if (belly < 0.0) {
    tissue = belly > -4.0 || p.y > -38 ? T::muscle : T::air;
    return true;
  }
  for (const Rod& part : colon) {
    const double haustra = 2.5 * wave((p.x + p.y + p.z) / 34);
    const double d = part.distance(p) + haustra;
    if (d < 0.0) {
      tissue = d > -2.5 || p.y > part.a.y + 9 ? T::muscle : T::air;
      return true;
    }
  }
  // Loops of small bowel, with fat between.
  static constexpr Ellipsoid loops({4, -28, -104}, {74, 50, 44});
  if (loops.contains(p)) {
    const double fold = wave((p.x + 8 * wave(p.z / 60)) / 56) +
                        wave((p.y + 6 * wave(p.x / 70)) / 50) +
                        wave((p.z + 8 * wave(p.y / 55)) / 54);
    if (std::abs(fold) < 1.0) {
      tissue = std::abs(fold) < 0.12 && p.y < -30 ? T::air : T::muscle;
      return true;
    }
  }
  return false;
}

}  // namespace

PhantomTissue abdomenTissue(const Vec3& p) {
  const double level = kBody.level(p);
  if (level >= 1.0) return T::air;
  const Vec3 m = mirrored(p);
  const double depth = level > 0.2 ? std::min(-kBody.distance(p), kDeep) : kDeep;
  if (depth < kSkin) return T::skin;

  const double fat = kSkin + fatThickness(p);
  if (m.x < 52 && p.y > 24) {
    const double canal = std::sqrt(square(m.x) + square(m.y - 74)) - 9.0;
    if (canal < 0.0) {
      return canal < -4.5 ? T::whiteMatter : canal < -0.5 ? T::csf : T::dura;
    }
    const double spine = spineDistance(m, canal);
    if (spine < 0.0) return longBone(spine, 1.8);
    if (ellipseDistance(m.x, m.y - 47, 23, 16) < 0.0) return T::muscle;  // discs
  }
  if (depth < fat) return T::fat;
  const double rib = ribDistance(m, depth, fat);
  if (rib < 0.0) return longBone(rib, 1.5);
  if (cartilageDistance(m, depth, fat) < 0.0) return T::marrow;
  const double hip = hipDistance(m);
  if (hip < 0.0) return longBone(hip, 2.0);
  if (deepMuscleDistance(m) < 0.0) return T::muscle;
  if (depth < fat + kMuscleWall) {
    // Three flat muscles at the sides, with thin fat between.
    const double within = depth - fat;
    return m.x > 70 && toNearest(within, 4.6) < 0.35 && within > 2 ? T::fat : T::muscle;
  }

  const double above = p.z - diaphragm(p);
  if (above > 0.0 && inGreatVessel(p)) return T::vessel;
  if (above > 3.5) {
    static constexpr Ellipsoid heart({14, -34, 116}, {54, 44, 48});
    const bool mediastinum = ellipseDistance(p.x - 2, p.y - 4, 24, 44) < 0.0;
    return mediastinum || heart.contains(p) ? T::muscle : T::air;
  }
  if (above > 0.0) return T::muscle;

  if (inGreatVessel(p)) return T::vessel;
  const double liver = liverDistance(p, depth, fat);
  if (liver < 0.0) {
    if (liver > -kCapsule) return T::capsule;
    return liver < -3.0 && inLiverVessel(p) ? T::vessel : T::liver;
  }
  if (liver < 2.5) return T::fat;  // organs glide on it
  static constexpr Ellipsoid gallbladder({-52, -52, -22}, {12, 23, 19});
  if (gallbladder.contains(p)) return T::csf;
  T tissue = T::fat;
  if (inKidney(m, tissue)) return tissue;
  static constexpr Ellipsoid spleen({104, 38, 42}, {26, 42, 46});
  if (spleen.contains(p) && above < -2.0) return T::spleen;
  if (inGut(p, tissue)) return tissue;
  return T::fat;
}

}  // namespace trephine
