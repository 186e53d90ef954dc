// How pictures that OpenGL draws get into the window.
#pragma once

#include <string>

namespace trephine {

enum class WayToScreen {
  composed,  // the graphics card puts views and panels together, the whole window for each picture
  copied     // a picture is read back and painted like any other widget: no more than it is redrawn
};

// `renderer`: what the driver calls itself (GL_RENDERER). A processor that draws has its pictures
// in memory anyway, and putting the whole window together would be its work, too; reading back from
// a graphics card would stop it for each picture. `wanted`: "composed" or "copied" where somebody
// decides for themselves (the environment's TREPHINE_VIEW); anything else decides nothing.
WayToScreen wayToScreen(const std::string& renderer, const std::string& wanted);

}  // namespace trephine
