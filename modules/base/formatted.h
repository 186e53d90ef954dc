// Numbers in a sentence, after printf's formats. Any thread.
#pragma once

#include <cstdio>
#include <string>

namespace trephine {

// At most 299 characters; what is beyond is cut.
inline std::string formatted(const char* format, auto... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace trephine
