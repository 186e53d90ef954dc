// A small scene, and what tests ask of its pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "render/scene_renderer.h"

namespace trephine::test {

constexpr int kWidth = 200, kHeight = 160;  // below the size at which the orientation cue is drawn

#define RENDERER_OR_SKIP(name)                                                      \
  auto name##_made = test::offscreenIfDisplay();                                    \
  if (!name##_made) GTEST_SKIP() << "No display: this test draws and reads pixels"; \
  ASSERT_TRUE(name##_made->ok()) << name##_made->error().sentence();                \
  SceneRenderer& name = ***name##_made

inline std::optional<Result<std::unique_ptr<SceneRenderer>>> offscreenIfDisplay() {
  const char* display = std::getenv("DISPLAY");
  if (!display || !*display) return std::nullopt;
  return SceneRenderer::offscreen(kWidth, kHeight);
}

inline Tissue tissue(const char* id, int low, int high, Vec3 colour, double opacity) {
  Tissue t;
  t.id = id;
  t.hu_min = low;
  t.hu_max = high;
  t.colour = colour;
  t.opacity = opacity;
  return t;
}

inline TissueSet tissues(double soft_opacity = 0.0, double bone_opacity = 0.9) {
  return {"test",
          {tissue("soft", -100, 199, Vec3(0.8, 0.5, 0.4), soft_opacity),
           tissue("bone", 300, 3000, Vec3(0.9, 0.9, 0.8), bone_opacity)}};
}

// A soft ball with a shell of bone inside, partial volumes at their edges, centred on 0.
inline Volume ball() {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {64, 60, 48};
  g.spacing_mm = Vec3(1.0, 1.0, 1.25);
  g.origin_mm = -0.5 * Vec3(63, 59, 47) * g.spacing_mm;
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const double depth = 28.0 - glm::length(g.toPatient_mm(Vec3(i, j, k)));
        const auto in = [&](double from) { return std::clamp(depth - from + 0.5, 0.0, 1.0); };
        volume.hu.push_back(std::int16_t(-1000 + 1040 * in(0) + 1000 * in(5) - 1000 * in(10)));
      }
    }
  }
  return volume;
}

// Where pixels differ: how many, and their centre of mass, x right and y down.
struct Difference {
  int pixels = 0;
  glm::dvec2 centre{0.0};
};
inline Difference difference(const Picture& a, const Picture& b, int threshold = 8) {
  Difference d;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c) {
        const std::size_t at = (std::size_t(y) * std::size_t(a.width) + std::size_t(x)) * 3 + c;
        most = std::max(most, std::abs(int(a.rgb[at]) - int(b.rgb[at])));
      }
      if (most < threshold) continue;
      ++d.pixels;
      d.centre += glm::dvec2(x, y);
    }
  }
  if (d.pixels) d.centre /= d.pixels;
  return d;
}

// The pixel on which a point falls, from the public camera alone.
inline glm::dvec2 pixelOf(const SceneRenderer& renderer, const Vec3& focus, const Vec3& point) {
  const Vec3 d = point - focus;
  const double mm = renderer.mmPerPixelAt(point);
  return {(kWidth - 1) / 2.0 + glm::dot(d, renderer.viewRight()) / mm,
          (kHeight - 1) / 2.0 - glm::dot(d, renderer.viewUp()) / mm};
}

inline void carve(Grid& grid, Vec3 centre, double radius, std::int16_t hu = kAirHu) {
  auto writer = grid.takeWriter();
  ASSERT_TRUE(writer.has_value());
  const GridGeometry& g = grid.geometry();
  for (std::size_t index = 0; index < g.voxelCount(); ++index) {
    const Index3 v = g.indicesOf(index);
    if (glm::distance(g.toPatient_mm(Vec3(v[0], v[1], v[2])), centre) < radius) {
      writer->store(index, hu);
    }
  }
}

}  // namespace trephine::test
