#include "library/stored_case.h"

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "library/codes.h"

namespace trephine {

Result<StoredCase> storedCase(CaseLibrary& library, const std::string& id,
                              const Progress& progress) {
  Result<LoadedCase> loaded = library.load(id, progress);
  if (!loaded) return loaded.error();
  Case of = caseOf(loaded->volume, loaded->record.volume_sha256);
  of.provenance = loaded->provenance;
  of.name = loaded->record.name;
  of.stored = id;
  StoredCase stored{withStructures(std::move(of), loaded->structures), {}, {}, {}};
  if (const std::optional<Error>& why = loaded->structures_problem) {
    stored.no_structures = Error{
        code::kNoStructures,
        tr("The file with the case's structures cannot be used, so it has none ({})", why->what),
        why->where,
        tr("Put the file back and open the case again; or make them anew and save them in the "
           "case")};
  }
  const std::string file = id + "/tissues.json";
  std::optional<Error> problem = loaded->tissues_problem;
  if (!problem && loaded->tissues.empty())
    problem = Error{code::kMissingFile, tr("There are none"), file, ""};
  if (!problem) {
    Result<TissueSet> set = parseTissueSet(loaded->tissues, file);
    set ? void(stored.tissues = *std::move(set)) : void(problem = set.error());
  }
  // No reason not to open the case.
  if (problem) {
    stored.no_tissues = Error{code::kNoTissues,
                              tr("The file with the case's own tissues cannot be used, so it has "
                                 "those of the exercise ({})",
                                 problem->what),
                              problem->where,
                              tr("Put the file back and open the case again; or set the tissues "
                                 "and save them in the case")};
  }
  return stored;
}

}  // namespace trephine
