// Which study, series and frame of reference something is of, by hashes: to tell what belongs
// together, where the UIDs themselves may not stand.
#pragma once

#include <string>

namespace trephine {

// Stands for a UID where it may not be named: 32 hexadecimal digits, the same on every machine,
// with the "#2" of a part of a series. From SHA-256 of the UID.
std::string seriesHash(const std::string& uid);
// The same; empty where the UID is.
std::string hashOrNone(const std::string& uid);

// Hashes; empty where unknown.
struct SourceIds {
  std::string study{}, series{}, frame_of_reference{};

  friend bool operator==(const SourceIds&, const SourceIds&) = default;
};

}  // namespace trephine
