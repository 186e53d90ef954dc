// A folder that a program works in and that goes with it. It is locked (flock) while the program
// lives: what one that was killed has left is told from what another writes.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace trephine {

class LockedFolder {
 public:
  // PARENT/NAME and six letters by chance, for this account alone. NAME ends in the mark that
  // removeLeft() is given later (".trephine-part-"). Error: CANNOT_WRITE, which names `wanted`:
  // what a person asked for. Where the disk knows no locks of folders it is made all the same.
  static Result<LockedFolder> make(const std::filesystem::path& parent, const std::string& name,
                                   const std::filesystem::path& wanted);
  // Those in a folder whose name ends in the mark and six letters, of this account's programs that
  // have ended. On a disk that cannot lock folders, one counts as left when none of its entries was
  // made or removed for 24 hours.
  static void removeLeft(const std::filesystem::path& parent, const std::string& mark);

  LockedFolder(LockedFolder&& other) noexcept
      : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}
  // The two change folders and locks: the other deletes what was here.
  LockedFolder& operator=(LockedFolder&& other) noexcept {
    std::swap(path_, other.path_);
    lock_ = std::move(other.lock_);
    return *this;
  }
  ~LockedFolder();  // with all that is in it

  const std::filesystem::path& path() const { return path_; }
  // Neither touches the disk or the lock. keep(): the caller has renamed the folder to its place,
  // and it stays. moveTo(): the caller has put another folder at `path`, and that is deleted at the
  // end.
  void keep() { path_.clear(); }
  void moveTo(std::filesystem::path path) { path_ = std::move(path); }

 private:
  LockedFolder(std::filesystem::path path, Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;  // empty: kept
  Descriptor lock_;
};

}  // namespace trephine
