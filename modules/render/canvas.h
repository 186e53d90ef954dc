// Images on the GPU that are drawn into and read by a later pass. VTK's own framebuffers are not
// used: theirs have the window's size and hold one picture.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "render/cast_plan.h"

namespace trephine {

// Every method needs the context to be current. Rows go up, as OpenGL's do.
class Canvas {
 public:
  enum class Image {
    colour,      // 8 bits each of RGBA, premultiplied
    depths_mm,   // two floats: first visible, opaque by half; 1e9: never
    hidden_part  // a depth buffer, 0 near to 1 far
  };

  // Makes this the framebuffer, with these images, of this size in device pixels; what they held is
  // lost where the size changed. A canvas has the same images each time: the list is looked at only
  // where the size changed. It sets no viewport and clears nothing. False when the GPU refused; it
  // is bound all the same.
  bool bind(int width, int height, std::initializer_list<Image> images);
  void bind() const;
  unsigned int framebuffer() const { return framebuffer_; }
  unsigned int texture(std::size_t image) const { return textures_[image]; }
  int width() const { return width_; }
  int height() const { return height_; }
  // Takes a part of another canvas into a part of this one, spread where that is larger: colours
  // evenly, depths from the nearest. Both hold colour, depths, colour. A part has a low and a high
  // corner, {low_x, low_y, high_x, high_y}; the high one is not in it. Afterwards `from` is bound
  // for reading and this one for drawing.
  void take(const Canvas& from, const PixelRect& part, const PixelRect& into) const;
  // Copies the first image into another framebuffer of the same size, and leaves that one bound.
  void copyTo(unsigned int framebuffer) const;
  // The second channel of the depths, which are the second image: mm from the eye's plane. Rows go
  // up. Of one pixel the part is {x, y, x + 1, y + 1}. Empty for no pixels. It stays bound for
  // reading.
  std::vector<float> readDepth_mm(const PixelRect& part) const;
  // Gives all of it back. There is no destructor: call this while the context is there.
  void release();

 private:
  unsigned int framebuffer_ = 0;
  std::array<unsigned int, 3> textures_{};
  int width_ = 0;
  int height_ = 0;
};

}  // namespace trephine
