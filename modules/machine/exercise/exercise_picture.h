// A picture of an exercise without a window.
#pragma once

#include <filesystem>

#include "base/result.h"
#include "session/session.h"

namespace trephine {

// Draws the session's volume as it is now, which began as `whole`, from the exercise's point of
// view, with its tools, and writes a PNG. Errors: NO_DISPLAY, NO_OPENGL, OUT_OF_MEMORY,
// CANNOT_WRITE.
Status writeExercisePicture(Session& session, const std::shared_ptr<const Volume>& whole,
                            const std::filesystem::path& file);

}  // namespace trephine
