// The figures of `trephine-measure render` for programs, people and tables, and its bars.
#include <algorithm>
#include <cstdio>
#include <locale>
#include <sstream>

#include "lab/render/render_measurement.h"
#include "machine/common/spread.h"

namespace trephine {

namespace {

const RenderRow* find(const RenderMeasurement& m, const RenderRow& like, const char* mapper) {
  const auto found = std::find_if(m.rows.begin(), m.rows.end(), [&](const RenderRow& row) {
    return row.of_case == like.of_case && row.preset == like.preset && row.mode == like.mode &&
           row.width == like.width && row.height == like.height && row.mapper == mapper &&
           row.sample_distance_voxels == like.sample_distance_voxels && row.level == like.level;
  });
  return found == m.rows.end() ? nullptr : &*found;
}

std::string titleOf(const std::string& of_case, const std::string& preset) {
  return preset + ", " + of_case;
}

// Of pictures with plain ones beside them at the first sample distance of each subject.
void addStillBars(const RenderMeasurement& m, std::vector<RenderBar>& bars) {
  std::vector<std::string> seen;
  for (const RenderRow& row : m.rows) {
    if (row.mapper != "trephine" || !row.ms_plain_median) continue;
    const std::string title = titleOf(row.of_case, row.preset);
    if (std::find(seen.begin(), seen.end(), title) != seen.end()) continue;
    seen.push_back(title);
    const double times = row.preset == "bone" ? 12.0 : row.preset == "skin" ? 10.0 : 5.0;
    if (const RenderRow* stock = find(m, row, "stock"); stock && row.ms_median > 0.0) {
      bars.push_back(
          {title + ": times as fast as stock", stock->ms_median / row.ms_median, times, true});
    }
    if (row.psnr_to_stock_dB) {
      bars.push_back(
          {title + ": plain picture against stock [dB]", *row.psnr_to_stock_dB, 60.0, true});
    }
    if (*row.ms_plain_median > 0.0) {
      bars.push_back({title + ": frame against the plain one", row.ms_median / *row.ms_plain_median,
                      1.25, false});
    }
  }
}

void addMovingBars(const RenderMeasurement& m, std::vector<RenderBar>& bars) {
  for (const RenderRow& row : m.rows) {
    if (row.mode == "still" || !(row.ms_median > 0.0)) continue;
    const std::string title = row.mode + ", " + titleOf(row.of_case, row.preset);
    const bool liver = row.preset == "liver";
    const double rate = row.mode == "cut" ? 12.0 : liver ? 10.0 : 15.0;
    bars.push_back({title + ": frames/s", 1000.0 / row.ms_median, rate, true});
    if (row.mode == "rotate") {
      bars.push_back({title + ": pixels of a block", row.level, liver ? 4.0 : 3.0, false});
    }
  }
  for (const RefineRow& rest : m.rests) {
    const std::string title = "at rest, " + titleOf(rest.of_case, rest.preset);
    const bool liver = rest.preset == "liver";
    if (liver) bars.push_back({title + ": first refined [ms]", rest.first_ms, 1000.0, false});
    bars.push_back({title + ": full quality [ms]", rest.full_ms, liver ? 4000.0 : 1500.0, false});
  }
}

}  // namespace

std::vector<RenderBar> renderBars(const RenderMeasurement& m) {
  std::vector<RenderBar> bars;
  addStillBars(m, bars);
  for (const SurfaceRow& row : m.surface) {
    if (row.mapper != "trephine") continue;
    bars.push_back({"shell: luminance error [%]", row.of.luminance_error_percent, 2.5, false});
    bars.push_back({"shell: median error of normals [deg]", row.of.normal_median_deg, 2.5, false});
    bars.push_back({"shell: p99 error of normals [deg]", row.of.normal_p99_deg, 7.0, false});
  }
  for (const ClassRow& row : m.wrong_class) {
    if (row.mapper == "trephine") {
      bars.push_back({row.of_case + ": wrong class [%]", row.percent, 4.0, false});
    }
  }
  addMovingBars(m, bars);
  double frame_ms = 0.0;
  for (const RenderRow& row : m.rows) {
    if (row.mode == "cut") frame_ms = std::max(frame_ms, row.ms_median);
  }
  if (frame_ms > 0.0) {
    bars.push_back(
        {"removal to pixel: max [ms], a frame and 50", m.removal_max_ms, frame_ms + 50.0, false});
    bars.push_back({"hand to the tool's pixel: median [ms]", m.hand_median_ms, 45.0, false});
    bars.push_back({"hand to the tool's pixel: p99 [ms]", m.hand_p99_ms, 100.0, false});
    bars.push_back({"ticks missed meanwhile [%]", m.missed_ticks_percent, 1.0, false});
  }
  bars.push_back({"first picture after an import [ms]", m.first_picture_ms, 1000.0, false});
  return bars;
}

Json toJson(const RenderMeasurement& m) {
  Json rows = Json::array(), surface = Json::array(), bars = Json::array();
  for (const RenderRow& row : m.rows) {
    rows.push_back({{"case", row.of_case},
                    {"preset", row.preset},
                    {"size", {row.width, row.height}},
                    {"mode", row.mode},
                    {"mapper", row.mapper},
                    {"sample_distance_voxels", row.sample_distance_voxels},
                    {"level", row.level},
                    {"ms_median", row.ms_median},
                    {"ms_plain_median", orNull(row.ms_plain_median)},
                    {"psnr_db", orNull(row.psnr_dB)},
                    {"ssim", orNull(row.ssim)},
                    {"psnr_to_stock_db", orNull(row.psnr_to_stock_dB)}});
  }
  for (const SurfaceRow& row : m.surface) {
    surface.push_back({{"mapper", row.mapper},
                       {"normal_error_deg",
                        {{"median", row.of.normal_median_deg}, {"p99", row.of.normal_p99_deg}}},
                       {"luminance_error_percent", row.of.luminance_error_percent}});
  }
  const auto classes = [](const std::vector<ClassRow>& of) {
    Json list = Json::array();
    for (const ClassRow& row : of) {
      list.push_back({{"case", row.of_case}, {"mapper", row.mapper}, {"value", row.percent}});
    }
    return list;
  };
  for (const RenderBar& bar : renderBars(m)) {
    bars.push_back(
        {{"name", bar.name}, {"value", bar.value}, {"limit", bar.limit}, {"pass", bar.pass()}});
  }
  return {{"rows", rows},
          {"surface", surface},
          {"wrong_class_percent", classes(m.wrong_class)},
          {"wrong_class_hu_only_percent", classes(m.wrong_class_hu_only)},
          {"removal_to_pixel_ms", {{"median", m.removal_median_ms}, {"max", m.removal_max_ms}}},
          {"hand_to_tool_pixel_ms", {{"median", m.hand_median_ms}, {"p99", m.hand_p99_ms}}},
          {"first_picture_ms", m.first_picture_ms},
          {"renderer", m.renderer},
          {"bars", bars}};
}

std::string toText(const RenderMeasurement& m) {
  const auto cell = [](const std::optional<double>& value, int digits) {
    char text[40] = "-";
    if (value) std::snprintf(text, sizeof text, "%.*f", digits, *value);
    return std::string(text);
  };
  char line[240];
  std::string text = m.renderer + "\n";
  std::snprintf(line, sizeof line, "%-16s %-6s %-10s %-7s %-9s %6s %6s %10s %10s %7s %7s %9s\n",
                "case", "preset", "size", "mode", "mapper", "voxels", "level", "ms", "plain ms",
                "PSNR", "SSIM", "to stock");
  text += line;
  for (const RenderRow& row : m.rows) {
    const std::string size = std::to_string(row.width) + "x" + std::to_string(row.height);
    std::snprintf(line, sizeof line,
                  "%-16s %-6s %-10s %-7s %-9s %6.2f %6.2f %10.1f %10s %7s %7s %9s\n",
                  row.of_case.c_str(), row.preset.c_str(), size.c_str(), row.mode.c_str(),
                  row.mapper.c_str(), row.sample_distance_voxels, row.level, row.ms_median,
                  cell(row.ms_plain_median, 1).c_str(), cell(row.psnr_dB, 1).c_str(),
                  cell(row.ssim, 4).c_str(), cell(row.psnr_to_stock_dB, 1).c_str());
    text += line;
  }
  for (const SurfaceRow& row : m.surface) {
    std::snprintf(line, sizeof line,
                  "shell, %-9s normals off by %.2f deg (median), %.2f (99 %%); luminance %.2f %%\n",
                  row.mapper.c_str(), row.of.normal_median_deg, row.of.normal_p99_deg,
                  row.of.luminance_error_percent);
    text += line;
  }
  for (const auto& [of, title] : {std::pair(&m.wrong_class, "wrong class"),
                                  std::pair(&m.wrong_class_hu_only, "wrong class, no labels")}) {
    for (const ClassRow& row : *of) {
      std::snprintf(line, sizeof line, "%-23s %-16s %-9s %6.2f %%\n", title, row.of_case.c_str(),
                    row.mapper.c_str(), row.percent);
      text += line;
    }
  }
  for (const RenderBar& bar : renderBars(m)) {
    std::snprintf(line, sizeof line, "%-62s %10.2f  %s %8.2f  %s\n", bar.name.c_str(), bar.value,
                  bar.at_least ? "at least" : "at most ", bar.limit, bar.pass() ? "pass" : "FAIL");
    text += line;
  }
  return text;
}

std::string toCsv(const RenderMeasurement& m) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "case,preset,width,height,mode,mapper,sample_distance_voxels,level,ms_median,"
          "ms_plain_median,psnr_db,ssim,psnr_to_stock_db\n";
  for (const RenderRow& row : m.rows) {
    text << row.of_case << ',' << row.preset << ',' << row.width << ',' << row.height << ','
         << row.mode << ',' << row.mapper << ',' << row.sample_distance_voxels << ',' << row.level
         << ',' << row.ms_median;
    for (const auto& value : {row.ms_plain_median, row.psnr_dB, row.ssim, row.psnr_to_stock_dB}) {
      text << ',';
      if (value) text << *value;
    }
    text << '\n';
  }
  return text.str();
}

}  // namespace trephine
