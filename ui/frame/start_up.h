// What must be settled before the first widget.
#pragma once

#include "base/result.h"

namespace trephine {

// Chooses how Qt draws, sets the surface format of every view, and asks display and OpenGL, which
// Qt and VTK would end the process over. Before QApplication. Errors: NO_DISPLAY, NO_OPENGL (then a
// window may be shown all the same, but no view).
Status prepareDisplay();

// Voxels go back to the system when they are let go of, instead of leaving holes in which the next
// case's have no room. Before the first case.
void prepareMemory();

// Milliseconds since the system started this process.
double msSinceProcessStart();

}  // namespace trephine
