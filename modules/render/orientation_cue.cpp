#include "render/orientation_cue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

namespace trephine {

namespace {

constexpr std::string_view kNames = "LRPASI";  // of the directions below, patient frame, LPS
const Vec3 kDirections[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const Vec3 kNear(1.0, 1.0, 1.0);
const Vec3 kFar(0.55, 0.57, 0.6);

}  // namespace

void addOrientationCue(const ViewCamera& camera, int width, int height, ScreenLines& to) {
  if (std::min(width, height) < kRoomForCues) return;
  const double radius = std::clamp(0.05 * height, 24.0, 64.0);
  const double letter = std::clamp(0.024 * height, 13.0, 32.0);
  const double line = std::clamp(height / 500.0, 1.5, 4.0);
  const glm::dvec2 centre(radius + 1.9 * letter, radius + 1.9 * letter);
  // The nearest last, over the others.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < 6; ++i) {
    order.emplace_back(-glm::dot(kDirections[i], camera.forward()), i);
  }
  std::sort(order.begin(), order.end());
  const auto wayOf = [&](std::size_t i) {
    return glm::dvec2(glm::dot(kDirections[i], camera.right()),
                      glm::dot(kDirections[i], camera.up()));
  };
  const auto middleOf = [&](std::size_t i) {
    const glm::dvec2 way = wayOf(i);
    return centre + way * (radius + 0.95 * letter);
  };
  // Its letter would lie on the cross, or behind the letter of what is nearer.
  const auto hasLetter = [&](std::size_t row) {
    if (glm::length(wayOf(order[row].second)) < 0.4) return false;
    for (std::size_t nearer = row + 1; nearer < order.size(); ++nearer) {
      if (glm::length(wayOf(order[nearer].second)) < 0.4) continue;
      const glm::dvec2 apart =
          glm::abs(middleOf(order[row].second) - middleOf(order[nearer].second));
      if (apart.x < 0.8 * letter && apart.y < 1.2 * letter) return false;
    }
    return true;
  };
  for (std::size_t row = 0; row < order.size(); ++row) {
    const auto [nearness, i] = order[row];
    const glm::dvec2 way = wayOf(i);
    // What points away from the eye is dimmer.
    const Vec3 colour = glm::mix(kFar, kNear, 0.5 + 0.5 * nearness);
    const double length = glm::length(way);
    if (length >= 0.2 || nearness > 0.0) {
      to.push_back({centre, centre + way * radius, 0.75 * colour, line});
    }
    if (!hasLetter(row)) continue;
    addWords(kNames.substr(i, 1), middleOf(i) - glm::dvec2(0.3, 0.5) * letter, letter, colour, line,
             to);
  }
}

void addScaleBar(const ViewCamera& camera, const Vec3& at_mm, int width, int height,
                 ScreenLines& to) {
  if (std::min(width, height) < kRoomForCues) return;
  const double mm = camera.mmPerPixelAt(at_mm, height);
  const std::optional<double> length_mm = scaleBar_mm(mm, 0.22 * width);
  if (!length_mm) return;
  const double line = std::clamp(height / 500.0, 1.5, 4.0);
  const double letter = std::clamp(0.018 * height, 11.0, 26.0);
  const glm::dvec2 end(width - 1.6 * letter, 1.6 * letter);
  const glm::dvec2 start(end.x - *length_mm / mm, end.y);
  const glm::dvec2 tick(0.0, 0.45 * letter);
  const Vec3 colour = kNear;
  to.push_back({start, end, colour, line});
  to.push_back({start - tick, start + tick, colour, line});
  to.push_back({end - tick, end + tick, colour, line});
  char words[32];
  std::snprintf(words, sizeof words, "%g mm", *length_mm);
  addWords(words, {0.5 * (start.x + end.x - widthOfWords(words, letter)), start.y + 0.8 * letter},
           letter, colour, line, to);
}

}  // namespace trephine
