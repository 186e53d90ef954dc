#include "desk/fit_question.h"

#include <gtest/gtest.h>

#include "case/codes.h"
#include "exercise/codes.h"

namespace trephine {
namespace {

using Mend = FitQuestion::Mend;

Placement warnedOf(const std::vector<Warning>& warnings) {
  Placement placed;
  placed.patient.anatomy.emplace();
  placed.patient.anatomy->region = BodyRegion::abdomen;
  placed.warnings = warnings;
  return placed;
}

const Warning kOther{code::kOtherAnatomy, "The case shows an abdomen"};
const Warning kLacks{code::kLacksStructure, "The case has no structure 'liver'"};
const Warning kNoEntry{code::kNoLandmark, "The place is not in the case."};
const Warning kVault{code::kNoVault, "The vault is not in the case"};

TEST(FitQuestion, IsNotAskedWhereNothingIsWarnedOf) {
  EXPECT_FALSE(fitQuestion(warnedOf({})));
}

TEST(FitQuestion, SaysEachWarningAsASentence) {
  const auto question = fitQuestion(warnedOf({kLacks, kNoEntry}));
  ASSERT_TRUE(question);
  EXPECT_EQ(question->why, (std::vector<std::string>{"The case has no structure 'liver'.",
                                                     "The place is not in the case."}));
}

TEST(FitQuestion, OffersWhatMendsTheMostFirst) {
  const auto mend = [](const std::vector<Warning>& warnings) {
    return fitQuestion(warnedOf(warnings))->mend;
  };
  EXPECT_EQ(mend({kNoEntry, kLacks, kOther}), Mend::change_exercise);
  EXPECT_EQ(mend({kNoEntry, kLacks}), Mend::make_structure);
  EXPECT_EQ(mend({kVault, kNoEntry}), Mend::place_entry);
  EXPECT_EQ(mend({kVault}), Mend::other_exercise);
}

TEST(FitQuestion, NamesTheAnatomyOfTheCaseWhereTheExerciseIsForAnother) {
  EXPECT_EQ(fitQuestion(warnedOf({kOther}))->anatomy, "abdomen");
  EXPECT_EQ(fitQuestion(warnedOf({kLacks}))->anatomy, "");
}

}  // namespace
}  // namespace trephine
