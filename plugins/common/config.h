// A plugin's configuration: JSON text, format "trephine.device", version 1. What is wrong is thrown
// as one sentence that names field and value.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "plugin.h"

namespace trephine::plugin {

using Json = nlohmann::json;

[[noreturn]] inline void refuseText(std::string sentence) {
  throw Refused{TREPHINE_ERROR_ARGUMENT, std::move(sentence)};
}

[[noreturn]] inline void refuseField(const std::string& field, const std::string& why) {
  refuseText("Field '" + field + "': " + why);
}

// As a sentence shows it: shortened.
inline std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

inline std::string joined(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

inline const Json& member(const Json& object, const char* key, const std::string& parent) {
  auto it = object.find(key);
  if (it == object.end()) refuseField(joined(parent, key), "this required field is missing.");
  return *it;
}

inline void checkObject(const Json& value, const std::string& field,
                        const std::vector<std::string_view>& keys) {
  if (!value.is_object()) refuseField(field, "expected an object, found " + shown(value) + ".");
  for (auto it = value.begin(); it != value.end(); ++it) {
    if (std::find(keys.begin(), keys.end(), it.key()) != keys.end()) continue;
    refuseField(joined(field, it.key()), "unknown field with value " + shown(it.value()) +
                                             "; remove it or correct its name.");
  }
}

// Both ends are allowed.
inline double checkNumber(const Json& value, const std::string& field, double low, double high) {
  if (!value.is_number()) refuseField(field, "expected a number, found " + shown(value) + ".");
  const double number = value.get<double>();
  if (number >= low && number <= high) return number;
  refuseField(field, "the value " + shown(value) + " must be at least " + shown(low) +
                         " and at most " + shown(high) + ".");
}

inline bool checkBool(const Json& value, const std::string& field) {
  if (!value.is_boolean())
    refuseField(field, "expected true or false, found " + shown(value) + ".");
  return value.get<bool>();
}

inline std::string checkText(const Json& object, const char* key, const std::string& parent) {
  const Json& value = member(object, key, parent);
  if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
    refuseField(joined(parent, key), "expected text, found " + shown(value) + ".");
  }
  return value.get<std::string>();
}

// A number of a configuration in one row; where it is absent, `into` keeps its own.
template <class Config>
struct NumberOf {
  const char* key;
  double low, high;  // both ends are allowed
  double Config::*member;
};

template <class Config, std::size_t kCount>
std::vector<std::string_view> keysOf(const NumberOf<Config> (&numbers)[kCount]) {
  std::vector<std::string_view> keys;
  for (const NumberOf<Config>& n : numbers) keys.push_back(n.key);
  return keys;
}

template <class Config, std::size_t kCount>
void readNumbers(const Json& root, const NumberOf<Config> (&numbers)[kCount], Config& into) {
  for (const NumberOf<Config>& n : numbers) {
    if (root.contains(n.key)) into.*n.member = checkNumber(root[n.key], n.key, n.low, n.high);
  }
}

// The text as an object with format, version, model and no other fields than `keys`.
inline Json parseConfig(const char* text, std::vector<std::string_view> keys) {
  constexpr int kVersion = 1;
  constexpr int kMaxDepth = 64;  // printing a value recurses, so nesting has to end
  Json root;
  try {
    root = Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
      if (depth <= kMaxDepth) return true;
      refuseText("The text is nested deeper than " + std::to_string(kMaxDepth) + ".");
    });
  } catch (const Json::parse_error& e) {
    refuseText("The text is not valid JSON at byte " + std::to_string(e.byte) + ".");
  } catch (const Json::exception& e) {  // a number that is too large
    refuseText(e.what());
  }
  if (!root.is_object()) refuseText("Expected an object, found " + shown(root) + ".");
  keys.insert(keys.end(), {"format", "version", "model"});
  checkObject(root, "", keys);
  const std::string format = checkText(root, "format", "");
  if (format != "trephine.device") {
    refuseField("format", "this is '" + format + "', not 'trephine.device'.");
  }
  const Json& version = member(root, "version", "");
  if (!version.is_number_integer() || version < 1) {
    refuseField("version", "expected a whole number from 1, found " + shown(version) + ".");
  }
  if (version > kVersion) {
    refuseField("version", "version " + shown(version) + " is newer than version " +
                               std::to_string(kVersion) + ", which this plugin reads.");
  }
  checkText(root, "model", "");
  return root;
}

}  // namespace trephine::plugin
