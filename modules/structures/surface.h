// A structure's surface, for other programs: closed, smooth, in the patient's LPS mm.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "base/result.h"
#include "volume/label_map.h"

namespace trephine {

struct SurfaceWritten {
  std::size_t triangles = 0;
  double ml = 0.0;  // that it encloses
};

// Binary STL of the voxels with this label: a surface half-way between voxels (VTK's flying edges),
// smoothed by a windowed sinc that shrinks nothing; where the structure ends with the scan it is
// closed there. Normals point out. Errors: EMPTY_STRUCTURE, CANNOT_WRITE (what was there stays),
// CANCELLED, OUT_OF_MEMORY.
Result<SurfaceWritten> writeSurface(const LabelMap& map, int label,
                                    const std::filesystem::path& file,
                                    const Progress& progress = Progress());

}  // namespace trephine
