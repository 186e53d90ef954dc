// The patient couch and the head holder in a CT: found on a coarse grid, removed at full
// resolution.
//
// A couch is told by its shape, never by its side: it is thin (at most about 6 mm), wide, far
// longer than an ear or a finger along the head-foot axis, outside the body, and not bone. Arms,
// hands and feet are solid; ears and skin hang on the head or body, which is kept with all that
// touches it. Where the couch itself touches the body, it is told apart only if it runs straight
// along the scan, as couches do. In doubt it stays. Not found at all: solid parts over 6 mm thick,
// a couch that is seen only where the body lies on it, and one that leans against the grid or bends
// where it touches the body.
//
// Pure functions; two threads inside.
#pragma once

#include <cstdint>
#include <vector>

#include "imaging/steps/coarse_grid.h"
#include "volume/volume.h"

namespace trephine {

struct CouchFinding {
  bool found = false;
  std::uint64_t voxels = 0;  // about how many voxels that are not air would go
  double length_mm = 0.0;    // of couch or holder along the head-foot axis
  double width_mm = 0.0;     // across that, of all its parts together

  // A cell of the coarse grid (coarse_grid.h) each: what removeCouch does there.
  enum Cell : std::uint8_t {
    keep,    // nothing
    remove,  // all becomes air
    share    // couch and patient meet here: looked at voxel by voxel
  };
  std::array<int, 3> axis{0, 1, 2};
  Index3 step{1, 1, 1};
  Index3 size{0, 0, 0};
  std::vector<std::uint8_t> cells;

  // For a preview: whether the voxel lies where all becomes air. The voxel lies in the volume.
  bool isCouch(int i, int j, int k) const {
    if (!found) return false;
    const Index3 voxel{i, j, k};
    const auto at = [&](std::size_t n) { return voxel[std::size_t(axis[n])] / step[n]; };
    return cells[(std::size_t(at(2)) * std::size_t(size[1]) + std::size_t(at(1))) *
                     std::size_t(size[0]) +
                 std::size_t(at(0))] == remove;
  }
};

// Holds at most about 10 MB. The second form saves time where findFace uses the same grid.
CouchFinding findCouch(const Volume& volume);
CouchFinding findCouch(const CoarseGrid& grid);

// Sets the couch to kAirHu; returns how many voxels that were not air (over -900 HU) went. Where
// couch and patient meet, what is denser than fat's edge (-300 HU) stays unless it is the straight
// couch itself, and so does everything within 2 mm of it. `finding` is of this very volume.
std::uint64_t removeCouch(Volume& volume, const CouchFinding& finding);

}  // namespace trephine
