// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <algorithm>
#include <array>
#include <cctype>

#include "render/gl_limits.h"

namespace trephine {

int largestVolumeEdge() {
  GLint edge = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &edge);
  return edge;
}

bool isSoftware(const std::string& driver) {
  std::string lower = driver;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return char(std::tolower(c)); });
  // Mesa's renderers that run on the processor, and those of others.
  constexpr std::array kNames{"llvmpipe",
                              "softpipe",
                              "software",
                              "swr",
                              "swiftshader",
                              "gdi generic",
                              "microsoft basic render"};
  return std::ranges::any_of(
      kNames, [&](const char* name) { return lower.find(name) != std::string::npos; });
}

}  // namespace trephine
