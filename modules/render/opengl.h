// OpenGL's functions, loaded by VTK. VTK renamed the loader's header in 9.4. In .cpp files only,
// and before any other header that knows OpenGL.
#pragma once

#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
