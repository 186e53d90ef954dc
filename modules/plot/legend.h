// Below the axes: what the cells' looks mean, beside it what the lines and bands are. Internal to
// the room.
#pragma once

#include <vector>

#include "plot/canvas.h"

namespace trephine::plot {

// For each whether any of it lies within the axes.
struct Seen {
  std::vector<bool> lines, bands;
};

// 0 where there is nothing to explain.
double legendHeight(const Plot& plot);

// Its first row at `top`. `cells_bear`: what the texts in the cells are, empty where they bear
// none.
void drawLegend(Canvas& canvas, const Plot& plot, double top, double width,
                const std::string& cells_bear, const Seen& seen);

}  // namespace trephine::plot
