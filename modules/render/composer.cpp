// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <string>
#include <vector>

#include "base/tr.h"
#include "render/composer.h"
#include "render/gl_program.h"

namespace trephine {

namespace {

constexpr const char* kWhole = R"(#version 150
in vec2 place;
void main() { gl_Position = vec4(place, 0.0, 1.0); }
)";

// Dark below, lighter above: tissue of any colour stands out.
constexpr const char* kVolume = R"(#version 150
uniform sampler2D volume;
uniform bool shown;
uniform vec2 span;
uniform vec2 beyond;
uniform float height;
uniform bool even;
out vec4 colour;
void main()
{
  vec3 back = mix(vec3(0.07, 0.075, 0.08), vec3(0.22, 0.225, 0.235), even ? 0.3 : gl_FragCoord.y / height);
  vec4 front = shown ? texture(volume, (gl_FragCoord.xy + beyond) / span) : vec4(0.0);
  colour = vec4(front.rgb + (1.0 - front.a) * back, 1.0);
}
)";

// The four rays around a pixel each say what they show with the tool among their samples; so a
// tool's edge at tissue is smooth in a coarse picture too.
constexpr const char* kTools = R"(#version 150
uniform sampler2D toolColour;
uniform sampler2D toolDepth;
uniform sampler2D volume;
uniform sampler2D depths;
uniform sampler2D before;
uniform bool shown;
uniform bool parallel;
uniform float opacity;
uniform vec2 range;
uniform vec2 span;
uniform vec2 beyond;
out vec4 colour;
void main()
{
  ivec2 here = ivec2(gl_FragCoord.xy);
  float d = texelFetch(toolDepth, here, 0).r;
  if (d >= 1.0) discard;
  vec3 tool = texelFetch(toolColour, here, 0).rgb;
  float t = parallel ? mix(range.x, range.y, d)
                     : range.x * range.y / (range.y - d * (range.y - range.x));
  if (!shown) { colour = vec4(tool, opacity); return; }
  ivec2 last = textureSize(volume, 0) - 1;
  vec2 at = (gl_FragCoord.xy + beyond) / span * vec2(textureSize(volume, 0)) - 0.5;
  vec2 low = floor(at);
  vec2 share = at - low;
  vec3 sum = vec3(0.0);
  float seen = 0.0;
  for (int corner = 0; corner < 4; ++corner)
  {
    ivec2 step = ivec2(corner & 1, corner >> 1);
    vec2 w = mix(1.0 - share, share, vec2(step));
    if (w.x * w.y < 0.001) continue;
    ivec2 ray = clamp(ivec2(low) + step, ivec2(0), last);
    vec2 met = texelFetch(depths, ray, 0).rg;
    vec4 front = vec4(0.0);
    if (t >= met.g) front = texelFetch(volume, ray, 0);
    else if (t >= met.r) front = texelFetch(before, ray, 0);
    sum += w.x * w.y * (front.rgb + (1.0 - front.a) * tool);
    seen += w.x * w.y * (1.0 - front.a);
  }
  if (seen < 0.02) discard;  // what is there stays: the tissue, or a line on it
  colour = vec4(sum, opacity);
}
)";

constexpr const char* kLineVertex = R"(#version 150
in vec2 place;
in vec3 edge;   // across, along, half width
in vec3 tint;
uniform vec2 size;
out vec3 at;
out float halfLength;
out vec3 shade;
in float reach;
void main()
{
  at = edge;
  halfLength = reach;
  shade = tint;
  gl_Position = vec4(place / size * 2.0 - 1.0, 0.0, 1.0);
}
)";

// Round ends, soft edges.
constexpr const char* kLine = R"(#version 150
in vec3 at;
in float halfLength;
in vec3 shade;
out vec4 colour;
void main()
{
  float away = length(vec2(at.x, max(0.0, abs(at.y) - halfLength)));
  colour = vec4(shade, clamp(at.z + 0.5 - away, 0.0, 1.0));
}
)";

constexpr double kRim = 1.6;  // pixels

void set(unsigned int program, const char* name, const glm::dvec2& value) {
  glUniform2f(glGetUniformLocation(program, name), float(value.x), float(value.y));
}
void set(unsigned int program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}

// Reads the texture at this unit.
void read(unsigned int program, const char* name, int unit, unsigned int texture) {
  glActiveTexture(GLenum(GL_TEXTURE0 + unit));
  glBindTexture(GL_TEXTURE_2D, texture);
  set(program, name, unit);
}

