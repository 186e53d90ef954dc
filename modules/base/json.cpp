#include "base/json.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

namespace trephine {

namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxDepth = 64;  // printing a value recurses, so nesting has to end

const Json kNull = nullptr;
const Json kEmptyObject = Json::object();

// Cuts between characters: half a UTF-8 character could not be written as JSON.
std::string shorten(std::string text, std::size_t length) {
  if (text.size() <= length) return text;
  length -= 3;
  while (length > 0 && (text[length] & 0xC0) == 0x80) --length;
  return text.substr(0, length) + "...";
}

std::string shorten(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return shorten(std::move(text), 60);
}

// Follows the parser, so that what it refuses can be named by its field, and refuses what it lets
// pass: a field given twice and nesting without end.
class ParseWatch {
 public:
  bool operator()(Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        if (levels_.size() >= kMaxDepth) {
          throw std::length_error("it is nested deeper than " + std::to_string(kMaxDepth));
        }
        levels_.push_back({event == Event::array_start, 0, {}, {}});
        break;
      case Event::key:
        levels_.back().key = parsed.get<std::string>();
        if (!levels_.back().keys.insert(levels_.back().key).second) {
          throw std::invalid_argument("a field is given twice");
        }
        break;
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        [[fallthrough]];
      case Event::value:
        if (!levels_.empty()) ++levels_.back().index;
        break;
    }
    return true;
  }

  std::string field() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.is_array) {
        text += "[" + std::to_string(level.index) + "]";
      } else if (!level.key.empty()) {
        text += (text.empty() ? "" : ".") + level.key;
      }
    }
    return text;
  }

 private:
  struct Level {
    bool is_array;
    std::size_t index;
    std::string key;
    std::set<std::string> keys;
  };
  std::vector<Level> levels_;
};

}  // namespace

Result<Json> parseJson(std::string_view text, const std::string& file) {
  ParseWatch watch;
  std::string reason;
  std::string where = file;
  try {
    return Json::parse(
        text, [&](int, Json::parse_event_t event, Json& parsed) { return watch(event, parsed); });
  } catch (const Json::parse_error& e) {
    reason = e.what();
    // nlohmann's message holds line and column after its own tag.
    if (auto at = reason.find("line "); at != std::string::npos) reason = reason.substr(at);
  } catch (const std::exception& e) {  // a number out of range, or what the watch refuses
    reason = e.what();
    if (auto at = reason.find("] "); at != std::string::npos) reason = reason.substr(at + 2);
    where += ": " + watch.field();
  }
  return Error{"BAD_JSON", "The file is not valid JSON: " + shorten(std::move(reason), 200), where,
               "Correct it at that place"};
}

Result<Json> readJsonFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ec;
  if (!in || std::filesystem::is_directory(file, ec)) {
    return Error{"MISSING_FILE", "The file cannot be read", file.string(),
                 "Check the name and that you may read it"};
  }
  std::string text;
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), std::streamsize(piece.size())) || in.gcount() > 0) {
    text.append(piece.data(), std::size_t(in.gcount()));
    if (text.size() > kMaxFileBytes) {
      return Error{"BAD_JSON", "The file is larger than 64 MB, which none of our JSON files is",
                   file.string(), "Choose another file"};
    }
  }
  return parseJson(text, file.string());
}

JsonReader::JsonReader(const Json& object, std::string file, std::string field)
    : JsonReader(&object, std::make_shared<State>(State{std::move(file), {}}), std::move(field)) {}

JsonReader::JsonReader(const Json* object, std::shared_ptr<State> state, std::string field)
    : object_(object),
      state_(std::move(state)),
      field_(std::move(field)),
      seen_(std::make_shared<std::vector<std::string>>()),
      children_(std::make_shared<std::vector<JsonReader>>()) {
  if (!object_->is_object()) {
    fail("", "Expected an object, found " + shorten(*object_));
    object_ = &kEmptyObject;
  }
}

std::string JsonReader::fieldName(const char* key) const {
  if (*key == '\0') return field_.empty() ? "the file's top level" : field_;
  return field_.empty() ? key : field_ + "." + key;
}

void JsonReader::fail(const char* key, const std::string& what, const std::string& next) {
  if (state_->error) return;
  state_->error =
      Error{"BAD_FIELD", what, state_->file + ": " + fieldName(key),
            next.empty() ? "Correct it; the file's schema describes every field" : next};
}

bool JsonReader::has(const char* key) const {
  return object_->contains(key);
}

const Json* JsonReader::find(const char* key, bool required) {
  seen_->emplace_back(key);
  auto it = object_->find(key);
  if (it != object_->end()) return &*it;
  if (required) fail(key, "A required field is missing", "Add it; the schema lists every field");
  return nullptr;
}

double JsonReader::asNumber(const Json& value, const char* key) {
  if (!value.is_number()) {
    fail(key, "Expected a number, found " + shorten(value));
    return 0.0;
  }
  double number = value.get<double>();
  if (!std::isfinite(number)) {
    fail(key, "The number " + std::to_string(number) + " is not finite");
    return 0.0;
  }
  return number;
}

