#include "headset/stereo_screen.h"

namespace trephine {

EyeRect rectOf(std::size_t eye, Packing packing, int width, int height) {
  if (packing == Packing::top_bottom) {
    const int low = height / 2;
    return eye == 0 ? EyeRect{0, low, width, height - low} : EyeRect{0, 0, width, low};
  }
  const int left = width / 2;
  return eye == 0 ? EyeRect{0, 0, left, height} : EyeRect{left, 0, width - left, height};
}

double aspectOf(Packing packing, int width, int height) {
  return (packing == Packing::full ? 0.5 : 1.0) * double(width) / double(height);
}

StereoScreen screenThrough(double focus_mm, double half_height_mm, double aspect, double eyes_mm,
                           double away_mm) {
  return {focus_mm, eyes_mm * focus_mm / away_mm, 2.0 * half_height_mm, aspect};
}

Eyes eyesBefore(const StereoScreen& screen) {
  return eyesBefore(screen, Pose{});
}

Eyes eyesBefore(const StereoScreen& screen, const Pose& head) {
  Eyes eyes;
  const double half_width = 0.5 * screen.height * screen.aspect, half_height = 0.5 * screen.height;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const double aside = (eye == 0 ? -0.5 : 0.5) * screen.separation;
    eyes[eye].pose = head;
    eyes[eye].pose.position += head.orientation * Vec3(aside, 0.0, 0.0);
    eyes[eye].sees = {(-half_width - aside) / screen.distance,
                      (half_width - aside) / screen.distance, -half_height / screen.distance,
                      half_height / screen.distance};
  }
  return eyes;
}

double parallaxAt(const StereoScreen& screen, double depth) {
  return screen.separation * (1.0 - screen.distance / depth) / (screen.height * screen.aspect);
}

}  // namespace trephine
