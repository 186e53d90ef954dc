// When this version was made: a date that CMakeLists.txt sets (TREPHINE_RELEASED), not the time of
// the build.
#pragma once

namespace trephine {

extern const char* const kReleased;  // such as "2026-11-24"

}  // namespace trephine
