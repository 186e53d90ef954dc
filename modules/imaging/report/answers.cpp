#include "imaging/report/answers.h"

#include <algorithm>
#include <set>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "volume/codes.h"

namespace trephine {

Options optionsOf(const SeriesReport& series) {
  Options options;
  for (const Choice& choice : series.choices) options[choice.code] = choice.options;
  return options;
}

namespace {

const std::set<Code>& codes() {
  static const std::set<Code> known = {
      code::kCouch,         code::kDerivedImages, code::kDuplicatePositions, code::kFace,
      code::kFaceRemains,   code::kFaceTakesMore, code::kFormsDiffer,        code::kHighBits,
      code::kImplausibleHu, code::kIncomplete,    code::kLocationMismatch,   code::kLossySource,
      code::kMissingSlices, code::kMixedSlices,   code::kOneLocation,        code::kParts,
      code::kPhases,        code::kSlopesDiffer,  code::kSparseSlices,       code::kThickSlices,
      code::kUnevenSpacing, code::kValueMap};
  return known;
}

}  // namespace

std::string answerTo(const Answers& answers, Code code) {
  const auto given = answers.find(code);
  return given == answers.end() ? std::string() : given->second;
}

bool isChoice(Code code) {
  return codes().contains(code);
}

Status fits(const Options& asked, const Answers& answers) {
  for (const auto& [code, option] : answers) {
    if (!isChoice(code)) {
      return Error{code::kBadChoice, tr("There is no choice of this name"), cleanUtf8(code.str()),
                   tr("Choose among {}", listed(namesOf(codes())))};
    }
    const auto question = asked.find(code);
    if (question == asked.end()) continue;
    if (std::ranges::find(question->second, option) != question->second.end()) continue;
    return Error{code::kBadChoice,
                 tr("The choice {} has no option '{}'", code.str(), cleanUtf8(option)), "",
                 tr("Choose {}", listed(question->second, tr("or")))};
  }
  return {};
}

}  // namespace trephine
