// Puts the picture that is shown together: the volume over the background, tools in it where its
// depth leaves them visible, lines over all. OpenGL of our own, beside VTK.
#pragma once

#include <string>

#include "render/canvas.h"
#include "render/cast_plan.h"
#include "render/screen_lines.h"

namespace trephine {

// How many pixels of the window a picture of the volume spans, since its own may be larger, and how
// many of them lie left of and below the window.
struct Span {
  glm::dvec2 pixels{1.0};
  glm::dvec2 beyond{0.0};
};

// From a depth buffer's 0..1 to the distance from the eye's plane.
struct DepthRange {
  double near_mm = 1.0;
  double far_mm = 2.0;
  bool parallel = false;
};

// Every method needs the context to be current, and changes OpenGL's state behind VTK's back.
class Composer {
 public:
  // Lighter above and darker below, or even: what turns with a head cannot be brighter on one side.
  enum class Background { shaded, even };
  // The volume (null: none) over the background, into the framebuffer that is bound.
  void drawVolume(const Canvas* volume, const Span& span, int width, int height,
                  Background background = Background::shaded);
  // Tools into the picture that is there, inside this part of it. `tools` holds their colour and
  // depth and has the window's size. Tissue in front of a tool hides it, or tints it where it can
  // be seen through. With an opacity below 1 what is behind shines through.
  void drawTools(const Canvas& tools, double opacity, const DepthRange& range, const Canvas* volume,
                 const Span& span, const PixelRect& part);
  void drawLines(const ScreenLines& lines, int width, int height);
  void release();
  // Why the shaders could not be built; empty where they could.
  const std::string& failure() const { return failure_; }

 private:
  bool prepare();
  void quad(const PixelRect& part);
  unsigned int build(const char* fragment, const char* vertex);

  unsigned int volume_ = 0, tools_ = 0, lines_ = 0;  // programs
  unsigned int array_ = 0, buffer_ = 0;
  std::string failure_;
};

}  // namespace trephine
