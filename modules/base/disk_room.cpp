#include "base/disk_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "base/codes.h"

namespace trephine {

namespace fs = std::filesystem;

Status enoughRoom(const fs::path& folder, double bytes, const std::string& what) {
  std::error_code ec;
  fs::path there = fs::absolute(folder, ec);
  while (!fs::exists(there, ec) && there.has_relative_path()) there = there.parent_path();
  const fs::space_info room = fs::space(there, ec);
  if (ec || bytes <= double(room.available)) return {};
  const auto mb = [](double n) {
    return std::to_string(std::int64_t(std::min(std::ceil(n / 1e6), 9e18))) + " MB";
  };
  return Error{code::kCannotWrite,
               "The disk has no room for " + what + ": it needs " + mb(bytes) + ", and " +
                   mb(double(room.available)) + " are free",
               folder.string(), "Free some space, or choose another storage folder"};
}

}  // namespace trephine
