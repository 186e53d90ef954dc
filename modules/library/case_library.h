// Cases on disk: one folder each under the storage folder, whole or not there, without a word of
// whom it is of. Formats: resources/schemas/case.md.
//
// Nothing is kept in memory between calls, so several programs may use one storage folder. Any
// thread, one call at a time each; what takes a Progress or checks a name takes longer than a
// window may stand still. Nothing throws.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_identity.h"
#include "imaging/report/report.h"
#include "library/case_folders.h"
#include "library/case_record.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// What becomes a case. Without a report there are no card and no verdict; without a source,
// nothing that it may not be called.
struct NewCase {
  std::shared_ptr<const Volume> volume;          // never null
  std::shared_ptr<const LabelMap> structures{};  // on the volume's grid; null: none
  std::optional<ImportReport> report{};          // CtFolder::report(), after read()
  std::optional<Provenance> provenance{};
  Json tissues = Json::object();             // a tissue set; {}: none
  BodyRegion region = BodyRegion::not_sure;  // anatomyOf() tells
  SourceIdentity source{};                   // CtFolder::sourceIdentity(); compared, not kept
  std::string name{};                        // as a person calls it; empty: a neutral one
};

struct SavedCase {
  CaseRecord record;
  // RENAMED_STRUCTURE: the name of one told who the patient is, and is now "label 7".
  std::vector<Warning> warnings{};
};

struct ListedCase {
  std::string id;
  CaseRecord record;               // as far as it can be read
  std::optional<Error> problem{};  // why it cannot be opened
};

struct LoadedCase {
  CaseRecord record;  // its structures are those of the file
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> structures;  // null: none
  std::optional<Provenance> provenance;
  Json tissues = Json::object();  // {}: none
  // There are some, and they cannot be read.
  std::optional<Error> tissues_problem{}, structures_problem{};
};

class CaseLibrary {
 public:
  // Sweeps what programs that ended in the middle have left there. A folder that is not there yet
  // is made by the first save.
  explicit CaseLibrary(std::filesystem::path storage);

  const std::filesystem::path& storage() const { return folders_.storage(); }

  // All cases, the newest first; those that cannot be opened are among them. Reads case.json of
  // each and looks which files are there.
  std::vector<ListedCase> list() const;

  // Whole or not at all. Errors: CANNOT_WRITE (with the room that it needs where that is short),
  // BAD_NAME, NAME_TAKEN, NAME_IS_IDENTITY, WRONG_GRID (structures of another grid), CANCELLED,
  // OUT_OF_MEMORY.
  Result<SavedCase> save(const NewCase& of, const Progress& progress = Progress());

  // Voxels and grid are compared with what was saved. A case whose tissues or
  // structures cannot be read opens without them. Errors: NO_SUCH_CASE, CASE_PART_MISSING,
  // CASE_CHANGED, OLDER_VERSION, those of list() and of readVolume, CANCELLED.
  Result<LoadedCase> load(const std::string& id, const Progress& progress = Progress());

  // Its folder keeps its name. The new one may be that which a case gets by itself. Errors:
  // BAD_NAME, NAME_TAKEN, NAME_IS_IDENTITY, NAME_UNCHECKED (what it may not be called is not
  // there), NO_SUCH_CASE, CANNOT_WRITE.
  Result<CaseRecord> rename(const std::string& id, const std::string& new_name);
  // Whole or not at all; a case that cannot be opened, too. Errors: NO_SUCH_CASE, CANNOT_WRITE.
  Status remove(const std::string& id);
  // Instead of what it had; a map without structures: none. Errors: WRONG_GRID, NAME_IS_IDENTITY
  // (`where`: which of them), NO_SUCH_CASE, CANNOT_WRITE, CANCELLED.
  Result<CaseRecord> saveStructures(const std::string& id, const LabelMap& structures,
                                    const Progress& progress = Progress());
  // {}: none. Errors: NO_SUCH_CASE, CANNOT_WRITE.
  Status saveTissues(const std::string& id, const Json& tissues);

 private:
  Result<CaseRecord> record(const std::string& id) const;
  Status writeRecord(const CaseRecord& record, const case_folders::Part& part) const;
  void mendRows(const CaseRecord& of) const;
  SourceIds idsOf(const CaseRecord& record, const Provenance& provenance) const;
  // Folded, of all cases but that one.
  std::set<std::string> namesBeside(const std::string& id) const;

  case_folders::Folders folders_;
};

// "Head 2026-11-24 2": what a case is called before a person calls it something.
std::string neutralName(BodyRegion region, const std::string& day, int number);
bool isNeutralName(const std::string& name);

}  // namespace trephine
