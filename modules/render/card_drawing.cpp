// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <algorithm>
#include <utility>

#include "base/log.h"
#include "render/card_drawing.h"
#include "render/gl_program.h"

namespace trephine {

namespace {

constexpr const char* kCardVertex = R"(#version 150
in vec3 corner;   // place in the picture, -1 to 1 each way, and distance from the eye's plane
in vec2 texel;
out vec2 at;
out float away;
void main()
{
  at = texel;
  away = corner.z;
  gl_Position = vec4(corner.xy * corner.z, 0.0, corner.z);
}
)";

constexpr const char* kCard = R"(#version 150
uniform sampler2D card;
uniform sampler2D depths;
uniform bool shown;
uniform vec2 span;
uniform vec2 beyond;
in vec2 at;
in float away;
out vec4 colour;
void main()
{
  if (shown) {
    float opaque = texture(depths, (gl_FragCoord.xy + beyond) / span).g;
    if (away > opaque) discard;
  }
  colour = texture(card, at);
}
)";

}  // namespace

void CardDrawing::show(std::vector<Card> cards) {
  std::vector<Shown> next;
  for (Card& card : cards) {
    const auto before =
        std::ranges::find(cards_, card.name,
                          [](const Shown& shown) -> const std::string& { return shown.card.name; });
    Shown shown;
    if (before != cards_.end()) {
      shown.texture = std::exchange(before->texture, 0);
      shown.sent = before->sent && before->card.rgba == card.rgba;
    }
    shown.card = std::move(card);
    next.push_back(std::move(shown));
  }
  for (const Shown& gone : cards_) {
    if (gone.texture != 0) left_over_.push_back(gone.texture);
  }
  cards_ = std::move(next);
}

bool CardDrawing::prepare() {
  if (!left_over_.empty()) {
    glDeleteTextures(GLsizei(left_over_.size()), left_over_.data());
    left_over_.clear();
  }
  if (cards_.empty()) return false;
  if (refused_) return false;
  if (program_ == 0) {
    const Result<unsigned int> linked = linkProgram(kCardVertex, kCard, {"corner", "texel"});
    refused_ = !linked;
    if (refused_) {
      spdlog::warn("Cards cannot be drawn: {}", linked.error().where);
      return false;
    }
    program_ = *linked;
    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &buffer_);
  }
  return true;
}

void CardDrawing::send(Shown& shown) {
  if (shown.texture == 0) glGenTextures(1, &shown.texture);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shown.texture);
  if (std::exchange(shown.sent, true)) return;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, shown.card.width, shown.card.height, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, shown.card.rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void CardDrawing::draw(const ViewCamera& camera, int width, int height, const Canvas* volume,
                       const Span& span) {
  if (!prepare()) return;
  const FieldOfView sees = camera.sees(width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE);
  glViewport(0, 0, width, height);
  glUseProgram(program_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, volume ? volume->texture(1) : 0);
  glUniform1i(glGetUniformLocation(program_, "card"), 0);
  glUniform1i(glGetUniformLocation(program_, "depths"), 1);
  glUniform2f(glGetUniformLocation(program_, "span"), float(span.pixels.x), float(span.pixels.y));
  glUniform2f(glGetUniformLocation(program_, "beyond"), float(span.beyond.x), float(span.beyond.y));
  for (Shown& shown : cards_) {
    const Card& card = shown.card;
    if (card.width <= 0 || card.height <= 0) continue;
    send(shown);
    glUniform1i(glGetUniformLocation(program_, "shown"), volume && !card.before_all ? 1 : 0);
    const Vec3 right = card.pose_mm.orientation * Vec3(0.5 * card.width_mm, 0.0, 0.0);
    const Vec3 up =
        card.pose_mm.orientation * Vec3(0.0, 0.5 * card.width_mm * card.height / card.width, 0.0);
    float corners[4][5];
    for (int i = 0; i < 4; ++i) {
      const double x = i & 1 ? 1.0 : -1.0, y = i & 2 ? 1.0 : -1.0;
      const Vec3 at = card.pose_mm.position + x * right + y * up - camera.eye();
      const double away = glm::dot(at, camera.forward());
      // Behind the eye's plane, the clipping by w takes it; at it there is nothing to divide by.
      const double by = std::abs(away) < 1e-3 ? 1e-3 : away;
      const auto place = [by](double along, double low, double high) {
        return float(2.0 * (along / by - low) / (high - low) - 1.0);
      };
      const float values[5] = {place(glm::dot(at, camera.right()), sees.left, sees.right),
                               place(glm::dot(at, camera.up()), sees.down, sees.up), float(by),
                               float(0.5 + 0.5 * x), float(0.5 - 0.5 * y)};
      std::copy(std::begin(values), std::end(values), corners[i]);
    }
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STREAM_DRAW);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 5 * sizeof(float), nullptr);
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, 5 * sizeof(float),
                          reinterpret_cast<const void*>(3 * sizeof(float)));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_BLEND);
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(0);
  glUseProgram(0);
}

void CardDrawing::release() {
  for (Shown& shown : cards_) {
    if (shown.texture != 0) left_over_.push_back(shown.texture);
    shown.texture = 0;
    shown.sent = false;
  }
  if (!left_over_.empty()) glDeleteTextures(GLsizei(left_over_.size()), left_over_.data());
  left_over_.clear();
  if (program_ != 0) glDeleteProgram(program_);
  if (array_ != 0) glDeleteVertexArrays(1, &array_);
  if (buffer_ != 0) glDeleteBuffers(1, &buffer_);
  program_ = array_ = buffer_ = 0;
  refused_ = false;
}

}  // namespace trephine
