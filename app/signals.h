// SIGHUP, SIGINT and SIGTERM, the same for every command of both programs.
#pragma once

#include "base/progress.h"

namespace trephine {

// From here on the first of these signals cancels `progress`, so that the work ends in order and
// closes what it writes. A second one (a second SIGTERM within 2 s is the first again), or 30 s of
// work that does not end, ends the program at once; files that are replaced as a whole are then as
// they were, a recording is readable. `progress` lives as long as the program.
void cancelOnSignals(Progress& progress);

// The signal once it came, else 0. The program then ends with 128 more.
int signalReceived();

}  // namespace trephine
