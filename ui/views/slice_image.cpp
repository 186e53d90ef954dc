#include "ui/views/slice_image.h"

#include <algorithm>
#include <cmath>

namespace trephine {

HuWindow wholeRange(const SlicePicture& slice) {
  if (slice.hu.empty()) return kWideWindow;
  const auto [low, high] = std::ranges::minmax(slice.hu);
  return {0.5 * (double(low) + double(high)), std::max(1.0, double(high) - double(low))};
}

QImage windowed(const SlicePicture& slice, const HuWindow& window) {
  if (slice.columns <= 0 || slice.rows <= 0 ||
      slice.hu.size() != std::size_t(slice.columns) * std::size_t(slice.rows)) {
    return {};
  }
  const float black = float(window.centre_hu - window.width_hu / 2.0);
  const float scale = float(255.0 / window.width_hu);
  QImage image(slice.columns, slice.rows, QImage::Format_Grayscale8);
  const std::int16_t* hu = slice.hu.data();
  for (int row = 0; row < slice.rows; ++row) {
    uchar* line = image.scanLine(row);
    for (int column = 0; column < slice.columns; ++column) {
      line[column] = uchar(std::clamp((float(*hu++) - black) * scale + 0.5f, 0.0f, 255.0f));
    }
  }
  return image;
}

int mainAxis(const Vec3& direction) {
  const Vec3 size = glm::abs(direction);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

Mirroring mirroringOf(const Mat3& direction) {
  const Vec3 &across = direction[0], &down = direction[1];
  const double onwards = down[mainAxis(down)];
  return {across[mainAxis(across)] < 0.0, mainAxis(down) == 2 ? onwards > 0.0 : onwards < 0.0};
}

}  // namespace trephine
