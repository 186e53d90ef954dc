#include "imaging/common/source_ids.h"

#include <algorithm>

#include "base/sha256.h"
#include "base/stretched_hash.h"

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

bool SourceIds::standsFor(const std::string& own, const std::string& hash) const {
  return !own.empty() && !hash.empty() && own == (key.empty() ? hash : keyedHash(hash, key));
}

SourceIds SourceIds::keyed(const std::string& with_key) const {
  const auto by_key = [&](const std::string& id) {
    return id.empty() ? std::string() : keyedHash(id, with_key);
  };
  return {by_key(study), by_key(series), by_key(frame_of_reference), with_key, false};
}

}  // namespace trephine
