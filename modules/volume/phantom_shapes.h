// Shapes that the phantoms are made of. Only + - * / and sqrt: the same bits on every machine.
// Distances are in mm, negative inside.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "volume/phantom.h"

namespace trephine::shapes {

// The point mirrored to the patient's left: most of a body is symmetric.
inline Vec3 mirrored(const Vec3& p) {
  return {std::abs(p.x), p.y, p.z};
}

inline double square(double v) {
  return v * v;
}

// 0 below `low`, 1 above `high`, smooth between.
inline double ramp(double low, double high, double v) {
  const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// 1 at 0, 0 from |v| = 1 on, smooth.
inline double bump(double v) {
  return v * v < 1.0 ? square(1.0 - v * v) : 0.0;
}

// A smooth wave of period 1 and amplitude 1: parabolas in place of a sine.
inline double wave(double t) {
  const double u = 2.0 * (t - std::floor(t + 0.5));
  return 4.0 * u * (1.0 - std::abs(u));
}

// Distance of `v` from the nearest multiple of `period`.
inline double toNearest(double v, double period) {
  const double t = v / period;
  return std::abs(t - std::floor(t + 0.5)) * period;
}

// Union and intersection whose crease is rounded over a width k; exact where the two differ by
// more than k.
inline double smoothUnion(double a, double b, double k) {
  const double h = k - std::abs(a - b), least = a < b ? a : b;
  return h > 0.0 ? least - h * h / (4.0 * k) : least;
}
inline double smoothIntersection(double a, double b, double k) {
  return -smoothUnion(-a, -b, k);
}

// A box around a shape: what is farther away than a union asks for need not be computed.
struct Box {
  Vec3 low;
  Vec3 high;

  // Whether all that lies within is surely more than `limit` away.
  bool isBeyond(const Vec3& p, double limit) const {
    const auto off = [](double v, double from, double to) {
      return v < from ? from - v : v > to ? v - to : 0.0;
    };
    const double away = square(off(p.x, low.x, high.x)) + square(off(p.y, low.y, high.y)) +
                        square(off(p.z, low.z, high.z));
    return limit > 0.0 ? away > limit * limit : away > 0.0;
  }
};

// Eight octants of ellipsoids joined where their tangents agree, so that front and back, top and
// bottom may differ. `low` and `high` are the semi-axes on the negative and positive side.
struct Ellipsoid {
  Vec3 centre;
  Vec3 low;
  Vec3 high;
  Vec3 low_per2;  // 1 / low^2
  Vec3 high_per2;
  double least;  // of the semi-axes

  constexpr Ellipsoid(const Vec3& c, const Vec3& semi) : Ellipsoid(c, semi, semi) {}
  constexpr Ellipsoid(const Vec3& c, const Vec3& low_semi, const Vec3& high_semi)
      : centre(c),
        low(low_semi),
        high(high_semi),
        low_per2(1.0 / (low.x * low.x), 1.0 / (low.y * low.y), 1.0 / (low.z * low.z)),
        high_per2(1.0 / (high.x * high.x), 1.0 / (high.y * high.y), 1.0 / (high.z * high.z)),
        least(std::min({low.x, low.y, low.z, high.x, high.y, high.z})) {}

  Vec3 semiAxes(const Vec3& q) const {
    return {q.x < 0 ? low.x : high.x, q.y < 0 ? low.y : high.y, q.z < 0 ? low.z : high.z};
  }

  // Whether roughDistance() is surely more than `limit`: it is least * (sqrt(level) - 1) or more.
  bool isBeyond(const Vec3& p, double limit) const {
    const Vec3 q = p - centre;
    const double away = q.x * q.x * (q.x < 0 ? low_per2.x : high_per2.x) +
                        q.y * q.y * (q.y < 0 ? low_per2.y : high_per2.y) +
                        q.z * q.z * (q.z < 0 ? low_per2.z : high_per2.z);
    const double bound = limit > 0.0 ? least + limit : least;
    return away * (least * least) > bound * bound * (1.0 + 1e-12);
  }

  // 1 on the surface, less inside: cheaper than a distance.
  double level(const Vec3& p) const {
    const Vec3 q = p - centre;
    const Vec3 u = q / semiAxes(q);
    return u.x * u.x + u.y * u.y + u.z * u.z;
  }
  bool contains(const Vec3& p) const { return level(p) < 1.0; }

  // About the distance, by the first order of level(): good near the surface.
  double roughDistance(const Vec3& p) const {
    const Vec3 q = p - centre;
    const Vec3 a = semiAxes(q);
    const Vec3 u = q / a, g = u / a;
    const double l = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    const double slope = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z);
    return slope > 0.0 ? l * (l - 1.0) / slope : -std::min({a.x, a.y, a.z});
  }

  // The distance, exact to 0.01 mm at the surface and far better elsewhere. The closest point is
  // v_i a_i with v_i = a_i q_i / (t + a_i^2), where t makes |v| = 1 (Eberly, "Distance from a point
  // to an ellipsoid"). 1 / |v| is concave and nearly straight in t: a step of Halley's method on it
  // from the surface's t = 0 is enough near the surface; elsewhere Newton's (the secular equation
  // of More and Sorensen) goes on from there. `least_t` is left of the root, right of every pole.
  double distance(const Vec3& p) const {
    const Vec3 q = glm::abs(p - centre), a = semiAxes(p - centre), a2 = a * a;
    const Vec3 level_parts = q * q * per2(p - centre);
    const Vec3 slope_parts = level_parts * per2(p - centre);
    const Vec3 bend_parts = slope_parts * per2(p - centre);
    const double level = level_parts.x + level_parts.y + level_parts.z;
    const double slope = slope_parts.x + slope_parts.y + slope_parts.z;
    const double bend = bend_parts.x + bend_parts.y + bend_parts.z;
    const double off = level * (std::sqrt(level) - 1.0);
    double t =
        off * level * slope / (level * slope * slope + 1.5 * off * (slope * slope - level * bend));
    if (std::abs(level - 1.0) > 0.1) {
      const Vec3 aq = a * q, aq2 = aq * aq;
      const double least_t =
          std::max({aq.x - a2.x, aq.y - a2.y, aq.z - a2.z, 1e-9 - least * least});
      if (!(t > least_t)) t = std::max(0.0, least_t);
      for (int step = 0; step < 40; ++step) {
        const Vec3 s(1.0 / (t + a2.x), 1.0 / (t + a2.y), 1.0 / (t + a2.z));
        const Vec3 term = aq2 * (s * s);
        const double norm2 = term.x + term.y + term.z, off_one = std::sqrt(norm2) - 1.0;
        const double down = term.x * s.x + term.y * s.y + term.z * s.z;
        if (!(down > 0.0)) break;
        t = std::max(least_t, t + norm2 * off_one / down);
        if (std::abs(off_one) < 1e-3) break;
      }
    }
    const Vec3 way(q.x / (t + a2.x), q.y / (t + a2.y), q.z / (t + a2.z));
    return t * std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
  }

 private:
  Vec3 per2(const Vec3& q) const {
    return {q.x < 0 ? low_per2.x : high_per2.x, q.y < 0 ? low_per2.y : high_per2.y,
            q.z < 0 ? low_per2.z : high_per2.z};
  }
};

// A rod whose radius goes from r0 at a to r1 at b.
struct Rod {
  Vec3 a;
  Vec3 b;
  double r0;
  double r1;

