// Where pictures for two eyes show a small ball, against where theory puts it, and whether a
// picture that looks past its middle is a piece of a wider one.
#pragma once

#include "render/scene_renderer.h"

namespace trephine {

struct EyeGeometry {
  double disparity_error_px = 0.0;  // worst
  double vertical_error_px = 0.0;   // of one eye against the other, worst
  double psnr_to_crop_db = 0.0;     // least
};
// The renderer shows another volume from then on.
EyeGeometry measureEyeGeometry(SceneRenderer& renderer);

}  // namespace trephine
