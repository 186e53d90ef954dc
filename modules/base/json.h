// Strict reading of our JSON files: a missing key, an unknown key, a wrong type or a non-finite
// number is an Error that names file, field and value.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

using Json = nlohmann::ordered_json;

// Refuses what is not JSON, a number that no double holds (1e999), a field given twice in one
// object, nesting deeper than 64 and a file of over 64 MB.
Result<Json> parseJson(std::string_view text, const std::string& file);
Result<Json> readJsonFile(const std::filesystem::path& file);

// Reads one JSON object field by field. The first problem is kept and every later read returns a
// default, so that a caller reads all fields straight through and asks `finish()` once.
class JsonReader {
 public:
  JsonReader(const Json& object, std::string file, std::string field = "");

  bool has(const char* key) const;
  double number(const char* key);
  double number(const char* key, double fallback);
  std::int64_t integer(const char* key);
  std::int64_t integer(const char* key, std::int64_t fallback);
  bool boolean(const char* key, bool fallback);
  std::string text(const char* key);
  std::string text(const char* key, std::string fallback);
  Vec3 vec3(const char* key);
  Vec3 vec3(const char* key, Vec3 fallback);
  std::vector<std::string> texts(const char* key);
  // Always `count` values: zeros after a problem.
  std::vector<std::int64_t> integers(const char* key, std::size_t count);
  // The sub-object or the array's elements, each with its own field name.
  JsonReader object(const char* key);
  std::vector<JsonReader> objects(const char* key);
  // The raw value; null where absent.
  const Json& raw(const char* key);

  // Checks `format` and `version`: a newer version is refused by name.
  void format(const char* format, int version);

  // Records a problem found by the caller; `field` is the key, "" the object itself.
  void fail(const char* field, const std::string& what, const std::string& next = "");
  // The first problem of this reader or of any reader made from it; also reports unknown keys.
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
  double asNumber(const Json& value, const char* key);
  std::int64_t asInteger(const Json& value, const char* key);
  void checkUnknown();

  const Json* object_;
  std::shared_ptr<State> state_;
  std::string field_;
  std::shared_ptr<std::vector<std::string>> seen_;
  std::shared_ptr<std::vector<JsonReader>> children_;
};

}  // namespace trephine
