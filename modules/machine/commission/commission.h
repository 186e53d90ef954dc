// Is this machine fit for the work? Each check against the one table of limits
// (commission_limits.h), under three minutes together.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "machine/commission/commission_limits.h"
#include "machine/trades/recommended.h"

namespace trephine {

struct CommissionOptions {
  std::filesystem::path storage;  // the folder of cases: its disk
  bool storage_is_set = false;    // by the workstation's settings: it has to be there
  int largest_edge = 0;           // voxels, of the cases there; 0: none is larger than usual
  double seconds = 5.0;           // of each row of lateness, 0.2 to 60
  double patience_s = 15.0;       // until somebody holds the arms; 0: they are not tried, to 600
};

struct Commissioning {
  std::vector<CommissionCheck> checks;
  std::string when;     // "2026-11-24 09:30", by the clock
  std::string build;    // of this program
  std::string machine;  // processors and system, without the name of the host
  // The best settings of touch that this machine keeps; not what rays take, which `trades`
  // finds in minutes.
  std::vector<RecommendedSetting> recommended;
};
// Fails before this version was made. Pure; `shown` is how a person reads that time.
CommissionCheck judgedClock(std::time_t now, const std::string& shown);
Fitness fitnessOf(const Commissioning& of);  // the worst

// Errors: BAD_OPTION, CANCELLED. What cannot be measured is a check that says why.
Result<Commissioning> commission(const CommissionOptions& options,
                                 const Progress& progress = Progress());

// A check that is otherwise than before: another verdict, or a value that is worse by a quarter.
struct CommissionChange {
  std::string words;
  Fitness before = Fitness::pass, now = Fitness::pass;
  std::optional<double> value_before, value_now;
  std::string unit;
};
std::string shownValue(const std::optional<double>& value, const std::string& unit);  // "3.00 GB"
std::string changeText(const CommissionChange& change);  // "A: 3 GB (pass) before, 1 GB (fail) now"
std::vector<CommissionChange> changesSince(const Commissioning& before, const Commissioning& now);

Json toJson(const std::vector<CommissionCheck>& checks);
// Of what that wrote; nothing where it is something else.
std::optional<std::vector<CommissionCheck>> checksOf(const Json& rows);
// {format, version, checks:[{name, value, unit, limit, verdict, next, words, remark}], verdict,
// when, build, machine}: what was measured, without what is recommended by it.
Json toJson(const Commissioning& of);
// Of what toJson() wrote. Errors: those of readJsonFile, BAD_FIELD.
Result<Commissioning> readCommissioning(const std::filesystem::path& file);
// Nothing: there is none to compare with.
using CommissionChanges = std::optional<std::vector<CommissionChange>>;
Json toJson(const CommissionChanges& changes);  // null, or [{words, before, now}]
std::string toText(const Commissioning& of, const CommissionChanges& changes);
// One page to be printed, in plain words.
std::string toHtml(const Commissioning& of, const CommissionChanges& changes);

}  // namespace trephine
