// The eye in the patient frame: in perspective, or orthographic, or one eye of two, which looks
// past the middle of its picture. Pure.
#pragma once

#include <optional>

#include "base/eye_view.h"
#include "base/math.h"
#include "volume/volume.h"

namespace trephine {

// Named for the side of the patient that is seen.
enum class StandardView { anterior, posterior, left, right, superior, inferior };

class ViewCamera {
 public:
  static constexpr double kViewAngle_deg = 30.0;  // from the picture's lower to its upper edge

  // `direction` points from the eye to the focus. What is not finite or has no length is ignored;
  // an `up` along the direction is replaced.
  void lookAt(const Vec3& focus_mm, const Vec3& direction, const Vec3& up, double distance_mm);
  // As one eye of two, until it is told where to look otherwise. Patient frame, mm.
  void lookThrough(const EyeView& eye_mm);
  bool offAxis() const { return off_axis_.has_value(); }
  // In a picture of this shape, in perspective.
  FieldOfView sees(int width, int height) const;
  // Where the eye looks and what is up in its picture, from this side: the patient upright, seen
  // from above and below with the face up.
  struct Direction {
    Vec3 forward, up;
  };
  static Direction from(StandardView side);
  // As near as every corner of this box of the volume's voxels allows, in a picture of this shape.
  void fit(const GridGeometry& geometry, const VoxelBox& box, const Vec3& direction, const Vec3& up,
           int width, int height);
  // To the right and upwards around this place, which stays where it is in the picture.
  void orbit(double azimuth_deg, double elevation_deg, const Vec3& about_mm);
  // Nearer by the factor, between 1 mm and `farthest_mm` from the focus.
  void zoom(double factor, double farthest_mm);
  // The picture moves right and down by pixels, in a picture of this height.
  void pan(double right_pixels, double down_pixels, int height);
  // Orthographic: what lies in the focus's plane keeps its size.
  void setParallel(bool parallel) { parallel_ = parallel; }
  bool parallel() const { return parallel_; }

  const Vec3& focus() const { return focus_mm_; }
  double distance_mm() const { return distance_mm_; }
  // Orthographic, it stands back, so that nothing of the volume lies behind it.
  Vec3 eye() const { return focus_mm_ - forward_ * (distance_mm_ + (parallel_ ? kBack_mm : 0.0)); }
  const Vec3& forward() const { return forward_; }
  const Vec3& up() const { return up_; }
  Vec3 right() const { return glm::cross(forward_, up_); }
  // Of the perspective eye: x to the right, y up, looks along -z.
  Pose pose_mm() const {
    return {focus_mm_ - forward_ * distance_mm_,
            glm::normalize(glm::quat_cast(Mat3(right(), up_, -forward_)))};
  }
  // Orthographic, the same everywhere.
  double mmPerPixelAt(const Vec3& patient_mm, int height) const;
  // Half of what the picture spans upwards in the focus's plane.
  double halfHeight_mm() const;

  // The pixel of a point, from the lower left corner, whole numbers at the pixels' corners. None
  // for a point beside or behind a perspective eye.
  std::optional<glm::dvec2> pixelOf(const Vec3& patient_mm, int width, int height) const;
  // Where the ray through a pixel starts and goes; of length 1.
  struct Ray {
    Vec3 from_mm{0.0};
    Vec3 direction{0.0};
  };
  Ray rayThrough(const glm::dvec2& pixel, int width, int height) const;

 private:
  static constexpr double kBack_mm = 2000.0;

  Vec3 focus_mm_{0.0};
  Vec3 forward_{0.0, 1.0, 0.0};
  Vec3 up_{0.0, 0.0, 1.0};
  double distance_mm_ = 500.0;
  bool parallel_ = false;
  std::optional<FieldOfView> off_axis_;
};

// A scale bar's length: 1, 2 or 5 times a power of ten, in mm, as long as `most_pixels` allow; none
// where a pixel's span is no number that can be drawn.
std::optional<double> scaleBar_mm(double mm_per_pixel, double most_pixels);

}  // namespace trephine
