// Whether answers fit the questions.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "imaging/report/report.h"

namespace trephine {

// The options of each question that is asked.
using Options = std::map<Code, std::vector<std::string>>;

Options optionsOf(const SeriesReport& series);

// What was answered to a question; empty: nothing.
std::string answerTo(const Answers& answers, Code code);

// Whether the importer ever asks a question of this code.
bool isChoice(Code code);

// Answers to questions that are asked must be among the options, and all codes must be known.
// Errors: BAD_CHOICE.
Status fits(const Options& asked, const Answers& answers);

}  // namespace trephine
