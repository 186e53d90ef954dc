// A part of a grid into a texture in use. After the header that loads OpenGL.
#pragma once

#include <vtkTextureObject.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "render/label_shape.h"
#include "volume/volume.h"

namespace trephine {

// Tells OpenGL how the rows of a grid lie in memory, for as long as this lives.
class UnpackRows {
 public:
  explicit UnpackRows(const Index3& size) {
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, size[0]);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, size[1]);
  }
  ~UnpackRows() {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, alignment_);
  }
  UnpackRows(const UnpackRows&) = delete;
  UnpackRows& operator=(const UnpackRows&) = delete;

 private:
  GLint alignment_ = 4;
};

// How values of a type lie in a texture.
constexpr GLenum formatOf(const std::int16_t*) {
  return GL_RED;
}
constexpr GLenum formatOf(const LabelShape*) {
  return GL_RG;
}
constexpr GLenum formatOf(const std::uint8_t*) {
  return GL_RED;
}

// Sends a part of `grid`, of this size, into a texture that holds all of it from this slice on.
template <class Value>
void sendBox(vtkTextureObject& texture, const Value* grid, const Index3& size, const VoxelBox& box,
             int slice = 0) {
  const auto [i, j, k] = box.low;
  const UnpackRows layout(size);
  texture.Activate();
  glTexSubImage3D(
      GL_TEXTURE_3D, 0, i, j, slice + k, box.high[0] - i, box.high[1] - j, box.high[2] - k,
      formatOf(grid), std::is_same_v<Value, std::int16_t> ? GL_SHORT : GL_UNSIGNED_BYTE,
      grid + (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
          std::size_t(i));
}

// Sends values that lie tight, those of this box of one slice alone.
template <class Value>
void sendSlice(vtkTextureObject& texture, const Value* values, const VoxelBox& box) {
  const int wide = box.high[0] - box.low[0], high = box.high[1] - box.low[1];
  const UnpackRows layout({wide, high, 1});
  texture.Activate();
  glTexSubImage3D(GL_TEXTURE_3D, 0, box.low[0], box.low[1], box.low[2], wide, high, 1,
                  formatOf(values), GL_UNSIGNED_BYTE, values);
}

}  // namespace trephine
