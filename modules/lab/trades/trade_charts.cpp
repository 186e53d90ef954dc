#include "lab/trades/trade_charts.h"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/file.h"
#include "lab/common/chart_picture.h"
#include "render/display_probe.h"

namespace trephine {

namespace {

constexpr int kWidth = 1200, kHeight = 800;  // lengths on the page are pixels of the picture
constexpr float kLeft = 120.0f, kBottom = 110.0f, kAcross = 1000.0f, kUp = 550.0f;  // the plot
constexpr double kLogarithmicFrom = 20.0;

using Colour = std::array<unsigned char, 3>;
constexpr Colour kBlack{0, 0, 0}, kGrey{90, 90, 90}, kLine{225, 225, 225}, kBlue{0, 92, 175},
    kGreen{20, 140, 95}, kRed{165, 15, 38};

std::string number(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6);
  return std::string(text, end.ptr);
}

// 1, 2 or 5 times a power of ten, so that about `count` of them make up the range.
double roundStep(double range, int count) {
  const double raw = range / count;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= raw) return digit * decade;
  }
  return 10.0 * decade;
}

struct Chart {
  const Knob* knob = nullptr;  // null: one that the table does not know
  std::vector<TradeRow> rows;  // of one knob
  TradeAxis cost, error;
};

class Page : public vtkContextItem {
 public:
  static Page* New();
  vtkTypeMacro(Page, vtkContextItem);
  const Chart* chart = nullptr;

  bool Paint(vtkContext2D* painter) override {
    painter_ = painter;
    grid();
    bounds();
    curve();
    points();
    words();
    return true;
  }

 protected:
  Page() = default;

 private:
  float x(double cost) const { return kLeft + kAcross * float(chart->cost.at(cost)); }
  float y(double error) const { return kBottom + kUp * float(chart->error.at(error)); }

  void pen(const Colour& colour, float width = 1.0f) {
    painter_->GetPen()->SetColor(colour[0], colour[1], colour[2]);
    painter_->GetPen()->SetOpacity(255);
    painter_->GetPen()->SetWidth(width * kChartFine);
    painter_->GetPen()->SetLineType(vtkPen::SOLID_LINE);
  }
  void line(float x1, float y1, float x2, float y2) {
    painter_->DrawLine(x1 * kChartFine, y1 * kChartFine, x2 * kChartFine, y2 * kChartFine);
  }
  void dashes(float x1, float y1, float x2, float y2) {
    const float length = std::hypot(x2 - x1, y2 - y1);
    for (float from = 0.0f; from < length; from += 14.0f) {
      const float a = from / length, b = std::min(1.0f, (from + 8.0f) / length);
      line(x1 + a * (x2 - x1), y1 + a * (y2 - y1), x1 + b * (x2 - x1), y1 + b * (y2 - y1));
    }
  }
  enum class Side { left, centre, right };
  void text(float at_x, float at_y, const std::string& words, int size, const Colour& colour,
            Side side = Side::left, bool bold = false, double turned = 0.0, bool plate = false) {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToArial();
    look->SetBold(bold);
    look->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
    look->SetVerticalJustificationToCentered();
    if (side == Side::centre) look->SetJustificationToCentered();
    if (side == Side::right) look->SetJustificationToRight();
    look->SetOrientation(turned);
    // A long text is made smaller, not cut off.
    for (; size > 8; --size) {
      look->SetFontSize(size * kChartFine);
      painter_->ApplyTextProp(look);
      if (turned != 0.0) break;
      float bounds[4];
      painter_->ComputeStringBounds(words, bounds);
      if (bounds[2] / kChartFine <= float(kWidth) - 48.0f) break;
    }
    if (plate) {  // so that no line runs through the word
      float bounds[4];
      painter_->ComputeStringBounds(words, bounds);
      const float width = bounds[2] / kChartFine, height = float(size);
      painter_->GetPen()->SetLineType(vtkPen::NO_PEN);
      painter_->GetBrush()->SetColor(255, 255, 255, 255);
      painter_->DrawRect((side == Side::right ? at_x - width : at_x) * kChartFine,
                         (at_y - 0.5f * height) * kChartFine, width * kChartFine,
                         height * kChartFine);
    }
    painter_->DrawString(at_x * kChartFine, at_y * kChartFine, words);
  }

