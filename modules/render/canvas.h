// An image on the GPU in which a still picture grows, strip by strip.
#pragma once

namespace trephine {

// Every method needs the context to be current. Rows go up, as OpenGL's do.
class Canvas {
 public:
  // Makes this the draw framebuffer, of this size; what it held is lost where the size changed.
  void bind(int width, int height);
  // Copies all of it into another framebuffer of the same size, and leaves that one bound.
  void copyTo(unsigned int framebuffer) const;
  void release();

 private:
  unsigned int framebuffer_ = 0;
  unsigned int colour_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace trephine
