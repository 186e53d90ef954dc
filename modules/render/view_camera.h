// The eye: a perspective camera in the patient frame. Pure.
#pragma once

#include "base/math.h"
#include "volume/volume.h"

namespace trephine {

class ViewCamera {
 public:
  static constexpr double kViewAngle_deg = 30.0;  // from the picture's lower to its upper edge

  // `direction` points from the eye to the focus. What is not finite or has no length is ignored;
  // an `up` along the direction is replaced.
  void lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up, double distance_mm);
  // As near as every corner of the volume allows, in a picture of this shape.
  void fit(const GridGeometry& geometry, const Vec3& direction, const Vec3& up, int width,
           int height);
  // To the right and upwards around the focus.
  void orbit(double azimuth_deg, double elevation_deg);
  // Nearer by the factor, between 1 mm and `farthest_mm` from the focus.
  void zoom(double factor, double farthest_mm);
  // The picture moves right and down by pixels, in a picture of this height.
  void pan(double right_pixels, double down_pixels, int height);

  const Vec3& focus() const { return focus_mm_; }
  Vec3 eye() const { return focus_mm_ - forward_ * distance_mm_; }
  const Vec3& forward() const { return forward_; }
  const Vec3& up() const { return up_; }
  Vec3 right() const { return glm::cross(forward_, up_); }
  double mmPerPixelAt(const Vec3& patient_mm, int height) const;

 private:
  Vec3 focus_mm_{0.0};
  Vec3 forward_{0.0, 1.0, 0.0};
  Vec3 up_{0.0, 0.0, 1.0};
  double distance_mm_ = 500.0;
};

}  // namespace trephine
