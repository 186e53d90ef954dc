#include "lab/trades/trade_charts.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "plot/drawing.h"

namespace trephine {

namespace {

using plot::number;
using plot::Tone;

constexpr double kLogarithmicFrom = 20.0;

// Null: one that the table does not know.
const Knob* knobOf(const TradeRow& row) {
  const auto knob =
      std::find_if(kKnobs.begin(), kKnobs.end(), [&](const Knob& k) { return k.id == row.knob; });
  return knob == kKnobs.end() ? nullptr : &*knob;
}

// An extra figure's name ends in its unit.
std::string limitText(std::string_view figure, double limit, const std::string& cost_unit) {
  if (figure == "cost") return "cost at most " + number(limit) + " " + cost_unit;
  const std::size_t end = figure.rfind('_');
  std::string name(figure.substr(0, end)), unit(figure.substr(end + 1));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + " at most " + number(limit) + " " + (unit == "percent" ? "%" : unit);
}

std::string goodEnough(const Knob& knob, const TradeRow& row) {
  std::string text = "Good enough: error at most " + number(knob.tolerance) + " " + row.error_unit;
  for (const auto& [figure, limit] :
       {std::pair(knob.limited, knob.limit), std::pair(knob.also, knob.also_limit)}) {
    if (!figure.empty()) text += "; " + limitText(figure, limit, row.cost_unit);
  }
  return text;
}

// By knob, in the order of their first rows.
Result<std::vector<std::vector<TradeRow>>> byKnob(const std::vector<TradeRow>& rows) {
  std::vector<std::vector<TradeRow>> knobs;
  for (const TradeRow& row : rows) {
    const bool possible =
        std::isfinite(row.error) && std::isfinite(row.cost) && row.error >= 0.0 && row.cost >= 0.0;
    if (!possible) {
      return Error{code::kBadArgument, "A row holds a figure that cannot be",
                   row.knob + " " + row.setting, "Errors and costs are 0 or above"};
    }
    auto knob = std::find_if(knobs.begin(), knobs.end(),
                             [&](const auto& k) { return k.front().knob == row.knob; });
    if (knob == knobs.end()) knob = knobs.insert(knobs.end(), std::vector<TradeRow>());
    knob->push_back(row);
  }
  if (knobs.empty()) {
    return Error{code::kBadArgument, "There is no row to draw", "the trades",
                 "Measure at least one"};
  }
  return knobs;
}

}  // namespace

plot::Axis tradeAxis(const std::string& title, const std::string& unit,
                     const std::vector<double>& figures) {
  plot::Axis axis{title, unit};
  if (figures.empty()) return axis;
  const auto [least, most] = std::minmax_element(figures.begin(), figures.end());
  axis.logarithmic = *least > 0.0 && *most > kLogarithmicFrom * *least;
  if (axis.logarithmic) {
    const double margin = 0.06 * std::log10(*most / *least);
    axis.low = std::log10(*least) - margin;
    axis.high = std::log10(*most) + margin;
  } else {
    axis.high = *most > 0.0 ? 1.12 * *most : 1.0;
  }
  return axis;
}

plot::Plot tradeChart(const std::vector<TradeRow>& rows) {
  const TradeRow& first = rows.front();
  const Knob* knob = knobOf(first);
  plot::Plot chart;
  chart.title = (knob ? std::string(knob->title) : first.knob) + ": error over cost";
  chart.notes = {
      "Error against: " + first.reference,
      "Green, large and bold: recommended, the cheapest that is good enough, else the one with the "
      "least error",
      knob ? goodEnough(*knob, first) : ""};
  const std::string unit = knob && !knob->unit.empty() ? " " + std::string(knob->unit) : "";
  std::vector<double> costs, errors;
  plot::Line line;
  bool numbers = true;  // settings that are numbers follow one another; words do not
  for (const TradeRow& row : rows) {
    costs.push_back(row.cost);
    errors.push_back(row.error);
    line.points.push_back({row.cost, row.error});
    numbers = numbers && !row.setting.empty() && row.setting[0] >= '0' && row.setting[0] <= '9';
    chart.marks.push_back({{row.cost, row.error},
                           row.setting + unit,
                           row.recommended ? Tone::good : Tone::series_1,
                           row.recommended});
  }
  if (numbers) chart.lines.push_back(line);
  chart.x = tradeAxis("Cost", first.cost_unit, costs);
  chart.y = tradeAxis("Error", first.error_unit, errors);
  if (!knob) return chart;
  chart.guides.push_back(
      {true, knob->tolerance, "tolerance " + number(knob->tolerance) + " " + first.error_unit});
  if (knob->limited == "cost") {
    chart.guides.push_back(
        {false, knob->limit, "at most " + number(knob->limit) + " " + first.cost_unit});
  }
  return chart;
}

Result<std::vector<std::filesystem::path>> writeTradeCharts(const std::vector<TradeRow>& rows,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress) {
  const Result<std::vector<std::vector<TradeRow>>> knobs = byKnob(rows);
  if (!knobs) return knobs.error();
  if (Status made = makeFolder(folder); !made) return made.error();
  std::vector<std::filesystem::path> files;
  for (const std::vector<TradeRow>& knob : *knobs) {
    if (progress.cancelled()) {
      return Error{code::kCancelled, "The drawing of the charts was cancelled", folder.string(),
                   ""};
    }
    const std::filesystem::path file = folder / ("trade-" + knob.front().knob + ".png");
    if (Status written = plot::writePng(tradeChart(knob), plot::Theme::light, file); !written) {
      return written.error();
    }
    files.push_back(file);
  }
  return files;
}

}  // namespace trephine
