#include "headset/room_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/tr.h"
#include "headset/codes.h"

namespace trephine {

namespace {

constexpr double kErrorAt_m = 0.1;
constexpr double kLeastSpread_mm = 20.0;  // of marks across the line that fits them best

// The unit quaternion x that makes x^T N x largest, N symmetric, by Jacobi's rotations.
Quat largestOf(glm::dmat4 n) {
  glm::dmat4 vectors(1.0);
  constexpr int kSweeps = 50;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double off = 0.0;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) off += n[q][p] * n[q][p];
    }
    if (off < 1e-30) break;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        if (n[q][p] == 0.0) continue;
        const double theta = 0.5 * std::atan2(2.0 * n[q][p], n[q][q] - n[p][p]);
        const double c = std::cos(theta), s = std::sin(theta);
        glm::dmat4 turn(1.0);
        turn[p][p] = turn[q][q] = c;
        turn[q][p] = s;
        turn[p][q] = -s;
        n = glm::transpose(turn) * n * turn;
        vectors = vectors * turn;
      }
    }
  }
  int best = 0;
  for (int i = 1; i < 4; ++i) {
    if (n[i][i] > n[best][best]) best = i;
  }
  const glm::dvec4& x = vectors[best];
  return glm::normalize(Quat(x[0], x[1], x[2], x[3]));
}

Vec3 meanOf(std::span<const Vec3> points) {
  Vec3 sum(0.0);
  for (const Vec3& each : points) sum += each;
  return sum / double(points.size());
}

// How far the points lie, at most, off the line through the two that are farthest apart.
double spread_m(std::span<const Vec3> points) {
  Vec3 from(0.0), along(0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Vec3 way = points[j] - points[i];
      if (glm::length(way) > glm::length(along)) from = points[i], along = way;
    }
  }
  if (glm::length(along) == 0.0) return 0.0;
  along = glm::normalize(along);
  double most = 0.0;
  for (const Vec3& each : points) {
    most = std::max(most, glm::length(glm::cross(each - from, along)));
  }
  return most;
}

}  // namespace

EyeView RoomPlace::toPatient_mm(const EyeView& room_m) const {
  return {{toPatient_mm(room_m.pose.position),
           glm::normalize(glm::conjugate(turn) * room_m.pose.orientation)},
          room_m.sees};
}

Vec3 levelAhead(const Head& head_m) {
  for (const Vec3& way : {head_m.forward, head_m.up}) {
    const Vec3 level(way.x, 0.0, way.z);
    if (glm::length(level) > 1e-3) return glm::normalize(level);
  }
  return Vec3(0.0, 0.0, -1.0);
}

RoomPlace before(const Eyes& eyes_m, const Looked& what, double ahead_m, double above_m,
                 double scale) {
  const Head head_m = headOf(eyes_m);
  const Vec3 place_m = head_m.position + ahead_m * levelAhead(head_m) + Vec3(0.0, above_m, 0.0);
  const Vec3 forward = glm::normalize(place_m - head_m.position);
  const Vec3 right = glm::normalize(glm::cross(forward, Vec3(0.0, 1.0, 0.0)));
  const Vec3 up = glm::cross(right, forward);
  const Mat3 room(right, up, -forward);
  const Mat3 patient(glm::cross(what.forward, what.up), what.up, -what.forward);
  RoomPlace to;
  to.scale = scale;
  to.turn = glm::normalize(glm::quat_cast(room * glm::transpose(patient)));
  to.origin_m = place_m - to.turn * (what.at_mm * (1e-3 * scale));
  return to;
}

RoomPlace where(const Pose& room_from_device_m, const ArmInPatient& arm) {
  RoomPlace to;
  to.scale = 1.0 / arm.travel;
  to.turn = glm::normalize(room_from_device_m.orientation * glm::conjugate(arm.turn));
  to.origin_m = room_from_device_m.position - to.turn * (arm.origin_mm * (1e-3 * to.scale));
  return to;
}

