#include "render/view_camera.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

const double kTan = std::tan(glm::radians(ViewCamera::kViewAngle_deg / 2.0));

}  // namespace

void ViewCamera::lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up,
                        double distance_mm) {
  if (!isFinite(focus_mm) || !isFinite(direction) || !isFinite(up) || !isFinite(distance_mm) ||
      glm::length(direction) == 0.0 || distance_mm <= 0.0) {
    return;
  }
  off_axis_.reset();
  focus_mm_ = focus_mm;
  forward_ = glm::normalize(direction);
  distance_mm_ = distance_mm;
  Vec3 side = glm::cross(forward_, up);
  if (glm::length(side) <= 1e-6 * glm::length(up)) {
    side = glm::cross(forward_, std::abs(forward_.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, -1, 0));
  }
  up_ = glm::normalize(glm::cross(side, forward_));
}

void ViewCamera::lookThrough(const EyeView& eye_mm) {
  constexpr double kAhead_mm = 500.0;  // of a focus, which nothing in such a picture depends on
  const FieldOfView& sees = eye_mm.sees;
  if (!isFinite(eye_mm.pose) || !(sees.left < sees.right) || !(sees.down < sees.up)) return;
  const Quat& turn = eye_mm.pose.orientation;
  const Vec3 forward = turn * Vec3(0.0, 0.0, -1.0);
  lookAt(eye_mm.pose.position + kAhead_mm * forward, forward, turn * Vec3(0.0, 1.0, 0.0),
         kAhead_mm);
  parallel_ = false;
  off_axis_ = sees;
}

FieldOfView ViewCamera::sees(int width, int height) const {
  if (off_axis_) return *off_axis_;
  const double aside = kTan * double(width) / double(std::max(1, height));
  return {-aside, aside, -kTan, kTan};
}

ViewCamera::Direction ViewCamera::from(StandardView side) {
  switch (side) {
    case StandardView::anterior:
      return {Vec3(0, 1, 0), Vec3(0, 0, 1)};
    case StandardView::posterior:
      return {Vec3(0, -1, 0), Vec3(0, 0, 1)};
    case StandardView::left:
      return {Vec3(-1, 0, 0), Vec3(0, 0, 1)};
    case StandardView::right:
      return {Vec3(1, 0, 0), Vec3(0, 0, 1)};
    case StandardView::superior:
      return {Vec3(0, 0, -1), Vec3(0, -1, 0)};
    case StandardView::inferior:
      return {Vec3(0, 0, 1), Vec3(0, -1, 0)};
  }
  return {Vec3(0, 1, 0), Vec3(0, 0, 1)};
}

void ViewCamera::fit(const GridGeometry& geometry, const VoxelBox& box, const Vec3& direction,
                     const Vec3& view_up, int width, int height) {
  const auto voxel = [&](std::size_t axis, bool last) {
    return last ? double(box.high[axis] - 1) : double(box.low[axis]);
  };
  const Vec3 centre =
      geometry.toPatient_mm(0.5 * (Vec3(voxel(0, false), voxel(1, false), voxel(2, false)) +
                                   Vec3(voxel(0, true), voxel(1, true), voxel(2, true))));
  lookAt(centre, direction, view_up, 1.0);
  const double tan_right = kTan * double(width) / double(height);
  double distance = 1.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at = geometry.toPatient_mm(
                        Vec3(voxel(0, corner & 1), voxel(1, corner & 2), voxel(2, corner & 4))) -
                    centre;
    const double beside =
        std::max(std::abs(glm::dot(at, right())) / tan_right, std::abs(glm::dot(at, up())) / kTan);
    distance = std::max(distance, beside - glm::dot(at, forward()));
  }
  distance_mm_ = distance * 1.02;
}

void ViewCamera::orbit(double azimuth_deg, double elevation_deg, const Vec3& about_mm) {
  if (!isFinite(azimuth_deg) || !isFinite(elevation_deg) || !isFinite(about_mm)) return;
  const Quat turn = glm::angleAxis(glm::radians(azimuth_deg), up_) *
                    glm::angleAxis(glm::radians(-elevation_deg), right());
  lookAt(about_mm + turn * (focus_mm_ - about_mm), turn * forward_, turn * up_, distance_mm_);
}

void ViewCamera::zoom(double factor, double farthest_mm) {
  if (!isFinite(factor) || factor <= 0.0) return;
  distance_mm_ = std::clamp(distance_mm_ / factor, 1.0, std::max(1.0, farthest_mm));
}

void ViewCamera::pan(double right_pixels, double down_pixels, int height) {
  if (!isFinite(right_pixels) || !isFinite(down_pixels)) return;
  focus_mm_ += (up_ * down_pixels - right() * right_pixels) * mmPerPixelAt(focus_mm_, height);
}

double ViewCamera::halfHeight_mm() const {
  return distance_mm_ * kTan;
}

double ViewCamera::mmPerPixelAt(const Vec3& patient_mm, int height) const {
  if (parallel_) return 2.0 * halfHeight_mm() / double(std::max(1, height));
  const double depth_mm = std::max(1e-3, glm::dot(patient_mm - eye(), forward_));
  if (off_axis_) return depth_mm * (off_axis_->up - off_axis_->down) / double(std::max(1, height));
  return 2.0 * depth_mm * kTan / double(std::max(1, height));
}

std::optional<glm::dvec2> ViewCamera::pixelOf(const Vec3& patient_mm, int width, int height) const {
  const Vec3 at = patient_mm - eye();
  if (!isFinite(at) || (!parallel_ && glm::dot(at, forward_) < 1e-3)) return std::nullopt;
  if (off_axis_) {
    const FieldOfView& of = *off_axis_;
    const double depth = glm::dot(at, forward_);
    return glm::dvec2(width * (glm::dot(at, right()) / depth - of.left) / (of.right - of.left),
                      height * (glm::dot(at, up_) / depth - of.down) / (of.up - of.down));
  }
  const double mm = mmPerPixelAt(patient_mm, height);
  return glm::dvec2(0.5 * width + glm::dot(at, right()) / mm,
                    0.5 * height + glm::dot(at, up_) / mm);
}

ViewCamera::Ray ViewCamera::rayThrough(const glm::dvec2& pixel, int width, int height) const {
  if (off_axis_) {
    const FieldOfView& of = *off_axis_;
    const double aside = of.left + pixel.x / std::max(1, width) * (of.right - of.left);
    const double above = of.down + pixel.y / std::max(1, height) * (of.up - of.down);
    return {eye(), glm::normalize(forward_ + right() * aside + up_ * above)};
  }
  const double mm = 2.0 * halfHeight_mm() / double(std::max(1, height));
  const Vec3 beside =
      right() * ((pixel.x - 0.5 * width) * mm) + up_ * ((pixel.y - 0.5 * height) * mm);
  if (parallel_) return {eye() + beside, forward_};
  return {eye(), glm::normalize(forward_ * distance_mm_ + beside)};
}

std::optional<double> scaleBar_mm(double mm_per_pixel, double most_pixels) {
  const double most_mm = mm_per_pixel * most_pixels;
  if (!isFinite(most_mm) || most_mm < 1e-3 || most_mm > 1e6) return std::nullopt;
  const double ten = std::pow(10.0, std::floor(std::log10(most_mm)));
  for (const double times : {5.0, 2.0}) {
    if (times * ten <= most_mm) return times * ten;
  }
  return ten;
}

}  // namespace trephine
