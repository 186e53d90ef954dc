#include "lab/stability/stability_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/codes.h"
#include "base/file.h"
#include "plot/drawing.h"

namespace trephine {

namespace {

using plot::Axis;
using plot::HeatMap;
using plot::Shape;
using plot::Tone;

// Shares of an axis between its end and the outer markers: half a marker and a little.
constexpr double kFringeX = 0.062, kFringeY = 0.05;
constexpr int kSamples = 900;  // of a curve: about one a pixel
constexpr double kMilli = 1000.0;

struct Stroke {
  Tone tone;
  std::vector<double> dashes_px;
};
// Told apart by their dashes as well.
const std::array<Stroke, 2> kGuides{{{Tone::ink, {}}, {Tone::ink, {3, 5}}}};
const std::array<Stroke, kMostCurves> kStrokes{{{Tone::series_1, {10, 6}},
                                                {Tone::series_2, {13, 5, 3, 5}},
                                                {Tone::series_3, {20, 5}},
                                                {Tone::series_4, {3, 4}}}};

// Told apart by shape and by lightness as well, for those who see colours otherwise.
const std::array<HeatMap::Level, 5> kLevels{{
    {Shape::pill, Tone::heat_1, "every cell stable"},
    {Shape::rectangle, Tone::heat_2, "up to a third unstable"},
    {Shape::rectangle, Tone::heat_3, "up to two thirds unstable"},
    {Shape::rectangle, Tone::heat_4, "more than two thirds unstable"},
    {Shape::hexagon, Tone::heat_5, "every cell unstable"},
}};

bool mixed(const MapBin& bin) {
  return bin.unstable > 0 && bin.unstable < bin.total;
}

std::size_t levelOf(const MapBin& bin) {
  if (!mixed(bin)) return bin.unstable == 0 ? 0 : 4;
  if (3 * bin.unstable <= bin.total) return 1;
  return 3 * bin.unstable <= 2 * bin.total ? 2 : 3;
}

plot::Words textOf(const MapBin& bin) {
  plot::Words words{std::to_string(bin.unstable) + "/" + std::to_string(bin.total), {}};
  if (!mixed(bin)) return words;  // the look says it
  const double share = 100.0 * double(bin.unstable) / double(bin.total);
  words.brief = std::to_string(std::clamp(int(std::lround(share)), 1, 99)) + "%";
  return words;
}

// From `low` to `high` decades with a fringe.
void stretch(Axis& axis, double low, double high, double fringe) {
  const double range = high - low;
  const double margin = range > 0.0 ? range * fringe / (1.0 - 2.0 * fringe) : 0.2;
  axis.low = low - margin;
  axis.high = high + margin;
}

Axis periodAxis(const std::vector<double>& periods_ms, bool exact) {
  Axis axis{"Sampling period T", "ms", true};
  stretch(axis, std::log10(periods_ms.front()), std::log10(periods_ms.back()), kFringeX);
  if (exact) axis.at = periods_ms;
  return axis;
}

double leastSpacing(const Axis& axis, const std::vector<double>& centres) {
  double least = 1.0;
  for (std::size_t i = 1; i < centres.size(); ++i) {
    least = std::min(least, axis.share(centres[i]) - axis.share(centres[i - 1]));
  }
  return least;
}

// The curves belong to the map too, at least where they end, unless that is far from all markers or
// would press these together.
Axis tissueAxis(const StabilityMap& map, const Axis& x) {
  constexpr double kFar = 2.0, kClosest = 0.04;  // decades; a share of the axis
  const double first = std::log10(map.tissues.front()), last = std::log10(map.tissues.back());
  double low = first, high = last;
  Axis axis{map.walls ? "Stiffness of the wall k" : "Damping of the tissue b",
            map.walls ? "N/m" : "N s/m", true};
  stretch(axis, low, high, kFringeY);
  if (map.tissues_exact) axis.at = map.tissues;
  for (const LimitCurve& limit : map.limits) {
    for (const double period_s : {map.periods.back(), std::pow(10.0, x.high) / kMilli}) {
      const double end = std::log10(limit.at(period_s));
      if (!(end > first - kFar && end < last + kFar)) continue;
      Axis wider = axis;
      stretch(wider, std::min(low, end), std::max(high, end), kFringeY);
      if (leastSpacing(wider, map.tissues) < kClosest) continue;
      low = std::min(low, end);
      high = std::max(high, end);
      axis = wider;
    }
  }
  return axis;
}

plot::Line lineOf(const LimitCurve& limit, const Stroke& stroke, const Axis& x) {
  plot::Line line{{}, stroke.tone, 2.5, stroke.dashes_px, limit.name, limit.legend};
  for (int i = 0; i <= kSamples; ++i) {
    const double period_ms = std::pow(10.0, x.low + (x.high - x.low) * i / kSamples);
    line.points.push_back({period_ms, limit.at(period_ms / kMilli)});
  }
  return line;
}

}  // namespace

plot::Plot plotOf(const StabilityMap& map) {
  plot::Plot page;
  page.width_px = 1200;
  page.height_px = 900;
  page.title = map.title;
  page.notes = {map.conditions, map.hands, map.note};
  page.legend_heading = "Published limits: stable below, without delay";
  page.heat_map.emplace();
  HeatMap& markers = *page.heat_map;
  for (const double period_s : map.periods) markers.columns.push_back(kMilli * period_s);
  markers.rows = map.tissues;
  markers.levels.assign(kLevels.begin(), kLevels.end());
  markers.heading = {"Markers: unstable / total", "Markers: percent unstable"};
  for (const MapBin& bin : map.bins) {
    markers.cells.push_back({{kMilli * bin.period_s, bin.tissue}, levelOf(bin), textOf(bin)});
  }
  page.x = periodAxis(markers.columns, map.periods_exact);
  page.y = tissueAxis(map, page.x);
  std::size_t guides = 0, others = 0;
  for (const LimitCurve& limit : map.limits) {
    page.lines.push_back(
        lineOf(limit, limit.guides ? kGuides[guides++] : kStrokes[others++], page.x));
  }
  return page;
}

Result<std::vector<std::filesystem::path>> writeStabilityMaps(const std::vector<MapCell>& cells,
                                                              const std::filesystem::path& folder,
                                                              const Progress& progress) {
  const Result<std::vector<StabilityMap>> maps = stabilityMaps(cells);
  if (!maps) return maps.error();
  if (Status made = makeFolder(folder); !made) return made.error();
  std::vector<std::filesystem::path> files;
  for (const StabilityMap& map : *maps) {
    if (progress.cancelled()) {
      return Error{code::kCancelled, "The drawing of the maps was cancelled", folder.string(), ""};
    }
    progress.at(double(files.size()) / double(maps->size()), map.file_name);
    const std::filesystem::path file = folder / map.file_name;
    if (Status written = plot::writePng(plotOf(map), plot::Theme::light, file); !written) {
      return written.error();
    }
    files.push_back(file);
  }
  progress.at(1.0, "done");
  return files;
}

}  // namespace trephine
