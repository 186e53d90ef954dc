// Normals that a picture shows of a sphere, beside the sphere's own.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/scene_renderer.h"

namespace trephine {

struct SphereNormal {
  Vec3 shown, truth;  // of length 1
  Vec3 ray;           // from the eye
};

// One for each pixel whose ray meets a sphere around the origin where the sphere's normal is at
// most 37 degrees off the view's axis (a sine of 0.6). `picture` is that renderer's, of normals as
// colour (UploadProbe). `hollow`: a sphere's wall that is seen from inside.
inline std::vector<SphereNormal> sphereNormals(const Picture& picture,
                                               const SceneRenderer& renderer, double radius_mm,
                                               bool hollow = false) {
  constexpr double kCentral = 0.6;
  const ViewCamera& camera = renderer.camera();
  const Vec3 right = camera.right(), up = camera.up(), forward = camera.forward();
  std::vector<SphereNormal> normals;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto [eye, ray] =
          camera.rayThrough({x + 0.5, picture.height - y - 0.5}, picture.width, picture.height);
      const double middle = -glm::dot(eye, ray);
      const double left = radius_mm * radius_mm - glm::dot(eye, eye) + middle * middle;
      if (left <= 0.0) continue;
      const double side = hollow ? -1.0 : 1.0;
      const Vec3 truth = side * glm::normalize(eye + ray * (middle - side * std::sqrt(left)));
      if (glm::length(truth - glm::dot(truth, forward) * forward) > kCentral) continue;
      const std::uint8_t* rgb =
          picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
      const auto part = [&](int channel) { return rgb[channel] / 127.5 - 1.0; };
      const Vec3 coded = right * part(0) + up * part(1) - forward * part(2);
      normals.push_back({coded / std::max(1e-9, glm::length(coded)), truth, ray});
    }
  }
  return normals;
}

inline double error_deg(const SphereNormal& normal) {
  return glm::degrees(std::acos(std::clamp(glm::dot(normal.shown, normal.truth), -1.0, 1.0)));
}

}  // namespace trephine
