// Bones and skin of the head from rods and ellipsoids with smooth joints. Sizes of an adult's;
// nasion (0, -80, -14), chin at z = -117 (at -94 as drawn, see lifeSize), ears at z = -35.
#include "volume/phantom_skull.h"

namespace trephine::skull {

namespace {

using namespace shapes;

// d joined with a shape over k; the shape is not looked at where it is too far away to matter.
double joined(double d, const Ellipsoid& shape, const Vec3& m, double k) {
  return shape.isBeyond(m, d + k) ? d : smoothUnion(d, shape.roughDistance(m), k);
}
template <class Rods>
double joined(double d, const Rods& rods, const Vec3& m, double k) {
  return rods.box().isBeyond(m, d + k) ? d : smoothUnion(d, rods.distance(m), k);
}

// A flat figure's rod: the distance of (y, z) alone.
double rod2(double y, double z, double ay, double az, double by, double bz, double r0, double r1) {
  const double dy = by - ay, dz = bz - az;
  const double t = std::clamp(((y - ay) * dy + (z - az) * dz) / (dy * dy + dz * dz), 0.0, 1.0);
  return std::sqrt(square(y - ay - t * dy) + square(z - az - t * dz)) - (r0 + (r1 - r0) * t);
}

// A bar that is higher than thick: the rod of a space squeezed along z.
double bar(const Rod& rod, const Vec3& m, double middle, double squeeze) {
  return rod.distance({m.x, m.y, middle + (m.z - middle) * squeeze});
}

// Along the dental arch from the midline, and out from its middle line (27 mm wide, 29 mm long).
struct Arch {
  double along, out;
};
Arch arch(const Vec3& m, double front) {
  const double y = m.y - (front + 29.0);
  if (y < 0.0)
    return {44.0 * m.x / (m.x - y * (27.0 / 29.0) + 1e-9), ellipseDistance(m.x, y, 27, 29)};
  return {44.0 + y, m.x - 27.0 - 0.06 * y};
}

constexpr double kTooth = 7.33;  // mm along the arch

// A row of teeth between the gum's height and the biting edge; molars are wider than incisors.
double teeth(const Arch& at, double z, double gum, double edge) {
  if (at.along > 7.4 * kTooth) return 1e3;
  const double beside = 0.5 * kTooth - toNearest(at.along, kTooth);  // from the tooth's middle
  const double thick = 2.6 + 1.8 * ramp(2.2 * kTooth, 4 * kTooth, at.along);
  const double middle = 0.5 * (gum + edge), half = 0.5 * std::abs(edge - gum);
  // Narrower towards the gum.
  const double towards_gum = (z - middle) / (gum - middle);
  double d = smoothIntersection(beside - (3.45 - 0.5 * ramp(0.0, 1.0, towards_gum)),
                                std::abs(at.out) - thick, 2.5);
  return smoothIntersection(d, std::abs(z - middle) - half, 2.0);
}

// Swellings of the roots, in front more than at the sides.
double roots(const Arch& at) {
  return 0.9 * bump((0.5 * kTooth - toNearest(at.along, kTooth)) / 3.6);
}

double upperJaw(const Vec3& m) {
  static constexpr Ellipsoid body({22, -50, -55}, {19, 23, 21});
  static constexpr Rod cheek{{24, -64, -56}, {42, -58, -49}, 6, 7};
  static constexpr Chain<3> frontal_process{{{{9, -76, -18}, {14, -73, -34}, 3.5, 4},
                                             {{14, -73, -34}, {17, -71, -50}, 4, 5},
                                             {{17, -71, -50}, {14, -73, -66}, 5, 4}},
                                            5};
  static constexpr Chain<2> rim{
      {{{15, -73, -38}, {24, -71, -48}, 3, 3.5}, {{24, -71, -48}, {40, -64, -49}, 3.5, 4}}, 4};
  static constexpr Rod spine{{0, -72, -67}, {0, -80, -65}, 3, 1.3};
  double d = smoothUnion(body.roughDistance(m), cheek.distance(m), 8);
  d = joined(d, frontal_process, m, 6);
  d = joined(d, rim, m, 5);
  if (m.z < -54.0) {
    // The alveolar ridge, and the palate that it stands around.
    const Arch at = arch(m, -77);
    double ridge = std::abs(at.out + 0.5) - 5.0 - roots(at) * (at.out > 0.0 ? 1.0 : 0.0);
    ridge = smoothIntersection(ridge, std::abs(m.z + 70) - 10.0, 5);
    ridge = smoothIntersection(ridge, at.along - 7.2 * kTooth, 6);
    const double palate =
        smoothIntersection(std::max(at.out, m.y + 26), std::abs(m.z + 66) - 2.2, 2);
    d = smoothUnion(smoothUnion(d, ridge, 6), palate, 4);
    d = joined(d, spine, m, 4);
    if (m.z < -76.0) d = smoothUnion(d, teeth(at, m.z, -77, -88.2), 0.8);
  }
  return d;
}

double lowerJaw(const Vec3& m) {
  // Body: bars from the chin to the angle.
  static constexpr Chain<4> body{{{{0, -71, 0}, {15, -69, 0}, 5.8, 5.8},
                                  {{15, -69, 0}, {29, -54, 0}, 5.8, 5.6},
                                  {{29, -54, 0}, {40, -32, 0}, 5.6, 5.2},
                                  {{40, -32, 0}, {46, -13, 0}, 5.2, 4.6}},
                                 0.5};
  static constexpr Ellipsoid chin({0, -76.5, -110}, {10, 5, 6});
  static constexpr Ellipsoid tubercle({11, -72, -111}, {6, 4.5, 4.5});
  double d = 1e3;
  if (m.z < -80.0) {
    const double rises = m.z + 105.5 - 9.0 * ramp(-56, -8, m.y);
    d = body.distance({m.x, m.y, 0.5 * rises});
    d = smoothUnion(d, smoothUnion(chin.roughDistance(m), tubercle.roughDistance(m), 6), 7);
    const Arch at = arch(m, -75);
    double ridge = std::abs(at.out) - 4.4 - roots(at) * (at.out > 0.0 ? 0.8 : 0.0);
    ridge = smoothIntersection(ridge, std::abs(m.z + 101) - 4.0, 4);
    ridge = smoothIntersection(ridge, at.along - 7.2 * kTooth, 6);
    d = smoothUnion(d, ridge, 5);
    d = smoothUnion(d, teeth(at, m.z, -98.5, -88.8), 0.8);
  }
  if (m.y > -42.0) {
    // Ramus: a plate of angle, coronoid process and neck.
    double plate = rod2(m.y, m.z, -14, -94, -9, -66, 14, 13);
    plate = smoothUnion(plate, rod2(m.y, m.z, 0, -68, 3, -44, 5.5, 4.5), 9);
    plate = smoothUnion(plate, rod2(m.y, m.z, -19, -66, -24, -43, 6, 2.5), 9);
    const double middle = 46.5 + 0.07 * (m.z + 100.0);
    double ramus = smoothIntersection(plate, std::abs(m.x - middle) - 3.6, 7);
    static constexpr Ellipsoid condyle({50, 3, -43}, {9, 4.5, 4.5});
    ramus = smoothUnion(ramus, condyle.roughDistance(m), 4);
    d = smoothUnion(d, ramus, 8);
  }
  return d;
}

// Brow, cheek bone and arch, bridge of the nose.
double upperFace(const Vec3& m) {
  static constexpr Chain<4> brow{{{{0, -75, -7}, {14, -76, -5}, 5.5, 5.5},
                                  {{14, -76, -5}, {32, -70, -3.5}, 5.5, 4.5},
                                  {{32, -70, -3.5}, {47, -60, -10}, 4.5, 4},
                                  {{47, -60, -10}, {52.5, -55, -22}, 4, 4}},
                                 6};
  static constexpr Chain<2> cheek{
      {{{52.5, -55, -22}, {52, -55, -38}, 4, 5.5}, {{52, -55, -38}, {45, -59, -48}, 6, 7.5}}, 6};
  static constexpr Rod arch_bones[] = {{{50, -54, -46}, {60, -38, -45}, 5, 4.2},
                                       {{60, -38, -45}, {63.5, -20, -43.5}, 4.2, 3.2},
                                       {{63.5, -20, -43.5}, {63.5, -4, -41}, 3.2, 3.4},
                                       {{63.5, -4, -41}, {60, 10, -37}, 3.4, 5}};
  static constexpr Chain<2> bridge{
      {{{0, -76, -12}, {1.2, -80, -24}, 4.8, 4.2}, {{1.2, -80, -24}, {1.5, -87, -37}, 4.2, 3.0}},
      4};
  static constexpr Rod side{{6, -76, -16}, {9, -77, -38}, 4, 2.8};
  static constexpr Ellipsoid root({0, -70, -25}, {10.5, 11, 14});
  double d = brow.distance(m);
  d = joined(d, cheek, m, 7);
  if (m.x > 34.0 && m.z < -24.0) {
    double arch_mm = bar(arch_bones[0], m, -45, 0.72);
    for (int n = 1; n < 4; ++n) {
      arch_mm = smoothUnion(arch_mm, bar(arch_bones[n], m, arch_bones[n].a.z, 0.72), 4);
    }
    d = smoothUnion(d, arch_mm, 5);
  }
  if (m.x < 24.0) {
    if (!bridge.box().isBeyond(m, d + 5) || !side.box().isBeyond(m, d + 5)) {
      d = smoothUnion(d, smoothUnion(bridge.distance(m), side.distance(m), 4), 4);
    }
    d = joined(d, root, m, 4);
  }
  return d;
}

}  // namespace

Vec3 lifeSize(const Vec3& m) {
  const double below = std::max(-42.0 - m.z, 0.0);
  return {m.x, m.y, m.z - 0.52 * below * below / (below + 8.0)};
}

double orbit(const Vec3& m) {
  // From the opening to the apex; below 0 in front of the rim, where the hollow stays as wide.
  const double t = std::clamp((m.y + 70.0) / 42.0, -0.4, 1.0);
  const double back = std::max(t, 0.0), narrow = 1.0 - back * back * 0.55 - back * 0.25;
  const double wide = 19.5 * narrow, high = 17.0 * narrow;
  // The rim droops to the side.
  const double x = m.x - (31.5 - 17.0 * back), z = m.z + 28.5 + 0.10 * (m.x - 32.0) * (1.0 - back);
  const double u2 = square(x / wide), v2 = square(z / high);
  const double norm = std::sqrt(std::sqrt(u2 * u2 + v2 * v2 + 0.4 * u2 * v2));
  return smoothIntersection((norm - 1.0) * std::min(wide, high), m.y + 28.0, 6);
}

double nose(const Vec3& drawn) {
  const Vec3 m = lifeSize(drawn);
  // A drop in (x, z), its bottom flat and heart-shaped around the spine.
  const double low = std::sqrt(square(m.x - 4.0) + square(m.z + 54.5)) - 8.0;
  const double high = rod2(m.x, m.z, 0, -53, 0, -38, 9.0, 3.4);
  double d = smoothUnion(low, high, 4);
  return smoothIntersection(d, m.y + 23.0, 4);
}

double earCanal(const Vec3& m) {
  static constexpr Rod canal{{90, 8, -35}, {54, 12, -37}, 4.2, 2.8};
  return canal.distance(m);
}

double relief(const Vec3& m) {
  double out = 0.0;
  const auto swell = [&](double x, double y, double z, double reach, double high) {
    const double r2 = square(m.x - x) + square(m.y - y) + square(m.z - z), reach2 = reach * reach;
    if (r2 < reach2) out += high * square(1.0 - r2 / reach2);
  };
  swell(56, 30, 44, 52, 4.5);    // parietal eminence
  swell(30, -64, 36, 40, 3.0);   // frontal eminence
  swell(0, 88, -20, 16, 3.5);    // occipital protuberance
  swell(20, 84, -28, 26, 2.0);   // and the swellings beside it
  swell(62, -34, -4, 46, -7.0);  // temporal fossa, deepest behind the eye socket
  // The temporal line: what lies within it is sunk a little, with a low crest at its border.
  if (m.x > 30.0 && m.z > -40.0) {
    const double line2 = square((m.y - 2.0) / 62.0) + square((m.z + 14.0) / 54.0);
    if (line2 < 1.3) {                                        // the crest ends where it is 1.226
      const double within = (1.0 - std::sqrt(line2)) * 56.0;  // mm, about
      const double fades = ramp(70.0, 10.0, m.y);
      out += fades * (0.4 * bump(within / 6.0) - 1.3 * ramp(0.0, 20.0, within));
    }
  }
  return out;
}

double suture(const Vec3& m) {
  if (m.z < -34.0) return 0.0;
  double nearest = 1e3;
  const double bregma = -22.0 - 0.22 * (74.0 - m.z);
  if (m.z > -8.0 && std::abs(m.y - bregma) < 6.0) {
    nearest = std::abs(m.y - bregma - 1.3 * wave(m.x / 9.0) - 0.6 * wave(m.x / 4.3 + 0.3));
  }
  if (m.x < 4.0 && m.y > -21.0 && m.y < 74.0 && m.z > 40.0) {
    nearest = std::min(nearest, std::abs(m.x - 0.6 - 0.6 * wave(m.y / 9.0)));
  }
  if (m.y > 30.0 && m.x > 0.0) {
    const double lambda = 50.0 - 1.12 * m.x;
    const double across = (m.z - lambda - 1.8 * wave((m.x - 0.6 * m.z) / 11.0)) / 1.5;
    nearest = std::min(nearest, std::abs(across));
  }
  if (m.x > 48.0) {
    const double squama = std::sqrt(square((m.y - 4.0) / 36.0) + square((m.z + 34.0) / 36.0));
    if (m.z > -30.0) nearest = std::min(nearest, 0.7 + std::abs(squama - 1.0) * 36.0);
  }
  return 1.1 * bump(nearest / 1.4);
}

double bones(const Vec3& m, double braincase) {
  static constexpr Ellipsoid mastoid({54, 24, -42}, {10, 13, 20});
  static constexpr Rod root{{56, 12, -31}, {62, 4, -36}, 6, 5};
  static constexpr Rod styloid{{46, 17, -46}, {41, 10, -70}, 2.6, 1.2};
  static constexpr Chain<2> pterygoid{
      {{{16, -22, -38}, {19, -24, -57}, 4, 2.4}, {{16, -22, -38}, {10, -18, -56}, 4, 1.8}}, 2};
  static constexpr Ellipsoid sphenoid({0, -14, -36}, {22, 24, 13});
  static constexpr Ellipsoid clivus({0, 6, -48}, {13, 14, 14});
  static constexpr Ellipsoid condyle({15, 22, -44}, {6, 10, 6});
  double d = braincase;
  if (m.z < 16.0 && m.y < 24.0 && m.z > -90.0) {
    static constexpr Box face{{-6, -96, -60}, {74, 21, 9}};
    if ((m.y < -20.0 || m.x > 34.0) && !face.isBeyond(m, d + 6))
      d = smoothUnion(d, upperFace(m), 6);
  }
  const Vec3 life = lifeSize(m);
  static constexpr Box upper_jaw{{-6, -86, -95}, {56, -12, -10}};
  if (m.y < -14.0 && m.z < -8.0 && m.z > -84.0 && !upper_jaw.isBeyond(life, d + 5)) {
    d = smoothUnion(d, upperJaw(life), 5);
  }
  if (m.z < -20.0 && m.y > -50.0 && m.y < 50.0) {
    d = joined(d, sphenoid, m, 8);
    d = joined(d, clivus, m, 8);
    d = joined(d, condyle, m, 5);
    if (m.x > 30.0) {
      if (!mastoid.isBeyond(m, d + 10) || !root.box().isBeyond(m, d + 10)) {
        d = smoothUnion(d, smoothUnion(mastoid.roughDistance(m), root.distance(m), 6), 8);
      }
      d = joined(d, styloid, m, 3);
    }
    d = joined(d, pterygoid, m, 4);
  }
  // Hollows, with thin walls of their own further back.
  if (m.y < -20.0 && m.z > -66.0 && m.z < 6.0) {
    const double socket = orbit(m);
    if (m.y > -64.0 + 0.25 * std::max(0.0, 40.0 - m.x)) {
      d = smoothUnion(d, std::abs(socket - 1.0) - 0.9, 2);
    }
    d = smoothIntersection(d, -socket, 3);
  }
  if (m.y < -18.0 && m.x < 16.0) {
    const double cavity = nose(m);
    d = smoothIntersection(d, -cavity, 2.5);
    if (cavity < 1.0 && m.y > -74.0 && m.y < -24.0) {
      // Septum and the lower conchae.
      static constexpr Chain<2> concha{
          {{{8, -64, -53}, {8, -30, -53}, 2.2, 2.4}, {{7, -60, -45}, {7, -30, -45}, 1.6, 1.8}}, 1};
      d = std::min({d, std::max(m.x - 0.8, -70.0 - m.y), concha.distance(m)});
    }
  }
  if (m.x > 48.0 && m.z < -24.0) d = smoothIntersection(d, -earCanal(m), 2);
  // Its distances are half of the true ones above and below.
  static constexpr Box lower_jaw{{-8, -90, -126}, {68, 20, -30}};
  if (m.z < -38.0 && m.y < 16.0 && !lower_jaw.isBeyond(life, 2.0 * d)) {
    d = std::min(d, lowerJaw(life));
  }
  return d;
}

double vertebrae(const Vec3& m, double canal) {
  const double level = m.z + 66.0;
  const double number = std::floor(level / 18.0 + 0.5);  // 0: the first below the dens
  const Vec3 local{m.x, m.y, level - 18.0 * number};
  const double high = std::abs(local.z);
  double d = smoothIntersection(ellipseDistance(local.x, local.y - 9, 13, 9), high - 6.8, 4);
  static constexpr Ellipsoid mass({20, 21, 0}, {9, 8, 7});
  static constexpr Rod transverse{{20, 18, 0}, {33, 14, 1}, 4.5, 3.5};
  static constexpr Rod lamina{{17, 32, -1}, {3, 44, -3}, 4.2, 4};
  static constexpr Rod spinous{{0, 43, -2}, {0, 64, -7}, 4, 3};
  d = joined(d, mass, local, 4);
  d = joined(d, transverse, local, 4);
  d = smoothUnion(d, smoothUnion(lamina.distance(local), spinous.distance(local), 4), 4);
  if (m.z > -57.0) {
    // The atlas is a ring without a body around the dens.
    static constexpr Rod dens{{0, 10, -62}, {0, 11, -51}, 5.0, 3.6};
    static constexpr Ellipsoid side({20, 22, -52}, {9, 9, 4.5});
    static constexpr Chain<4> ring{{{{0, 3, -53}, {14, 9, -53}, 3.2, 3},
                                    {{22, 30, -52}, {14, 40, -52}, 3.2, 3},
                                    {{14, 40, -52}, {0, 45, -53}, 3, 3.6},
                                    {{24, 20, -52}, {40, 19, -51}, 4, 3}},
                                   3};
    d = std::min(dens.distance(m), smoothUnion(side.roughDistance(m), ring.distance(m), 4));
  }
  return smoothIntersection(d, -canal, 2);
}

double skin(const Vec3& drawn, double scalp) {
  if (scalp < -18.0) return scalp;
  const Vec3 m = lifeSize(drawn);
  static constexpr Ellipsoid face({0, -30, -48}, {60, 50, 58});
  static constexpr Ellipsoid jaw({0, -32, -89}, {53, 51, 34});
  static constexpr Ellipsoid jowl({36, -30, -76}, {20, 38, 40});
  static constexpr Rod chin{{0, -71, -107}, {9, -69, -107}, 13, 12};
  static constexpr Chain<3> brow{{{{0, -77, -7}, {20, -76, -5}, 7.5, 7.5},
                                  {{20, -76, -5}, {46, -62, -12}, 7.5, 7.5},
                                  {{46, -62, -12}, {53, -54, -26}, 7.5, 8}},
                                 6};
  static constexpr Chain<2> nose_parts{
      {{{0, -77, -16}, {0, -90, -46}, 6.5, 7.2}, {{0, -90, -46}, {0, -94, -55}, 7.2, 8.2}}, 6};
  static constexpr Rod wing{{9, -85, -58}, {11, -79, -57}, 5.5, 5};
  static constexpr Rod column{{0, -93, -58}, {0, -82, -65}, 4.5, 5};
  static constexpr Rod upper_lip{{0, -85, -82}, {22, -77, -86}, 6, 2.5};
  static constexpr Rod lower_lip{{0, -84, -92}, {21, -77, -88}, 6.2, 2.5};
  static constexpr Ellipsoid muzzle({0, -61, -80}, {33, 25, 25});
  static constexpr Ellipsoid nose_base({0, -78, -50}, {10, 11, 17});
  static constexpr Ellipsoid cheek({37, -52, -60}, {21, 20, 24});
  static constexpr Ellipsoid lid({31, -66, -28}, {17, 14.8, 14});
  // No seam at the height where the face begins.
  double d = smoothUnion(scalp, face.roughDistance(m), 0.1 + 12.0 * ramp(16, 0, m.z));
  if (m.z < -5.0) {
    const double neck = smoothIntersection(ellipseDistance(m.x, m.y - 24, 53, 53), m.z + 18, 10);
    d = smoothUnion(d, neck, 16);
    d = joined(d, jaw, m, 12);
    d = joined(d, jowl, m, 14);
  }
  if (d > 32.0 || d < -18.0) return d;  // none of what follows reaches there
  if (m.y < -34.0) {
    d = joined(d, brow, m, 7);
    if (!cheek.isBeyond(m, d + 10) || !muzzle.isBeyond(m, d + 10)) {
      d = smoothUnion(d, smoothUnion(cheek.roughDistance(m), muzzle.roughDistance(m), 8), 8);
    }
    d = joined(d, chin, m, 8);
    static constexpr Box whole_nose{{-12, -106, -76}, {22, -64, -7}};
    if (!whole_nose.isBeyond(m, d + 8)) {
      double front = nose_parts.distance(m);
      front = smoothUnion(front, smoothUnion(wing.distance(m), column.distance(m), 3), 3);
      front = joined(front, nose_base, m, 4);
      d = smoothUnion(d, front, 8);
    }
    d = joined(d, upper_lip, m, 4);
    d = joined(d, lower_lip, m, 3);
    // The line between the lips, and that between the lids.
    const double mouth = std::sqrt(square(m.z + 87.0 - 0.02 * m.x) + square((m.y + 93.0) / 8.0));
    if (m.x < 24.0) d = std::max(d, 0.9 * bump(m.x / 26.0) + 0.3 - mouth);
    d = joined(d, lid, m, 7);
    if (m.y < -70.0 && m.z < -10.0 && m.z > -48.0) {
      const double aside2 = square((m.x - 31.0) / 15.5);
      if (aside2 < 1.0) {
        // The closed lids meet along an arc below the pupil; the upper folds above it.
        const double between = std::abs(m.z + 33.5 - 3.5 * aside2),
                     fold = std::abs(m.z + 20.0 + 5.0 * aside2);
        d += (1.0 - aside2) * (1.2 * bump(between / 1.9) + 0.8 * bump(fold / 2.0));
      }
    }
  }
  // The muscle that fills the temporal fossa.
  static constexpr Ellipsoid temple({40, -26, -18}, {28, 34, 23});
  d = joined(d, temple, drawn, 8);
  if (m.x > 30.0 && m.z < 0.0) {
    // Over the cheek's arch and behind the ear.
    static constexpr Chain<2> arch_skin{
        {{{44, -61, -42}, {60, -36, -42}, 10, 9}, {{60, -36, -42}, {62, 4, -40}, 9, 10}}, 8};
    static constexpr Ellipsoid behind({50, 22, -40}, {21, 24, 32});
    d = joined(d, arch_skin, drawn, 22);
    d = joined(d, behind, drawn, 10);
  }
  if (m.x > 54.0) {
    static constexpr Ellipsoid ear({74, 17, -32}, {5, 15, 29}, {6, 19, 32});
    static constexpr Ellipsoid lobe({72, 8, -58}, {5, 8, 9});
    static constexpr Ellipsoid shell({83, 13, -33}, {7, 9, 15});
    static constexpr Ellipsoid scapha({83, 19, -20}, {6, 11, 17});
    // It stands off to the back.
    const Vec3 turned{m.x - 0.35 * (m.y - 8.0), m.y, drawn.z};
    double pinna = smoothUnion(ear.roughDistance(turned), lobe.roughDistance(turned), 5);
    pinna = smoothIntersection(pinna, -shell.roughDistance(turned), 3);
    pinna = smoothIntersection(pinna, -scapha.roughDistance(turned), 3);
    d = smoothUnion(d, pinna, 3);
  }
  return d;
}

}  // namespace trephine::skull
