#pragma once

#include <string>

#include "base/result.h"

namespace trephine {

// Whether VTK can draw here. A child process tries it first, since VTK, Xlib and drivers end or
// hang a process in which they cannot; it is given 15 s. Once it could, it is not asked again.
// Render's thread. Errors: NO_DISPLAY, NO_OPENGL (none, or older than 3.2).
Status probeDisplay();
// What the driver that was tried calls itself (GL_RENDERER); empty before.
std::string probedRenderer();

// Of the context that is current: 32 for 3.2; 0 where there is none, or one older than 3.0.
int openGlVersion();
constexpr int kOpenGlNeeded = 32;
// `driver`: what it says of itself.
Error openGlTooOld(const std::string& driver);

}  // namespace trephine
