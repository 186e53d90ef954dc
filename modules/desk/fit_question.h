// What a person is asked before an exercise starts on a case that it is not made for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "case/placement.h"

namespace trephine {

// One may go on as it is, or do first what `mend` says.
struct FitQuestion {
  enum class Mend {
    change_exercise,  // to one for `anatomy`
    make_structure,   // that the exercise needs and the case lacks
    place_entry,      // where the exercise begins
    other_exercise    // that fits, whichever it is
  };
  std::vector<std::string> why;  // sentences, one a warning of the placement
  Mend mend = Mend::other_exercise;
  std::string anatomy{};  // of the case, as exercises name it; empty but for change_exercise
};

// Nothing where there is nothing to be warned of. Pure.
std::optional<FitQuestion> fitQuestion(const Placement& placed);

}  // namespace trephine
