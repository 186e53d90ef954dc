// The window's side of the exchange: textures to draw into, and fences between the two threads. Who
// draws is asked; this knows no exercise. The window's thread, with its OpenGL context current.
#pragma once

#include <functional>

#include "headset/picture_exchange.h"

namespace trephine {

class PicturePainter {
 public:
  // Into a framebuffer object of this size.
  using PaintEye =
      std::function<void(const EyeView& room_m, unsigned int framebuffer, int width, int height)>;
  // The panel as it is, out of this framebuffer object of this size.
  struct Panel {
    unsigned int framebuffer = 0;
    int width = 0, height = 0;
  };

  // Answers the newest request, where there is one. True where it drew.
  bool serve(PictureExchange& exchange, const PaintEye& paint_eye, const Panel& panel);
  // How long the last pair took [ms].
  double pair_ms() const { return pair_ms_; }
  // The left picture of that pair; it stays until the next is drawn. 0 before there is one.
  struct Left {
    unsigned int texture = 0;
    int width = 0, height = 0;
  };
  const Left& left() const { return left_; }
  // Once the headset's thread has ended: all that was made here goes.
  void release(PictureExchange& exchange);

 private:
  void fit(SharedPicture& picture, int width, int height, std::size_t count);

  unsigned int framebuffer_ = 0;
  double pair_ms_ = 0.0;
  Left left_;
};

}  // namespace trephine