double apart_mm(const RoomPlace& place, const Pose& room_from_device_m, const ArmInPatient& arm) {
  constexpr double kReach_m = 0.08;
  double most_m = 0.0;
  for (const Vec3& way : {Vec3(0.0), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                          Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    const Vec3 tip_m = kReach_m * way;
    const Vec3 felt_m = room_from_device_m.position + room_from_device_m.orientation * tip_m;
    const Vec3 tool_mm = arm.origin_mm + 1000.0 * arm.travel * (arm.turn * tip_m);
    most_m = std::max(most_m, glm::distance(place.toRoom_m(tool_mm), felt_m));
  }
  return 1e3 * most_m;
}

// Horn, "Closed-form solution of absolute orientation using unit quaternions", 1987.
Result<Registration> registerArm(std::span<const Vec3> device_m, std::span<const Vec3> room_m) {
  if (device_m.size() < 3 || device_m.size() != room_m.size()) {
    return Error{code::kTooFewMarks, tr("Three marks are needed to know where the arm stands"),
                 tr("{} marks", std::min(device_m.size(), room_m.size())),
                 tr("Touch all of them with the arm's tip")};
  }
  const bool finite = std::ranges::all_of(device_m, [](const Vec3& p) { return isFinite(p); }) &&
                      std::ranges::all_of(room_m, [](const Vec3& p) { return isFinite(p); });
  if (!finite || 1e3 * std::min(spread_m(device_m), spread_m(room_m)) < kLeastSpread_mm) {
    return Error{code::kBadMarks, tr("The marks lie on one line, or were touched at one place"),
                 "marks", tr("Touch them one after the other, each at its place")};
  }
  const Vec3 device_mean = meanOf(device_m), room_mean = meanOf(room_m);
  Mat3 s(0.0);  // s[b][a]: sum of device a times room b
  for (std::size_t i = 0; i < device_m.size(); ++i) {
    s += glm::outerProduct(device_m[i] - device_mean, room_m[i] - room_mean);
  }
  const double xx = s[0][0], xy = s[1][0], xz = s[2][0], yx = s[0][1], yy = s[1][1], yz = s[2][1],
               zx = s[0][2], zy = s[1][2], zz = s[2][2];
  const glm::dmat4 n(xx + yy + zz, yz - zy, zx - xz, xy - yx,   //
                     yz - zy, xx - yy - zz, xy + yx, zx + xz,   //
                     zx - xz, xy + yx, -xx + yy - zz, yz + zy,  //
                     xy - yx, zx + xz, yz + zy, -xx - yy + zz);
  Registration found;
  Pose& pose = found.room_from_device_m;
  pose.orientation = largestOf(n);
  pose.position = room_mean - pose.orientation * device_mean;
  double squares = 0.0;
  for (std::size_t i = 0; i < device_m.size(); ++i) {
    const Vec3 off = pose.position + pose.orientation * device_m[i] - room_m[i];
    squares += glm::dot(off, off);
  }
  const double count = double(device_m.size());
  found.marks_mm = 1e3 * std::sqrt(squares / count);
  // Fitzpatrick, West and Maurer, "Predicting error in rigid-body point-based registration", 1998:
  // of marks that are each wrong by e, the fit shows e^2 (1 - 2 / N), and a place at the distance d
  // is wrong by e^2 / N (1 + sum of d_k^2 / f_k^2 / 3) over the axes k of the marks, from which
  // these lie f_k and the place d_k; d_k^2 is 2/3 d^2, over all directions. The sum of 1 / f_k^2 is
  // that of the inverse of the marks' mean square about each axis.
  Mat3 about(0.0);
  for (const Vec3& each : room_m) {
    const Vec3 r = each - room_mean;
    about += (glm::dot(r, r) * Mat3(1.0) - glm::outerProduct(r, r)) / count;
  }
  const Mat3 inverse = glm::inverse(about);
  const double sum = inverse[0][0] + inverse[1][1] + inverse[2][2];
  const double fle_mm = found.marks_mm / std::sqrt(1.0 - 2.0 / count);
  found.error_mm = fle_mm * std::sqrt((1.0 + kErrorAt_m * kErrorAt_m * 2.0 / 9.0 * sum) / count);
  return found;
}

}  // namespace trephine
