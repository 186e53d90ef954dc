// Internal to the room.
#pragma once

#include "base/result.h"
#include "plot/plot.h"

namespace trephine::plot {

// Whether a plot can be drawn at all. Error: BAD_ARGUMENT, see draw.
Status checked(const Plot& plot);

}  // namespace trephine::plot
