#pragma once

#include "base/result.h"

namespace trephine {

// Asks the X display for OpenGL before VTK does: VTK 9 ends the process where it finds none.
// Errors: NO_DISPLAY, NO_OPENGL.
Status probeDisplay();

}  // namespace trephine
