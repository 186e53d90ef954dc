#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "base/codes.h"
#include "base/file.h"

namespace trephine {

// The folder of a run. What was made of it goes again if nothing came to lie in it.
class OutFolder {
 public:
  explicit OutFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code ec;
    for (std::filesystem::path at = std::filesystem::absolute(folder_, ec);
         !at.empty() &&
         std::filesystem::symlink_status(at, ec).type() == std::filesystem::file_type::not_found;
         at = at.parent_path()) {
      made_.push_back(at);
    }
  }
  ~OutFolder() {
    std::error_code ec;
    for (const std::filesystem::path& at : made_)
      std::filesystem::remove(at, ec);  // only an empty folder goes
  }
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;
  Status make() const { return makeFolder(folder_); }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // the deepest first
};

}  // namespace trephine
