// The small picture by which a case is known again: a skull, never a face; else a slice. Pure, no
// OpenGL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "imaging/steps/anatomy.h"
#include "volume/volume.h"

namespace trephine {

struct CasePicture {
  static constexpr int kWidth = 256, kHeight = 192;
  std::vector<std::uint8_t> rgb{};  // three bytes a pixel, rows from above
};

// Of a head: its bone, from behind and the left and from above, by where a ray first meets the
// largest piece of bone (250 HU), so that couch, holder and skin are not in it. Of all else, and of
// a head without bone: a coronal slice through the middle of the body, in a window for soft tissue,
// as one sees a patient who faces one; where the scan is too short for that, an axial one. Spacings
// and axes are those of the volume. Below half a second for 512 x 512 x 300, on two threads.
// The volume has a voxel at least on each axis. std::bad_alloc where there is no memory.
CasePicture casePicture(const Volume& volume, BodyRegion region);

// The bytes of a PNG; none of a picture without pixels. Says in its text that it is for training,
// not for diagnosis or treatment planning.
std::string pngOf(const CasePicture& picture);

}  // namespace trephine
