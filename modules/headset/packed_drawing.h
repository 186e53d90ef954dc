// The pictures of both eyes on one screen, as it wants them packed, through the lens before each.
// With the screen's OpenGL context current.
#pragma once

#include <array>

#include "headset/lens_profile.h"
#include "headset/stereo_screen.h"

namespace trephine {

class PackedDrawing {
 public:
  // Textures of the left and the right eye, into the framebuffer that is bound, of this size. What
  // a lens takes from beyond a picture's edge is black. False where the shader was refused.
  bool draw(const std::array<unsigned int, 2>& textures, Packing packing, const LensProfile& lens,
            int width, int height);
  void release();

 private:
  unsigned int program_ = 0, array_ = 0;
};

}  // namespace trephine
