#include "ui/views/way_to_screen.h"

#include <algorithm>
#include <array>

namespace trephine {

namespace {

// Mesa's renderers that run on the processor, and those of others.
constexpr std::array kOfProcessors{"llvmpipe", "softpipe", "Software Rasterizer", "SWR",
                                   "SwiftShader", "GDI Generic"};

}  // namespace

WayToScreen wayToScreen(const std::string& renderer, const std::string& wanted) {
  if (wanted == "composed") return WayToScreen::composed;
  if (wanted == "copied") return WayToScreen::copied;
  const bool software = std::ranges::any_of(kOfProcessors, [&](const char* name) {
    return renderer.find(name) != std::string::npos;
  });
  return software ? WayToScreen::copied : WayToScreen::composed;
}

}  // namespace trephine
