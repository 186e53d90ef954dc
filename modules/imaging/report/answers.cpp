#include "imaging/report/answers.h"

#include <algorithm>
#include <set>

#include "imaging/common/text.h"

namespace trephine {

Options optionsOf(const SeriesReport& series) {
  Options options;
  for (const Choice& choice : series.choices) options[choice.code] = choice.options;
  return options;
}

namespace {

const std::set<std::string>& codes() {
  static const std::set<std::string> known = {
      "COUCH",          "DERIVED_IMAGES",  "DUPLICATE_POSITIONS", "FACE",
      "FACE_REMAINS",   "FACE_TAKES_MORE", "FORMS_DIFFER",        "HIGH_BITS",
      "IMPLAUSIBLE_HU", "INCOMPLETE",      "LOCATION_MISMATCH",   "LOSSY_SOURCE",
      "MISSING_SLICES", "MIXED_SLICES",    "ONE_LOCATION",        "PARTS",
      "PHASES",         "SLOPES_DIFFER",   "SPARSE_SLICES",       "UNEVEN_SPACING",
      "VALUE_MAP"};
  return known;
}

}  // namespace

std::string answerTo(const Answers& answers, const std::string& code) {
  const auto given = answers.find(code);
  return given == answers.end() ? std::string() : given->second;
}

bool isChoice(const std::string& code) {
  return codes().contains(code);
}

Status fits(const Options& asked, const Answers& answers) {
  for (const auto& [code, option] : answers) {
    if (!isChoice(code)) {
      return Error{"BAD_CHOICE", "There is no choice of this name", cleanUtf8(code),
                   "Choose among " + listed({codes().begin(), codes().end()})};
    }
    const auto question = asked.find(code);
    if (question == asked.end()) continue;
    if (std::ranges::find(question->second, option) != question->second.end()) continue;
    return Error{"BAD_CHOICE", "The choice " + code + " has no option '" + cleanUtf8(option) + "'",
                 "", "Choose " + listed(question->second, "or")};
  }
  return {};
}

}  // namespace trephine
