#include "ui/prepare/edit_words.h"

#include <gtest/gtest.h>

#include "exercise/exercise_fields.h"
#include "qt_support.h"

namespace trephine {
namespace {

const QString kAnyNumber = "a number of a tissue";

// The words for an edit of each field of a table.
template <class Fields>
void expectOwnWords(const std::string& prefix, const Fields& fields) {
  for (const auto& field : fields) {
    EXPECT_NE(editWords(prefix + field.row.key), kAnyNumber) << prefix << field.row.key;
  }
}

TEST(EditWords, AreThereForEachFieldOfAnExercise) {
  expectOwnWords("exercise ", kExerciseFields);
  expectOwnWords("view ", kViewFields);
  expectOwnWords("outline ", kOutlineFields);
  expectOwnWords("", kTouchFields);
  expectOwnWords("", kPointsFields);
  expectOwnWords("", kLockFields);
}

TEST(EditWords, TellTheNameOfAnExerciseFromThatOfATissue) {
  EXPECT_EQ(editWords("name:bone"), "the name of a tissue");
  EXPECT_EQ(editWords("exercise name"), "the name of the exercise");
  EXPECT_EQ(editWords("friction:bone"), kAnyNumber);
}

}  // namespace
}  // namespace trephine
