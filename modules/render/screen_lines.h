// Lines and letters over the picture: orientation, scale bar, handles, the way from a tool to the
// surface. Each has a dark rim, so that it can be read on bone and on air. Pure.
#pragma once

#include <string_view>
#include <vector>

#include "base/math.h"

namespace trephine {

// Pixels, from the lower left corner.
struct ScreenLine {
  glm::dvec2 from{0.0};
  glm::dvec2 to{0.0};
  Vec3 colour{1.0};
  double width = 1.5;  // without the rim
};

using ScreenLines = std::vector<ScreenLine>;

// Where words stand.
struct WordsBox {
  glm::dvec2 low{0.0}, high{0.0};
  bool overlaps(const WordsBox& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y &&
           other.low.y < high.y;
  }
};

// Words in strokes, `height` pixels high, their left lower corner at `at`: digits, point, hyphen,
// blank and the letters L R A P S I m; what else it holds is left blank.
void addWords(std::string_view words, const glm::dvec2& at, double height, const Vec3& colour,
              double width, ScreenLines& to);
double widthOfWords(std::string_view words, double height);
// A square around a point.
void addSquare(const glm::dvec2& at, double half, const Vec3& colour, double width,
               ScreenLines& to);

}  // namespace trephine
