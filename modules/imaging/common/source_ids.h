// Which study, series and frame of reference something is of, by hashes: to tell what belongs
// together, where the UIDs themselves may not stand.
#pragma once

#include <string>

namespace trephine {

// Stands for a UID within a program: 32 hexadecimal digits, the same on every machine, with the
// "#2" of a part of a series. From SHA-256 of the UID. Whoever has a list of UIDs finds the patient
// by it: it is never written or printed.
std::string seriesHash(const std::string& uid);
// The same; empty where the UID is.
std::string hashOrNone(const std::string& uid);

// Hashes; empty where unknown.
struct SourceIds {
  std::string study{}, series{}, frame_of_reference{};
  // Of a case that is kept: each of the three is the HMAC-SHA256 of what it was, by this key of the
  // case's own. Empty: they are those of seriesHash().
  std::string key{};
  // They are kept where this account may not read: nothing can be told by them.
  bool unreadable = false;

  bool empty() const { return study.empty() && series.empty() && frame_of_reference.empty(); }
  // Whether `own`, one of the three, stands for the UID of which `hash` is the seriesHash().
  bool standsFor(const std::string& own, const std::string& hash) const;
  // These, which are those of seriesHash(), by a key.
  SourceIds keyed(const std::string& with_key) const;

  friend bool operator==(const SourceIds&, const SourceIds&) = default;
};

}  // namespace trephine
