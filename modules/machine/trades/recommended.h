// The settings that are recommended on a machine, of those whose error and cost were measured
// (trades_measurement.h); they are shown beside an exercise's own, and nothing sets them. As a
// file: "trephine.recommended", version 1.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "exercise/policy.h"

namespace trephine {

struct RecommendedSetting {
  std::string knob, setting;  // an id of kKnobs and one of its settings, neither checked here
  double error = 0.0;         // what the setting gets wrong; 0 or above
  std::string error_unit;
  double cost = 0.0;  // what it costs; 0 or above
  std::string cost_unit;
  friend bool operator==(const RecommendedSetting&, const RecommendedSetting&) = default;
};

// {format, version, knobs:[{knob, setting, error, error_unit, cost, cost_unit}]}
Json toJson(const std::vector<RecommendedSetting>& settings);
// Errors: MISSING_FILE, BAD_JSON, BAD_FIELD (another format, a newer version, an unknown key, a
// figure below 0, a knob given twice).
Result<std::vector<RecommendedSetting>> readRecommended(const std::filesystem::path& file);

// Those of `before` whose knobs `now` has not, and then those of `now`: what leaves a knob out says
// nothing of it.
std::vector<RecommendedSetting> renewed(std::vector<RecommendedSetting> before,
                                        const std::vector<RecommendedSetting>& now);

// What holds on this machine, knob by knob: the person's recommended.json (`own_folder`, empty:
// none) over the hospital's in the policy's folder over the product's in resourceFolder(). Each of
// the three may be missing; without any it is empty. Where the policy locks the rate, rate_hz is
// not taken from the person's; where it also gives one, rate_hz is left out. A file of person or
// hospital that cannot be read is said in the log, and the others hold. Errors: those of
// readRecommended() for a product's file that is there. It reads files.
Result<std::vector<RecommendedSetting>> recommendedHere(const Policy& policy,
                                                        const std::filesystem::path& own_folder);

}  // namespace trephine
