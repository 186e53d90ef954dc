// A folder of its own in another, which goes away with all that it holds.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <utility>

#include "base/result.h"

namespace trephine {

class TemporaryFolder {
 public:
  // Its name is hidden and begins with `stem`. Error: CANNOT_WRITE.
  static Result<TemporaryFolder> in(const std::filesystem::path& folder, const std::string& stem) {
    std::string pattern = (folder / ("." + stem + "-XXXXXX")).string();
    if (!::mkdtemp(pattern.data())) {
      return Error{"CANNOT_WRITE", "The folder cannot be written to", folder.string(),
                   "Choose another place"};
    }
    return TemporaryFolder(pattern);
  }
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::move(other.path_)) {
    other.path_.clear();
  }
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder() {
    std::error_code none;
    if (!path_.empty()) std::filesystem::remove_all(path_, none);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace trephine
