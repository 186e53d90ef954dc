// Internal to plot/: callers from elsewhere ask draw (plot/drawing.h), which asks this first.
#pragma once

#include "base/result.h"
#include "plot/plot.h"

namespace trephine::plot {

// Whether a plot can be drawn at all. Error: BAD_ARGUMENT, for what draw lists but texts too large.
Status checked(const Plot& plot);

}  // namespace trephine::plot
