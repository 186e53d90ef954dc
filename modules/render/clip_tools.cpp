#include "render/clip_tools.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trephine {

namespace {

const Vec3 kBoxColour(0.98, 0.8, 0.3);
const Vec3 kPlaneColour(0.4, 0.85, 1.0);
constexpr double kHandle_pixels = 5.0;
constexpr double kThinnest_voxels = 1.0;

// How far along `axis` a point goes when it is dragged by pixels.
double along_mm(const Vec3& at, const Vec3& axis, const glm::dvec2& pixels,
                const ViewCamera& camera, int width, int height) {
  const double mm = camera.mmPerPixelAt(at, height);
  const glm::dvec2 way(glm::dot(axis, camera.right()), glm::dot(axis, camera.up()));
  // Seen end on, it follows up and down: up is away from the eye.
  if (glm::length(way) < 0.15)
    return pixels.y * mm * (glm::dot(axis, camera.forward()) < 0 ? -1 : 1);
  const auto from = camera.pixelOf(at, width, height),
             to = camera.pixelOf(at + axis, width, height);
  if (!from || !to) return 0.0;
  const glm::dvec2 step = *to - *from;
  return glm::dot(pixels, step) / std::max(1e-9, glm::dot(step, step));
}

void addEdge(const Vec3& from, const Vec3& to, const Vec3& colour, double line,
             const ViewCamera& camera, int width, int height, ScreenLines& lines) {
  const auto a = camera.pixelOf(from, width, height), b = camera.pixelOf(to, width, height);
  if (a && b) lines.push_back({*a, *b, colour, line});
}

}  // namespace

void ClipTools::setVolume(const GridGeometry& geometry) {
  if (geometry == geometry_) return;
  geometry_ = geometry;
  reset();
}

void ClipTools::reset() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    faces_[2 * axis] = -0.5;
    faces_[2 * axis + 1] = geometry_.size[axis] - 0.5;
  }
  placed_ = box_on_ = plane_on_ = false;
}

void ClipTools::showPlane(bool on, const ViewCamera& camera) {
  if (on && !placed_) planeThrough(geometry_.centre_mm(), Vec3(0.0), camera);
  plane_on_ = on;
}

void ClipTools::planeThrough(const Vec3& tip_mm, const Vec3& axis, const ViewCamera& camera) {
  if (!isFinite(tip_mm)) return;
  const Vec3 to_eye = camera.parallel() ? -camera.forward() : glm::normalize(camera.eye() - tip_mm);
  normal_ = to_eye;
  if (isFinite(axis) && glm::length(axis) > 0.0) {
    const Vec3 way = glm::normalize(axis);
    const Vec3 across = to_eye - way * glm::dot(to_eye, way);
    if (glm::length(across) > 0.1) normal_ = glm::normalize(across);
  }
  point_mm_ = tip_mm;
  placed_ = plane_on_ = true;
}

Vec3 ClipTools::normalOf(int face) const {
  return geometry_.direction[face / 2] * (face % 2 ? 1.0 : -1.0);
}

Vec3 ClipTools::corner(int index) const {
  Vec3 voxel;
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = faces_[std::size_t(2 * axis + (index >> axis & 1))];
  }
  return geometry_.toPatient_mm(voxel);
}

Vec3 ClipTools::middle() const {
  return 0.5 * (corner(0) + corner(7));
}

double ClipTools::reach_mm() const {
  return 0.3 * geometry_.diagonal_mm();
}

std::vector<ClipPlane> ClipTools::planes() const {
  std::vector<ClipPlane> planes;
  for (int face = 0; box_on_ && face < 6; ++face) {
    const auto axis = std::size_t(face / 2);
    const bool whole = face % 2 ? faces_[std::size_t(face)] >= geometry_.size[axis] - 0.5
                                : faces_[std::size_t(face)] <= -0.5;
    if (!whole) planes.push_back({corner(face % 2 ? 7 : 0), normalOf(face)});
  }
  if (plane_on_) planes.push_back({point_mm_, normal_});
  return planes;
}

std::vector<ClipTools::Handle> ClipTools::handles() const {
  std::vector<Handle> handles;
  for (int face = 0; box_on_ && face < 6; ++face) {
    Vec3 voxel;
    for (int axis = 0; axis < 3; ++axis) {
      voxel[axis] = 0.5 * (faces_[std::size_t(2 * axis)] + faces_[std::size_t(2 * axis + 1)]);
    }
    voxel[face / 2] = faces_[std::size_t(face)];
    handles.push_back({Grip::face, face, geometry_.toPatient_mm(voxel)});
  }
  if (plane_on_) {
    handles.push_back({Grip::plane, 0, point_mm_});
    handles.push_back({Grip::normal, 0, point_mm_ + normal_ * (0.6 * reach_mm())});
  }
  return handles;
}

