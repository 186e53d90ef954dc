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
  // PARENT/NAME and six letters by chance, for this account alone; NAME ends in a mark of its kind.
  // Error: CANNOT_WRITE, of `wanted`.
  static Result<LockedFolder> make(const std::filesystem::path& parent, const std::string& name,
                                   const std::filesystem::path& wanted);
  // Those in a folder whose name holds the mark and six letters after it, of this account's
  // programs that have ended. On a disk that knows no locks of folders none works on one for a day.
  static void removeLeft(const std::filesystem::path& parent, const std::string& mark);

  LockedFolder(LockedFolder&& other) noexcept
      : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}
  LockedFolder& operator=(LockedFolder&& other) noexcept {
    std::swap(path_, other.path_);
    lock_ = std::move(other.lock_);
    return *this;
  }
  ~LockedFolder();  // with all that is in it

  const std::filesystem::path& path() const { return path_; }
  // It has become something else, and stays; or another folder lies in its place, and goes.
  void keep() { path_.clear(); }
  void moveTo(std::filesystem::path path) { path_ = std::move(path); }

 private:
  LockedFolder(std::filesystem::path path, Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;  // empty: kept
  Descriptor lock_;
};

}  // namespace trephine
