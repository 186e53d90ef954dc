#include "haptics/swept_solid.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

Interval within(double centre, double half2) {
  if (!(half2 >= 0.0)) return {};
  const double half = std::sqrt(half2);
  return {centre - half, centre + half};
}

Interval joined(const Interval& a, const Interval& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval ballRow(const Vec3& centre, double r2, double y, double z) {
  const double dy = y - centre.y, dz = z - centre.z;
  return within(centre.x, r2 - dy * dy - dz * dz);
}

bool isBall(const Capsule& c) { return c.from == c.to; }

}  // namespace

Interval rowWithin(const Capsule& c, double y, double z) {
  const double r2 = c.radius * c.radius;
  Interval row = ballRow(c.from, r2, y, z);
  if (isBall(c)) return row;
  row = joined(row, ballRow(c.to, r2, y, z));
  // The cylinder between: points whose distance from the axis is at most r, and whose foot lies on
  // the segment. With X = x - from.x, axis u, s = dy u_y + dz u_z.
  const Vec3 axis = c.to - c.from;
  const double length = glm::length(axis);
  const Vec3 u = axis / length;
  const double dy = y - c.from.y, dz = z - c.from.z;
  const double s = dy * u.y + dz * u.z, d2 = dy * dy + dz * dz;
  const double a = 1.0 - u.x * u.x;
  Interval side;
  if (a > 1e-12) {
    const double under = u.x * u.x * s * s - a * (d2 - s * s - r2);
    if (under < 0.0) return row;
    const double root = std::sqrt(under);
    side = {(u.x * s - root) / a, (u.x * s + root) / a};
  } else if (d2 <= r2) {
    side = {-length - c.radius, length + c.radius};
  } else {
    return row;
  }
  if (std::abs(u.x) > 1e-9) {
    const double one = -s / u.x, other = (length - s) / u.x;
    side.low = std::max(side.low, std::min(one, other));
    side.high = std::min(side.high, std::max(one, other));
  } else if (s < 0.0 || s > length) {
    return row;
  }
  if (side.empty()) return row;
  return joined(row, {side.low + c.from.x, side.high + c.from.x});
}

Interval bandWithin(const Capsule& c, double z) {
  const double r = c.radius;
  if (isBall(c)) {
    const double dz = z - c.from.z;
    return within(c.from.y, r * r - dz * dz);
  }
  const Vec3 axis = c.to - c.from;
  double t0 = 0.0, t1 = 1.0;
  if (std::abs(axis.z) > 1e-9) {
    const double one = (z - r - c.from.z) / axis.z, other = (z + r - c.from.z) / axis.z;
    t0 = std::max(t0, std::min(one, other));
    t1 = std::min(t1, std::max(one, other));
    if (t0 > t1) return {};
  } else if (std::abs(z - c.from.z) > r) {
    return {};
  }
  const double y0 = c.from.y + t0 * axis.y, y1 = c.from.y + t1 * axis.y;
  return {std::min(y0, y1) - r, std::max(y0, y1) + r};
}

double moved(const Capsule& from, const Capsule& to) {
  return std::max(glm::length(to.from - from.from), glm::length(to.to - from.to));
}

// Two equal balls d apart leave r - sqrt(r^2 - d^2 / 4) between them, r / 30 for d = r / 2.
SweptSolid::SweptSolid(const Capsule& from, const Capsule& to) {
  const double steps = std::ceil(2.0 * moved(from, to) / std::max(to.radius, 1e-6));
  count_ = int(std::clamp(steps, 1.0, double(kMost)));
  for (int n = 0; n < count_; ++n) {
    const double t = double(n + 1) / count_;
    places_[std::size_t(n)] = {from.from + t * (to.from - from.from),
                               from.to + t * (to.to - from.to), to.radius};
  }
}

Interval SweptSolid::row(double y, double z) const {
  Interval out;
  for (int n = 0; n < count_; ++n) out = joined(out, rowWithin(places_[std::size_t(n)], y, z));
  return out;
}

Interval SweptSolid::band(double z) const {
  Interval out;
  for (int n = 0; n < count_; ++n) out = joined(out, bandWithin(places_[std::size_t(n)], z));
  return out;
}

Interval SweptSolid::depth() const {
  Interval out;
  for (int n = 0; n < count_; ++n) {
    const Capsule& c = places_[std::size_t(n)];
    out = joined(out, {std::min(c.from.z, c.to.z) - c.radius, std::max(c.from.z, c.to.z) + c.radius});
  }
  return out;
}

}  // namespace trephine
