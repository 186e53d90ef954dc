// What the import measurement says of other programs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "lab/import/import_measurement.h"

namespace trephine::bench {

// Medians against medians of the same run; nothing where one of the two is missing.
struct PeerRatios {
  std::optional<double> command_to_dcm2niix;  // on int16
  std::optional<double> scan_to_gdcmscanner;
  // By series: "trephine command" against the fastest peer that got every voxel right.
  std::vector<std::pair<std::string, std::optional<double>>> compressed;
};
PeerRatios peerRatiosOf(const ImportMeasurement& measurement);

// Those of lab, with the ratios to other programs filled in.
Json toJson(const ImportMeasurement& measurement);
std::string toText(const ImportMeasurement& measurement);

}  // namespace trephine::bench
