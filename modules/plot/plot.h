// What a plot shows, as data: values, texts and the role of each colour. Lengths ending in _px are
// pixels of the picture; texts are UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plot/axis.h"

namespace trephine::plot {

// What a colour means; the theme says which it is.
enum class Tone : std::uint8_t {
  ink,
  quiet,
  series_1,
  series_2,
  series_3,
  series_4,
  good,
  bad,
  heat_1,  // the levels of a heat map, from good to bad, told apart by lightness too
  heat_2,
  heat_3,
  heat_4,
  heat_5,
};

// Values, in the axes' units. One that is not finite leaves a gap; one between two gaps is a dot.
struct Point {
  double x = 0.0, y = 0.0;
};

struct Line {
  std::vector<Point> points;
  Tone tone = Tone::series_1;
  double width_px = 1.5;               // above 0
  std::vector<double> dashes_px = {};  // ink and gap in turn, 1 at least; empty: solid
  std::string name = {};               // beside its right end; empty: none
  std::string legend = {};             // empty: not in the legend
};

// What lies between two lines. A value that is not finite leaves a gap.
struct Band {
  struct Span {
    double x = 0.0, low = 0.0, high = 0.0;
  };
  std::vector<Span> spans;
  Tone tone = Tone::series_1;
  std::string legend = {};
};

// A dashed line right across or right up, with its text beside it.
struct Guide {
  bool across = true;  // or up
  double at = 0.0;     // of the y axis, or of the x axis
  std::string text = {};
  Tone tone = Tone::bad;
};

// A disc with its text beside it.
struct Mark {
  Point at;
  std::string text = {};
  Tone tone = Tone::series_1;
  bool strong = false;  // larger, its text bold and first to find a place
};

// `brief` stands where `full` has no room.
struct Words {
  std::string full, brief;
};

enum class Shape : std::uint8_t { pill, rectangle, hexagon };

struct HeatMap {
  struct Level {
    Shape shape = Shape::rectangle;
    Tone tone = Tone::heat_1;
    std::string legend;
  };
  struct Cell {
    Point at;
    std::size_t level = 0;
    Words text = {};
  };
  // Where cells may lie, no two the same and ascending: the closest say how large the cells are.
  std::vector<double> columns, rows;
  std::vector<Cell> cells;
  std::vector<Level> levels;
  Words heading = {};  // over the levels in the legend: what the cells' texts are
};

struct Plot {
  int width_px = 1200, height_px = 800;
  std::string title = {};
  std::vector<std::string> notes = {};  // below the title, a row each
  Axis x, y;
  std::optional<HeatMap> heat_map = {};
  std::vector<Band> bands = {};
  std::vector<Line> lines = {};
  std::vector<Guide> guides = {};
  std::vector<Mark> marks = {};
  std::string legend_heading = {};  // over lines and bands
};

}  // namespace trephine::plot
