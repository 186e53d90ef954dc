// Exercises on cases that are not their own: they run, and say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/system.h"
#include "case/codes.h"
#include "case/placement.h"
#include "exercise/exercise_structures.h"
#include "session/session.h"
#include "support.h"

namespace trephine {
namespace {

using Codes = std::set<std::string>;

Exercise exerciseOf(const std::string& name) {
  return *readExercise(resourceFolder() / "scenes" / (name + ".json"));
}

std::vector<std::string> all() {
  std::vector<std::string> names;
  const std::filesystem::path scenes = resourceFolder() / "scenes";
  for (const auto& file : std::filesystem::recursive_directory_iterator(scenes)) {
    const std::filesystem::path name = file.path().lexically_relative(scenes);
    if (name.extension() == ".json") names.push_back((name.parent_path() / name.stem()).string());
  }
  EXPECT_GE(names.size(), 7u);
  return names;
}
// Those of the seed paper are placed as the others are: they differ in laws, tools and card.
std::vector<std::string> placedOnes() {
  std::vector<std::string> names = all();
  std::erase_if(names, [](const std::string& name) { return name.starts_with("research/"); });
  return names;
}

// What a fifth of a second of an exercise warns of on a case, read once for all of them.
Codes warnings(const std::string& name, const Case& of, const std::string& source) {
  Exercise exercise = exerciseOf(name);
  exercise = onCase(exercise, source);
  const auto placed = place(exercise, of);
  EXPECT_TRUE(placed.ok() && !placed->error) << name;
  const auto script = readOperatorScript(exercise.operator_file, exercise);
  EXPECT_TRUE(script.ok()) << name;
  auto session = Session::create(*placed, {{}, *script});
  EXPECT_TRUE(session.ok()) << name << ": " << session.error().sentence();
  if (!session) return {"NOT_CREATED"};
  EXPECT_TRUE((*session)->freewheel(0.2).ok()) << name;
  Codes codes;
  for (const Warning& warning : (*session)->report().warnings) codes.insert(warning.code.str());
  return codes;
}

void expectAmong(const Codes& said, const Codes& allowed, const std::string& where) {
  for (const std::string& code : said) EXPECT_TRUE(allowed.contains(code)) << where << ": " << code;
}

TEST(OtherCases, EveryExerciseRunsOnEveryBuiltInCaseAndSaysWhereItIsForAnother) {
  for (const auto& [source, anatomy] :
       {std::pair{"phantom:cranium", "cranium"}, std::pair{"phantom:abdomen", "abdomen"}}) {
    const Case of = *readCase(source);
    for (const std::string& name : all()) {
      const Codes said = warnings(name, of, source);
      const bool other = exerciseOf(name).anatomy != anatomy;
      EXPECT_EQ(said.contains("OTHER_ANATOMY"), other) << name << " on " << source;
      if (!other) {
        EXPECT_EQ(said, Codes{}) << name << " on " << source;
      }
    }
  }
}

TEST(OtherCases, EveryExerciseRunsOnARealAbdomen) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const std::string source = data / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz";
  const Case of = *readCase(source);
  for (const std::string& name : placedOnes()) {
    const Codes said = warnings(name, of, source);
    expectAmong(said, {"OTHER_ANATOMY", "NO_LANDMARK", "STARTS_IN_TISSUE", "LACKS_STRUCTURE"},
                name);
    EXPECT_EQ(said.contains("OTHER_ANATOMY"), exerciseOf(name).anatomy == "cranium") << name;
  }
}

TEST(OtherCases, EveryExerciseRunsOnARealSkullAndThoseForItWithoutAWord) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const std::string source = data / "head-ct-plastic-skull";
  const Case of = *readCase(source);
  for (const std::string& name : placedOnes()) {
    const Codes said = warnings(name, of, source);
    if (exerciseOf(name).anatomy == "cranium") {
      EXPECT_EQ(said, Codes{}) << name;
    } else {
      EXPECT_TRUE(said.contains("OTHER_ANATOMY")) << name;
    }
  }
}

// One exercise of each anatomy: the case decides here.
TEST(OtherCases, NoScanIsADeadEndBeItOfAFewSlices) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const char* folder :
       {"abdomen-ct-totalsegmentator/example_ct_dicom", "head-ct-gantry-tilt"}) {
    const std::string source = data / folder;
    const Case of = *readCase(source);
    for (const char* name : {"cranium", "liver"}) {
      expectAmong(
          warnings(name, of, source),
          {"OTHER_ANATOMY", "NO_VAULT", "NO_LANDMARK", "STARTS_IN_TISSUE", "LACKS_STRUCTURE"},
          std::string(name) + " on " + folder);
    }
  }
}

}  // namespace
}  // namespace trephine
