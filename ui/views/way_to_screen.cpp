#include "ui/views/way_to_screen.h"

#include "render/gl_limits.h"

namespace trephine {

WayToScreen wayToScreen(const std::string& renderer, const std::string& wanted) {
  if (wanted == "composed") return WayToScreen::composed;
  if (wanted == "copied") return WayToScreen::copied;
  return isSoftware(renderer) ? WayToScreen::copied : WayToScreen::composed;
}

}  // namespace trephine
