// A program of OpenGL in the context that is current; what it draws into is `colour`.
#pragma once

#include <initializer_list>

#include "base/result.h"

namespace trephine {

// `inputs` are the vertices' attributes, from 0 on. Errors: NO_OPENGL, with what the driver says.
Result<unsigned int> linkProgram(const char* vertex, const char* fragment,
                                 std::initializer_list<const char*> inputs);

}  // namespace trephine
