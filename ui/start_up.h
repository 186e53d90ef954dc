// What must be settled before the first widget.
#pragma once

#include "base/result.h"

namespace trephine {

// Asks display and OpenGL, which Qt and VTK would end the process over, and sets the surface format
// of every view. Before QApplication. Errors: NO_DISPLAY, NO_OPENGL.
Status prepareDisplay();

// Milliseconds since the system started this process.
double msSinceProcessStart();

}  // namespace trephine
