// The part of a carve journal that does not fit into memory: an unnamed temporary file that is gone
// when the program ends, however it ends.
#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "volume/carve_journal.h"

namespace trephine {

class JournalFile {
 public:
  // Makes the file in `folder`, which must exist. Errors: CANNOT_WRITE.
  static Result<std::unique_ptr<JournalFile>> create(const std::filesystem::path& folder);
  ~JournalFile();
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // Saves what is not saved yet and brings back what is asked for. Called by the recorder thread
  // every 20 ms, always with the same journal.
  //
  // Each error is returned once. CANNOT_WRITE: nothing is saved from then on, the journal fills up
  // and removal stops; going back still works. CANNOT_READ: the load is tried again at every call,
  // and the job that needs it waits.
  Status service(CarveJournal& journal);

 private:
  JournalFile(int descriptor, std::filesystem::path folder);
  Status save(CarveLog& log);
  Status load(CarveLog& log);

  int descriptor_;
  std::filesystem::path folder_;
  bool write_failed_ = false;
  bool read_failed_ = false;
};

}  // namespace trephine
