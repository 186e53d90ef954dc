// What a setting of the ray caster costs, and what it gets wrong: a plain one against a plain
// picture of 0.25 voxels, so that the pictures do not show what the truths bring.
#pragma once

#include <array>
#include <vector>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct RaySetting {
  double distance_voxels = 0.5;  // between samples, in the smallest edge of a voxel
  bool plain = false;            // without the truths of surface and class
};

struct RaySettingFigures {
  RaySetting setting;
  double ms = 0.0;                       // of a picture: the mean of bone, skin and liver
  double picture_rms_percent = 0.0;      // of 255, of the worst picture, against 0.25 voxels
  double wrong_class_percent = 0.0;      // of the cranium's pixels
  double luminance_error_percent = 0.0;  // of a shell of bone
};

struct RaySettingOptions {
  std::array<int, 2> size{800, 600};
  int repeats = 3;
  int truth_step = 3;  // every so many pixels, as `trephine-measure render` looks
};

// Pictures are of bone, of skin and of the shipped liver, each from its own view and from every
// side but below, where a head is one cut through the neck. Errors: NO_DISPLAY, NO_OPENGL,
// CANCELLED.
Result<std::vector<RaySettingFigures>> measureRaySettings(const std::vector<RaySetting>& settings,
                                                          const RaySettingOptions& options,
                                                          const Progress& progress = Progress());

}  // namespace trephine
