#include "plot/legend.h"

#include <algorithm>
#include <cmath>

#include "base/tr.h"

namespace trephine::plot {

namespace {

constexpr double kRow = 25.0, kSides = 24.0, kGap = 48.0;
constexpr double kCellWidth = 36.0, kCellHeight = 18.0, kLineWidth = 48.0, kText = 10.0;

struct Item {
  const Line* line = nullptr;
  const Band* band = nullptr;
  std::string text;
};

std::size_t itemCount(const Plot& plot) {
  const auto named = [](const auto& one) { return !one.legend.empty(); };
  return std::size_t(std::count_if(plot.lines.begin(), plot.lines.end(), named) +
                     std::count_if(plot.bands.begin(), plot.bands.end(), named));
}

bool hasValues(const Line& line) {
  return std::any_of(line.points.begin(), line.points.end(),
                     [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

bool hasValues(const Band& band) {
  return std::any_of(band.spans.begin(), band.spans.end(), [](const Band::Span& s) {
    return std::isfinite(s.x) && std::isfinite(s.low) && std::isfinite(s.high);
  });
}

std::vector<Item> itemsOf(const Plot& plot, const Seen& seen) {
  const auto textOf = [](const auto& one, bool is_seen) {
    if (is_seen) return one.legend;
    return one.legend + (hasValues(one) ? tr(": outside of these axes") : tr(": no values"));
  };
  std::vector<Item> items;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const Line& line = plot.lines[i];
    if (!line.legend.empty()) items.push_back({&line, nullptr, textOf(line, seen.lines[i])});
  }
  for (std::size_t i = 0; i < plot.bands.size(); ++i) {
    const Band& band = plot.bands[i];
    if (!band.legend.empty()) items.push_back({nullptr, &band, textOf(band, seen.bands[i])});
  }
  return items;
}

// The first row: what stands over the levels, over lines and bands.
bool headed(const Plot& plot) {
  const bool over_levels = plot.heat_map && !(plot.heat_map->heading.full.empty() &&
                                              plot.heat_map->heading.brief.empty());
  return over_levels || (!plot.legend_heading.empty() && itemCount(plot) > 0);
}

}  // namespace

double legendHeight(const Plot& plot) {
  const std::size_t levels = plot.heat_map ? plot.heat_map->levels.size() : 0;
  const std::size_t rows = std::max(levels, itemCount(plot));
  return rows == 0 ? 0.0 : kRow * double(rows + (headed(plot) ? 1 : 0));
}

void drawLegend(Canvas& canvas, const Plot& plot, double top, double width,
                const std::string& cells_bear, const Seen& seen) {
  const QColor ink = canvas.colour(Tone::ink);
  const std::vector<Item> items = itemsOf(plot, seen);
  const double first = headed(plot) ? top : top - kRow;
  double left = kSides;
  if (plot.heat_map) {
    const double most = (items.empty() ? 1.0 : 0.5) * width - 2.0 * kSides;
    double widest = std::min(most, canvas.sizeOf(cells_bear, {16.0, true}).width());
    canvas.text({left, top}, Side::left, cells_bear, {16.0, true}, ink, most + 1.0);
    double row = first;
    for (const HeatMap::Level& level : plot.heat_map->levels) {
      row += kRow;
      canvas.cell({left, row - 0.5 * kCellHeight, kCellWidth, kCellHeight}, level.shape,
                  canvas.colour(level.tone));
      const double before = kCellWidth + kText;
      canvas.text({left + before, row}, Side::left, level.legend, {}, ink, most - before + 1.0);
      widest = std::max(widest, std::min(most, before + canvas.sizeOf(level.legend, {}).width()));
    }
    left += widest + kGap;
  }
  const double room = width - kSides - left - kLineWidth - kText;
  Font font;
  for (const Item& item : items) font = canvas.fitting(item.text, font, room);
  if (!items.empty()) {
    canvas.text({left, top}, Side::left, plot.legend_heading, {16.0, true}, ink,
                width - kSides - left);
  }
  double row = first;
  for (const Item& item : items) {
    row += kRow;
    if (item.line) {
      canvas.line({{left, row}, {left + kLineWidth, row}}, canvas.colour(item.line->tone),
                  item.line->width_px, item.line->dashes_px);
    } else {
      canvas.plate({left, row - 0.5 * kCellHeight, kLineWidth, kCellHeight},
                   bandFill(canvas.colour(item.band->tone)));
    }
    canvas.text({left + kLineWidth + kText, row}, Side::left, item.text, font, ink, room);
  }
}

}  // namespace trephine::plot
