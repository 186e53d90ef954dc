// Speed against accuracy: for every knob of touch and of the view its settings, what each gets
// wrong and what each costs, from one run, and which one is recommended on this machine.
//
// A knob is what an exercise or an import can set, or what the view is drawn with. Of each exactly
// one setting is recommended: the cheapest of those that are good enough, which is what the table
// of kKnobs says. Where none is, the one with the least error.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "base/tr.h"
#include "machine/trades/recommended.h"

namespace trephine {

struct TradeRow {
  std::string knob;  // an id of kKnobs
  std::string setting;
  double error = 0.0;
  std::string error_unit;
  double cost = 0.0;
  std::string cost_unit;
  std::string reference;  // what the error is against
  bool recommended = false;
  std::vector<std::pair<std::string, double>> extra;  // name with unit, figure

  double extraOf(std::string_view name) const;  // NaN where there is none
};

// Good enough is an error of at most `tolerance`; where `limited` names an extra figure, or is
// "cost", that is at most `limit` as well, and likewise `also`.
struct Knob {
  std::string_view id;
  std::string_view title;
  double tolerance;  // in the rows' error unit
  std::string_view limited = "";
  double limit = 0.0;
  std::string_view also = "";
  double also_limit = 0.0;
  std::string_view unit = "";  // of the settings
};
inline constexpr std::array<Knob, 6> kKnobs{{
    {"points_blade", trLater("Points along a blade"), 5.0, "volume_error_percent", 5.0},
    {"points_burr", trLater("Points on a burr's shell"), 5.0, "volume_error_percent", 5.0},
    {"force_at", trLater("Where the force acts"), 10.0},
    // Bone by two springs (coulomb, elastic), of what the arm shows at that rate: the rest is for
    // what the hand and its delays take.
    {"rate_hz", trLater("Rate of touch"), 5.0, "cost", 25.0, "bone_of_k_max_percent", 60.0, "Hz"},
    {"grid", trLater("Resolution of the grid"), 5.0, "surface_distance_mm", 0.5},
    // The worst picture: 1 % of 255 are 40 dB. Beyond, bone is seen to shine through thin skin.
    {"ray_casting", trLater("Samples of a ray"), 4.0, "luminance_error_percent", 2.5,
     "picture_rms_percent", 1.0},
}};

struct TradesOptions {
  std::vector<int> blade_points{2, 4, 8, 16, 32, 64, 128, 256};
  std::vector<int> burr_points{8, 16, 32, 64, 128, 256, 512};
  std::vector<double> rates_hz{250.0, 500.0, 1000.0, 2000.0, 4000.0, 10000.0, 20000.0};
  int grid = 256;         // voxels along an edge of 49.2 mm, a multiple of 4, 32 to 512
  double stroke_s = 2.0;  // 0.2 to 20
  int strokes = 12;       // 1 to 1000, at random (trade_stroke.h), from
  int first_stroke = 0;   // this number on
  // Voxels, 0.1 to 8; none: the rays are left out.
  std::vector<double> ray_distances{0.25, 0.5, 0.75, 1.0, 2.0};
  std::array<int, 2> ray_picture{800, 600};
  int reference_step = 3;  // pixels
};

struct TradesMeasurement {
  std::vector<TradeRow> rows;
};

// Marks one row of each knob by the rule above. Rows of a knob that is not in kKnobs stay unmarked.
void recommend(std::vector<TradeRow>& rows);

// The rows that are marked.
std::vector<RecommendedSetting> recommendedOf(const std::vector<TradeRow>& rows);

// Writes trades.csv, trades.json and recommended.json into the folder `out` unless that is empty.
// Errors: BAD_ARGUMENT, CANCELLED, CANNOT_WRITE.
Result<TradesMeasurement> measureTrades(const TradesOptions& options,
                                        const std::filesystem::path& out = {},
                                        const Progress& progress = Progress());

// A trades.json. Errors: MISSING_FILE, BAD_JSON, BAD_FIELD (a newer version, a negative figure).
Result<TradesMeasurement> readTrades(const std::filesystem::path& file);

// {rows:[{knob, setting, error, error_unit, cost, cost_unit, reference, recommended, extra:{}}]}
Json toJson(const TradesMeasurement& measurement);
std::string toText(const TradesMeasurement& measurement);

}  // namespace trephine
