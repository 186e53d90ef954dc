// What is shown of a session: of one that runs here, of one that is replayed, later of one that
// runs elsewhere. One thread, the owner's.
#pragma once

#include "exercise/exercise.h"
#include "haptics/haptic_loop.h"
#include "volume/grid.h"

namespace trephine {

class SessionView {
 public:
  virtual ~SessionView() = default;
  // As it began on its case: tissues with their labels, maps fixed in the patient. What was changed
  // since is in state(), but for numbers of tissues.
  virtual const Exercise& exercise() const = 0;
  // The newest state: poses, forces, counts, time. A copy: a later call does not change it.
  virtual LoopState state() = 0;
  // The voxels as they are now. What changed since they were looked at last are the grid's dirty
  // bricks, which a mirror takes (VolumeMirror::pull).
  virtual Grid& grid() = 0;
};

}  // namespace trephine
