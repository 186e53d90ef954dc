// The recommended settings of a measured machine, as a file: "trephine.recommended", version 1.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "exercise/policy.h"

namespace trephine {

struct RecommendedSetting {
  std::string knob, setting;
  double error = 0.0;
  std::string error_unit;
  double cost = 0.0;
  std::string cost_unit;
  friend bool operator==(const RecommendedSetting&, const RecommendedSetting&) = default;
};

// {format, version, knobs:[{knob, setting, error, error_unit, cost, cost_unit}]}
Json toJson(const std::vector<RecommendedSetting>& settings);
// Errors: MISSING_FILE, BAD_JSON, BAD_FIELD (a negative figure, a knob given twice).
Result<std::vector<RecommendedSetting>> readRecommended(const std::filesystem::path& file);

// What stands on this machine, knob by knob: recommended.json of the person (`own_folder`, empty:
// none) over the hospital's in the policy's folder over the product's. A knob that the workstation
// locks takes nothing from the person's, and one that it prescribes is not recommended at all.
// Nothing where there is no such file. A file of person or hospital that is broken is said in the
// log, and the others stand. Errors: those of the product's file.
Result<std::vector<RecommendedSetting>> recommendedHere(const Policy& policy,
                                                        const std::filesystem::path& own_folder);

}  // namespace trephine
