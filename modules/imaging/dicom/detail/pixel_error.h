// What every reader of pixels says: where and what to do are for the one who asked for them.
#pragma once

#include <string>
#include <utility>

#include "base/result.h"
#include "volume/codes.h"

namespace trephine {

inline Error unreadablePixels(std::string what) {
  return Error{code::kUnreadable, std::move(what), "", ""};
}

}  // namespace trephine
