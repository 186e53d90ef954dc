// The laws of soft tissue and bone beside published measurements: twelve experiments, each a
// scripted stroke through the real loop, and the force that the laws demand.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

enum class BandKind { published, estimate };  // estimate: of the comparison, from what is published
enum class NumberUse { fitted, predicted };   // whether a number was chosen from this very band

// A condition of an experiment, and what was measured.
struct TissueRow {
  std::string experiment;  // A1 to A12
  std::string quantity, unit;
  double ours = 0.0;
  std::optional<double> low, high;  // nothing: open
  BandKind kind = BandKind::estimate;
  NumberUse use = NumberUse::predicted;
  std::string source;
  std::string confidence;  // of the source: as tissues.md has it
  bool inside() const { return !(low && ours < *low) && !(high && ours > *high); }
};

// A number that is shipped as another than the published one, which an arm could not show, and by
// which factor.
struct ScaledForce {
  std::string tissue, quantity, unit;
  double published = 0.0, shipped = 0.0;
};

// What an experiment is drawn as, mostly the force along the way over the arm's travel, and the
// band that was published for it.
struct TissueCurve {
  std::string experiment, title;
  std::string x_title = "travel", x_unit = "mm";
  std::vector<std::pair<double, double>> points;
  std::optional<double> low{}, high{};
  std::string band{};  // what the band is
  std::string y_title = "force", y_unit = "N";
};

struct TissueMeasurement {
  std::vector<TissueRow> rows;
  std::vector<ScaledForce> scaled;
  std::vector<TissueCurve> curves;
};

// Errors: those of the shipped tissues; CANCELLED.
Result<TissueMeasurement> measureTissue(const Progress& progress);

// The rows' table and a CSV of each curve, in this folder.
Status writeTissueTables(const TissueMeasurement& measured, const std::filesystem::path& out);
// A picture of each curve; those that were written.
Result<std::vector<std::filesystem::path>> drawTissue(const TissueMeasurement& measured,
                                                      const std::filesystem::path& out);

Json toJson(const TissueMeasurement& measured);
std::string toText(const TissueMeasurement& measured);

}  // namespace trephine
