// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include "render/gl_limits.h"

namespace trephine {

int largestVolumeEdge() {
  GLint edge = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &edge);
  return edge;
}

bool isSoftware(const std::string& driver) {
  for (const char* name : {"llvmpipe", "softpipe", "Software"}) {
    if (driver.find(name) != std::string::npos) return true;
  }
  return false;
}

}  // namespace trephine
