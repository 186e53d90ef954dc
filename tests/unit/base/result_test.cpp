#include "base/result.h"

#include <gtest/gtest.h>

#include <memory>

#include "base/codes.h"

namespace trephine {
namespace {

TEST(Error, SaysWhatWhereAndWhatToDoInOneSentence) {
  const Error error{code::kMissingFolder, "The folder does not exist", "case",
                    "Choose another one"};
  EXPECT_EQ(error.sentence(), "The folder does not exist (case). Choose another one.");
}

TEST(Error, LeavesOutThePartsThatItDoesNotHave) {
  EXPECT_EQ((Error{Code("X"), "It failed", "", ""}).sentence(), "It failed.");
  EXPECT_EQ((Error{Code("X"), "It failed", "here", ""}).sentence(), "It failed (here).");
  EXPECT_EQ((Error{Code("X"), "It failed", "", "Try again"}).sentence(), "It failed. Try again.");
}

TEST(Error, IsOneLineWhateverNamesItHolds) {
  const Error error{Code("X"), "It failed", "a\nOK: whole\u2028b\x1b[2J.h5", "Try\ragain"};
  EXPECT_EQ(error.sentence(), "It failed (a OK: whole b [2J.h5). Try again.");
}

TEST(Result, HoldsAValue) {
  Result<int> result = 7;
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(static_cast<bool>(result));
  EXPECT_EQ(*result, 7);
}

TEST(Result, HoldsAnErrorInsteadOfAValue) {
  const Result<int> result = Error{Code("CODE"), "what", "where", "next"};
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "CODE");
  EXPECT_EQ(result.error().where, "where");
}

TEST(Result, GivesAwayAValueThatCannotBeCopied) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  ASSERT_TRUE(result.ok());
  std::unique_ptr<int> taken = *std::move(result);
  EXPECT_EQ(*taken, 3);
}

TEST(Result, KeepsAValueApartFromAnErrorEvenWhereTheValueIsText) {
  const Result<std::string> result = std::string("text");
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->size(), 4u);
}

TEST(Status, IsSuccessUntilItIsGivenAnError) {
  Status status;
  EXPECT_TRUE(status.ok());
  status = Error{Code("CODE"), "what", "", ""};
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CODE");
}

}  // namespace
}  // namespace trephine
