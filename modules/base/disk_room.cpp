#include "base/disk_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "base/codes.h"
#include "base/tr.h"

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
               tr("The disk has no room for {}: it needs {}, and {} are free", what, mb(bytes),
                  mb(double(room.available))),
               folder.string(), tr("Free some space, or choose another storage folder")};
}

}  // namespace trephine
