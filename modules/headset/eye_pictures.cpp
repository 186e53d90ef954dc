#include "headset/eye_pictures.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <utility>

namespace trephine {

unsigned int EyePictures::framebuffer(std::size_t eye, int width, int height) {
  QOpenGLExtraFunctions& f = *QOpenGLContext::currentContext()->extraFunctions();
  const std::array<int, 2> size{width, height};
  if (std::exchange(sizes_[eye], size) == size) return framebuffers_[eye];
  if (textures_[eye] == 0) f.glGenTextures(1, &textures_[eye]);
  if (framebuffers_[eye] == 0) f.glGenFramebuffers(1, &framebuffers_[eye]);
  f.glBindTexture(GL_TEXTURE_2D, textures_[eye]);
  f.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  f.glBindTexture(GL_TEXTURE_2D, 0);
  f.glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[eye]);
  f.glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures_[eye], 0);
  return framebuffers_[eye];
}

void EyePictures::release() {
  QOpenGLExtraFunctions& f = *QOpenGLContext::currentContext()->extraFunctions();
  f.glDeleteTextures(2, textures_.data());
  f.glDeleteFramebuffers(2, framebuffers_.data());
  *this = {};
}

}  // namespace trephine
