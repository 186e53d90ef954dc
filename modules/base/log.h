// Logging goes to stderr, never to stdout (which may hold JSON), and never from the tick.
// No patient's name, folder or file name may be logged: log counts, codes and sizes.
#pragma once

#include <spdlog/spdlog.h>

namespace trephine {

// Sends the default logger to stderr. Called once by each program's main.
void setUpLog(bool quiet);

}  // namespace trephine
