// What the list of cases shows of one: its case.json (resources/schemas/case.md), and what its
// folder tells. Plain data, without a word of whom it is of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "imaging/report/report.h"
#include "imaging/steps/anatomy.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct CaseStructure {
  std::string name;
  double ml = 0.0;
  Vec3 colour{1.0};  // r, g, b in [0, 1]

  friend bool operator==(const CaseStructure&, const CaseStructure&) = default;
};

struct CaseRecord {
  std::string name;      // UTF-8, one line, at most 80 characters; unique among cases
  std::string imported;  // "2026-11-24T09:30:00", the workstation's time
  BodyRegion region = BodyRegion::not_sure;
  GridGeometry grid;
  std::string volume_sha256;       // of its voxels (volumeSha256)
  std::optional<Verdict> verdict;  // of its import; none where there was none
  std::vector<CaseStructure> structures;
  std::string names_key;  // of the file of what it may not be called; empty: there is none

  // Of its folder, not written.
  std::string id;                // the folder's name
  std::filesystem::path folder;  // picture.png and report.html lie there
  std::uint64_t bytes = 0;       // that its files take
};

// What a label map holds, in its own order.
std::vector<CaseStructure> structuresOf(const LabelMap& map);

// Checks nothing: a record that is refused, or has no hash, is written and cannot be read again.
Json toJson(const CaseRecord& record);
// Id, folder and bytes are the library's to fill. `file` is named in errors. Errors: BAD_FIELD, a
// newer version among them.
Result<CaseRecord> caseRecordFrom(const Json& json, const std::string& file);

}  // namespace trephine
