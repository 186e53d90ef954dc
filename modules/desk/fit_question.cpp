#include "desk/fit_question.h"

#include <algorithm>

#include "case/codes.h"
#include "exercise/codes.h"

namespace trephine {

std::optional<FitQuestion> fitQuestion(const Placement& placed) {
  if (placed.warnings.empty()) return std::nullopt;
  FitQuestion question;
  for (const Warning& warning : placed.warnings) {
    question.why.push_back(warning.text + (warning.text.ends_with('.') ? "" : "."));
  }
  const auto warned = [&](Code code) {
    return std::ranges::find(placed.warnings, code, &Warning::code) != placed.warnings.end();
  };
  using Mend = FitQuestion::Mend;
  if (warned(code::kOtherAnatomy)) {
    question.mend = Mend::change_exercise;
    question.anatomy = exerciseAnatomy(placed.patient.anatomy->region);
  } else if (warned(code::kLacksStructure)) {
    question.mend = Mend::make_structure;
  } else if (warned(code::kNoLandmark)) {
    question.mend = Mend::place_entry;
  }
  return question;
}

}  // namespace trephine
