#include "lab/headset/headset_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace trephine {

namespace {

constexpr int kEdge = 128;  // voxels
constexpr double kSpacing_mm = 0.5;
constexpr double kBall_mm = 30.0;  // a ball of tissue, and in it a small one
constexpr double kMarker_mm = 3.0;
const Vec3 kMarkerAt_mm(2.0, 14.0, 1.5);
// Outside of the box, inside it, and deep inside.
constexpr double kAway_mm[] = {150.0, 40.0, 20.0};
constexpr double kAside_mm = 31.5;
constexpr int kPixels = 480;

Volume balls() {
  Volume volume;
  volume.geometry.size = {kEdge, kEdge, kEdge};
  volume.geometry.spacing_mm = Vec3(kSpacing_mm);
  volume.geometry.origin_mm = Vec3(-0.5 * kSpacing_mm * (kEdge - 1));
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t index = 0; index < volume.hu.size(); ++index) {
    const Index3 v = volume.geometry.indicesOf(index);
    const Vec3 at = volume.geometry.toPatient_mm(Vec3(v[0], v[1], v[2]));
    volume.hu[index] = glm::distance(at, kMarkerAt_mm) < kMarker_mm ? 2500
                       : glm::length(at) < kBall_mm                 ? 300
                                                                    : kAirHu;
  }
  return volume;
}

TissueSet tissues(double of_the_ball) {
  Tissue ball;
  ball.id = "ball";
  ball.hu_min = 0;
  ball.hu_max = 1000;
  ball.colour = Vec3(0.8, 0.8, 0.75);
  ball.opacity = of_the_ball;
  Tissue marker = ball;
  marker.id = "marker";
  marker.hu_min = 1500;
  marker.hu_max = 3000;
  marker.colour = Vec3(1.0, 0.0, 0.0);
  marker.opacity = 1.0;
  return {"eyes", {ball, marker}};
}

// Looks along +y with z up, from this side of the marker.
EyeView eyeAt(double aside_mm, double away_mm, const FieldOfView& sees) {
  const Quat turn = glm::quat_cast(Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)));
  return {{Vec3(aside_mm, kMarkerAt_mm.y - away_mm, 0.0), turn}, sees};
}

std::optional<glm::dvec2> centreOfRed(const Picture& picture) {
  constexpr double kRed = 60.0;  // more than green and blue, where it is nothing else
  glm::dvec2 sum(0.0);
  double count = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p =
          picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
      // A pixel at its edge counts for a part, and how it is lit for nothing.
      const double part = std::clamp((double(p[0]) - std::max(p[1], p[2])) / kRed, 0.0, 1.0);
      sum += part * glm::dvec2(x + 0.5, picture.height - y - 0.5);
      count += part;
    }
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

// The middle of the outline that the small ball has in such a picture: of a ball of radius r at the
// depth d, aside by x, it is x d / (d^2 - r^2).
glm::dvec2 expected(const EyeView& eye) {
  const double depth = kMarkerAt_mm.y - eye.pose.position.y;
  const double by = depth / (depth * depth - kMarker_mm * kMarker_mm);
  const glm::dvec2 at =
      by * glm::dvec2(kMarkerAt_mm.x - eye.pose.position.x, kMarkerAt_mm.z - eye.pose.position.z);
  const FieldOfView& of = eye.sees;
  return double(kPixels) *
         glm::dvec2((at.x - of.left) / (of.right - of.left), (at.y - of.down) / (of.up - of.down));
}

Picture crop(const Picture& of, int x0, int y0, int width, int height) {
  Picture part;
  part.width = width;
  part.height = height;
  for (int y = y0; y < y0 + height; ++y) {
    const auto row = of.rgb.begin() + 3 * (std::ptrdiff_t(y) * of.width + x0);
    part.rgb.insert(part.rgb.end(), row, row + 3 * width);
  }
  return part;
}

}  // namespace

EyeGeometry measureEyeGeometry(SceneRenderer& renderer) {
  EyeGeometry found;
  found.psnr_to_crop_db = std::numeric_limits<double>::infinity();
  renderer.setTools({});
  renderer.setCards({});
  renderer.setVolume(Grid(balls()));
  renderer.setTissues(tissues(0.0));
  UploadProbe::setFirstTissue(renderer, true);  // without light, which would move its middle
  const FieldOfView left{-1.0, 0.75, -1.0, 0.75}, right{-0.75, 1.0, -1.0, 0.75};
  for (const double away_mm : kAway_mm) {
    // Near by, eyes as far apart as a person's would not both see it.
    const double aside_mm = std::min(kAside_mm, 0.2 * away_mm);
    std::optional<glm::dvec2> seen[2];
    glm::dvec2 theory[2];
    for (const int eye : {0, 1}) {
      const EyeView view = eyeAt(eye == 0 ? -aside_mm : aside_mm, away_mm, eye == 0 ? left : right);
      seen[eye] = centreOfRed(renderer.eyePicture(view, kPixels, kPixels));
      theory[eye] = expected(view);
    }
    constexpr double kNotSeen_px = 1e6;
    const bool both = seen[0] && seen[1];
    const double disparity =
        both ? std::abs((seen[0]->x - seen[1]->x) - (theory[0].x - theory[1].x)) : kNotSeen_px;
    const double vertical = both ? std::abs(seen[0]->y - seen[1]->y) : kNotSeen_px;
    found.disparity_error_px = std::max(found.disparity_error_px, disparity);
    found.vertical_error_px = std::max(found.vertical_error_px, vertical);
  }
  UploadProbe::setFirstTissue(renderer, false);
  renderer.setTissues(tissues(0.9));
  for (const double away_mm : kAway_mm) {
    for (const bool of_left : {true, false}) {
      constexpr int kPerUnit = 80;  // pixels for a tangent of 1
      constexpr int kPart = int(1.75 * kPerUnit);
      const double aside_mm = of_left ? -kAside_mm : kAside_mm;
      const Picture part =
          renderer.eyePicture(eyeAt(aside_mm, away_mm, of_left ? left : right), kPart, kPart);
      const Picture whole = renderer.eyePicture(eyeAt(aside_mm, away_mm, {-1.0, 1.0, -1.0, 1.0}),
                                                2 * kPerUnit, 2 * kPerUnit);
      const Picture of_whole = crop(whole, of_left ? 0 : kPerUnit / 4, kPerUnit / 4, kPart, kPart);
      found.psnr_to_crop_db = std::min(found.psnr_to_crop_db, psnr_dB(of_whole, part));
    }
  }
  return found;
}

}  // namespace trephine
