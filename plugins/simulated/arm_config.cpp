#include "arm_config.h"

#include "../common/config.h"

namespace trephine::simulated {

namespace {

using namespace plugin;

constexpr double kMinEncoderStep_m = 1e-9;

// {"value": ..., "source": text, "verified": true or false} -> its value.
const Json& sourced(const Json& arm, const char* key, const std::string& parent) {
  const Json& number = member(arm, key, parent);
  const std::string field = joined(parent, key);
  checkObject(number, field, {"value", "source", "verified"});
  checkText(number, "source", field);
  checkBool(member(number, "verified", field), joined(field, "verified"));
  return member(number, "value", field);
}

void readNumber(const Json& arm, const ArmNumber& number, const std::string& parent,
                ArmConfig& config) {
  if (number.optional && !arm.contains(number.key)) return;
  const Json& value = sourced(arm, number.key, parent);
  const std::string field = joined(parent, number.key) + ".value";
  double values[3] = {};
  if (number.count == 1) {
    values[0] = checkNumber(value, field, number.low, number.high);
  } else {
    if (!value.is_array() || value.size() != 3) {
      refuseField(field, "expected three numbers, found " + shown(value) + ".");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[axis] = checkNumber(value[axis], field + "[" + std::to_string(axis) + "]", number.low,
                                 number.high);
    }
  }
  number.set(config, values);
}

ArmConfig parseArm(const Json& arm, const std::string& field) {
  std::vector<std::string_view> keys;
  for (const ArmNumber& number : kArmNumbers) keys.push_back(number.key);
  checkObject(arm, field, keys);
  ArmConfig config;
  TrephineCapabilities& c = config.capabilities;
  c.size = sizeof(TrephineCapabilities);
  c.version = TREPHINE_DEVICE_ABI;
  c.input_dof = 6;
  for (const ArmNumber& number : kArmNumbers) readNumber(arm, number, field, config);
  if (c.encoder_step_m > 0.0 && c.encoder_step_m < kMinEncoderStep_m) {
    refuseField(joined(field, "encoder_step_m.value"), "the value " + shown(c.encoder_step_m) +
                                                           " must be 0 or at least " +
                                                           shown(kMinEncoderStep_m) + ".");
  }
  if (c.continuous_force_N > c.peak_force_N) {
    refuseField(joined(field, "continuous_force_N.value"),
                "the value " + shown(c.continuous_force_N) + " must be at most the peak force of " +
                    shown(c.peak_force_N) + ".");
  }
  return config;
}

}  // namespace

DeviceConfig parseConfig(const char* text, std::size_t n_arms) {
  std::vector<std::string_view> keys{"arm", "arms"};
  for (const TroubleNumber& trouble : kTroubleNumbers) keys.push_back(trouble.key);
  const Json root = plugin::parseConfig(text, keys);
  if (root.contains("arm") == root.contains("arms")) {
    refuseField("arm", "give either 'arm', one object for every arm, or 'arms', a list of them.");
  }
  DeviceConfig config;
  if (root.contains("arm")) {
    config.arms.assign(n_arms, parseArm(root["arm"], "arm"));
  } else {
    const Json& arms = root["arms"];
    if (!arms.is_array()) refuseField("arms", "expected a list, found " + shown(arms) + ".");
    if (arms.size() != n_arms) {
      refuseField("arms", "it describes " + std::to_string(arms.size()) + " arms, and " +
                              std::to_string(n_arms) + " are open.");
    }
    for (std::size_t i = 0; i < n_arms; ++i) {
      config.arms.push_back(parseArm(arms[i], "arms[" + std::to_string(i) + "]"));
    }
  }
  for (const TroubleNumber& trouble : kTroubleNumbers) {
    if (!root.contains(trouble.key)) continue;
    if (trouble.together && !root.contains(trouble.together)) {
      refuseField(trouble.key, "it goes together with '" + std::string(trouble.together) + "'.");
    }
    config.troubles.*trouble.member = checkNumber(root[trouble.key], trouble.key, 0.0, 1e6);
  }
  return config;
}

}  // namespace trephine::simulated