  double distance(const Vec3& p) const {
    const Vec3 ab = b - a, ap = p - a;
    const double t = std::clamp(glm::dot(ap, ab) / glm::dot(ab, ab), 0.0, 1.0);
    const Vec3 off = ap - ab * t;
    return std::sqrt(glm::dot(off, off)) - (r0 + (r1 - r0) * t);
  }
  bool contains(const Vec3& p) const { return distance(p) < 0.0; }

  constexpr Box box() const {
    const double r = std::max(r0, r1);
    return {{std::min(a.x, b.x) - r, std::min(a.y, b.y) - r, std::min(a.z, b.z) - r},
            {std::max(a.x, b.x) + r, std::max(a.y, b.y) + r, std::max(a.z, b.z) + r}};
  }
};

// Rods one after another, joined over k.
template <std::size_t N>
struct Chain {
  Rod rods[N];
  double k;

  double distance(const Vec3& p) const {
    double d = rods[0].distance(p);
    for (std::size_t n = 1; n < N; ++n) d = smoothUnion(d, rods[n].distance(p), k);
    return d;
  }
  constexpr Box box() const {
    Box all = rods[0].box();
    for (const Rod& rod : rods) {
      const Box one = rod.box();
      all = {{std::min(all.low.x, one.low.x), std::min(all.low.y, one.low.y),
              std::min(all.low.z, one.low.z)},
             {std::max(all.high.x, one.high.x), std::max(all.high.y, one.high.y),
              std::max(all.high.z, one.high.z)}};
    }
    // A smooth joint bulges by a quarter of its width.
    const double sag = 0.25 * k * double(N - 1);
    return {{all.low.x - sag, all.low.y - sag, all.low.z - sag},
            {all.high.x + sag, all.high.y + sag, all.high.z + sag}};
  }
};

// Signed distance to an ellipse-shaped cylinder along z, first order.
inline double ellipseDistance(double x, double y, double ax, double ay) {
  const double ux = x / ax, uy = y / ay;
  const double l = std::sqrt(ux * ux + uy * uy);
  const double slope = std::sqrt(square(ux / ax) + square(uy / ay));
  return slope > 0.0 ? l * (l - 1.0) / slope : -std::min(ax, ay);
}

// Cortical bone `cortex_mm` thick around marrow, at `distance` < 0 from the bone's surface.
inline PhantomTissue longBone(double distance, double cortex_mm) {
  return distance > -cortex_mm ? PhantomTissue::bone : PhantomTissue::marrow;
}

}  // namespace trephine::shapes

namespace trephine {

PhantomTissue craniumTissue(const Vec3& patient_mm);
PhantomTissue abdomenTissue(const Vec3& patient_mm);

}  // namespace trephine
