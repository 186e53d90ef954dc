// Textures that both eyes' pictures are drawn into, for another screen. Of the OpenGL context that
// is current.
#pragma once

#include <array>
#include <cstddef>

namespace trephine {

class EyePictures {
 public:
  // The framebuffer of this eye's picture, of this size from here on.
  unsigned int framebuffer(std::size_t eye, int width, int height);
  const std::array<unsigned int, 2>& textures() const { return textures_; }
  void release();

 private:
  std::array<unsigned int, 2> textures_{}, framebuffers_{};
  std::array<std::array<int, 2>, 2> sizes_{};
};

}  // namespace trephine
