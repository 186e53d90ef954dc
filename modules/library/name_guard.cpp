#include "library/name_guard.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/codes.h"
#include "base/stretched_hash.h"
#include "base/tr.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kNamesVersion = 1;
constexpr std::size_t kMostHashes = 4096;
constexpr Range kIterations{1, 1e7}, kWords{1, 16}, kLengths{1, 64};

Error checkCancelled() {
  return Error{code::kCancelled, tr("Checking the name was cancelled"), "", ""};
}

}  // namespace

std::map<std::string, std::string> NameGuard::hashesOf(const std::vector<std::string>& keys,
                                                       const Progress& progress) const {
  std::vector<std::string> hashes(keys.size());
  onTwoThreads(int(keys.size()), [&](int n) {
    if (progress.cancelled()) return;
    hashes[std::size_t(n)] = stretchedHash(keys[std::size_t(n)], salt_, iterations_);
  });
  std::map<std::string, std::string> by_key;
  for (std::size_t n = 0; n < keys.size(); ++n) by_key[keys[n]] = hashes[n];
  return by_key;
}

Result<NameGuard> NameGuard::of(const SourceKeys& source, const Progress& progress) {
  NameGuard guard;
  Result<std::string> salt = randomHex(16);
  if (!salt) return salt.error();
  guard.salt_ = *salt;
  guard.iterations_ = kStretchIterations;
  guard.most_words_ = source.most_words;
  guard.lengths_ = source.lengths;
  std::vector<std::string> keys;
  for (const auto& [key, kind] : source.keys) keys.push_back(key);
  for (const auto& [key, hash] : guard.hashesOf(keys, progress)) {
    guard.hashes_[hash] = source.keys.at(key);
  }
  if (progress.cancelled()) return checkCancelled();
  return guard;
}

Result<NameGuard> NameGuard::read(const std::filesystem::path& file) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.filename().string());
  NameGuard guard;
  reader.format("trephine.names", kNamesVersion);
  guard.salt_ = reader.text("salt");
  guard.iterations_ = int(reader.integer("iterations", kIterations));
  guard.most_words_ = int(reader.integer("most_words", kWords));
  const Json& lengths = reader.raw("lengths");
  if (!lengths.is_array()) reader.fail("lengths", tr("Expected a list of whole numbers"));
  for (const Json& length : lengths) {
    if (length.is_number_integer() && kLengths.holds(length.get<double>())) {
      guard.lengths_.insert(length.get<int>());
    } else {
      reader.fail("lengths", tr("Expected whole numbers from 1 to 64"));
    }
  }
  for (JsonReader& item : reader.objects("refused", kMostHashes)) {
    const std::string hash = item.text("hash"), kind = item.text("kind");
    const std::optional<IdentityKind> known = identityKindNamed(kind);
    if (!known) item.fail("kind", tr("The kind of text is not known"));
    if (known) guard.hashes_[hash] = *known;
  }
  if (reader.has("source")) {
    JsonReader of = reader.object("source");
    guard.source_ = {of.text("study"), of.text("series"), of.text("frame_of_reference"),
                     of.text("key"), false};
  }
  if (Status status = reader.finish(); !status) return status.error();
  return guard;
}

Json NameGuard::toJson() const {
  Json refused = Json::array();
  for (const auto& [hash, kind] : hashes_) {
    refused.push_back({{"hash", hash}, {"kind", identityKindName(kind)}});
  }
  Json json = {{"format", "trephine.names"},   {"version", kNamesVersion},  {"salt", salt_},
               {"iterations", iterations_},    {"most_words", most_words_}, {"lengths", lengths_},
               {"refused", std::move(refused)}};
  if (!source_.empty()) {
    json["source"] = {{"study", source_.study},
                      {"series", source_.series},
                      {"frame_of_reference", source_.frame_of_reference},
                      {"key", source_.key}};
  }
  return json;
}

Status NameGuard::setSource(const SourceIds& ids) {
  source_ = ids;
  if (ids.empty() || !ids.key.empty()) return {};
  const Result<std::string> key = randomHex(16);
  if (!key) return key.error();
  source_ = ids.keyed(*key);
  return {};
}

Status NameGuard::check(const std::string& name) const {
  if (hashes_.empty()) return {};
  const std::set<std::string> keys = nameKeys(name, most_words_, lengths_);
  std::optional<IdentityKind> told;
  for (const auto& [key, hash] : hashesOf({keys.begin(), keys.end()}, Progress())) {
    const auto found = hashes_.find(hash);
    if (found != hashes_.end() && (!told || found->second < *told)) told = found->second;
  }
  if (told) return identityError(*told);
  return {};
}

Status NameGuard::checkPatient(const std::vector<std::string>& names,
                               const Progress& progress) const {
  if (hashes_.empty()) return {};
  // Names of structures share most of their words.
  std::set<std::string> all;
  std::vector<std::set<std::string>> keys;
  for (const std::string& name : names) {
    keys.push_back(nameKeys(name, most_words_, lengths_));
    all.insert(keys.back().begin(), keys.back().end());
  }
  const auto by_key = hashesOf({all.begin(), all.end()}, progress);
  if (progress.cancelled()) return checkCancelled();
  for (std::size_t n = 0; n < names.size(); ++n) {
    for (const std::string& key : keys[n]) {
      const auto found = hashes_.find(by_key.at(key));
      if (found == hashes_.end() || !tellsPatient(found->second)) continue;
      Error error = identityError(found->second);
      error.where = tr("name {} of {}", n + 1, names.size());
      return error;
    }
  }
  return {};
}

}  // namespace trephine
