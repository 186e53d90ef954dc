#include "render/screen_lines.h"

namespace trephine {

namespace {

using Stroke = std::vector<glm::dvec2>;

constexpr double kAdvance = 0.85;  // from one letter to the next, in heights

// Strokes in a box 0.6 wide and 1 high, y up.
const std::vector<Stroke>& strokesOf(char letter) {
  static const std::vector<Stroke> none;
  static const std::vector<std::pair<char, std::vector<Stroke>>> all = {
      {'0',
       {{{0, .15},
         {0, .85},
         {.15, 1},
         {.45, 1},
         {.6, .85},
         {.6, .15},
         {.45, 0},
         {.15, 0},
         {0, .15}}}},
      {'1', {{{.1, .8}, {.3, 1}, {.3, 0}}, {{.1, 0}, {.5, 0}}}},
      {'2', {{{0, .85}, {.15, 1}, {.45, 1}, {.6, .85}, {.6, .6}, {0, 0}, {.6, 0}}}},
      {'3',
       {{{0, .9}, {.15, 1}, {.45, 1}, {.6, .85}, {.6, .65}, {.45, .52}, {.2, .52}},
        {{.45, .52}, {.6, .4}, {.6, .15}, {.45, 0}, {.15, 0}, {0, .1}}}},
      {'4', {{{.45, 0}, {.45, 1}, {0, .3}, {.6, .3}}}},
      {'5',
       {{{.55, 1},
         {.05, 1},
         {0, .55},
         {.4, .6},
         {.6, .45},
         {.6, .15},
         {.45, 0},
         {.15, 0},
         {0, .1}}}},
      {'6',
       {{{.5, 1},
         {.2, .85},
         {0, .5},
         {0, .15},
         {.15, 0},
         {.45, 0},
         {.6, .15},
         {.6, .4},
         {.45, .55},
         {.15, .55},
         {0, .4}}}},
      {'7', {{{0, 1}, {.6, 1}, {.2, 0}}}},
      {'8',
       {{{.15, .53},
         {0, .68},
         {0, .87},
         {.15, 1},
         {.45, 1},
         {.6, .87},
         {.6, .68},
         {.45, .53},
         {.15, .53},
         {0, .37},
         {0, .13},
         {.15, 0},
         {.45, 0},
         {.6, .13},
         {.6, .37},
         {.45, .53}}}},
      {'9',
       {{{.1, 0},
         {.4, .15},
         {.6, .5},
         {.6, .85},
         {.45, 1},
         {.15, 1},
         {0, .85},
         {0, .6},
         {.15, .45},
         {.45, .45},
         {.6, .6}}}},
      {'.', {{{.25, 0}, {.33, 0}}}},
      {'-', {{{.1, .5}, {.5, .5}}}},
      {'m',
       {{{0, 0}, {0, .6}},
        {{0, .48}, {.15, .6}, {.3, .48}, {.3, 0}},
        {{.3, .48}, {.45, .6}, {.6, .48}, {.6, 0}}}},
      {'L', {{{.05, 1}, {.05, 0}, {.6, 0}}}},
      {'R',
       {{{0, 0}, {0, 1}, {.45, 1}, {.6, .85}, {.6, .65}, {.45, .5}, {0, .5}}, {{.3, .5}, {.6, 0}}}},
      {'A', {{{0, 0}, {.3, 1}, {.6, 0}}, {{.12, .35}, {.48, .35}}}},
      {'P', {{{0, 0}, {0, 1}, {.45, 1}, {.6, .85}, {.6, .65}, {.45, .5}, {0, .5}}}},
      {'S',
       {{{.6, .85},
         {.45, 1},
         {.15, 1},
         {0, .85},
         {0, .65},
         {.15, .5},
         {.45, .5},
         {.6, .35},
         {.6, .15},
         {.45, 0},
         {.15, 0},
         {0, .15}}}},
      {'I', {{{.3, 0}, {.3, 1}}, {{.1, 1}, {.5, 1}}, {{.1, 0}, {.5, 0}}}},
  };
  for (const auto& [known, strokes] : all) {
    if (known == letter) return strokes;
  }
  return none;
}

}  // namespace

void addWords(std::string_view words, const glm::dvec2& at, double height, const Vec3& colour,
              double width, ScreenLines& to) {
  glm::dvec2 corner = at;
  for (const char letter : words) {
    for (const Stroke& stroke : strokesOf(letter)) {
      for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
        to.push_back({corner + stroke[i] * height, corner + stroke[i + 1] * height, colour, width});
      }
    }
    corner.x += kAdvance * height;
  }
}

double widthOfWords(std::string_view words, double height) {
  return words.empty() ? 0.0 : (double(words.size() - 1) * kAdvance + 0.6) * height;
}

void addSquare(const glm::dvec2& at, double half, const Vec3& colour, double width,
               ScreenLines& to) {
  const glm::dvec2 corners[4] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  for (int i = 0; i < 4; ++i)
    to.push_back({at + corners[i], at + corners[(i + 1) % 4], colour, width});
}

}  // namespace trephine
