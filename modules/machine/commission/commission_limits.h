// When a workstation is fit: one table, each limit with its reason. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "base/result.h"

namespace trephine {

enum class Fitness { pass, warn, fail };
const char* nameOf(Fitness verdict);

struct CommissionLimit {
  const char* name;
  const char* words;  // what it is, for a person
  const char* unit;
  bool at_least;               // else at most
  double warn;                 // beyond it
  std::optional<double> fail;  // beyond it; nothing: it never keeps the workstation from its work
  const char* reason;
  const char* next;  // where it is not passed
};
std::span<const CommissionLimit> commissionLimits();
// Null where there is none of that name.
const CommissionLimit* commissionLimit(const std::string& name);

struct CommissionCheck {
  std::string name, words;
  std::optional<double> value;  // nothing: it could not be measured
  std::string unit;
  std::optional<double> limit;  // the one that was missed, else that of a warning
  Fitness verdict = Fitness::pass;
  std::string next;    // empty: nothing is to be done
  std::string remark;  // what else is known, such as a driver's name
};

// By the table, of which a limit that is `at_least` is raised to what is `needed` on this machine.
// A value that is no number fails.
CommissionCheck judged(const std::string& name, double value, std::string remark = "",
                       std::optional<double> needed = {});
CommissionCheck judgedCard(const std::string& driver);         // `opengl`
CommissionCheck judgedScreen(const std::array<int, 2>& size);  // `screen`: pixels
// What could not be measured, and why.
CommissionCheck notMeasured(const std::string& name, Fitness verdict, const Error& why);

}  // namespace trephine
