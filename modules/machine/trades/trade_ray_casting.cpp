// How the view casts its rays: the distance between samples, and whether surface and class are
// looked for.
#include <cstdio>

#include "base/codes.h"
#include "base/log.h"
#include "base/tr.h"
#include "machine/drawing/ray_settings.h"
#include "machine/trades/trade_knobs.h"
#include "render/codes.h"

namespace trephine {

std::string rayCastingSetting(double distance_voxels, bool plain) {
  char text[40];
  std::snprintf(text, sizeof text, "%s%g voxels", plain ? "plain, " : "", distance_voxels);
  return text;
}

TradeRows tradeRayCasting(const TradesOptions& options, const Progress& progress) {
  std::vector<RaySetting> settings;
  for (const bool plain : {false, true}) {
    for (const double distance : options.ray_distances) settings.push_back({distance, plain});
  }
  RaySettingOptions of;
  of.size = options.ray_picture;
  of.truth_step = options.reference_step;
  const auto figures = measureRaySettings(settings, of, progress);
  std::vector<TradeRow> rows;
  if (!figures &&
      (figures.error().code == code::kNoDisplay || figures.error().code == code::kNoOpengl)) {
    spdlog::warn("No ray casting: {}", figures.error().what);
    return rows;
  }
  if (!figures) return figures.error();
  for (const RaySettingFigures& f : *figures) {
    TradeRow row;
    row.knob = "ray_casting";
    row.setting = rayCastingSetting(f.setting.distance_voxels, f.setting.plain);
    row.error = f.wrong_class_percent;
    row.error_unit = "% of pixels of a wrong tissue";
    row.cost = f.ms;
    row.cost_unit = "ms a picture, " + std::to_string(options.ray_picture[0]) + "x" +
                    std::to_string(options.ray_picture[1]);
    row.reference = "the phantom's truth, from six directions";
    row.extra = {{"luminance_error_percent", f.luminance_error_percent},
                 {"picture_rms_percent", f.picture_rms_percent}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
