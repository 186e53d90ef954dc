#include "headset/packed_drawing.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>

#include "base/log.h"

namespace trephine {

namespace {

constexpr const char* kCorners = R"(#version 150
out vec2 at;   // in the picture, 0 to 1
void main()
{
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
}
)";

// lens_profile.h has the formula.
constexpr const char* kLens = R"(#version 150
uniform sampler2D picture;
uniform float aspect;
uniform float axis;
uniform vec3 k;
uniform vec3 colours;
in vec2 at;
out vec4 shown;
float taken(vec2 away, float bend, int colour, out bool inside)
{
  vec2 from = (vec2(axis, 0.0) + away * (bend * colours[colour])) / vec2(2.0 * aspect, 2.0) + 0.5;
  inside = all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, vec2(1.0)));
  return texture(picture, from)[colour];
}
void main()
{
  vec2 away = (at - 0.5) * vec2(2.0 * aspect, 2.0) - vec2(axis, 0.0);
  float r2 = dot(away, away);
  float bend = 1.0 + r2 * (k.x + r2 * (k.y + r2 * k.z));
  shown = vec4(0.0, 0.0, 0.0, 1.0);
  for (int colour = 0; colour < 3; ++colour) {
    bool inside;
    float value = taken(away, bend, colour, inside);
    shown[colour] = inside ? value : 0.0;
  }
}
)";

QOpenGLExtraFunctions& current() {
  return *QOpenGLContext::currentContext()->extraFunctions();
}

unsigned int build() {
  QOpenGLExtraFunctions& f = current();
  const unsigned int program = f.glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair(GL_VERTEX_SHADER, kCorners), std::pair(GL_FRAGMENT_SHADER, kLens)}) {
    const unsigned int shader = f.glCreateShader(GLenum(kind));
    const char* source = text;
    f.glShaderSource(shader, 1, &source, nullptr);
    f.glCompileShader(shader);
    f.glAttachShader(program, shader);
    f.glDeleteShader(shader);
  }
  f.glLinkProgram(program);
  GLint linked = 0;
  f.glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  f.glDeleteProgram(program);
  spdlog::warn("Two pictures cannot be packed: their shader was refused");
  return 0;
}

}  // namespace

bool PackedDrawing::draw(const std::array<unsigned int, 2>& textures, Packing packing,
                         const LensProfile& lens, int width, int height) {
  QOpenGLExtraFunctions& f = current();
  if (program_ == 0) {
    program_ = build();
    f.glGenVertexArrays(1, &array_);
  }
  if (program_ == 0) return false;
  f.glDisable(GL_DEPTH_TEST);
  f.glDisable(GL_BLEND);
  f.glDisable(GL_SCISSOR_TEST);
  f.glDisable(GL_CULL_FACE);
  f.glViewport(0, 0, width, height);
  f.glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  f.glClear(GL_COLOR_BUFFER_BIT);
  f.glUseProgram(program_);
  f.glBindVertexArray(array_);
  f.glActiveTexture(GL_TEXTURE0);
  const auto place = [&](const char* name) { return f.glGetUniformLocation(program_, name); };
  f.glUniform1i(place("picture"), 0);
  f.glUniform1f(place("aspect"), float(aspectOf(packing, width, height)));
  f.glUniform3f(place("k"), float(lens.k[0]), float(lens.k[1]), float(lens.k[2]));
  f.glUniform3f(place("colours"), float(lens.colour[0]), float(lens.colour[1]),
                float(lens.colour[2]));
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const EyeRect rect = rectOf(eye, packing, width, height);
    f.glViewport(rect.x, rect.y, rect.width, rect.height);
    f.glUniform1f(place("axis"), float(eye == 0 ? lens.axis : -lens.axis));
    f.glBindTexture(GL_TEXTURE_2D, textures[eye]);
    f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    f.glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  f.glBindTexture(GL_TEXTURE_2D, 0);
  f.glBindVertexArray(0);
  f.glUseProgram(0);
  return true;
}

void PackedDrawing::release() {
  if (program_ != 0) current().glDeleteProgram(program_);
  if (array_ != 0) current().glDeleteVertexArrays(1, &array_);
  program_ = array_ = 0;
}

}  // namespace trephine
