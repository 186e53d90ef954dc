// The built-in head on a neck, shoulders and, if wanted, raised arms: in any pose.
#pragma once

#include "painted.h"
#include "volume/phantom.h"

namespace trephine::test {

struct HeadPose {
  double extended_deg = 0.0;  // chin up; below 0: chin to the chest
  double turned_deg = 0.0;    // to the patient's left
  bool arms_up = false;
};

// From the patient to the head as phantomTruth("cranium") has it: turned about the neck.
inline Vec3 intoHead(const Vec3& p, const HeadPose& pose) {
  constexpr double kRadians = 3.14159265358979 / 180.0;
  const Vec3 neck(0, 25, -60), q = p - neck;
  const double t = pose.turned_deg * kRadians, e = -pose.extended_deg * kRadians;
  const double x = std::cos(t) * q.x + std::sin(t) * q.y;
  const double y = -std::sin(t) * q.x + std::cos(t) * q.y;
  return neck + Vec3(x, std::cos(e) * y + std::sin(e) * q.z, -std::sin(e) * y + std::cos(e) * q.z);
}

inline Matter posedMan(const Vec3& p, const HeadPose& pose) {
  static const PhantomTruth head = phantomTruth("cranium").value();
  const Vec3 q = intoHead(p, pose);
  const double neck = ellipse(p.x, p.y - 25, 54, 52);
  if (q.z > -112.0) {
    const PhantomTissue tissue = head(q);
    const bool inside = tissue != PhantomTissue::air ||
                        (q.z > -100 && ellipse(q.x, q.y + 28, 55, 50) < 0.0 && std::abs(q.x) < 60);
    const bool own_neck = q.z < -80 && q.y > -30;
    if (inside && !(own_neck && neck <= 0.0)) return {phantomHu(tissue), Owner::patient};
  }
  if (p.z < -62 && neck <= 0.0) {
    if (ellipse(p.x, p.y - 32, 13, 13) < 0.0) return {500, Owner::patient};
    if (p.z < -90 && ellipse(p.x, p.y + 2, 9, 9) < 0.0) return {-1000, Owner::patient};
    return {neck > -0.08 ? -80 : 60, Owner::patient};
  }
  if (p.z < -150) {
    const double down = -p.z - 150.0;
    const double wide = std::min(60 + 5 * down, 190.0), deep = std::min(52 + 1.2 * down, 105.0);
    const double trunk = ellipse(p.x, p.y - 20, wide, deep);
    const bool lung = p.z < -190 && ellipse(std::abs(p.x) - 75, p.y - 20, 50, 65) < 0.0;
    if (trunk < 0.0) return {lung ? -850 : trunk > -0.1 ? -95 : 55, Owner::patient};
  }
  if (pose.arms_up) {
    const Vec3 m(std::abs(p.x), p.y, p.z), shoulder(150, 20, -190), elbow(155, -50, 0);
    const Vec3 hand(70, -60, 95);
    if (std::min(rod(m, shoulder, elbow, 11), rod(m, elbow, hand, 9)) < 0.0) {
      return {900, Owner::patient};
    }
    const double arm = std::min(rod(m, shoulder, elbow, 38), rod(m, elbow, hand, 28));
    if (arm < 0.0) return {arm > -7.0 ? -95 : 58, Owner::patient};
  }
  return {};
}

// 2 mm voxels, from the vault to the shoulders.
inline Volume posedHead(const HeadPose& pose) {
  GridGeometry grid = centredGrid({200, 150, 150}, {2.0, 2.0, 2.2});
  grid.origin_mm.z -= 50.0;
  return paint(grid, [&](const Vec3& p) { return posedMan(p, pose); }).volume;
}

// The same voxels under other words: a patient who lies the other way round. The volume's middle
// stays where it was; `axes` are signs of the patient's x, y and z.
inline Volume laidAs(Volume volume, const Vec3& axes) {
  GridGeometry& g = volume.geometry;
  const Vec3 middle = g.centre_mm();
  for (int n = 0; n < 3; ++n) g.direction[n] *= axes;
  g.origin_mm += middle - g.centre_mm();
  return volume;
}

}  // namespace trephine::test
