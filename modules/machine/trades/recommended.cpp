#include "machine/trades/recommended.h"

#include <algorithm>
#include <set>

#include "base/log.h"
#include "base/system.h"
#include "base/tr.h"

namespace trephine {

namespace {
constexpr const char* kFormat = "trephine.recommended";
constexpr int kVersion = 1;
constexpr Range kFigure{0, 1e15};
}  // namespace

Json toJson(const std::vector<RecommendedSetting>& settings) {
  Json knobs = Json::array();
  for (const RecommendedSetting& s : settings) {
    knobs.push_back({{"knob", s.knob},
                     {"setting", s.setting},
                     {"error", s.error},
                     {"error_unit", s.error_unit},
                     {"cost", s.cost},
                     {"cost_unit", s.cost_unit}});
  }
  return {{"format", kFormat}, {"version", kVersion}, {"knobs", knobs}};
}

Result<std::vector<RecommendedSetting>> readRecommended(const std::filesystem::path& file) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format(kFormat, kVersion);
  std::vector<RecommendedSetting> settings;
  std::set<std::string> seen;
  for (JsonReader& item : reader.objects("knobs", 1000)) {
    RecommendedSetting s;
    s.knob = item.text("knob");
    s.setting = item.text("setting");
    s.error = item.number("error", kFigure);
    s.error_unit = item.text("error_unit");
    s.cost = item.number("cost", kFigure);
    s.cost_unit = item.text("cost_unit");
    if (!seen.insert(s.knob).second) item.fail("knob", tr("The knob '{}' is given twice", s.knob));
    settings.push_back(std::move(s));
  }
  if (Status read = reader.finish(); !read) return read.error();
  return settings;
}

std::vector<RecommendedSetting> renewed(std::vector<RecommendedSetting> before,
                                        const std::vector<RecommendedSetting>& now) {
  for (const RecommendedSetting& setting : now) {
    std::erase_if(before, [&](const RecommendedSetting& s) { return s.knob == setting.knob; });
    before.push_back(setting);
  }
  return before;
}

Result<std::vector<RecommendedSetting>> recommendedHere(const Policy& policy,
                                                        const std::filesystem::path& own_folder) {
  constexpr const char* kFile = "recommended.json";
  const auto locked = [&](const RecommendedSetting& setting) {
    return setting.knob == "rate_hz" && policy.isLocked(Lock::rate);
  };
  std::vector<RecommendedSetting> here;
  for (const std::filesystem::path& folder : {resourceFolder(), policy.folder, own_folder}) {
    std::error_code ec;
    if (folder.empty() || !std::filesystem::exists(folder / kFile, ec)) continue;
    Result<std::vector<RecommendedSetting>> over = readRecommended(folder / kFile);
    if (!over && folder == resourceFolder()) return over.error();
    if (!over) {
      spdlog::warn("A recommended.json is left out. {}", over.error().sentence());
      continue;
    }
    if (folder == own_folder) std::erase_if(*over, locked);
    here = renewed(std::move(here), *over);
  }
  std::erase_if(here, [&](const RecommendedSetting& s) { return locked(s) && policy.rate_hz; });
  return here;
}

}  // namespace trephine
