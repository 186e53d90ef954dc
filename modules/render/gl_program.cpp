// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "render/gl_program.h"

namespace trephine {

Result<unsigned int> linkProgram(const char* vertex, const char* fragment,
                                 std::initializer_list<const char*> inputs) {
  const unsigned int program = glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair(GL_VERTEX_SHADER, vertex), std::pair(GL_FRAGMENT_SHADER, fragment)}) {
    const unsigned int shader = glCreateShader(GLenum(kind));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  GLuint number = 0;
  for (const char* input : inputs) glBindAttribLocation(program, number++, input);
  glBindFragDataLocation(program, 0, "colour");
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  char why[512] = {};
  glGetProgramInfoLog(program, sizeof why, nullptr, why);
  glDeleteProgram(program);
  return Error{code::kNoOpengl, tr("The graphics driver refuses a shader"), why,
               tr("Update the graphics driver")};
}

}  // namespace trephine
