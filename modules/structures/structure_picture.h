// A small picture of a structure as it lies in the patient: shaded, over the whole scan as an X-ray
// would show it, from the front. For report cards: which organ it is and where, at a glance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct ColourPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb{};  // three bytes a pixel, rows from above
};

// The patient's left is right, the head is up; along the grid's axes that are nearest to these.
// Any thread, two inside.
class StructurePictures {
 public:
  // The volume outlives this; `longest` (16 to 1024) is the longer side in pixels.
  StructurePictures(const Volume& volume, int longest);
  // Of the voxels with that label; the map is of the volume's grid. The scan alone where none has.
  ColourPicture of(const LabelMap& map, int label, const Vec3& colour) const;

 private:
  std::size_t indexAt(double across, double up, int depth) const;

  GridGeometry grid_;
  int width_ = 0, height_ = 0;  // of what is drawn, twice the picture's
  double pixel_mm_ = 1.0;
  Index3 axes_{0, 1, 2};          // of the grid: across, up, into the picture
  std::array<bool, 3> turned_{};  // against the picture's direction
  std::vector<float> xray_;       // 0 to 1
};

}  // namespace trephine
