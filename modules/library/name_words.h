// Names as what can be compared: by the same words, however they are written. Pure.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "imaging/common/source_identity.h"
#include "volume/segmentation.h"

namespace trephine {

// The words of a text, in its order: split where a letter meets a sign, a blank, a digit or another
// script, and a small letter a capital; without accents, in small letters, of hiragana and katakana
// the first. "DOE^Jane-2" is "doe", "jane", "2".
std::vector<std::string> wordsOf(std::string_view text);

// One line of at most 80 visible characters, without blanks around it. Error: BAD_NAME.
constexpr int kLongestCaseName = 80;
Result<std::string> caseNameFrom(std::string_view text);
// Equal for names that a person would take for the same: letters in either case, blanks. It is for
// comparing, not for showing.
std::string foldedName(std::string_view name);

// What a name may neither be nor hold, given whom its source is of, as keys that are compared as
// they are or by their hashes.
struct SourceKeys {
  std::map<std::string, IdentityKind> keys;
  int most_words = 2;       // that a key of what a name may not hold is made of
  std::set<int> lengths{};  // in characters, of such keys in scripts that leave no blanks
};
SourceKeys sourceKeys(const SourceIdentity& source);

// The keys of a name: the source's is among them where the name is or holds what it may not.
// `most_words` and `lengths` as of SourceKeys.
std::set<std::string> nameKeys(std::string_view name, int most_words, const std::set<int>& lengths);

// What of the source the name tells, of several the first kind; nothing where it tells none of it.
// A case's name is refused for every kind, a structure's only where tellsPatient().
std::optional<IdentityKind> toldBy(std::string_view name, const SourceKeys& source);
// Segments whose names tell who the patient is are called by their values, "label 7"; how many.
int hideNames(Segmentation& segmentation, const SourceKeys& source);
int hideNamesOf(Segmentation& segmentation, const SourceIdentity& source);
// Name, ID or accession number; not what folders and files are called.
bool tellsPatient(IdentityKind kind);
// NAME_IS_IDENTITY: why a name that tells this is refused. It repeats nothing of it.
Error identityError(IdentityKind told);
const char* identityKindName(IdentityKind kind);  // "patient_name"
std::optional<IdentityKind> identityKindNamed(std::string_view name);

}  // namespace trephine
