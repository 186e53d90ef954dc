#include "arm_config.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace trephine::simulated {

namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr int kMaxDepth = 64;  // printing a value recurses, so nesting has to end
constexpr double kMinEncoderStep_m = 1e-9;
// What files of before say of an arm; the host computes its own bound.
constexpr const char* kNoLongerRead[] = {"max_stiffness_N_per_m", "max_damping_Ns_per_m"};

// Caught in parseConfig: nothing leaves this file by exception.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Range {
  double low;
  double high;  // both ends are allowed
};

std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string joined(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

[[noreturn]] void refuse(const std::string& field, const std::string& why) {
  throw Refused("Field '" + field + "': " + why);
}

const Json& member(const Json& object, const char* key, const std::string& parent) {
  auto it = object.find(key);
  if (it == object.end()) refuse(joined(parent, key), "this required field is missing.");
  return *it;
}

void checkObject(const Json& value, const std::string& field,
                 const std::vector<std::string_view>& keys) {
  if (!value.is_object()) refuse(field, "expected an object, found " + shown(value) + ".");
  for (auto it = value.begin(); it != value.end(); ++it) {
    bool known = false;
    for (std::string_view key : keys) known = known || key == it.key();
    if (!known) {
      refuse(joined(field, it.key()),
             "unknown field with value " + shown(it.value()) + "; remove it or correct its name.");
    }
  }
}

double checkNumber(const Json& value, const std::string& field, const Range& range) {
  if (!value.is_number()) refuse(field, "expected a number, found " + shown(value) + ".");
  const double number = value.get<double>();
  if (!(number >= range.low && number <= range.high)) {
    refuse(field, "the value " + shown(value) + " must be at least " + shown(range.low) +
                      " and at most " + shown(range.high) + ".");
  }
  return number;
}

std::string checkText(const Json& object, const char* key, const std::string& parent) {
  const Json& value = member(object, key, parent);
  if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
    refuse(joined(parent, key), "expected text, found " + shown(value) + ".");
  }
  return value.get<std::string>();
}

// {"value": ..., "source": text, "verified": true or false} -> its value.
const Json& sourced(const Json& arm, const char* key, const std::string& parent) {
  const Json& number = member(arm, key, parent);
  const std::string field = joined(parent, key);
  checkObject(number, field, {"value", "source", "verified"});
  checkText(number, "source", field);
  const Json& verified = member(number, "verified", field);
  if (!verified.is_boolean()) {
    refuse(joined(field, "verified"), "expected true or false, found " + shown(verified) + ".");
  }
  return member(number, "value", field);
}

void readNumber(const Json& arm, const ArmNumber& number, const std::string& parent,
                ArmConfig& config) {
  if (number.optional && !arm.contains(number.key)) return;
  const Json& value = sourced(arm, number.key, parent);
  const std::string field = joined(parent, number.key) + ".value";
  const Range range{number.low, number.high};
  double values[3] = {};
  if (number.count == 1) {
    values[0] = checkNumber(value, field, range);
  } else {
    if (!value.is_array() || value.size() != 3) {
      refuse(field, "expected three numbers, found " + shown(value) + ".");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[axis] = checkNumber(value[axis], field + "[" + std::to_string(axis) + "]", range);
    }
  }
  number.set(config, values);
}

ArmConfig parseArm(const Json& arm, const std::string& field) {
  std::vector<std::string_view> keys;
  for (const ArmNumber& number : kArmNumbers) keys.push_back(number.key);
  for (const char* key : kNoLongerRead) keys.push_back(key);
  checkObject(arm, field, keys);
  ArmConfig config;
  TrephineCapabilities& c = config.capabilities;
  c.size = sizeof(TrephineCapabilities);
  c.version = TREPHINE_DEVICE_ABI;
  c.input_dof = 6;
  for (const ArmNumber& number : kArmNumbers) readNumber(arm, number, field, config);
  if (c.encoder_step_m > 0.0 && c.encoder_step_m < kMinEncoderStep_m) {
    refuse(joined(field, "encoder_step_m.value"), "the value " + shown(c.encoder_step_m) +
                                                      " must be 0 or at least " +
                                                      shown(kMinEncoderStep_m) + ".");
  }
  if (c.continuous_force_N > c.peak_force_N) {
    refuse(joined(field, "continuous_force_N.value"), "the value " + shown(c.continuous_force_N) +
                                                          " must be at most the peak force of " +
                                                          shown(c.peak_force_N) + ".");
  }
  return config;
}

void checkFormat(const Json& root) {
  const std::string format = checkText(root, "format", "");
  if (format != "trephine.device") {
    refuse("format", "this is '" + format + "', not 'trephine.device'.");
  }
  const Json& version = member(root, "version", "");
  if (!version.is_number_integer() || version < 1) {
    refuse("version", "expected a whole number from 1, found " + shown(version) + ".");
  }
  if (version > kVersion) {
    refuse("version", "version " + shown(version) + " is newer than version " +
                          std::to_string(kVersion) + ", which this plugin reads.");
  }
}

DeviceConfig parseRoot(const Json& root, std::size_t n_arms) {
  std::vector<std::string_view> keys{"format", "version", "model", "arm", "arms"};
  for (const TroubleNumber& trouble : kTroubleNumbers) keys.push_back(trouble.key);
  checkObject(root, "", keys);
  checkFormat(root);
  checkText(root, "model", "");
  if (root.contains("arm") == root.contains("arms")) {
    refuse("arm", "give either 'arm', one object for every arm, or 'arms', a list of them.");
  }
  DeviceConfig config;
  if (root.contains("arm")) {
    config.arms.assign(n_arms, parseArm(root["arm"], "arm"));
  } else {
    const Json& arms = root["arms"];
    if (!arms.is_array()) refuse("arms", "expected a list, found " + shown(arms) + ".");
    if (arms.size() != n_arms) {
      refuse("arms", "it describes " + std::to_string(arms.size()) + " arms, and " +
                         std::to_string(n_arms) + " are open.");
    }
    for (std::size_t i = 0; i < n_arms; ++i) {
      config.arms.push_back(parseArm(arms[i], "arms[" + std::to_string(i) + "]"));
    }
  }
  for (const TroubleNumber& trouble : kTroubleNumbers) {
    if (!root.contains(trouble.key)) continue;
    if (trouble.together && !root.contains(trouble.together)) {
      refuse(trouble.key, "it goes together with '" + std::string(trouble.together) + "'.");
    }
    config.troubles.*trouble.member = checkNumber(root[trouble.key], trouble.key, {0.0, 1e6});
  }
  return config;
}

}  // namespace

bool parseConfig(const char* text, std::size_t n_arms, DeviceConfig& config, std::string& error) {
  try {
    const Json root = Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
      if (depth > kMaxDepth) {
        throw Refused("The text is nested deeper than " + std::to_string(kMaxDepth) + ".");
      }
      return true;
    });
    if (!root.is_object()) throw Refused("Expected an object, found " + shown(root) + ".");
    config = parseRoot(root, n_arms);
    return true;
  } catch (const Json::parse_error& e) {
    error = "The text is not valid JSON at byte " + std::to_string(e.byte) + ".";
  } catch (const std::exception& e) {
    error = e.what();
  }
  return false;
}

}  // namespace trephine::simulated