void plainState() {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace

unsigned int Composer::build(const char* fragment, const char* vertex) {
  const Result<unsigned int> linked =
      linkProgram(vertex, fragment, {"place", "edge", "tint", "reach"});
  if (linked) return *linked;
  failure_ =
      linked.error().where.empty() ? tr("a shader could not be linked") : linked.error().where;
  return 0;
}

bool Composer::prepare() {
  if (!failure_.empty()) return false;
  if (volume_ == 0) {
    volume_ = build(kVolume, kWhole);
    tools_ = build(kTools, kWhole);
    lines_ = build(kLine, kLineVertex);
    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &buffer_);
  }
  plainState();
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  return failure_.empty();
}

void Composer::quad(const PixelRect& part) {
  static const float corners[8] = {-1, -1, 1, -1, -1, 1, 1, 1};
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.low_x, part.low_y, part.width(), part.height());
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  for (unsigned int other = 1; other < 4; ++other) glDisableVertexAttribArray(other);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
  glUseProgram(0);
}

void Composer::drawVolume(const Canvas* volume, const Span& span, int width, int height,
                          Background background) {
  if (!prepare()) return;
  glViewport(0, 0, width, height);
  glUseProgram(volume_);
  read(volume_, "volume", 0, volume ? volume->texture(0) : 0);
  set(volume_, "shown", volume ? 1 : 0);
  set(volume_, "span", span.pixels);
  set(volume_, "beyond", span.beyond);
  glUniform1f(glGetUniformLocation(volume_, "height"), float(height));
  set(volume_, "even", background == Background::even ? 1 : 0);
  quad({0, 0, width, height});
}

void Composer::drawTools(const Canvas& tools, double opacity, const DepthRange& range,
                         const Canvas* volume, const Span& span, const PixelRect& part) {
  if (part.empty() || !prepare()) return;
  glViewport(0, 0, tools.width(), tools.height());
  glUseProgram(tools_);
  read(tools_, "toolColour", 0, tools.texture(0));
  read(tools_, "toolDepth", 1, tools.texture(1));
  read(tools_, "volume", 2, volume ? volume->texture(0) : 0);
  read(tools_, "depths", 3, volume ? volume->texture(1) : 0);
  read(tools_, "before", 4, volume ? volume->texture(2) : 0);
  set(tools_, "shown", volume ? 1 : 0);
  set(tools_, "parallel", range.parallel ? 1 : 0);
  glUniform1f(glGetUniformLocation(tools_, "opacity"), float(opacity));
  set(tools_, "range", {range.near_mm, range.far_mm});
  set(tools_, "span", span.pixels);
  set(tools_, "beyond", span.beyond);
  if (opacity < 1.0) glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE);
  quad(part);
  glDisable(GL_BLEND);
  glActiveTexture(GL_TEXTURE0);
}

void Composer::drawLines(const ScreenLines& lines, int width, int height) {
  if (lines.empty() || !prepare()) return;
  struct Corner {
    float x, y, across, along, half, r, g, b, reach;
  };
  std::vector<Corner> corners;
  const auto add = [&](const ScreenLine& line, double half, const Vec3& colour) {
    const glm::dvec2 way = line.to - line.from;
    const double length = glm::length(way);
    const glm::dvec2 along = length > 1e-9 ? way / length : glm::dvec2(1.0, 0.0);
    const glm::dvec2 across(-along.y, along.x);
    const glm::dvec2 middle = 0.5 * (line.from + line.to);
    const double far = half + 1.0, reach = 0.5 * length;
    Corner four[4];
    for (int i = 0; i < 4; ++i) {
      const double side = i & 1 ? far : -far, end = i & 2 ? reach + far : -reach - far;
      const glm::dvec2 at = middle + across * side + along * end;
      four[i] = {float(at.x),     float(at.y),     float(side),     float(end),  float(half),
                 float(colour.x), float(colour.y), float(colour.z), float(reach)};
    }
    for (const int i : {0, 1, 2, 2, 1, 3}) corners.push_back(four[i]);
  };
  for (const ScreenLine& line : lines) add(line, 0.5 * line.width + kRim, Vec3(0.03));
  for (const ScreenLine& line : lines) add(line, 0.5 * line.width, line.colour);

  glViewport(0, 0, width, height);
  glUseProgram(lines_);
  set(lines_, "size", {width, height});
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size() * sizeof(Corner)), corners.data(),
               GL_STREAM_DRAW);
  const auto field = [](unsigned int index, int count, std::size_t first) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(Corner),
                          reinterpret_cast<const void*>(first * sizeof(float)));
  };
  field(0, 2, 0);
  field(1, 3, 2);
  field(2, 3, 5);
  field(3, 1, 8);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(corners.size()));
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  glUseProgram(0);
}

void Composer::release() {
  for (const unsigned int program : {volume_, tools_, lines_}) {
    if (program) glDeleteProgram(program);
  }
  if (array_) glDeleteVertexArrays(1, &array_);
  if (buffer_) glDeleteBuffers(1, &buffer_);
  *this = Composer();
}

}  // namespace trephine
