#include "headset/picture_painter.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <chrono>

namespace trephine {

namespace {

QOpenGLExtraFunctions& gl() {
  return *QOpenGLContext::currentContext()->extraFunctions();
}

void forget(void*& fence) {
  if (fence) gl().glDeleteSync(static_cast<GLsync>(fence));
  fence = nullptr;
}

}  // namespace

void PicturePainter::fit(SharedPicture& picture, int width, int height, std::size_t count) {
  QOpenGLExtraFunctions& f = gl();
  if (framebuffer_ == 0) f.glGenFramebuffers(1, &framebuffer_);
  const bool same_size = picture.width == width && picture.height == height;
  picture.width = width;
  picture.height = height;
  for (std::size_t i = 0; i < count; ++i) {
    unsigned int& texture = picture.textures[i];
    if (texture != 0 && same_size) continue;
    if (texture == 0) f.glGenTextures(1, &texture);
    f.glBindTexture(GL_TEXTURE_2D, texture);
    f.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   nullptr);
    f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    f.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    f.glBindTexture(GL_TEXTURE_2D, 0);
  }
  // The second of a panel's would be of another size.
  if (count == 1 && !same_size && picture.textures[1] != 0) {
    f.glDeleteTextures(1, &picture.textures[1]);
    picture.textures[1] = 0;
  }
}

bool PicturePainter::serve(PictureExchange& exchange, const PaintEye& paint_eye,
                           const Panel& panel) {
  const std::optional<PictureRequest> request = exchange.asked();
  if (!request) return false;
  SharedPicture* picture = exchange.begin(request->of);
  if (!picture) return false;
  QOpenGLExtraFunctions& f = gl();
  // What was read of it last has to be read before it is drawn into; this waits on the card alone.
  if (picture->read) f.glWaitSync(static_cast<GLsync>(picture->read), 0, GL_TIMEOUT_IGNORED);
  forget(picture->read);
  forget(picture->drawn);
  const auto begun = std::chrono::steady_clock::now();
  const bool eyes = request->of == PictureRequest::Of::eyes;
  const int width = eyes ? request->width : panel.width;
  const int height = eyes ? request->height : panel.height;
  if (width <= 0 || height <= 0) {
    exchange.giveUp(*picture);
    return false;
  }
  fit(*picture, width, height, eyes ? 2 : 1);
  for (std::size_t i = 0; i < (eyes ? 2U : 1U); ++i) {
    f.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    f.glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             picture->textures[i], 0);
    if (eyes) {
      paint_eye(request->eyes_m[i], framebuffer_, width, height);
      continue;
    }
    f.glBindFramebuffer(GL_READ_FRAMEBUFFER, panel.framebuffer);
    f.glDisable(GL_SCISSOR_TEST);
    f.glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  f.glBindFramebuffer(GL_FRAMEBUFFER, 0);
  void* drawn = f.glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  f.glFlush();
  if (eyes) {
    pair_ms_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  }
  if (eyes) left_ = {picture->textures[0], width, height};
  exchange.finish(*picture, *request, drawn);
  return true;
}

void PicturePainter::release(PictureExchange& exchange) {
  QOpenGLExtraFunctions& f = gl();
  for (SharedPicture& picture : exchange.all()) {
    for (unsigned int& texture : picture.textures) {
      if (texture != 0) f.glDeleteTextures(1, &texture);
    }
    forget(picture.drawn);
    forget(picture.read);
    picture = {};
  }
  if (framebuffer_ != 0) f.glDeleteFramebuffers(1, &framebuffer_);
  framebuffer_ = 0;
  left_ = {};
}

}  // namespace trephine
