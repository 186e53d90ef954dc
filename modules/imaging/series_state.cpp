#include "imaging/series_state.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "imaging/codes.h"

namespace trephine {

namespace {

bool refusesUnanswered(const Choice& choice) {
  return !choice.options.empty() && choice.options.front() == "refuse";
}

}  // namespace

SeriesState seriesState(const SeriesReport& series, const Answers& answers) {
  if (series.verdict == Verdict::pass) return SeriesState::pass;
  if (series.verdict == Verdict::repaired) return SeriesState::repaired;
  const bool by_kind = std::ranges::any_of(series.findings, [](const Finding& finding) {
    return finding.code == code::kNotCt || finding.code == code::kLabelMap;
  });
  if (series.modality == "SEG" && by_kind) return SeriesState::structures;
  bool asks = false, open = false;
  for (const Choice& choice : series.choices) {
    if (!refusesUnanswered(choice)) continue;
    asks = true;
    const auto answer = answers.find(choice.code);
    if (answer == answers.end() || answer->second == choice.options.front()) open = true;
  }
  if (!asks) return SeriesState::refused;
  return open ? SeriesState::asks : SeriesState::answered;
}

bool mayBeRead(SeriesState state) {
  return state != SeriesState::asks && state != SeriesState::refused &&
         state != SeriesState::structures;
}

const Answers& answersOf(const std::map<std::string, Answers>& answers, const std::string& uid) {
  static const Answers none;
  const auto found = answers.find(uid);
  return found == answers.end() ? none : found->second;
}

std::vector<std::size_t> seriesOrder(const std::vector<SeriesReport>& series,
                                     const std::map<std::string, Answers>& answers) {
  std::vector<std::size_t> order(series.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto rank = [&](std::size_t i) {
    const SeriesReport& one = series[i];
    const SeriesState state = seriesState(one, answersOf(answers, one.uid));
    const int usable = mayBeRead(state) ? 0 : state == SeriesState::asks ? 1 : 2;
    return std::tuple(usable, one.modality == "CT" ? 0 : 1, -one.slices);
  };
  std::ranges::stable_sort(order, {}, rank);
  return order;
}

std::vector<Choice> newChoices(const SeriesReport& before, const SeriesReport& after,
                               const Answers& answers) {
  std::vector<Choice> found;
  for (const Choice& choice : after.choices) {
    const bool asked_before =
        std::ranges::find(before.choices, choice.code, &Choice::code) != before.choices.end();
    if (!asked_before && !answers.contains(choice.code)) found.push_back(choice);
  }
  return found;
}

}  // namespace trephine
