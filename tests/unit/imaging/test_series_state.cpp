#include <gtest/gtest.h>

#include "imaging/codes.h"
#include "imaging/series_state.h"

namespace trephine {
namespace {

SeriesReport series(const std::string& uid, Verdict verdict, const char* modality = "CT",
                    int slices = 100) {
  SeriesReport of;
  of.uid = uid;
  of.verdict = verdict;
  of.modality = modality;
  of.slices = slices;
  return of;
}

Choice couch() {
  return {code::kCouch, "Remove the couch?", {"keep", "remove"}, {"Keep it", "Make it air"}};
}

SeriesReport askingSeries(const std::string& uid) {
  SeriesReport of = series(uid, Verdict::refused);
  of.choices.push_back({code::kMissingSlices,
                        "Two slices are missing. Fill them?",
                        {"refuse", "fill"},
                        {"Do not use the series", "Fill them from their neighbours"}});
  return of;
}

TEST(SeriesState, ARefusalThatAQuestionStandsForIsOpenUntilAnswered) {
  const SeriesReport asks = askingSeries("1");
  EXPECT_EQ(seriesState(asks, {}), SeriesState::asks);
  EXPECT_EQ(seriesState(asks, {{code::kMissingSlices, "refuse"}}), SeriesState::asks);
  EXPECT_EQ(seriesState(asks, {{code::kCouch, "remove"}}), SeriesState::asks);
  EXPECT_EQ(seriesState(asks, {{code::kMissingSlices, "fill"}}), SeriesState::answered);
  EXPECT_EQ(seriesState(series("2", Verdict::refused), {}), SeriesState::refused);
  SeriesReport optional = series("3", Verdict::refused);
  optional.choices = {couch()};
  EXPECT_EQ(seriesState(optional, {{code::kCouch, "remove"}}), SeriesState::refused)
      << "no answer about the couch makes a volume of it";
}

TEST(SeriesState, OnlyWhatIsUsableOrAnsweredMayBeRead) {
  EXPECT_TRUE(mayBeRead(SeriesState::pass));
  EXPECT_TRUE(mayBeRead(SeriesState::repaired));
  EXPECT_TRUE(mayBeRead(SeriesState::answered));
  EXPECT_FALSE(mayBeRead(SeriesState::asks));
  EXPECT_FALSE(mayBeRead(SeriesState::refused));
}

TEST(SeriesState, OnlyWhatIsNewAndUnansweredIsAskedAfterReading) {
  const SeriesReport before = askingSeries("1");
  SeriesReport after = before;
  after.choices.push_back(couch());
  const std::vector<Choice> asked = newChoices(before, after, {});
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].code.str(), "COUCH");
  EXPECT_TRUE(newChoices(before, after, {{code::kCouch, "keep"}}).empty());
}

TEST(SeriesState, WhatCanBeReadIsListedFirstAndCtAndManySlicesBeforeOthers) {
  const std::vector<SeriesReport> all{series("refused", Verdict::refused),
                                      series("mr", Verdict::pass, "MR", 500), askingSeries("asks"),
                                      series("few", Verdict::repaired, "CT", 9),
                                      series("many", Verdict::pass)};
  EXPECT_EQ(seriesOrder(all, {}), (std::vector<std::size_t>{4, 3, 1, 2, 0}));
  const std::map<std::string, Answers> answers{{"asks", {{code::kMissingSlices, "fill"}}}};
  EXPECT_EQ(seriesOrder(all, answers), (std::vector<std::size_t>{2, 4, 3, 1, 0}));
}

}  // namespace
}  // namespace trephine
