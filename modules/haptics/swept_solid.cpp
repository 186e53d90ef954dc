#include "haptics/swept_solid.h"

#include <algorithm>

namespace trephine {

CapsuleRows::CapsuleRows(const Capsule& capsule)
    : capsule_(capsule),
      sphere_(capsule.isSphere()),
      radius2_(capsule.radius > 0.0 ? capsule.radius * capsule.radius : -1.0) {
  if (sphere_) return;
  axis_ = capsule.to - capsule.from;
  length_ = glm::length(axis_);
  axis_ /= length_;
  across2_ = 1.0 - axis_.x * axis_.x;
  per_across2_ = across2_ > 1e-12 ? 1.0 / across2_ : 0.0;
  per_axis_x_ = std::abs(axis_.x) > 1e-9 ? 1.0 / axis_.x : 0.0;
}

// The cylinder between the ends: points whose distance from the axis is at most r, and whose foot
// lies on the segment. With X = x - from.x, axis u, s = dy u_y + dz u_z:
// (1 - u_x^2) X^2 - 2 u_x s X + dy^2 + dz^2 - s^2 - r^2 <= 0.
Interval CapsuleRows::sideRow(double y, double z) const {
  const double dy = y - capsule_.from.y, dz = z - capsule_.from.z;
  const double s = dy * axis_.y + dz * axis_.z, d2 = dy * dy + dz * dz;
  Interval side;
  if (per_across2_ > 0.0) {
    const double under = axis_.x * axis_.x * s * s - across2_ * (d2 - s * s - radius2_);
    if (under < 0.0) return {};
    const double root = std::sqrt(under), middle = axis_.x * s;
    side = {(middle - root) * per_across2_, (middle + root) * per_across2_};
  } else if (d2 <= radius2_) {
    side = {-length_ - capsule_.radius, length_ + capsule_.radius};
  } else {
    return {};
  }
  if (per_axis_x_ != 0.0) {
    const double one = -s * per_axis_x_, other = (length_ - s) * per_axis_x_;
    side.low = std::max(side.low, std::min(one, other));
    side.high = std::min(side.high, std::max(one, other));
  } else if (s < 0.0 || s > length_) {
    return {};
  }
  return {side.low + capsule_.from.x, side.high + capsule_.from.x};
}

Interval CapsuleRows::band(double z) const {
  const double r = capsule_.radius;
  const Vec3& from = capsule_.from;
  if (sphere_) {
    const double half2 = radius2_ - (z - from.z) * (z - from.z);
    if (!(half2 >= 0.0)) return {};
    return {from.y - std::sqrt(half2), from.y + std::sqrt(half2)};
  }
  double t0 = 0.0, t1 = length_;
  if (std::abs(axis_.z) > 1e-9) {
    const double one = (z - r - from.z) / axis_.z, other = (z + r - from.z) / axis_.z;
    t0 = std::max(t0, std::min(one, other));
    t1 = std::min(t1, std::max(one, other));
    if (t0 > t1) return {};
  } else if (std::abs(z - from.z) > r) {
    return {};
  }
  const double y0 = from.y + t0 * axis_.y, y1 = from.y + t1 * axis_.y;
  return {std::min(y0, y1) - r, std::max(y0, y1) + r};
}

double moved(const Capsule& from, const Capsule& to) {
  return std::max(glm::length(to.from - from.from), glm::length(to.to - from.to));
}

// Two equal spheres d apart leave r - sqrt(r^2 - d^2 / 4) between them, r / 30 for d = r / 2.
void SweptSolid::set(const Capsule& from, const Capsule& to) {
  const double steps = std::ceil(2.0 * moved(from, to) / std::max(to.radius, 1e-6));
  count_ = int(std::clamp(steps, 1.0, double(kMost)));
  for (int n = 0; n < count_; ++n) {
    const double t = double(n + 1) / count_;
    places_[std::size_t(n)] = CapsuleRows({from.from + t * (to.from - from.from),
                                           from.to + t * (to.to - from.to), to.radius});
  }
}

Interval SweptSolid::band(double z) const {
  Interval out;
  for (int n = 0; n < count_; ++n) out = joined(out, places_[std::size_t(n)].band(z));
  return out;
}

Interval SweptSolid::extent(int axis) const {
  Interval out;
  for (int n = 0; n < count_; ++n) {
    const Capsule& c = places_[std::size_t(n)].capsule();
    out = joined(out, {std::min(c.from[axis], c.to[axis]) - c.radius,
                       std::max(c.from[axis], c.to[axis]) + c.radius});
  }
  return out;
}

}  // namespace trephine
