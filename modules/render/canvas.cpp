// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include "render/canvas.h"

namespace trephine {

bool Canvas::bind(int width, int height, std::initializer_list<Image> images) {
  const bool made = framebuffer_ != 0 && width == width_ && height == height_;
  if (framebuffer_ == 0) glGenFramebuffers(1, &framebuffer_);
  bind();
  if (made) return true;
  while (glGetError() != GL_NO_ERROR) {
  }
  width_ = width;
  height_ = height;
  std::size_t at = 0;
  GLsizei colours = 0;
  GLenum buffers[3] = {};
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  for (const Image image : images) {
    unsigned int& texture = textures_[at++];
    if (texture == 0) glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    const GLint filter = image == Image::colour ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    GLenum attachment = GL_DEPTH_ATTACHMENT;
    if (image == Image::hidden_part) {
      glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, nullptr);
    } else {
      const bool colour = image == Image::colour;
      glTexImage2D(GL_TEXTURE_2D, 0, colour ? GL_RGBA8 : GL_RG32F, width, height, 0,
                   colour ? GL_RGBA : GL_RG, colour ? GL_UNSIGNED_BYTE : GL_FLOAT, nullptr);
      attachment = GLenum(GL_COLOR_ATTACHMENT0 + colours);
      buffers[colours++] = attachment;
    }
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  }
  glBindTexture(GL_TEXTURE_2D, GLuint(bound));
  glDrawBuffers(colours, buffers);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  const bool complete = glGetError() == GL_NO_ERROR &&
                        glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (!complete) width_ = height_ = 0;  // the same size is refused again
  return complete;
}

void Canvas::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

void Canvas::take(const Canvas& from, const PixelRect& part, const PixelRect& into) const {
  constexpr GLenum kAll[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  for (const GLenum image : kAll) {
    glReadBuffer(image);
    glDrawBuffers(1, &image);
    glBlitFramebuffer(part.low_x, part.low_y, part.high_x, part.high_y, into.low_x, into.low_y,
                      into.high_x, into.high_y, GL_COLOR_BUFFER_BIT,
                      image == GL_COLOR_ATTACHMENT1 ? GL_NEAREST : GL_LINEAR);
  }
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glDrawBuffers(3, kAll);
}

void Canvas::copyTo(unsigned int framebuffer) const {
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::vector<float> Canvas::readDepth_mm(const PixelRect& part) const {
  if (part.empty()) return {};
  std::vector<float> depth(std::size_t(part.pixels()));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(part.low_x, part.low_y, part.width(), part.height(), GL_GREEN, GL_FLOAT,
               depth.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  return depth;
}

void Canvas::release() {
  if (framebuffer_) glDeleteFramebuffers(1, &framebuffer_);
  for (const unsigned int texture : textures_) {
    if (texture) glDeleteTextures(1, &texture);
  }
  *this = Canvas();
}

}  // namespace trephine
