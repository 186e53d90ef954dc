#include "library/case_record.h"

#include <array>

#include "base/tr.h"

namespace trephine {

namespace {

constexpr const char* kFormat = "trephine.case";
constexpr int kRecordVersion = 1;
constexpr Range kSize{1, 2048}, kSpacing_mm{1e-4, 1e4}, kPlace_mm{-1e6, 1e6},
    kCosines{-1.001, 1.001};
constexpr Range kMl{0, 1e9}, kShares{0, 1};

Json vectorJson(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

const char* regionText(BodyRegion region) {
  return region == BodyRegion::not_sure ? "" : bodyRegionName(region);
}

std::optional<BodyRegion> regionFrom(const std::string& text) {
  for (const BodyRegion region : {BodyRegion::not_sure, BodyRegion::head, BodyRegion::abdomen}) {
    if (text == regionText(region)) return region;
  }
  return std::nullopt;
}

bool isHex(const std::string& text, std::size_t digits) {
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == text.npos;
}

}  // namespace

std::vector<CaseStructure> structuresOf(const LabelMap& map) {
  std::array<std::size_t, 256> voxels{};
  for (const std::uint8_t label : map.labels) ++voxels[label];
  const double voxel_ml = map.geometry.voxelVolume_mm3() / 1000.0;
  std::vector<CaseStructure> structures;
  for (const Structure& s : map.structures) {
    structures.push_back({s.name, double(voxels[std::size_t(s.label)]) * voxel_ml, s.colour});
  }
  return structures;
}

Json toJson(const CaseRecord& record) {
  Json structures = Json::array();
  for (const CaseStructure& s : record.structures) {
    structures.push_back({{"name", s.name}, {"ml", s.ml}, {"colour", vectorJson(s.colour)}});
  }
  const GridGeometry& g = record.grid;
  Json json = {
      {"format", kFormat},
      {"version", kRecordVersion},
      {"name", record.name},
      {"imported", record.imported},
      {"region", regionText(record.region)},
      {"size", g.size},
      {"spacing_mm", vectorJson(g.spacing_mm)},
      {"origin_mm", vectorJson(g.origin_mm)},
      {"direction",
       {vectorJson(g.direction[0]), vectorJson(g.direction[1]), vectorJson(g.direction[2])}},
      {"volume_sha256", record.volume_sha256},
      {"verdict", record.verdict ? verdictName(*record.verdict) : ""},
      {"structures", std::move(structures)}};
  if (!record.names_key.empty()) json["names_key"] = record.names_key;
  return json;
}

Result<CaseRecord> caseRecordFrom(const Json& json, const std::string& file) {
  JsonReader reader(json, file);
  reader.format(kFormat, kRecordVersion);
  CaseRecord record;
  record.name = reader.text("name");
  record.imported = reader.text("imported");
  const auto region = regionFrom(reader.text("region"));
  if (!region) reader.fail("region", tr("The region is none that is known"));
  record.region = region.value_or(BodyRegion::not_sure);
  GridGeometry& g = record.grid;
  const std::vector<std::int64_t> size = reader.integers("size", 3, kSize);
  g.size = {std::int32_t(size[0]), std::int32_t(size[1]), std::int32_t(size[2])};
  g.spacing_mm = reader.vec3("spacing_mm", kSpacing_mm);
  g.origin_mm = reader.vec3("origin_mm", kPlace_mm);
  const Json& axes = reader.raw("direction");
  if (!axes.is_array() || axes.size() != 3) reader.fail("direction", tr("Expected three axes"));
  for (int axis = 0; axes.is_array() && axis < 3 && axis < int(axes.size()); ++axis) {
    const Json& of = axes[std::size_t(axis)];
    for (int n = 0; n < 3; ++n) {
      const bool good = of.is_array() && of.size() == 3 && of[std::size_t(n)].is_number() &&
                        kCosines.holds(of[std::size_t(n)].get<double>());
      if (!good) reader.fail("direction", tr("Expected three numbers from -1 to 1 for each axis"));
      if (good) g.direction[axis][n] = of[std::size_t(n)].get<double>();
    }
  }
  record.volume_sha256 = reader.text("volume_sha256");
  if (!isHex(record.volume_sha256, 64)) reader.fail("volume_sha256", tr("The hash is none"));
  const std::string verdict = reader.text("verdict");
  for (const Verdict one : {Verdict::pass, Verdict::repaired}) {
    if (verdict == verdictName(one)) record.verdict = one;
  }
  if (!record.verdict && !verdict.empty()) reader.fail("verdict", tr("The verdict is none"));
  for (JsonReader& item : reader.objects("structures", kMostStructures)) {
    CaseStructure s;
    s.name = item.text("name");
    s.ml = item.number("ml", kMl);
    s.colour = item.vec3("colour", kShares);
    record.structures.push_back(std::move(s));
  }
  record.names_key = reader.text("names_key", "");
  if (!record.names_key.empty() && !isHex(record.names_key, 16)) {
    reader.fail("names_key", tr("The key is none"));
  }
  if (Status status = reader.finish(); !status) return status.error();
  return record;
}

}  // namespace trephine
