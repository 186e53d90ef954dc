#include "ui/views/way_to_screen.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace trephine {

namespace {

// Mesa's renderers that run on the processor, and those of others.
constexpr std::array kOfProcessors{"llvmpipe",    "softpipe",    "software rasterizer",   "swr",
                                   "swiftshader", "gdi generic", "microsoft basic render"};

}  // namespace

WayToScreen wayToScreen(const std::string& renderer, const std::string& wanted) {
  if (wanted == "composed") return WayToScreen::composed;
  if (wanted == "copied") return WayToScreen::copied;
  std::string lower = renderer;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return char(std::tolower(c)); });
  const bool software = std::ranges::any_of(
      kOfProcessors, [&](const char* name) { return lower.find(name) != std::string::npos; });
  return software ? WayToScreen::copied : WayToScreen::composed;
}

}  // namespace trephine
