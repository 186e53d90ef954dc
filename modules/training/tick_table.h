// A recording as a table for other programs: a line a tick and arm.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "training/session_reader.h"

namespace trephine {

// tick, t_s and arm; position [m] and velocity [m/s]; f_e the demanded force, f_c the controller's
// and sent what went to the arm [N]; E_obs [J] and alpha the controller's. All at the device, in its
// axes, the forces on the arm: what the controller saw. Names as in the seed paper. Numbers are written so that they read
// back as they were. Errors: those of the recording and of the disk, CANCELLED.
Status writeTickTable(const SessionReader& recording, const std::filesystem::path& file,
                      const Progress& progress = Progress());

}  // namespace trephine