  void grid() {
    pen(kLine);
    for (const double tick : chart->cost.ticks) line(x(tick), kBottom, x(tick), kBottom + kUp);
    for (const double tick : chart->error.ticks) line(kLeft, y(tick), kLeft + kAcross, y(tick));
    pen(kGrey);
    for (const float up : {kBottom, kBottom + kUp}) line(kLeft, up, kLeft + kAcross, up);
    for (const float at : {kLeft, kLeft + kAcross}) line(at, kBottom, at, kBottom + kUp);
    for (const double tick : chart->cost.ticks) {
      text(x(tick), kBottom - 18.0f, number(tick), 16, kBlack, Side::centre);
    }
    for (const double tick : chart->error.ticks) {
      text(kLeft - 10.0f, y(tick), number(tick), 16, kBlack, Side::right);
    }
  }

  // What good enough is, where it lies within the plot.
  void bounds() {
    if (!chart->knob) return;
    pen(kRed, 1.5f);
    const double tolerance = chart->knob->tolerance;
    const double up = chart->error.at(tolerance);
    if (up > 0.0 && up < 1.0) {
      dashes(kLeft, y(tolerance), kLeft + kAcross, y(tolerance));
      text(kLeft + 8.0f, y(tolerance) + 12.0f, "tolerance " + number(tolerance), 14, kRed);
    }
    if (chart->knob->limited != "cost") return;
    const double across = chart->cost.at(chart->knob->limit);
    if (across > 0.0 && across < 1.0) {
      const float at = x(chart->knob->limit);
      dashes(at, kBottom, at, kBottom + kUp);
      text(at - 8.0f, kBottom + kUp - 14.0f, "at most " + number(chart->knob->limit), 14, kRed,
           Side::right);
    }
  }

  void curve() {
    // Settings that are numbers follow one another; words do not.
    const auto isNumber = [](const TradeRow& row) {
      return !row.setting.empty() && row.setting[0] >= '0' && row.setting[0] <= '9';
    };
    if (!std::all_of(chart->rows.begin(), chart->rows.end(), isNumber)) return;
    pen(kBlue, 1.5f);
    for (std::size_t n = 1; n < chart->rows.size(); ++n) {
      const TradeRow &a = chart->rows[n - 1], &b = chart->rows[n];
      line(x(a.cost), y(a.error), x(b.cost), y(b.error));
    }
  }

  void points() {
    for (const TradeRow& row : chart->rows) {
      const Colour& colour = row.recommended ? kGreen : kBlue;
      const float radius = row.recommended ? 10.0f : 6.0f;
      painter_->GetPen()->SetLineType(vtkPen::NO_PEN);
      painter_->GetBrush()->SetColor(colour[0], colour[1], colour[2], 255);
      painter_->DrawEllipse(x(row.cost) * kChartFine, y(row.error) * kChartFine,
                            radius * kChartFine, radius * kChartFine);
      const bool beyond = x(row.cost) > kLeft + 0.8f * kAcross;
      text(x(row.cost) + (beyond ? -13.0f : 13.0f), y(row.error) + (beyond ? -15.0f : 13.0f),
           row.setting, 16, row.recommended ? kGreen : kBlack, beyond ? Side::right : Side::left,
           row.recommended, 0.0, true);
    }
  }

  void words() {
    const TradeRow& first = chart->rows.front();
    const std::string title = chart->knob ? std::string(chart->knob->title) : first.knob;
    text(24.0f, 770.0f, title + ": error over cost", 26, kBlack, Side::left, true);
    text(24.0f, 736.0f, "Error against: " + first.reference, 16, kGrey);
    std::string rule = "Green: recommended, the cheapest that is good enough";
    if (chart->knob) {
      rule += " (error at most " + number(chart->knob->tolerance);
      if (!chart->knob->limited.empty()) {
        std::string name(chart->knob->limited);
        std::replace(name.begin(), name.end(), '_', ' ');
        rule += ", " + name + " at most " + number(chart->knob->limit);
      }
      rule += "), else the one with the least error";
    }
    text(24.0f, 710.0f, rule, 16, kGrey);
    text(kLeft + kAcross / 2.0f, kBottom - 58.0f, "Cost [" + first.cost_unit + "]", 18, kBlack,
         Side::centre);
    text(32.0f, kBottom + kUp / 2.0f, "Error [" + first.error_unit + "]", 18, kBlack, Side::centre,
         false, 90.0);
  }

