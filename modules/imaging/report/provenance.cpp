#include "imaging/report/provenance.h"

#include "base/file.h"

namespace trephine {

Json toJson(const Provenance& provenance) {
  Json answers = Json::object();
  for (const auto& [code, option] : provenance.answers) answers[code] = option;
  Json changes = Json::array();
  for (const Finding& finding : provenance.changes) {
    changes.push_back({{"code", finding.code},
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
          {"unanswered", provenance.unanswered},
          {"unused_answers", provenance.unused_answers},
          {"changes", std::move(changes)},
          {"crop", std::move(crop)},
          {"reduction", provenance.reduction},
          {"loss", std::move(loss)},
          {"volume_sha256", provenance.volume_sha256},
          {"source_ids",
           {{"study", provenance.source_ids.study},
            {"series", provenance.source_ids.series},
            {"frame_of_reference", provenance.source_ids.frame_of_reference}}},
          {"build", provenance.build}};
}

std::filesystem::path provenanceFile(const std::filesystem::path& volume_file) {
  return volume_file.parent_path() / (volume_file.filename().string() + ".provenance.json");
}

Status writeProvenance(const Provenance& provenance, const std::filesystem::path& volume_file) {
  return writeTextFile(provenanceFile(volume_file), toJson(provenance).dump(2) + "\n");
}

}  // namespace trephine
