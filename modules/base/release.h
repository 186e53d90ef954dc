// When this version was made.
#pragma once

namespace trephine {

extern const char* const kReleased;  // "2026-11-24"

}  // namespace trephine
