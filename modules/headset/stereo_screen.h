// Two eyes before a flat screen: a 3-D monitor, a projector, an older headset that is a second
// screen. Pure.
#pragma once

#include <array>

#include "base/eye_view.h"

namespace trephine {

// How both pictures share the screen's pixels, the left eye's first (left, or above).
enum class Packing {
  full,       // side by side, each as wide as it is seen: the screen is twice as wide as a picture
  half,       // side by side, each squeezed to half its width
  top_bottom  // one above the other, each squeezed to half its height
};

// In pixels, from the lower left corner.
struct EyeRect {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const EyeRect&, const EyeRect&) = default;
};
EyeRect rectOf(std::size_t eye, Packing packing, int width, int height);
// Of the picture as it is seen: its width in its height.
double aspectOf(Packing packing, int width, int height);

// What is at the screen's distance has no parallax; what is nearer is seen before it.
struct StereoScreen {
  double distance = 600.0;   // from between the eyes to the plane of no parallax
  double separation = 63.0;  // of the eyes, in the same unit
  double height = 320.0;     // of what is seen in that plane
  double aspect = 16.0 / 9.0;
};
// As large as what a head sees in the plane that it looks at, so that this plane is the screen's,
// and the eyes as far apart as the screen is away from who looks at it.
StereoScreen screenThrough(double focus_mm, double half_height_mm, double aspect, double eyes_mm,
                           double away_mm);
// In the frame of the head, which looks along -z, between the eyes.
Eyes eyesBefore(const StereoScreen& screen);
// The same of a head that is elsewhere.
Eyes eyesBefore(const StereoScreen& screen, const Pose& head);

// How far to the right of the left eye's picture the right eye's shows a point at this depth, of
// the picture's width: negative before the screen, positive behind it.
double parallaxAt(const StereoScreen& screen, double depth);

}  // namespace trephine