  vtkContext2D* painter_ = nullptr;
};
vtkStandardNewMacro(Page);

Result<std::vector<Chart>> chartsOf(const std::vector<TradeRow>& rows) {
  std::vector<Chart> charts;
  for (const TradeRow& row : rows) {
    const bool possible =
        std::isfinite(row.error) && std::isfinite(row.cost) && row.error >= 0.0 && row.cost >= 0.0;
    if (!possible) {
      return Error{"BAD_ARGUMENT", "A row holds a figure that cannot be",
                   row.knob + " " + row.setting, "Errors and costs are 0 or above"};
    }
    auto chart = std::find_if(charts.begin(), charts.end(),
                              [&](const Chart& c) { return c.rows.front().knob == row.knob; });
    if (chart == charts.end()) chart = charts.insert(charts.end(), Chart());
    chart->rows.push_back(row);
  }
  if (charts.empty()) {
    return Error{"BAD_ARGUMENT", "There is no row to draw", "the trades", "Measure at least one"};
  }
  for (Chart& chart : charts) {
    std::vector<double> costs, errors;
    for (const TradeRow& row : chart.rows) {
      costs.push_back(row.cost);
      errors.push_back(row.error);
    }
    const auto knob = std::find_if(kKnobs.begin(), kKnobs.end(),
                                   [&](const Knob& k) { return k.id == chart.rows.front().knob; });
    if (knob != kKnobs.end()) chart.knob = &*knob;
    chart.cost = tradeAxis(costs);
    chart.error = tradeAxis(errors);
  }
  return charts;
}

}  // namespace

double TradeAxis::at(double value) const {
  return ((logarithmic ? std::log10(value) : value) - low) / (high - low);
}

TradeAxis tradeAxis(const std::vector<double>& values) {
  TradeAxis axis;
  if (values.empty()) return {false, 0.0, 1.0, {0.0, 1.0}};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  axis.logarithmic = *least > 0.0 && *most > kLogarithmicFrom * *least;
  if (!axis.logarithmic) {
    axis.high = *most > 0.0 ? 1.12 * *most : 1.0;
    const double step = roundStep(axis.high, 8);
    for (int n = 0; n * step <= axis.high; ++n) axis.ticks.push_back(n * step);
    return axis;
  }
  const double margin = 0.06 * std::log10(*most / *least);
  axis.low = std::log10(*least) - margin;
  axis.high = std::log10(*most) + margin;
  for (int decade = int(std::floor(axis.low)); decade <= axis.high; ++decade) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, decade);
      if (axis.at(value) >= 0.0 && axis.at(value) <= 1.0) axis.ticks.push_back(value);
    }
  }
  return axis;
}

Result<std::vector<std::filesystem::path>> writeTradeCharts(const std::vector<TradeRow>& rows,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress) {
  const Result<std::vector<Chart>> charts = chartsOf(rows);
  if (!charts) return charts.error();
  if (Status display = probeDisplay(); !display) return display.error();
  if (Status made = makeFolder(folder); !made) return made.error();
  std::vector<std::filesystem::path> files;
  for (const Chart& chart : *charts) {
    if (progress.cancelled()) {
      return Error{"CANCELLED", "The drawing of the charts was cancelled", folder.string(), ""};
    }
    vtkNew<Page> page;
    page->chart = &chart;
    const std::filesystem::path file = folder / ("trade-" + chart.rows.front().knob + ".png");
    const Picture picture = drawItems({page.GetPointer()}, kWidth, kHeight);
    if (Status written = writePng(picture, file); !written) return written.error();
    files.push_back(file);
  }
  return files;
}

}  // namespace trephine
