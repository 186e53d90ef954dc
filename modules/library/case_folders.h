// The storage folder on disk: whole cases, parts of what is being written, and who is at it. For
// this room's .cpp files only.
//
//   cases/ID/          a case
//   private/KEY.json   what a case may not be called (name_guard.h); for its owner alone
//   .parts/            what is being written or deleted; what no living process holds is swept
//   .lock              held while the list of cases changes
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"
#include "base/sync_folder.h"

namespace trephine::case_folders {

constexpr const char* kCaseFile = "case.json";
constexpr const char* kVolumeFile = "volume.mha";
constexpr const char* kStructuresFile = "structures.seg.nrrd";
constexpr const char* kReportPage = "report.html";
constexpr const char* kReportFile = "report.json";
constexpr const char* kProvenanceFile = "provenance.json";
constexpr const char* kTissuesFile = "tissues.json";
constexpr const char* kPictureFile = "picture.png";
// In a part, until it is its maker's own file in private/.
constexpr const char* kPrivatePart = "private.json";

// A file that is locked as long as this lives, against other processes and other threads.
class FileLock {
 public:
  // Waits for whoever holds it, which is never for long: BUSY after kPatience. Error: CANNOT_WRITE,
  // also where the file system knows no locks.
  static constexpr std::chrono::seconds kPatience{3};
  static Result<FileLock> waitFor(const std::filesystem::path& file);
  // Nothing where somebody holds it, or it cannot be told.
  static std::optional<FileLock> tryFor(const std::filesystem::path& file);

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

class Folders {
 public:
  explicit Folders(std::filesystem::path storage) : storage_(std::move(storage)) {}

  const std::filesystem::path& storage() const { return storage_; }
  std::filesystem::path cases() const { return storage_ / "cases"; }
  std::filesystem::path parts() const { return storage_ / ".parts"; }
  std::filesystem::path caseFolder(const std::string& id) const { return cases() / id; }
  std::filesystem::path privateFile(const std::string& key) const {
    return storage_ / "private" / (key + ".json");
  }

  // Makes the folders where they are missing. CANNOT_WRITE.
  Status make() const;
  // To be held while the list of cases is looked at to be changed.
  Result<FileLock> lock() const;
  // CANNOT_WRITE where the storage is a group's and this account only looks.
  Status mayChange() const;
  std::filesystem::path lockFile() const { return storage_ / ".lock"; }
  // What a storage folder needs when it is opened: makes what is missing beside its cases, and
  // sweeps. Nothing in a folder that has no cases yet. Never throws.
  void putInOrder() const;
  // Removes parts that no living process holds. What cannot be removed stays. Never throws.
  void sweep() const;
  // CANNOT_WRITE where less than that is free; what cannot be told is not in the way.
  Status roomFor(std::uint64_t bytes) const;
  void removePrivate(const std::string& key) const;
  // Removes those of other keys. The lock of the list is held.
  void keepPrivateOf(const std::set<std::string>& keys) const;

 private:
  std::filesystem::path storage_;
};

// A folder of one's own among the parts, gone with this unless it became a case.
class Part {
 public:
  enum class Of { wholeCase, someFiles };
  static Result<Part> make(const Folders& folders, Of what);
  Part(Part&& other) noexcept
      : folders_(std::move(other.folders_)),
        path_(std::exchange(other.path_, {})),
        lock_(std::move(other.lock_)) {}
  ~Part();

  std::filesystem::path operator/(const char* name) const { return path_ / name; }
  // Gone at once; what was written in it, with it.
  void drop();
  // Puts the file in the place of one in a case. CANNOT_WRITE.
  Status replace(const char* name, const std::filesystem::path& case_folder) const;
  // Writes private/KEY.json, readable by its owner alone. The case.json that names it is already
  // here: what is swept takes it along. CANNOT_WRITE.
  Status writePrivate(const std::string& key, std::string_view text) const;
  // The whole folder becomes that case: from here it is there. The lock of the list is held.
  Status becomeCase(const std::filesystem::path& case_folder);

 private:
  Part(Folders folders, std::filesystem::path path, FileLock lock)
      : folders_(std::move(folders)), path_(std::move(path)), lock_(std::move(lock)) {}

  Folders folders_;
  std::filesystem::path path_;  // empty: no longer a part
  std::optional<FileLock> lock_;
};

// The case goes to the parts, with one rename, and is then deleted, its private file too where its
// case.json still names it. The lock of the list is held. CANNOT_WRITE, NO_SUCH_CASE.
Status removeCase(const Folders& folders, const std::string& id);

}  // namespace trephine::case_folders
