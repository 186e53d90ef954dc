// What tells the viewer where he looks from and how large things are: a cross of the patient's axes
// in the lower left corner (L R, A P, S I), a scale bar in the lower right one. Pure.
#pragma once

#include "render/screen_lines.h"
#include "render/view_camera.h"

namespace trephine {

// A picture smaller than this, in pixels, has room for neither.
constexpr int kRoomForCues = 240;

void addOrientationCue(const ViewCamera& camera, int width, int height, ScreenLines& to);
// Its length holds in the plane of this place, orthographic everywhere.
void addScaleBar(const ViewCamera& camera, const Vec3& at_mm, int width, int height,
                 ScreenLines& to);

}  // namespace trephine
