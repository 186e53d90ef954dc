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

Status fits(const Options& asked, const Answers& answers) {
  static const std::set<std::string> known = {
      "COUCH",        "DERIVED_IMAGES",  "DUPLICATE_POSITIONS", "FACE",
      "FACE_REMAINS", "FACE_TAKES_MORE", "IMPLAUSIBLE_HU",      "LOCATION_MISMATCH",
      "LOSSY_SOURCE", "MISSING_SLICES",  "MIXED_SLICES",        "PARTS",
      "PHASES",       "SPARSE_SLICES",   "UNEVEN_SPACING",      "VALUE_MAP"};
  for (const auto& [code, option] : answers) {
    if (!known.contains(code)) {
      return Error{"BAD_CHOICE", "There is no choice of this name", cleanUtf8(code),
                   "Choose among " + listed({known.begin(), known.end()})};
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
