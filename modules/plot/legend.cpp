#include "plot/legend.h"

#include <algorithm>

namespace trephine::plot {

namespace {

constexpr double kRow = 25.0, kMargin = 24.0, kGap = 48.0;
constexpr double kCellWidth = 36.0, kCellHeight = 18.0, kLineWidth = 48.0, kText = 10.0;

struct Item {
  const Line* line = nullptr;
  const Band* band = nullptr;
  std::string text;
};

std::vector<Item> itemsOf(const Plot& plot, const std::vector<bool>& seen) {
  std::vector<Item> items;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const Line& line = plot.lines[i];
    if (line.legend.empty()) continue;
    const bool outside = i < seen.size() && !seen[i];
    items.push_back({&line, nullptr, line.legend + (outside ? ": outside of these axes" : "")});
  }
  for (const Band& band : plot.bands) {
    if (!band.legend.empty()) items.push_back({nullptr, &band, band.legend});
  }
  return items;
}

}  // namespace

double legendHeight(const Plot& plot) {
  const std::size_t levels = plot.heat_map ? plot.heat_map->levels.size() : 0;
  const std::size_t rows = std::max(levels, itemsOf(plot, {}).size());
  return rows == 0 ? 0.0 : kRow * double(rows + 1);
}

void drawLegend(Canvas& canvas, const Plot& plot, double top, double width,
                const std::string& cells_bear, const std::vector<bool>& seen) {
  const QColor ink = canvas.colour(Tone::ink);
  double left = kMargin;
  if (plot.heat_map) {
    double widest = canvas.sizeOf(cells_bear, {16.0, true}).width();
    canvas.text({left, top}, Side::left, cells_bear, {16.0, true}, ink);
    double row = top;
    for (const HeatMap::Level& level : plot.heat_map->levels) {
      row += kRow;
      canvas.cell({left, row - 0.5 * kCellHeight, kCellWidth, kCellHeight}, level.shape,
                  canvas.colour(level.tone));
      canvas.text({left + kCellWidth + kText, row}, Side::left, level.legend, {}, ink);
      widest = std::max(widest, kCellWidth + kText + canvas.sizeOf(level.legend, {}).width());
    }
    left += widest + kGap;
  }
  const double room = width - kMargin - left - kLineWidth - kText;
  const std::vector<Item> items = itemsOf(plot, seen);
  Font font;
  for (const Item& item : items) font = canvas.fitting(item.text, font, room);
  if (!items.empty()) {
    canvas.text({left, top}, Side::left, plot.legend_heading, {16.0, true}, ink,
                width - kMargin - left);
  }
  double row = top;
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
