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
constexpr std::size_t kMaxText = 4096;  // bytes; the longest path
constexpr Range kDirectionLength{1e-3, 1e3};

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
    return shorten(std::move(text), 120);
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
  std::error_code ec;
  const auto missing = [&](const char* what) {
    return Error{"MISSING_FILE", what, file.string(), "Check the name and that you may read it"};
  };
  // Asked before it is opened: opening a pipe waits for its writer.
  const auto status = std::filesystem::status(file, ec);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return missing("This is no file but a folder, a pipe or a device");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, ec);
  std::ifstream in(file, std::ios::binary);
  if (ec || !in) return missing("The file cannot be read");
  if (size > kMaxFileBytes) {
    return Error{"BAD_JSON", "The file is larger than 64 MB, which none of our JSON files is",
                 file.string(), "Choose another file"};
  }
  std::string text(std::size_t(size), '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
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

void JsonReader::outOfRange(const Json& value, const char* key, const Range& range) {
  fail(key, "The value " + shorten(value) + " must lie " + range.words());
}

double JsonReader::asNumber(const Json& value, const char* key, const Range& range) {
  if (!value.is_number()) {
    fail(key, "Expected a number, found " + shorten(value));
    return 0.0;
  }
  const double number = value.get<double>();
  if (range.holds(number)) return number;
  if (std::isfinite(number)) {
    outOfRange(value, key, range);
  } else {
    fail(key, "The number " + std::to_string(number) + " is not finite");  // JSON has no nan
  }
  return 0.0;
}

double JsonReader::number(const char* key, const Range& range) {
  const Json* value = find(key, true);
  return value ? asNumber(*value, key, range) : 0.0;
}

double JsonReader::number(const char* key, const Range& range, double fallback) {
  const Json* value = find(key, false);
  return value ? asNumber(*value, key, range) : fallback;
}

std::int64_t JsonReader::asInteger(const Json& value, const char* key, const Range& range) {
  // A literal beyond int64 is kept as unsigned and would wrap round.
  constexpr auto kMax = std::uint64_t(std::numeric_limits<std::int64_t>::max());
  if (!value.is_number_integer() ||
      (value.is_number_unsigned() && value.get<std::uint64_t>() > kMax)) {
    fail(key, "Expected a whole number, found " + shorten(value));
    return 0;
  }
  const auto number = value.get<std::int64_t>();
  if (range.holds(double(number))) return number;
  outOfRange(value, key, range);
  return 0;
}

std::int64_t JsonReader::integer(const char* key, const Range& range) {
  const Json* value = find(key, true);
  return value ? asInteger(*value, key, range) : 0;
}

std::int64_t JsonReader::integer(const char* key, const Range& range, std::int64_t fallback) {
  return has(key) ? integer(key, range) : (find(key, false), fallback);
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
  if (value->get_ref<const std::string&>().size() > kMaxText) {
    fail(key,
         "The text " + shorten(*value) + " is longer than " + std::to_string(kMaxText) + " bytes");
    return {};
  }
  return value->get<std::string>();
}

std::string JsonReader::text(const char* key, std::string fallback) {
  return has(key) ? text(key) : (find(key, false), fallback);
}

const Json* JsonReader::list(const char* key, std::size_t least, std::size_t most, const char* of) {
  const Json* value = find(key, true);
  if (!value) return nullptr;
  if (!value->is_array()) {
    fail(key, std::string("Expected a list of ") + of + ", found " + shorten(*value));
    return nullptr;
  }
  if (value->size() >= least && value->size() <= most) return value;
  fail(key, std::string("Expected a list of ") + (least == most ? "" : "at most ") +
                std::to_string(most) + " " + of + ", found " + std::to_string(value->size()) +
                ": " + shorten(*value));
  return nullptr;
}

Vec3 JsonReader::vec3(const char* key, const Range& range) {
  const std::vector<double> three = numbers(key, 3, range);
  return {three[0], three[1], three[2]};
}

Vec3 JsonReader::vec3(const char* key, const Range& range, Vec3 fallback) {
  return has(key) ? vec3(key, range) : (find(key, false), fallback);
}

Vec3 JsonReader::direction(const char* key) {
  const Vec3 along = vec3(key, {-kDirectionLength.high, kDirectionLength.high});
  const double length = glm::length(along);
  constexpr double kUnit = 1e-12;  // what was written as a unit vector is read as it was, to the bit
  if (std::abs(length - 1.0) < kUnit) return along;
  if (kDirectionLength.holds(length)) return along / length;
  fail(key, "The direction has a length of " + plainNumber(length) + ", which must lie " +
                kDirectionLength.words());
  return {0.0, 0.0, 1.0};
}

Vec3 JsonReader::direction(const char* key, Vec3 fallback) {
  return has(key) ? direction(key) : (find(key, false), fallback);
}

std::vector<std::string> JsonReader::texts(const char* key, std::size_t most) {
  std::vector<std::string> out;
  const Json* value = list(key, 0, most, "texts");
  if (!value) return out;
  for (const Json& item : *value) {
    if (item.is_string()) {
      out.push_back(item.get<std::string>());
    } else {
      fail(key, "Expected a list of texts, found " + shorten(item));
    }
  }
  return out;
}

std::vector<std::int64_t> JsonReader::integers(const char* key, std::size_t count,
                                               const Range& range) {
  std::vector<std::int64_t> out(count, 0);
  const Json* value = list(key, count, count, "whole numbers");
  for (std::size_t i = 0; value && i < count; ++i) out[i] = asInteger((*value)[i], key, range);
  return out;
}

std::vector<double> JsonReader::numbers(const char* key, std::size_t count, const Range& range) {
  std::vector<double> out(count, 0.0);
  const Json* value = list(key, count, count, "numbers");
  for (std::size_t i = 0; value && i < count; ++i) out[i] = asNumber((*value)[i], key, range);
  return out;
}

JsonReader JsonReader::object(const char* key) {
  const Json* value = find(key, true);
  JsonReader child(value ? value : &kEmptyObject, state_, fieldName(key));
  children_->push_back(child);
  return child;
}

std::vector<JsonReader> JsonReader::objects(const char* key, std::size_t most) {
  std::vector<JsonReader> out;
  const Json* value = list(key, 0, most, "objects");
  if (!value) return out;
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
  (void)text("purpose", "");     // kPurpose: what is saved for others says it
  constexpr double kAny = 1e15;  // each has an answer of its own below
  std::int64_t number = integer("version", {-kAny, kAny});
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
