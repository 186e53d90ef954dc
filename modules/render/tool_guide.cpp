#include "render/tool_guide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace trephine {

namespace {

const Vec3 kAhead(1.0, 1.0, 1.0);
constexpr double kNear_mm = 0.5;  // is there already, as exactly as the picture knows

// The working end looks along -z of the pose.
Vec3 pointing(const ToolView& tool) {
  return glm::normalize(tool.pose_mm.orientation) * Vec3(0, 0, -1);
}

double depthOf(const Vec3& at, const ViewCamera& camera) {
  return glm::dot(at - camera.eye(), camera.forward());
}

bool usable(const ToolView& tool) {
  return isFinite(tool.pose_mm) && glm::length(tool.pose_mm.orientation) > 0.0;
}

}  // namespace

double DepthPatch::at(const glm::dvec2& pixel) const {
  const glm::dvec2 ray = glm::floor((pixel + beyond) / step);
  const int x = int(ray.x) - rays.low_x, y = int(ray.y) - rays.low_y;
  if (x < 0 || y < 0 || x >= rays.width() || y >= rays.height()) return 1e9;
  return double(depth_mm[std::size_t(y) * std::size_t(rays.width()) + std::size_t(x)]);
}

PixelRect guideReach(const ToolView& tool, const ViewCamera& camera, int width, int height) {
  if (!usable(tool)) return {};
  const Vec3 tip = tool.pose_mm.position;
  const auto from = camera.pixelOf(tip, width, height);
  const auto to = camera.pixelOf(tip + pointing(tool) * kGuideReach_mm, width, height);
  if (!from || !to) return {};
  const glm::dvec2 low = glm::floor(glm::min(*from, *to)), high = glm::ceil(glm::max(*from, *to));
  const auto within = [](double value, int most) {
    return int(std::clamp(value, 0.0, double(most)));
  };
  return {within(low.x - 2, width), within(low.y - 2, height), within(high.x + 2, width),
          within(high.y + 2, height)};
}

std::optional<double> surfaceAhead_mm(const ToolView& tool, const DepthPatch& depth,
                                      const ViewCamera& camera, int width, int height) {
  if (!usable(tool)) return std::nullopt;
  constexpr double kStep_mm = 0.25;
  const Vec3 tip = tool.pose_mm.position, way = pointing(tool);
  for (double ahead = 0.0; ahead <= kGuideReach_mm; ahead += kStep_mm) {
    const Vec3 at = tip + way * ahead;
    const auto pixel = camera.pixelOf(at, width, height);
    if (!pixel) return std::nullopt;
    const double behind = depthOf(at, camera) - depth.at(*pixel);
    if (behind < 0.0) continue;
    // It came out of sight behind an edge, not through the surface there.
    if (behind > 3.0 * kStep_mm + 1.0) return std::nullopt;
    return ahead;
  }
  return std::nullopt;
}

void addGuide(const ToolView& tool, std::optional<double> ahead_mm, const ViewCamera& camera,
              int width, int height, bool at_left, std::vector<WordsBox>& taken, ScreenLines& to) {
  if (!usable(tool)) return;
  const auto tip = camera.pixelOf(tool.pose_mm.position, width, height);
  if (!tip) return;
  const double line = std::clamp(height / 700.0, 1.2, 3.0);
  if (tool.contact) {
    constexpr int kSides = 20;
    const double radius = 9.0 * line;
    for (int i = 0; i < kSides; ++i) {
      const auto corner = [&](int k) {
        const double angle = 2.0 * std::numbers::pi * k / kSides;
        return *tip + radius * glm::dvec2(std::cos(angle), std::sin(angle));
      };
      to.push_back({corner(i), corner(i + 1), tool.colour, line});
    }
    return;
  }
  if (!ahead_mm || *ahead_mm < kNear_mm) return;
  const auto met =
      camera.pixelOf(tool.pose_mm.position + pointing(tool) * *ahead_mm, width, height);
  if (!met) return;
  to.push_back({*tip, *met, kAhead, line});
  addSquare(*met, 3.0 * line, kAhead, line, to);
  char words[32];
  std::snprintf(words, sizeof words, "%.0f mm", *ahead_mm);
  const double letter = std::clamp(0.016 * height, 10.0, 24.0);
  const double aside = at_left ? -6.0 * line - widthOfWords(words, letter) : 6.0 * line;
  constexpr double kRoom = 0.4;  // around words, of a letter's height
  const glm::dvec2 room(kRoom * letter), size(widthOfWords(words, letter), letter);
  glm::dvec2 at = *met + glm::dvec2(aside, -0.5 * letter);
  const auto box = [&] { return WordsBox{at - 0.5 * room, at + size + 0.5 * room}; };
  for (std::size_t n = 0; n < taken.size(); ++n) {  // each may be in the way once
    const auto in_the_way =
        std::ranges::find_if(taken, [&](const WordsBox& one) { return one.overlaps(box()); });
    if (in_the_way == taken.end()) break;
    at.y = in_the_way->low.y - size.y - 0.6 * room.y;
  }
  taken.push_back(box());
  addWords(words, at, letter, kAhead, line, to);
}

}  // namespace trephine
