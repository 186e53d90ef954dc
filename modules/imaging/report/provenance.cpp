#include "imaging/report/provenance.h"

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"

namespace trephine {

Json toJson(const Provenance& provenance) {
  Json answers = Json::object();
  for (const auto& [code, option] : provenance.answers) answers[code.str()] = option;
  Json changes = Json::array();
  for (const Finding& finding : provenance.changes) {
    changes.push_back({{"code", finding.code.str()},
                       {"text", finding.text},
                       {"slices", finding.slices},
                       {"action", finding.action}});
  }
  Json crop = nullptr, loss = nullptr;
  if (const auto& box = provenance.crop) crop = {{"low", box->low}, {"high", box->high}};
  if (provenance.loss) {
    loss = {{"rms_hu", provenance.loss->rms_hu},
            {"p99_hu", provenance.loss->p99_hu},
            {"bone_volume_change_percent", provenance.loss->bone_volume_change_percent}};
  }
  return {{"source", provenance.source},
          {"transfer_syntax", provenance.transfer_syntax},
          {"lossy", provenance.lossy},
          {"slices_used", provenance.slices_used},
          {"choices", std::move(answers)},
          {"unanswered", namesOf(provenance.unanswered)},
          {"unused_answers", namesOf(provenance.unused_answers)},
          {"changes", std::move(changes)},
          {"crop", std::move(crop)},
          {"reduction", provenance.reduction},
          {"loss", std::move(loss)},
          {"volume_sha256", provenance.volume_sha256},
          {"build", provenance.build}};
}

namespace {

constexpr std::size_t kMost = 4096;  // of findings, and of their slices
constexpr Range kVoxels{0, 2048}, kSlices{0, 1e9}, kReductions{1, 4};
constexpr Range kHu{0, 1e5}, kPercent{-1e6, 1e6};

Index3 indexFrom(JsonReader& reader, const char* key) {
  const std::vector<std::int64_t> n = reader.integers(key, 3, kVoxels);
  return {std::int32_t(n[0]), std::int32_t(n[1]), std::int32_t(n[2])};
}

}  // namespace

Result<Provenance> provenanceFrom(const Json& json, const std::string& file) {
  Provenance provenance;
  JsonReader reader(json, file);
  provenance.source = reader.text("source");
  provenance.transfer_syntax = reader.text("transfer_syntax");
  provenance.lossy = reader.boolean("lossy", false);
  provenance.slices_used = int(reader.integer("slices_used", kSlices));
  const Json& answers = reader.raw("choices");
  if (!answers.is_object()) reader.fail("choices", tr("Expected an object of texts"));
  for (const auto& [code, option] : answers.items()) {
    if (!option.is_string()) {
      reader.fail("choices", tr("Expected an object of texts"));
      break;
    }
    provenance.answers[Code::named(code)] = option.get<std::string>();
  }
  for (const std::string& code : reader.texts("unanswered", kMost)) {
    provenance.unanswered.push_back(Code::named(code));
  }
  for (const std::string& code : reader.texts("unused_answers", kMost)) {
    provenance.unused_answers.push_back(Code::named(code));
  }
  for (JsonReader& item : reader.objects("changes", kMost)) {
    provenance.changes.push_back({Code::named(item.text("code")), Severity::repair,
                                  item.text("text"), item.texts("slices", kMost),
                                  item.text("action")});
  }
  if (!reader.raw("crop").is_null()) {
    JsonReader crop = reader.object("crop");
    provenance.crop = VoxelBox{indexFrom(crop, "low"), indexFrom(crop, "high")};
  }
  provenance.reduction = int(reader.integer("reduction", kReductions));
  if (!reader.raw("loss").is_null()) {
    JsonReader loss = reader.object("loss");
    provenance.loss = MeasuredLoss{loss.number("rms_hu", kHu), loss.number("p99_hu", kHu),
                                   loss.number("bone_volume_change_percent", kPercent)};
  }
  provenance.volume_sha256 = reader.text("volume_sha256");
  if (reader.has("source_ids")) {
    return Error{
        code::kOlderVersion,
        tr("It was written by a Trephine that kept which CT it is of where all may read it"), file,
        tr("Import the CT again, and delete what was made of it before")};
  }
  provenance.build = reader.text("build");
  if (Status status = reader.finish(); !status) return status.error();
  return provenance;
}

std::filesystem::path provenanceFile(const std::filesystem::path& volume_file) {
  return volume_file.parent_path() / (volume_file.filename().string() + ".provenance.json");
}

Status writeProvenance(const Provenance& provenance, const std::filesystem::path& volume_file) {
  return writeTextFile(provenanceFile(volume_file), toJson(provenance).dump(2) + "\n");
}

}  // namespace trephine
