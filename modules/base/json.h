// Strict reading of our JSON files: a missing key, an unknown key, a wrong type or a number out of
// its range is an Error that names file, field and value.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "base/progress.h"
#include "base/range.h"
#include "base/result.h"

namespace trephine {

using Json = nlohmann::ordered_json;

// Takes a time in proportion to the text. Refuses what is not JSON, a number that no double holds
// (1e999), a field given twice in one object, more than 1024 fields in one object, more than
// 4,000,000 values, and nesting deeper than 64. Errors: BAD_JSON, CANCELLED.
Result<Json> parseJson(std::string_view text, const std::string& file,
                       const Progress& progress = Progress());
// A file of at most 64 MB: no file of ours is larger. What is read on the window's thread has at
// most kMostWrittenBytes. Errors: MISSING_FILE, also for what is no regular file (a pipe could keep
// its reader waiting for ever), BAD_JSON for a larger one, and those of parseJson.
constexpr std::size_t kMostJsonBytes = std::size_t{64} << 20;
// Of an exercise, a tool, a tissue set: what a person writes. Read in 0.1 s.
constexpr std::size_t kMostWrittenBytes = std::size_t{4} << 20;
Result<Json> readJsonFile(const std::filesystem::path& file, const Progress& progress = Progress(),
                          std::size_t most_bytes = kMostJsonBytes);

// Reads one JSON object field by field. The first problem is kept and reading goes on: a caller
// reads all fields straight through, asks `finish()` once, and uses none of them after an error.
class JsonReader {
 public:
  // `object` outlives this reader and all that are made from it.
  JsonReader(const Json& object, std::string file, std::string field = "");

  bool has(const char* key) const;
  // Every number has a range: there is no other way to read one.
  double number(const char* key, const Range& range);
  double number(const char* key, const Range& range, double fallback);
  std::int64_t integer(const char* key, const Range& range);
  std::int64_t integer(const char* key, const Range& range, std::int64_t fallback);
  bool boolean(const char* key, bool fallback);
  // One line (isOneLine) of at most 4096 bytes: a line break in a name could forge a line of a
  // list.
  std::string text(const char* key);
  std::string text(const char* key, std::string fallback);
  Vec3 vec3(const char* key, const Range& range);
  Vec3 vec3(const char* key, const Range& range, Vec3 fallback);
  // Three numbers that point somewhere, made a unit vector: their length lies in 0.001 to 1000.
  Vec3 direction(const char* key);
  Vec3 direction(const char* key, Vec3 fallback);
  std::vector<std::string> texts(const char* key, std::size_t most);
  // Always `count` values: zeros after a problem.
  std::vector<std::int64_t> integers(const char* key, std::size_t count, const Range& range);
  std::vector<double> numbers(const char* key, std::size_t count, const Range& range);
  // The sub-object or the array's elements, each with its own field name. What has no fallback is
  // required, lists as well (texts and objects may be empty): ask has() first where it is not.
  JsonReader object(const char* key);
  std::vector<JsonReader> objects(const char* key, std::size_t most);
  // The raw value; null where absent. Not for numbers: they would have no range.
  const Json& raw(const char* key);

  // Checks `format` and `version`: 1 to `version` are read, a newer one is refused by name. A text
  // `purpose` may stand beside them.
  void format(const char* format, int version);

  // Records a problem found by the caller; `field` is the key, "" the object itself.
  void fail(const char* field, const std::string& what, const std::string& next = "");
  // Asked of the first reader alone: the first problem of it or of any reader made from it, unknown
  // keys of all of them included. Error: BAD_FIELD.
  Status finish();
  bool ok() const { return !state_->error; }
  const std::string& file() const { return state_->file; }
  std::string fieldName(const char* key) const;

 private:
  struct State {
    std::string file;
    std::optional<Error> error;
  };
  JsonReader(const Json* object, std::shared_ptr<State> state, std::string field);
  const Json* find(const char* key, bool required);
  // The list of that key; null after a problem.
  const Json* list(const char* key, std::size_t least, std::size_t most, const std::string& of);
  void checkOneLine(const Json& text, const char* key);
  double asNumber(const Json& value, const char* key, const Range& range);
  std::int64_t asInteger(const Json& value, const char* key, const Range& range);
  void outOfRange(const Json& value, const char* key, const Range& range);
  void checkUnknown();

  const Json* object_;
  std::shared_ptr<State> state_;
  std::string field_;
  std::shared_ptr<std::vector<std::string>> seen_;
  std::shared_ptr<std::vector<JsonReader>> children_;
};

// Whether all that the error of a JsonReader advises is to look at the file's schema.
bool pointsToSchema(const Error& error);

}  // namespace trephine
