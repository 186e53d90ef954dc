#include <algorithm>

#include "lab/touch/tissue_measurement.h"
#include "plot/drawing.h"

namespace trephine {

Result<std::vector<std::filesystem::path>> drawTissue(const TissueMeasurement& measured,
                                                      const std::filesystem::path& out) {
  std::vector<std::filesystem::path> files;
  for (const TissueCurve& curve : measured.curves) {
    plot::Plot plot;
    plot.title = curve.experiment + ": " + curve.title;
    plot::Line line;
    line.legend = "demanded by the laws";
    double low_x = 1e300, high_x = -1e300, low_y = 0.0, high_y = 0.0;
    for (const auto& [x, y] : curve.points) {
      line.points.push_back({x, y});
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
    }
    if (line.points.empty()) continue;
    high_y = std::max(high_y, curve.high.value_or(high_y));
    if (curve.low || curve.high) {
      plot::Band band;
      const double low = curve.low.value_or(low_y), high = curve.high.value_or(high_y);
      band.spans = {{low_x, low, high}, {high_x, low, high}};
      band.tone = plot::Tone::quiet;
      band.legend = curve.band;
      plot.bands.push_back(band);
    }
    const double margin = 0.06 * (high_y - low_y);
    plot.x = {curve.x_title, curve.x_unit};
    plot.x.low = low_x;
    plot.x.high = high_x;
    plot.y = {curve.y_title, curve.y_unit};
    plot.y.low = low_y - margin;
    plot.y.high = high_y + margin;
    plot.lines.push_back(std::move(line));
    const std::filesystem::path file = out / (curve.experiment + ".png");
    if (Status written = plot::writePng(plot, plot::Theme::light, file); !written)
      return written.error();
    files.push_back(file);
  }
  return files;
}

}  // namespace trephine