std::optional<ClipTools::Handle> ClipTools::handleAt(const glm::dvec2& pixel,
                                                     const ViewCamera& camera, int width,
                                                     int height, double reach_pixels) const {
  std::optional<Handle> nearest;
  double depth = std::numeric_limits<double>::infinity();
  for (const Handle& handle : handles()) {
    const auto at = camera.pixelOf(handle.at_mm, width, height);
    const double away = glm::dot(handle.at_mm - camera.eye(), camera.forward());
    if (!at || glm::distance(*at, pixel) > reach_pixels || away >= depth) continue;
    nearest = handle;
    depth = away;
  }
  return nearest;
}

void ClipTools::movePlane(double mm) {
  if (!isFinite(mm)) return;
  const Vec3 centre = geometry_.centre_mm();
  const double most = 0.5 * geometry_.diagonal_mm();
  const double from = glm::dot(point_mm_ - centre, normal_);
  point_mm_ += normal_ * (std::clamp(from + mm, -most, most) - from);
}

void ClipTools::drag(const Handle& handle, const glm::dvec2& pixels, const ViewCamera& camera,
                     int width, int height) {
  if (!isFinite(pixels.x) || !isFinite(pixels.y)) return;
  if (handle.grip == Grip::plane) {
    movePlane(along_mm(point_mm_, normal_, pixels, camera, width, height));
    return;
  }
  if (handle.grip == Grip::normal) {
    const double length = 0.6 * reach_mm();
    const Vec3 end = point_mm_ + normal_ * length;
    const double mm = camera.mmPerPixelAt(end, height);
    const Vec3 moved = end + (camera.right() * pixels.x + camera.up() * pixels.y) * mm - point_mm_;
    if (glm::length(moved) > 1e-3 * length) normal_ = glm::normalize(moved);
    return;
  }
  const auto face = std::size_t(handle.face), axis = face / 2, other = face ^ 1;
  const double mm = along_mm(handle.at_mm, normalOf(handle.face), pixels, camera, width, height);
  const double voxels = mm / geometry_.spacing_mm[int(axis)] * (face % 2 ? 1.0 : -1.0);
  const double low = face % 2 ? faces_[other] + kThinnest_voxels : -0.5;
  const double high = face % 2 ? geometry_.size[axis] - 0.5 : faces_[other] - kThinnest_voxels;
  faces_[face] = std::clamp(faces_[face] + voxels, std::min(low, high), std::max(low, high));
}

void ClipTools::addLines(const ViewCamera& camera, int width, int height, ScreenLines& to) const {
  const double line = std::clamp(height / 700.0, 1.2, 3.0);
  const auto edge = [&](const Vec3& a, const Vec3& b, const Vec3& colour) {
    addEdge(a, b, colour, line, camera, width, height, to);
  };
  for (int i = 0; box_on_ && i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(i & (1 << axis))) edge(corner(i), corner(i | 1 << axis), kBoxColour);
    }
  }
  if (plane_on_) {
    Vec3 side = glm::cross(normal_, std::abs(normal_.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0));
    side = glm::normalize(side) * reach_mm();
    const Vec3 up = glm::cross(normal_, side);
    const Vec3 corners[4] = {-side - up, side - up, side + up, up - side};
    for (int i = 0; i < 4; ++i) {
      edge(point_mm_ + corners[i], point_mm_ + corners[(i + 1) % 4], kPlaneColour);
    }
    edge(point_mm_, point_mm_ + normal_ * (0.6 * reach_mm()), kPlaneColour);
  }
  for (const Handle& handle : handles()) {
    const auto at = camera.pixelOf(handle.at_mm, width, height);
    const Vec3& colour = handle.grip == Grip::face ? kBoxColour : kPlaneColour;
    if (at) addSquare(*at, kHandle_pixels * line, colour, 1.5 * line, to);
  }
}

Vec3 draggedLight(const Vec3& from, const glm::dvec2& pixels, int height) {
  if (!isFinite(from) || glm::length(from) == 0.0) return Vec3(0, 0, 1);
  const Vec3 unit = glm::normalize(from);
  const double half = 0.5 * std::max(1, height);
  glm::dvec2 beside = glm::dvec2(unit) + pixels / half;
  if (!isFinite(beside.x) || !isFinite(beside.y)) return unit;
  constexpr double kLowest = 0.97;  // a light quite from the side leaves half the picture black
  if (glm::length(beside) > kLowest) beside *= kLowest / glm::length(beside);
  return {beside.x, beside.y, std::sqrt(1.0 - glm::dot(beside, beside))};
}

}  // namespace trephine
