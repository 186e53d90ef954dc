#include "imaging/common/source_ids.h"

#include <algorithm>

#include "base/sha256.h"

namespace trephine {

std::string seriesHash(const std::string& uid) {
  constexpr std::size_t kDigits = 32;
  std::size_t end = std::min(uid.rfind('#'), uid.size());
  // A file's name may hold one, too.
  if (uid.find_first_not_of("0123456789#.") != uid.npos) end = uid.size();
  return sha256Hex(uid.data(), end).substr(0, kDigits) + uid.substr(end);
}

std::string hashOrNone(const std::string& uid) {
  return uid.empty() ? "" : seriesHash(uid);
}

}  // namespace trephine