double JsonReader::number(const char* key) {
  const Json* value = find(key, true);
  return value ? asNumber(*value, key) : 0.0;
}

double JsonReader::number(const char* key, double fallback) {
  const Json* value = find(key, false);
  return value ? asNumber(*value, key) : fallback;
}

std::int64_t JsonReader::asInteger(const Json& value, const char* key) {
  // A literal beyond int64 is kept as unsigned and would wrap round.
  constexpr auto kMax = std::uint64_t(std::numeric_limits<std::int64_t>::max());
  if (!value.is_number_integer() ||
      (value.is_number_unsigned() && value.get<std::uint64_t>() > kMax)) {
    fail(key, "Expected a whole number, found " + shorten(value));
    return 0;
  }
  return value.get<std::int64_t>();
}

std::int64_t JsonReader::integer(const char* key) {
  const Json* value = find(key, true);
  return value ? asInteger(*value, key) : 0;
}

std::int64_t JsonReader::integer(const char* key, std::int64_t fallback) {
  return has(key) ? integer(key) : (find(key, false), fallback);
}

bool JsonReader::boolean(const char* key, bool fallback) {
  const Json* value = find(key, false);
  if (!value) return fallback;
  if (!value->is_boolean()) {
    fail(key, "Expected true or false, found " + shorten(*value));
    return fallback;
  }
  return value->get<bool>();
}

std::string JsonReader::text(const char* key) {
  const Json* value = find(key, true);
  if (!value) return {};
  if (!value->is_string()) {
    fail(key, "Expected text, found " + shorten(*value));
    return {};
  }
  return value->get<std::string>();
}

std::string JsonReader::text(const char* key, std::string fallback) {
  return has(key) ? text(key) : (find(key, false), fallback);
}

Vec3 JsonReader::vec3(const char* key) {
  const Json* value = find(key, true);
  Vec3 out{0.0};
  if (!value) return out;
  if (!value->is_array() || value->size() != 3) {
    fail(key, "Expected three numbers, found " + shorten(*value));
    return out;
  }
  for (int axis = 0; axis < 3; ++axis) out[axis] = asNumber((*value)[axis], key);
  return out;
}

Vec3 JsonReader::vec3(const char* key, Vec3 fallback) {
  return has(key) ? vec3(key) : (find(key, false), fallback);
}

std::vector<std::string> JsonReader::texts(const char* key) {
  const Json* value = find(key, true);
  std::vector<std::string> out;
  if (!value) return out;
  if (!value->is_array()) {
    fail(key, "Expected a list, found " + shorten(*value));
    return out;
  }
  for (const Json& item : *value) {
    if (item.is_string()) {
      out.push_back(item.get<std::string>());
    } else {
      fail(key, "Expected a list of texts, found " + shorten(item));
    }
  }
  return out;
}

std::vector<std::int64_t> JsonReader::integers(const char* key, std::size_t count) {
  const Json* value = find(key, true);
  std::vector<std::int64_t> out(count, 0);
  if (!value) return out;
  if (!value->is_array() || value->size() != count) {
    fail(key, "Expected a list of " + std::to_string(count) + " whole numbers, found " +
                  shorten(*value));
    return out;
  }
  for (std::size_t i = 0; i < count; ++i) out[i] = asInteger((*value)[i], key);
  return out;
}

JsonReader JsonReader::object(const char* key) {
  const Json* value = find(key, true);
  JsonReader child(value ? value : &kEmptyObject, state_, fieldName(key));
  children_->push_back(child);
  return child;
}

std::vector<JsonReader> JsonReader::objects(const char* key) {
  const Json* value = find(key, true);
  std::vector<JsonReader> out;
  if (!value) return out;
  if (!value->is_array()) {
    fail(key, "Expected a list, found " + shorten(*value));
    return out;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    out.push_back(JsonReader(&(*value)[i], state_, fieldName(key) + "[" + std::to_string(i) + "]"));
    children_->push_back(out.back());
  }
  return out;
}

const Json& JsonReader::raw(const char* key) {
  const Json* value = find(key, false);
  return value ? *value : kNull;
}

void JsonReader::format(const char* format, int version) {
  std::string found = text("format");
  std::int64_t number = integer("version");
  if (!ok()) return;
  if (found != format) {
    fail("format", "This is a '" + found + "' file, not a '" + format + "' file");
  } else if (number > version) {
    fail("version",
         "The file has version " + std::to_string(number) + " of " + format +
             ", and this program reads up to " + std::to_string(version),
         "Open it with a newer Trephine");
  } else if (number < 1) {
    fail("version", "The version " + std::to_string(number) + " does not exist");
  }
}

void JsonReader::checkUnknown() {
  for (auto it = object_->begin(); it != object_->end(); ++it) {
    if (std::find(seen_->begin(), seen_->end(), it.key()) == seen_->end()) {
      fail(it.key().c_str(), "Unknown field with value " + shorten(it.value()),
           "Remove it or correct its name");
      return;
    }
  }
  for (JsonReader& child : *children_) child.checkUnknown();
}

Status JsonReader::finish() {
  if (ok()) checkUnknown();
  if (state_->error) return *state_->error;
  return {};
}

}  // namespace trephine
