// What became of a source on its way to a volume, as JSON: in the import's answer, and in a file
// beside a volume that is written. It names no patient, path or UID, and nothing that stands for
// one: source_ids are not in it (the library keeps them by a key). Nothing is filtered here:
// whoever fills a Provenance keeps names, paths and UIDs out of its texts.
#pragma once

#include <filesystem>

#include "base/json.h"
#include "base/result.h"
#include "imaging/report/report.h"

namespace trephine {

Json toJson(const Provenance& provenance);

// The same back, without source_ids; `file` is named in errors. Errors: BAD_FIELD, OLDER_VERSION
// (source_ids are in it).
Result<Provenance> provenanceFrom(const Json& json, const std::string& file);

// "head.nii.gz.provenance.json" for "head.nii.gz".
std::filesystem::path provenanceFile(const std::filesystem::path& volume_file);
// Error: CANNOT_WRITE; what was there stays.
Status writeProvenance(const Provenance& provenance, const std::filesystem::path& volume_file);

}  // namespace trephine
