// Now, by the workstation's clock and in its time zone.
#pragma once

#include <ctime>
#include <string>

namespace trephine {

// As strftime has it, of at most 63 characters; empty where it would be longer. Any thread.
inline std::string localTime(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm at{};
  ::localtime_r(&now, &at);
  char text[64];
  return {text, std::strftime(text, sizeof text, format, &at)};
}

}  // namespace trephine
