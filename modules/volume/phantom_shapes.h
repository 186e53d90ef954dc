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
  const double h = std::max(k - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4.0 * k);
}
inline double smoothIntersection(double a, double b, double k) {
  return -smoothUnion(-a, -b, k);
}

// Eight octants of ellipsoids joined where their tangents agree, so that front and back, top and
// bottom may differ. `low` and `high` are the semi-axes on the negative and positive side.
struct Ellipsoid {
  Vec3 centre;
  Vec3 low;
  Vec3 high;

  Ellipsoid(const Vec3& c, const Vec3& semi) : centre(c), low(semi), high(semi) {}
  Ellipsoid(const Vec3& c, const Vec3& low_semi, const Vec3& high_semi)
      : centre(c), low(low_semi), high(high_semi) {}

  Vec3 semiAxes(const Vec3& q) const {
    return {q.x < 0 ? low.x : high.x, q.y < 0 ? low.y : high.y, q.z < 0 ? low.z : high.z};
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

  // The exact distance. The closest point is v_i a_i with v_i = a_i q_i / (t + a_i^2), where t
  // makes |v| = 1 (Eberly, "Distance from a point to an ellipsoid"). 1 / |v| is concave and nearly
  // straight in t, so Newton's method on it needs two or three steps from the surface's t = 0 (the
  // secular equation of More and Sorensen); `least` is left of the root and right of every pole.
  double distance(const Vec3& p) const {
    const Vec3 a = semiAxes(p - centre), a2 = a * a;
    const Vec3 q = glm::max(glm::abs(p - centre), Vec3(1e-9));
    const double least = std::max({a.x * (q.x - a.x), a.y * (q.y - a.y), a.z * (q.z - a.z)});
    double t = std::max(0.0, least);
    for (int step = 0; step < 40; ++step) {
      const Vec3 s(1.0 / (t + a2.x), 1.0 / (t + a2.y), 1.0 / (t + a2.z));
      const Vec3 v = a * q * s, term = v * v;
      const double norm2 = term.x + term.y + term.z, norm = std::sqrt(norm2);
      if (std::abs(norm - 1.0) < 1e-7) break;
      t = std::max(least, t + norm2 * (norm - 1.0) / (term.x * s.x + term.y * s.y + term.z * s.z));
    }
    const Vec3 off(q.x * t / (t + a2.x), q.y * t / (t + a2.y), q.z * t / (t + a2.z));
    const double d = std::sqrt(off.x * off.x + off.y * off.y + off.z * off.z);
    return t < 0.0 ? -d : d;
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
