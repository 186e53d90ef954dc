#include "machine/trades/trades_measurement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <locale>
#include <sstream>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "machine/trades/trade_knobs.h"

namespace trephine {

namespace {

constexpr double kRateUnit_hz = 160000.0;  // rates divide it: a whole number of steps in a period

Status check(const TradesOptions& options) {
  const auto bad = [](const std::string& what, const char* where) {
    return Error{code::kBadArgument, what, where, ""};
  };
  for (const auto& [counts, where] : {std::pair(&options.blade_points, "blade_points"),
                                      std::pair(&options.burr_points, "burr_points")}) {
    if (counts->empty()) return bad(tr("There must be a number of points to measure"), where);
    for (int count : *counts) {
      if (count < 2 || count > 1024) return bad(tr("A tool here has 2 to 1024 points"), where);
    }
  }
  if (options.rates_hz.empty()) return bad(tr("There must be a rate to measure"), "rates_hz");
  for (double rate_hz : options.rates_hz) {
    const double steps = kRateUnit_hz / rate_hz;
    if (!(rate_hz >= 100.0 && rate_hz <= 40000.0) || steps != std::floor(steps)) {
      return bad(tr("A rate lies between 100 and 40000 Hz and divides 160 kHz"), "rates_hz");
    }
  }
  if (options.grid < 32 || options.grid > 512 || options.grid % 4 != 0) {
    return bad(tr("The grid has 32 to 512 voxels along an edge, a multiple of 4"), "grid");
  }
  for (double distance : options.ray_distances) {
    if (!(distance >= 0.1 && distance <= 8.0)) {
      return bad(tr("Samples lie 0.1 to 8 voxels apart"), "ray_distances");
    }
  }
  if (!(options.stroke_s >= 0.2 && options.stroke_s <= 20.0)) {
    return bad(tr("A stroke takes 0.2 to 20 s"), "stroke_s");
  }
  if (options.strokes < 1 || options.strokes > 1000 || options.first_stroke < 0 ||
      options.first_stroke > 1'000'000) {
    return bad(tr("There are 1 to 1000 strokes"), "strokes");
  }
  return {};
}

constexpr const char* kTableFormat = "trephine.trades";

bool withinLimit(const Knob& knob, const TradeRow& row) {
  const auto within = [&row](std::string_view figure, double limit) {
    if (figure.empty()) return true;
    const double value = figure == "cost" ? row.cost : row.extraOf(figure);
    return value <= limit;  // NaN, a figure that is not there, is not
  };
  return within(knob.limited, knob.limit) && within(knob.also, knob.also_limit);
}

std::string toCsv(const TradesMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "knob,setting,error,error_unit,cost,cost_unit,recommended,extra,reference\n";
  for (const TradeRow& row : measurement.rows) {
    text << row.knob << ',' << row.setting << ',' << row.error << ",\"" << row.error_unit << "\","
         << row.cost << ",\"" << row.cost_unit << "\"," << (row.recommended ? 1 : 0) << ",\"";
    for (const auto& [name, value] : row.extra) text << name << '=' << value << ';';
    text << "\",\"" << row.reference << "\"\n";
  }
  return text.str();
}

Status writeTables(const TradesMeasurement& measurement, const std::filesystem::path& out) {
  if (Status csv = writeTextFile(out / "trades.csv", toCsv(measurement)); !csv) return csv;
  Json table = toJson(measurement);
  table["format"] = kTableFormat;
  table["version"] = 1;
  if (Status json = writeTextFile(out / "trades.json", table.dump(1) + "\n"); !json) return json;
  const Json recommended = toJson(recommendedOf(measurement.rows));
  return writeTextFile(out / "recommended.json", recommended.dump(2) + "\n");
}

}  // namespace

std::vector<RecommendedSetting> recommendedOf(const std::vector<TradeRow>& rows) {
  std::vector<RecommendedSetting> out;
  for (const TradeRow& row : rows) {
    if (!row.recommended) continue;
    out.push_back({row.knob, row.setting, row.error, row.error_unit, row.cost, row.cost_unit});
  }
  return out;
}

double TradeRow::extraOf(std::string_view name) const {
  for (const auto& [key, value] : extra) {
    if (key == name) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void recommend(std::vector<TradeRow>& rows) {
  for (const Knob& knob : kKnobs) {
    TradeRow* best = nullptr;
    // From what is asked to what is left: good enough, within the limit, any.
    using Order = bool (*)(const TradeRow&, const TradeRow&);
    const Order cheaper = [](const TradeRow& a, const TradeRow& b) { return a.cost < b.cost; };
    const Order truer = [](const TradeRow& a, const TradeRow& b) { return a.error < b.error; };
    const auto pick = [&](auto&& allowed, Order order) {
      for (TradeRow& row : rows) {
        if (row.knob != knob.id || !allowed(row)) continue;
        if (!best || order(row, *best)) best = &row;
      }
    };
    pick([&](const TradeRow& r) { return r.error <= knob.tolerance && withinLimit(knob, r); },
         cheaper);
    if (!best) pick([&](const TradeRow& r) { return withinLimit(knob, r); }, truer);
    if (!best) pick([](const TradeRow&) { return true; }, truer);
    if (best) best->recommended = true;
  }
}

Result<TradesMeasurement> measureTrades(const TradesOptions& options,
                                        const std::filesystem::path& out,
                                        const Progress& progress) {
  if (Status good = check(options); !good) return good.error();
  if (!out.empty()) {
    if (Status made = makeFolder(out); !made) return made.error();
  }
  const std::vector<std::pair<const char*, std::function<TradeRows()>>> knobs{
      {"points_blade",
       [&] { return tradePoints(ToolKind::blade, options.blade_points, options, progress); }},
      {"points_burr",
       [&] { return tradePoints(ToolKind::burr, options.burr_points, options, progress); }},
      {"force_at", [&] { return tradeForceAt(options, progress); }},
      {"rate_hz", [&] { return tradeRate(options, progress); }},
      {"grid", [&] { return tradeGrid(options, progress); }},
      {"ray_casting", [&] {
         return options.ray_distances.empty() ? TradeRows(std::vector<TradeRow>())
                                              : tradeRayCasting(options, progress);
       }}};
  TradesMeasurement result;
  for (std::size_t n = 0; n < knobs.size(); ++n) {
    progress.at(double(n) / double(knobs.size()), knobs[n].first);
    if (progress.cancelled()) return tradesCancelled();
    TradeRows rows = knobs[n].second();
    if (!rows) return rows.error();
    result.rows.insert(result.rows.end(), rows->begin(), rows->end());
  }
  recommend(result.rows);
  if (!out.empty()) {
    if (Status written = writeTables(result, out); !written) return written.error();
  }
  progress.at(1.0, "done");
  return result;
}

Json toJson(const TradesMeasurement& measurement) {
  Json rows = Json::array();
  for (const TradeRow& row : measurement.rows) {
    Json extra = Json::object();
    for (const auto& [name, value] : row.extra) extra[name] = value;
    rows.push_back({{"knob", row.knob},
                    {"setting", row.setting},
                    {"error", row.error},
                    {"error_unit", row.error_unit},
                    {"cost", row.cost},
                    {"cost_unit", row.cost_unit},
                    {"reference", row.reference},
                    {"recommended", row.recommended},
                    {"extra", extra}});
  }
  return {{"rows", rows}};
}

Result<TradesMeasurement> readTrades(const std::filesystem::path& file) {
  constexpr Range kFigure{0, 1e15};
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format(kTableFormat, 1);
  TradesMeasurement measurement;
  for (JsonReader& item : reader.objects("rows", 1000)) {
    TradeRow row;
    row.knob = item.text("knob");
    row.setting = item.text("setting");
    row.error = item.number("error", kFigure);
    row.error_unit = item.text("error_unit");
    row.cost = item.number("cost", kFigure);
    row.cost_unit = item.text("cost_unit");
    row.reference = item.text("reference");
    row.recommended = item.boolean("recommended", false);
    const Json& extra = item.raw("extra");
    for (auto it = extra.begin(); extra.is_object() && it != extra.end(); ++it) {
      if (it->is_number()) row.extra.emplace_back(it.key(), it->get<double>());
    }
    measurement.rows.push_back(std::move(row));
  }
  if (Status read = reader.finish(); !read) return read.error();
  return measurement;
}

std::string toText(const TradesMeasurement& measurement) {
  std::string text, knob;
  char line[400];
  for (const TradeRow& row : measurement.rows) {
    if (row.knob != knob) {
      knob = row.knob;
      const auto found =
          std::find_if(kKnobs.begin(), kKnobs.end(), [&](const Knob& k) { return k.id == knob; });
      text += found == kKnobs.end() ? knob : tr(found->title.data());
      text += tr(" (error: {})\n", row.reference);
    }
    std::snprintf(line, sizeof line, "  %c %-20s %10.3f %-19s %10.3f %-28s",
                  row.recommended ? '*' : ' ', row.setting.c_str(), row.error,
                  row.error_unit.c_str(), row.cost, row.cost_unit.c_str());
    text += line;
    for (const auto& [name, value] : row.extra) {
      std::snprintf(line, sizeof line, "  %s %.4g", name.c_str(), value);
      text += line;
    }
    text += '\n';
  }
  return text + tr("* recommended: the cheapest that is good enough\n");
}

}  // namespace trephine
