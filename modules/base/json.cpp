#include "base/json.h"

#include <algorithm>
#include <limits>
#include <set>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "base/utf8.h"

namespace trephine {

namespace {

constexpr std::size_t kMaxDepth = 64;  // printing a value recurses, so nesting has to end
// A field is found by a search through its object, and a value takes up to 80 bytes of memory.
constexpr std::size_t kMaxMembers = 1024;
constexpr std::size_t kMaxValues = 4000000;
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

// Whether a value has more text or parts than are worth writing for its first letters.
bool isLong(const Json& value, std::size_t& left) {
  if (left == 0) return true;
  --left;
  if (value.is_string()) {
    const std::size_t size = value.get_ref<const std::string&>().size();
    left -= std::min(left, size / 64);
  }
  if (!value.is_structured()) return left == 0;
  for (const Json& part : value) {
    if (isLong(part, left)) return true;
  }
  return false;
}

std::string shorten(const Json& value) {
  std::size_t most = 1000;
  if (isLong(value, most)) {
    return value.is_array()    ? tr("a list of {}", value.size())
           : value.is_object() ? tr("an object of {}", value.size())
                               : tr("a long text");
  }
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return shorten(std::move(text), 60);
}

// Makes the value out of what the parser reads. The library's own maker searches all members of an
// object for each new one, and lets pass a field given twice.
class ValueMaker : public Json::json_sax_t {
 public:
  explicit ValueMaker(const Progress& progress) : progress_(progress) { levels_.reserve(kMaxDepth); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(std::int64_t value) override { return add(value); }
  bool number_unsigned(std::uint64_t value) override { return add(value); }
  bool number_float(double value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(Json::binary_t&) override { return refuse(tr("it is binary")); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    Level& level = levels_.back();
    level.key = std::move(name);
    if (!level.keys.insert(level.key).second) return refuse(tr("a field is given twice"));
    if (level.keys.size() <= kMaxMembers) return true;
    return refuse(tr("an object has more than {} fields", kMaxMembers));
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& e) override {
    constexpr int kOutOfRange = 406;  // a number that no double holds
    const std::string said = e.what();
    // The library's message holds its own tag, then line and column.
    const auto line = said.find("line ");
    const auto words = said.find("] ");
    if (e.id == kOutOfRange && words != said.npos) return refuse(said.substr(words + 2));
    reason_ = line == said.npos ? said : said.substr(line);
    return false;
  }

  Json take() { return std::move(value_); }
  bool wasCancelled() const { return cancelled_; }
  const std::string& reason() const { return reason_; }
  // Where a value was refused; empty for what is no JSON.
  const std::string& field() const { return field_; }

 private:
  // What is open: a list, or an object of whose members one is being read.
  struct Level {
    bool is_list;
    Json::array_t items{};
    std::vector<std::pair<std::string, Json>> members{};
    std::string key{};
    std::set<std::string> keys{};
  };

  bool refuse(const std::string& why) {
    reason_ = why;
    for (const Level& level : levels_) {
      if (level.is_list) {
        field_ += "[" + std::to_string(level.items.size()) + "]";
      } else if (!level.key.empty()) {
        field_ += (field_.empty() ? "" : ".") + level.key;
      }
    }
    field_ = shorten(std::move(field_), 120);
    return false;
  }
  bool count() {
    constexpr std::size_t kLooks = 4096;  // values from one look at `cancelled` to the next
    if (++values_ > kMaxValues) {
      return refuse(tr("it holds more than {} values", kMaxValues));
    }
    cancelled_ = values_ % kLooks == 0 && progress_.cancelled();
    return !cancelled_;
  }
  void place(Json value) {
    if (levels_.empty()) {
      value_ = std::move(value);
    } else if (levels_.back().is_list) {
      levels_.back().items.push_back(std::move(value));
    } else {
      levels_.back().members.emplace_back(levels_.back().key, std::move(value));
    }
  }
  bool add(Json value) {
    if (!count()) return false;
    place(std::move(value));
    return true;
  }
  bool open(bool is_list) {
    if (levels_.size() >= kMaxDepth) {
      return refuse(tr("it is nested deeper than {}", kMaxDepth));
    }
    if (!count()) return false;
    levels_.push_back({is_list});
    return true;
  }
  bool close() {
    Level done = std::move(levels_.back());
    levels_.pop_back();
    if (done.is_list) {
      place(Json(std::move(done.items)));
      return true;
    }
    // The vector's own, which does not search for the key, and with room for all: its elements are
    // copied where it grows.
    Json::object_t object;
    object.reserve(done.members.size());
    for (auto& [key, value] : done.members) {
      object.Json::object_t::Container::emplace_back(std::move(key), std::move(value));
    }
    place(Json(std::move(object)));
    return true;
  }

  const Progress& progress_;
  Json value_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
  bool cancelled_ = false;
  std::string reason_, field_;
};

}  // namespace

Result<Json> parseJson(std::string_view text, const std::string& file, const Progress& progress) {
  ValueMaker maker(progress);
  std::string reason;
  try {
    if (Json::sax_parse(text, &maker)) return maker.take();
    if (maker.wasCancelled()) return Error{code::kCancelled, tr("Reading was cancelled"), file, ""};
    reason = maker.reason();
  } catch (const std::exception& e) {  // no memory
    reason = e.what();
  }
  return Error{
      code::kBadJson, tr("The file is not valid JSON: {}", shorten(std::move(reason), 200)),
      file + (maker.field().empty() ? "" : ": " + maker.field()), tr("Correct it at that place")};
}

Result<Json> readJsonFile(const std::filesystem::path& file, const Progress& progress,
                          std::size_t most_bytes) {
  Result<std::string> text = readWholeFile(file, most_bytes);
  if (text) return parseJson(*text, file.string(), progress);
  Error error = text.error();
  const bool too_large = error.code == code::kTooLarge;
  error.code = too_large ? code::kBadJson : code::kMissingFile;
  if (too_large) error.what += tr(", which none of our files of this kind is");
  return error;
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
    fail("", tr("Expected an object, found {}", shorten(*object_)));
    object_ = &kEmptyObject;
  }
}

namespace {

std::string seeSchema() {
  return tr("Correct it; the file's schema describes every field");
}

std::string addAsInSchema() {
  return tr("Add it; the schema lists every field");
}

}  // namespace

bool pointsToSchema(const Error& error) {
  return error.next == seeSchema() || error.next == addAsInSchema();
}

std::string JsonReader::fieldName(const char* key) const {
  if (*key == '\0') return field_.empty() ? tr("the file's top level") : field_;
  return field_.empty() ? key : field_ + "." + key;
}

void JsonReader::fail(const char* key, const std::string& what, const std::string& next) {
  if (state_->error) return;
  state_->error = Error{code::kBadField, what, state_->file + ": " + fieldName(key),
                        next.empty() ? seeSchema() : next};
}

bool JsonReader::has(const char* key) const {
  return object_->contains(key);
}

const Json* JsonReader::find(const char* key, bool required) {
  seen_->emplace_back(key);
  auto it = object_->find(key);
  if (it != object_->end()) return &*it;
  if (required) fail(key, tr("A required field is missing"), addAsInSchema());
  return nullptr;
}

void JsonReader::outOfRange(const Json& value, const char* key, const Range& range) {
  fail(key, tr("The value {} must lie {}", shorten(value), range.words()));
}

double JsonReader::asNumber(const Json& value, const char* key, const Range& range) {
  if (!value.is_number()) {
    fail(key, tr("Expected a number, found {}", shorten(value)));
    return 0.0;
  }
  const double number = value.get<double>();
  if (range.holds(number)) return number;
  if (std::isfinite(number)) {
    outOfRange(value, key, range);
  } else {
    fail(key, tr("The number {} is not finite", std::to_string(number)));  // JSON has no nan
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
    fail(key, tr("Expected a whole number, found {}", shorten(value)));
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
    fail(key, tr("Expected true or false, found {}", shorten(*value)));
    return fallback;
  }
  return value->get<bool>();
}

std::string JsonReader::text(const char* key) {
  const Json* value = find(key, true);
  if (!value) return {};
  if (!value->is_string()) {
    fail(key, tr("Expected text, found {}", shorten(*value)));
    return {};
  }
  if (value->get_ref<const std::string&>().size() > kMaxText) {
    fail(key, tr("The text {} is longer than {} bytes", shorten(*value), kMaxText));
    return {};
  }
  checkOneLine(*value, key);
  return value->get<std::string>();
}

void JsonReader::checkOneLine(const Json& text, const char* key) {
  if (isOneLine(text.get_ref<const std::string&>())) return;
  fail(key,
       tr("The text {} is no plain line: it has line breaks or control characters", shorten(text)));
}

std::string JsonReader::text(const char* key, std::string fallback) {
  return has(key) ? text(key) : (find(key, false), fallback);
}

const Json* JsonReader::list(const char* key, std::size_t least, std::size_t most,
                             const std::string& of) {
  const Json* value = find(key, true);
  if (!value) return nullptr;
  if (!value->is_array()) {
    fail(key, tr("Expected a list of {}, found {}", of, shorten(*value)));
    return nullptr;
  }
  if (value->size() >= least && value->size() <= most) return value;
  fail(key, tr("Expected a list of {}{} {}, found {}: {}", (least == most ? "" : tr("at most ")),
               most, of, value->size(), shorten(*value)));
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
  fail(key, tr("The direction has a length of {}, which must lie {}", plainNumber(length),
               kDirectionLength.words()));
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
      checkOneLine(item, key);
      out.push_back(item.get<std::string>());
    } else {
      fail(key, tr("Expected a list of texts, found {}", shorten(item)));
    }
  }
  return out;
}

std::vector<std::int64_t> JsonReader::integers(const char* key, std::size_t count,
                                               const Range& range) {
  std::vector<std::int64_t> out(count, 0);
  const Json* value = list(key, count, count, tr("whole numbers"));
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
    fail("format", tr("This is a '{}' file, not a '{}' file", found, format));
  } else if (number > version) {
    fail("version",
         tr("The file has version {} of {}, and this program reads up to {}", number, format,
            version),
         tr("Open it with a newer Trephine"));
  } else if (number < 1) {
    fail("version", tr("The version {} does not exist", number));
  }
}

void JsonReader::checkUnknown() {
  for (auto it = object_->begin(); it != object_->end(); ++it) {
    if (std::find(seen_->begin(), seen_->end(), it.key()) == seen_->end()) {
      fail(it.key().c_str(), tr("Unknown field with value {}", shorten(it.value())),
           tr("Remove it or correct its name"));
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
