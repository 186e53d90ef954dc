// Exercises in a storage folder that several accounts of a machine share: educators make and change
// them, trainees practise them, nobody else has them.
#include <gtest/gtest.h>

#include <fstream>

#include "accounts.h"
#include "base/file.h"
#include "exchange/exercise_folder.h"
#include "exercise/exercise.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using test::as, test::kOther, test::kStranger, test::kTeacher, test::kTrainee;

class SharedExercises : public test::SharedStorage {
 protected:
  static Exercise shipped(const std::string& name) {
    Exercise exercise = *readExercise(TREPHINE_TEST_SCENES "/burr-hole.json");
    exercise.name = name;
    return exercise;
  }
  fs::path savedBy(uid_t account, const std::string& name) {
    const fs::path folder = freshExercise(storage_, name);
    EXPECT_TRUE(as(account, [&] { return saveExercise(shipped(name), folder, storage_).ok(); }));
    return folder;
  }
};

TEST_F(SharedExercises, WhatAnEducatorSavesTheOthersMayChangeAndTraineesPractise) {
  const fs::path folder = savedBy(kTeacher, "A window");
  const auto exercises = exercisesIn(storage_);
  ASSERT_EQ(exercises.size(), 1u);
  const auto reads = [&] { return readExercise(exercises.front()).ok(); };
  EXPECT_TRUE(as(kOther, reads));
  EXPECT_TRUE(as(kTrainee, reads));
  EXPECT_FALSE(as(kStranger, reads)) << "of neither group";
  EXPECT_TRUE(as(kOther, [&] {
    Exercise changed = *readExercise(exercises.front());
    changed.name = "A smaller window";
    return saveExercise(changed, folder, storage_).ok();
  }));
  EXPECT_TRUE(
      as(kTeacher, [&] { return readExercise(exercises.front())->name == "A smaller window"; }));
  EXPECT_TRUE(as(kTeacher, [&] {
    return saveExercise(*readExercise(exercises.front()), folder, storage_).ok();
  })) << "also what the other has written";
}

TEST_F(SharedExercises, ATraineeChangesNoneAndIsToldWhy) {
  const fs::path folder = savedBy(kTeacher, "A window");
  const fs::path exercise = exercisesIn(storage_).front();
  std::ifstream before(exercise);
  const std::string bytes{std::istreambuf_iterator<char>(before), {}};
  EXPECT_TRUE(as(kTrainee, [&] {
    const auto over = saveExercise(shipped("Mine"), folder, storage_);
    const auto beside = saveExercise(shipped("Mine"), storage_ / "exercises" / "mine", storage_);
    return !over && over.error().code.str() == "CANNOT_WRITE" && !over.error().next.empty() &&
           !beside && beside.error().code.str() == "CANNOT_WRITE";
  }));
  EXPECT_FALSE(as(kTrainee, [&] { return std::ofstream(exercise, std::ios::app).good(); }));
  EXPECT_FALSE(as(kTrainee, [&] { return std::remove(exercise.c_str()) == 0; }));
  std::ifstream after(exercise);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(after), {}), bytes);
  EXPECT_EQ(exercisesIn(storage_).size(), 1u);
}

}  // namespace
}  // namespace trephine
