// What is kept of a case for its importer alone: whether a name tells of whom it is, also when its
// source is gone (salted, stretched hashes of what it may not tell, and nothing from which that
// could be read), and which CT it was made from, by a key.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_ids.h"
#include "library/name_words.h"

namespace trephine {

class NameGuard {
 public:
  NameGuard() = default;  // refuses nothing

  // About 20 ms for each of 20 to 60 texts, on two threads. Errors: CANCELLED, NO_RANDOM_NUMBERS.
  static Result<NameGuard> of(const SourceKeys& source, const Progress& progress = Progress());
  // Of the file that toJson() was written to. Errors: MISSING_FILE, BAD_JSON, BAD_FIELD.
  static Result<NameGuard> read(const std::filesystem::path& file);
  Json toJson() const;

  // Which CT the case was made from; none for what was made of a volume file.
  const SourceIds& source() const { return source_; }
  // By a key of its own where they are not yet by one. Error: NO_RANDOM_NUMBERS.
  Status setSource(const SourceIds& ids);

  // About 20 ms for each text that the names hold: some 7 for a name of three words. Not on the
  // window's thread. The Error of the first name that is refused (`where`: its number from 1, where
  // there are several): NAME_IS_IDENTITY, CANCELLED.
  Status check(const std::string& name) const;
  // Whether names tell who the patient is; of folders and files they may be called.
  Status checkPatient(const std::vector<std::string>& names, const Progress& progress) const;

 private:
  std::map<std::string, std::string> hashesOf(const std::vector<std::string>& keys,
                                              const Progress& progress) const;

  std::string salt_;
  int iterations_ = 0;
  int most_words_ = 2;
  std::set<int> lengths_;
  std::map<std::string, IdentityKind> hashes_;
  SourceIds source_;
};

}  // namespace trephine
