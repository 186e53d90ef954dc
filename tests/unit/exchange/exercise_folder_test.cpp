// An exercise that goes to another workstation and comes out there as it was.
#include "exchange/exercise_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <algorithm>
#include <fstream>

#include "base/descriptor.h"
#include "base/file.h"
#include "base/json.h"
#include "base/sha256.h"
#include "base/system.h"
#include "packed_words.h"
#include "exercise/exercise.h"
#include "case/placement.h"
#include "support.h"
#include "volume/phantom.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

class ExerciseFolder : public ::testing::Test {
 protected:
  static fs::path shipped(const std::string& name) {
    return fs::path(TREPHINE_TEST_SCENES) / (name + ".json");
  }
  // As an exercise is that was made from a patient's case, in a folder that tells who that is.
  fs::path ofAPatient() {
    const fs::path home = folder_ / "DOE^JANE";
    fs::create_directories(home);
    GridGeometry grid = *phantomGeometry("abdomen");
    for (int axis = 0; axis < 3; ++axis) {
      grid.size[std::size_t(axis)] /= 4;
      grid.spacing_mm[axis] *= 4.0;
    }
    const auto truth = phantomTruth("abdomen");
    EXPECT_TRUE(writeVolume(makePhantomOn(*truth, grid, kPhantomNoiseHu), home / "doe.mha"));
    LabelMap map;
    map.geometry = grid;
    map.labels.assign(grid.voxelCount(), 0);
    for (std::size_t i = 0; i < 500; ++i) map.labels[i + grid.voxelCount() / 2] = 1;
    map.structures = {{1, "liver", Vec3(1.0, 0.0, 0.0)}};
    EXPECT_TRUE(writeSegmentation(map, home / "doe.seg.nrrd"));
    Json exercise = *readJsonFile(shipped("liver"));
    exercise["case"] = "doe.mha";
    exercise["labels"] = "doe.seg.nrrd";
    const auto whole = [&](Json& name) {
      name = (fs::path(TREPHINE_TEST_SCENES) / name.get<std::string>()).lexically_normal().string();
    };
    whole(exercise["tissues"]);
    whole(exercise["operator"]);
    whole(exercise["tools"][1]["file"]);
    const fs::path file = home / "doe.json";
    EXPECT_TRUE(writeTextFile(file, exercise.dump()));
    return file;
  }
  ExportedExercise exported(const fs::path& exercise, const std::string& of = "") {
    auto done = exportExercise(exercise, of, folder_ / "stick");
    EXPECT_TRUE(done.ok()) << done.error().sentence();
    return done ? *done : ExportedExercise{};
  }
  ImportedExercise imported() {
    auto done = importExercise(folder_ / "stick", folder_ / "there");
    EXPECT_TRUE(done.ok()) << done.error().sentence();
    return done ? *done : ImportedExercise{};
  }

  test::TemporaryFolder folder_;
};

TEST_F(ExerciseFolder, EachShippedExerciseComesOutAsItWas) {
  for (const char* name : {"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm"}) {
    SCOPED_TRACE(name);
    fs::remove_all(folder_ / "stick");
    exported(shipped(name));
    const ImportedExercise there = imported();
    ASSERT_TRUE(there.check.verified());
    const Result<Exercise> before = readExercise(shipped(name)), after = readExercise(there.exercise);
    ASSERT_TRUE(before && after) << after.error().sentence();
    EXPECT_EQ(toJson(*after), toJson(*before));
    EXPECT_EQ(after->tissues_elsewhere.has_value(), before->tissues_elsewhere.has_value());
    ASSERT_EQ(after->tools.size(), before->tools.size());
    for (std::size_t i = 0; i < after->tools.size(); ++i) {
      EXPECT_EQ(after->tools[i].look.mesh.empty(), before->tools[i].look.mesh.empty());
    }
    EXPECT_EQ(test::bytesOfFile(after->operator_file), test::bytesOfFile(before->operator_file));
  }
}

TEST_F(ExerciseFolder, TheCaseGoesWithItVoxelByVoxelAndWithItsStructures) {
  const fs::path exercise_file = ofAPatient();
  exported(exercise_file);
  const ImportedExercise there = imported();
  ASSERT_TRUE(there.check.verified());
  Exercise before = *readExercise(exercise_file), after = *readExercise(there.exercise);
  const Result<Placement> of = openCase(before), again = openCase(after);
  ASSERT_TRUE(of && again);
  EXPECT_EQ(again->patient.sha256, of->patient.sha256);
  EXPECT_EQ(again->labels->labels, of->labels->labels);
  ASSERT_EQ(again->landmarks.size(), of->landmarks.size());
  EXPECT_EQ(again->landmarks[0].frame.position_mm, of->landmarks[0].frame.position_mm);
}

TEST_F(ExerciseFolder, NothingOfItTellsWhereItCameFrom) {
  exported(ofAPatient());
  imported();
  int files = 0;
  for (const char* place : {"stick", "there"}) {
    for (const fs::path& file : filesBelow(folder_ / place)) {
      std::string all = test::bytesOfFile(file) + fs::relative(file, folder_.path()).string();
      std::ranges::transform(all, all.begin(), [](char c) { return char(std::tolower(c)); });
      EXPECT_EQ(all.find("doe"), std::string::npos) << file;
      ++files;
    }
  }
  EXPECT_GT(files, 16);
}

TEST_F(ExerciseFolder, WhatIsMissingOrChangedIsNamedAndNothingIsWritten) {
  exported(shipped("liver"));
  fs::remove(folder_ / "stick/operator.json");
  std::string tissues = test::bytesOfFile(folder_ / "stick/tissues.json");
  tissues[tissues.find("350")] = '9';
  ASSERT_TRUE(writeTextFile(folder_ / "stick/tissues.json", tissues));
  const ImportedExercise there = imported();
  EXPECT_FALSE(there.check.verified());
  EXPECT_EQ(there.check.missing, std::vector<std::string>{"operator.json"});
  EXPECT_EQ(there.check.changed, std::vector<std::string>{"tissues.json"});
  EXPECT_TRUE(there.exercise.empty());
  EXPECT_FALSE(fs::exists(folder_ / "there"));
}

TEST_F(ExerciseFolder, ALinkOrAFolderInThePlaceOfAPartIsMissing) {
  exported(shipped("liver"));
  fs::rename(folder_ / "stick/operator.json", folder_ / "elsewhere.json");
  fs::create_symlink(folder_ / "elsewhere.json", folder_ / "stick/operator.json");
  EXPECT_EQ(imported().check.missing, std::vector<std::string>{"operator.json"});
}

TEST_F(ExerciseFolder, TheSameAgainIsTakenAsItIsAndAnotherOfTheNameGetsItsOwnFolder) {
  exported(shipped("liver"));
  const fs::path first = imported().exercise;
  EXPECT_EQ(imported().exercise, first);
  fs::remove_all(folder_ / "stick");
  Json exercise = *readJsonFile(shipped("liver"));
  exercise["rate_hz"] = 2000;
  exercise["tissues"] =
      (fs::path(TREPHINE_TEST_SCENES) / exercise["tissues"].get<std::string>()).string();
  exercise["operator"] =
      (fs::path(TREPHINE_TEST_SCENES) / exercise["operator"].get<std::string>()).string();
  exercise["tools"][1].erase("radius_mm");
  exercise["tools"][1]["file"] =
      (fs::path(TREPHINE_TEST_SCENES) / exercise["tools"][1]["file"].get<std::string>()).string();
  ASSERT_TRUE(writeTextFile(folder_ / "fast.json", exercise.dump()));
  exported(folder_ / "fast.json");
  const fs::path second = imported().exercise;
  EXPECT_NE(second, first);
  EXPECT_EQ(readExercise(second)->rate_hz, 2000.0);
  EXPECT_EQ(readExercise(first)->rate_hz, 1000.0);
}

TEST_F(ExerciseFolder, WhatLiesOutsideOfItIsRefused) {
  exported(shipped("liver"));
  const fs::path list = folder_ / "stick/exercise.json";
  const Json good = *readJsonFile(list);
  for (const char* name : {"../secret", "/etc/passwd", "tools/../../secret", "./scene.json", ""}) {
    SCOPED_TRACE(name);
    Json bad = good;
    bad["parts"][1]["file"] = name;
    ASSERT_TRUE(writeTextFile(list, bad.dump()));
    const auto refused = importExercise(folder_ / "stick", folder_ / "there");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code.str(), "BAD_FIELD");
  }
  // An exercise that names what is no part, with a list that is right.
  ASSERT_TRUE(writeTextFile(list, good.dump()));
  ASSERT_TRUE(
      writeTextFile(folder_ / "secret.json", test::bytesOfFile(folder_ / "stick/operator.json")));
  Json exercise = *readJsonFile(folder_ / "stick/scene.json");
  exercise["operator"] = "../secret.json";
  ASSERT_TRUE(writeTextFile(folder_ / "stick/scene.json", exercise.dump()));
  const std::string bytes = test::bytesOfFile(folder_ / "stick/scene.json");
  Json matching = good;
  ASSERT_EQ(matching["parts"][0]["file"], "scene.json");
  matching["parts"][0]["sha256"] = sha256Hex(bytes.data(), bytes.size());
  matching["parts"][0]["bytes"] = bytes.size();
  ASSERT_TRUE(writeTextFile(list, matching.dump()));
  const auto refused = importExercise(folder_ / "stick", folder_ / "there");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code.str(), "BAD_FIELD");
  EXPECT_FALSE(fs::exists(folder_ / "there"));
}

// The list of a folder as its files are now, which an exporter of a stranger writes as well.
void listAnew(const fs::path& folder) {
  Json list = *readJsonFile(folder / "exercise.json");
  list["parts"] = Json::array();
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_regular_file() || name == "exercise.json") continue;
    const std::string bytes = test::bytesOfFile(entry.path());
    list["parts"].push_back({{"file", name},
                             {"sha256", sha256Hex(bytes.data(), bytes.size())},
                             {"bytes", bytes.size()}});
  }
  ASSERT_TRUE(writeTextFile(folder / "exercise.json", list.dump()));
}

TEST_F(ExerciseFolder, OneThatNamesDevicesIsRefusedAndNothingIsWritten) {
  exported(shipped("liver"));
  const fs::path stick = folder_ / "stick";
  Json exercise = *readJsonFile(stick / "scene.json");
  exercise["arms"][0]["device"] = {{"plugin", "woodenhaptics"}, {"arm", 0}};
  ASSERT_TRUE(writeTextFile(stick / "scene.json", exercise.dump()));
  listAnew(stick);
  const auto refused = importExercise(stick, folder_ / "there");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code.str(), "BAD_FIELD");
  EXPECT_NE(refused.error().sentence().find("device"), std::string::npos);
}

TEST_F(ExerciseFolder, APartThatIsListedTwiceOrHasAnUnseenLetterInItsNameIsRefused) {
  exported(shipped("liver"));
  const fs::path list = folder_ / "stick/exercise.json";
  const Json good = *readJsonFile(list);
  Json twice = good;
  for (int n = 0; n < 4000; ++n) twice["parts"].push_back(good["parts"][0]);
  ASSERT_TRUE(writeTextFile(list, twice.dump()));
  EXPECT_EQ(importExercise(folder_ / "stick", folder_ / "there").error().code.str(), "BAD_FIELD");
  for (const char* name : {"tools/a\nb.json", "tools/a\x1b[2Jb.json", "tools/a\u200bb.json"}) {
    Json unseen = good;
    unseen["parts"][1]["file"] = name;
    ASSERT_TRUE(writeTextFile(list, unseen.dump()));
    EXPECT_EQ(importExercise(folder_ / "stick", folder_ / "there").error().code.str(), "BAD_FIELD");
  }
}

TEST_F(ExerciseFolder, APartThatNothingNamesOrIsNamedInTwoWaysAndAListThatIsALinkAreRefused) {
  exported(ofAPatient());
  const fs::path stick = folder_ / "stick";
  const Json good = *readJsonFile(stick / "exercise.json");
  ASSERT_TRUE(imported().check.verified()) << "what lies beside a label map is no stranger";
  ASSERT_TRUE(writeTextFile(stick / "evil.sh", "#!/bin/sh"));
  listAnew(stick);
  const auto unnamed = importExercise(stick, folder_ / "elsewhere");
  ASSERT_FALSE(unnamed);
  EXPECT_NE(unnamed.error().what.find("evil.sh"), std::string::npos) << unnamed.error().what;
  fs::remove(stick / "evil.sh");
  // A name like the case's makes it no part of that.
  ASSERT_TRUE(writeTextFile(stick / "case/volume.payload", "x"));
  listAnew(stick);
  EXPECT_EQ(importExercise(stick, folder_ / "elsewhere").error().code.str(), "BAD_FIELD");
  fs::remove(stick / "case/volume.payload");
  // Names beside a label map, and voxels beside a header, are named by these.
  const Segmentation read = *readSegmentation(stick / "case/structures.seg.nrrd");
  const LabelMap map = merged(read, smallerFirst(read));
  ASSERT_TRUE(writeSegmentation(map, stick / "case/labels.nii.gz"));
  ASSERT_TRUE(fs::exists(stick / "case/labels.structures.json"));
  fs::remove(stick / "case/structures.seg.nrrd");
  std::string volume = test::bytesOfFile(stick / "case/volume.mha");
  const std::size_t voxels = volume.find("LOCAL\n") + 6;
  ASSERT_TRUE(writeTextFile(stick / "case/other.raw", volume.substr(voxels)));
  ASSERT_TRUE(writeTextFile(stick / "case/volume.mhd",
                            volume.substr(0, voxels - 6) + "other.raw\n"));
  fs::remove(stick / "case/volume.mha");
  Json exercise = *readJsonFile(stick / "scene.json");
  exercise["case"] = "case/volume.mhd";
  exercise["labels"] = "case/labels.nii.gz";
  const std::string exercise_before = test::bytesOfFile(stick / "scene.json");
  ASSERT_TRUE(writeTextFile(stick / "scene.json", exercise.dump()));
  listAnew(stick);
  const auto beside = importExercise(stick, folder_ / "beside");
  ASSERT_TRUE(beside.ok()) << beside.error().sentence();
  EXPECT_TRUE(beside->check.verified());
  Json twice = good;
  const auto in_folder = std::ranges::find_if(good["parts"], [](const Json& part) {
    return part["file"].get<std::string>().find('/') != std::string::npos;
  });
  ASSERT_NE(in_folder, good["parts"].end());
  std::string other = (*in_folder)["file"];
  other.insert(other.find('/'), "/");
  twice["parts"].push_back(*in_folder);
  twice["parts"].back()["file"] = other;
  ASSERT_TRUE(writeTextFile(stick / "exercise.json", twice.dump()));
  EXPECT_EQ(importExercise(stick, folder_ / "elsewhere").error().code.str(), "BAD_FIELD") << other;
  ASSERT_TRUE(writeTextFile(folder_ / "list.json", good.dump()));
  fs::remove(stick / "exercise.json");
  fs::create_symlink(folder_ / "list.json", stick / "exercise.json");
  EXPECT_EQ(importExercise(stick, folder_ / "elsewhere").error().code.str(), "MISSING_FILE");
  EXPECT_TRUE(exercisesIn(folder_ / "elsewhere").empty());
}

TEST_F(ExerciseFolder, WhatTheDiskHasNoRoomForIsRefusedBeforeItIsRead) {
  exported(shipped("liver"));
  const fs::path stick = folder_ / "stick";
  Json list = *readJsonFile(stick / "exercise.json");
  // More than is free, of which nothing is stored.
  const std::uintmax_t kHuge = fs::space(folder_.path()).available + (std::uintmax_t(1) << 33);
  fs::resize_file(stick / "tissues.json", kHuge);
  for (Json& part : list["parts"]) {
    if (part["file"] == "tissues.json") part["bytes"] = kHuge;
  }
  ASSERT_TRUE(writeTextFile(stick / "exercise.json", list.dump()));
  const auto refused = importExercise(stick, folder_ / "there");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code.str(), "CANNOT_WRITE");
  EXPECT_NE(refused.error().what.find("no room"), std::string::npos) << refused.error().what;
}

TEST_F(ExerciseFolder, ACaseThatCannotBeOpenedFromItsPartsAloneIsRefusedAndNothingIsKept) {
  const auto refused = [&] {
    listAnew(folder_ / "stick");
    const auto done = importExercise(folder_ / "stick", folder_ / "there");
    EXPECT_FALSE(done.ok());
    EXPECT_TRUE(exercisesIn(folder_ / "there").empty());
    return done ? Error{} : done.error();
  };
  exported(ofAPatient());
  const fs::path stick = folder_ / "stick";
  const Json good = *readJsonFile(stick / "scene.json");
  Json exercise = good;
  exercise["case"] = "phantom:cranium/../x";
  ASSERT_TRUE(writeTextFile(stick / "scene.json", exercise.dump()));
  EXPECT_EQ(refused().code.str(), "BAD_FIELD");
  // A header whose voxels are in a file that no list names, wherever that lies.
  fs::create_directories(folder_ / "voxels");
  Volume small;
  small.geometry.size = {8, 8, 8};
  small.hu.assign(512, 100);
  ASSERT_TRUE(writeVolume(slabsOf(small), folder_ / "voxels/v.mha"));
  std::string header = test::bytesOfFile(folder_ / "voxels/v.mha");
  header.resize(header.find("ElementDataFile"));
  const std::string beside = (folder_ / "voxels/v.raw").string();
  ASSERT_TRUE(writeTextFile(beside, std::string(1024, '\0')));
  for (const std::string& data : {beside, std::string("../../voxels/v.raw")}) {
    ASSERT_TRUE(
        writeTextFile(stick / "case/volume.mhd", header + "ElementDataFile = " + data + "\n"));
    exercise["case"] = "case/volume.mhd";
    ASSERT_TRUE(writeTextFile(stick / "scene.json", exercise.dump()));
    const Error error = refused();
    EXPECT_EQ(error.sentence().find("-part-"), std::string::npos) << error.sentence();
  }
  // Cut short.
  ASSERT_TRUE(writeTextFile(stick / "scene.json", good.dump()));
  fs::remove(stick / "case/volume.mhd");
  fs::resize_file(stick / "case/volume.mha", fs::file_size(stick / "case/volume.mha") / 2);
  refused();
}

TEST_F(ExerciseFolder, IsNotWrittenOverWhatIsThereAndLeavesNothingWhereItFails) {
  ASSERT_TRUE(makeFolder(folder_ / "stick"));
  ASSERT_TRUE(writeTextFile(folder_ / "stick/mine.txt", "mine"));
  const auto taken = exportExercise(shipped("liver"), "", folder_ / "stick");
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code.str(), "CANNOT_WRITE");
  EXPECT_EQ(test::bytesOfFile(folder_ / "stick/mine.txt"), "mine");
  const auto no_case =
      exportExercise(shipped("liver"), (folder_ / "nothing.mha").string(), folder_ / "other");
  ASSERT_FALSE(no_case);
  EXPECT_EQ(no_case.error().code.str(), "MISSING_FILE");
  int there = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) there += entry.exists();
  EXPECT_EQ(there, 1) << "the folder with mine.txt alone";
}

TEST_F(ExerciseFolder, OnAnotherCaseWhatHoldsOfItsOwnAloneIsLeftOut) {
  const fs::path exercise_file = ofAPatient();
  Json exercise = *readJsonFile(exercise_file);
  exported(exercise_file, "phantom:abdomen");
  const Json out = *readJsonFile(folder_ / "stick/scene.json");
  EXPECT_EQ(out["case"], "phantom:abdomen");
  EXPECT_FALSE(out.contains("labels"));
  EXPECT_FALSE(fs::exists(folder_ / "stick/case"));
}

// ---- Exercises that are made here.

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(ExerciseFolder, EveryShippedExerciseIsSavedReadAndSavedAgainInTheSameBytes) {
  int exercises = 0;
  for (const auto& entry : fs::recursive_directory_iterator(TREPHINE_TEST_SCENES)) {
    if (!entry.is_regular_file()) continue;
    const Result<Exercise> shipped = readExercise(entry.path());
    ASSERT_TRUE(shipped.ok());
    const fs::path storage = folder_ / "storage";
    const fs::path folder = freshExercise(storage, shipped->name);
    const Result<fs::path> saved = saveExercise(*shipped, folder, storage);
    ASSERT_TRUE(saved.ok()) << saved.error().sentence();
    const Result<Exercise> read = readExercise(*saved);
    ASSERT_TRUE(read.ok()) << read.error().sentence();
    // All but where its files lie.
    const auto settings = [](const Exercise& exercise) {
      Json json = toJson(exercise);
      if (exercise.tissues_elsewhere) json["elsewhere"] = toJson(*exercise.tissues_elsewhere);
      json["operator"] = !exercise.operator_file.empty();
      for (const ExerciseTool& tool : exercise.tools) json["meshes"].push_back(!tool.look.mesh.empty());
      return json;
    };
    EXPECT_EQ(settings(*read), settings(*shipped)) << entry.path();
    const std::string first = textOf(*saved);
    ASSERT_TRUE(saveExercise(*read, folder, storage).ok());
    EXPECT_EQ(textOf(*saved), first) << "in its own place";
    const fs::path other = freshExercise(storage, shipped->name);
    EXPECT_NE(other, folder);
    const Result<fs::path> copy = saveExercise(*read, other, storage);
    ASSERT_TRUE(copy.ok());
    EXPECT_EQ(textOf(*copy), first) << "and in another";
    ++exercises;
  }
  EXPECT_GE(exercises, 7);
  EXPECT_EQ(exercisesIn(folder_ / "storage").size(), std::size_t(2 * exercises));
  for (const fs::path& file : filesBelow(folder_.path())) {
    EXPECT_EQ(file.string().find("-part-"), std::string::npos) << file;
  }
}

TEST_F(ExerciseFolder, SavingItAgainKeepsWhatAPersonHasPutBesideItAndDropsWhatItNoLongerNames) {
  const fs::path storage = folder_ / "storage", folder = storage / "exercises" / "mine";
  Exercise exercise = *readExercise(shipped("burr-hole"));
  ASSERT_TRUE(saveExercise(exercise, folder, storage).ok());
  ASSERT_TRUE(fs::exists(folder / "operator.json"));
  fs::create_directories(folder / "notes");
  ASSERT_TRUE(writeTextFile(folder / "notes" / "lesson.txt", "Tuesday").ok());
  ASSERT_TRUE(writeTextFile(folder / "photo.jpg", "?").ok());
  fs::create_symlink("photo.jpg", folder / "cover");
  exercise.operator_file.clear();
  ASSERT_TRUE(saveExercise(exercise, folder, storage).ok());
  EXPECT_EQ(textOf(folder / "notes" / "lesson.txt"), "Tuesday");
  EXPECT_TRUE(fs::exists(folder / "photo.jpg"));
  EXPECT_EQ(fs::read_symlink(folder / "cover"), "photo.jpg");
  EXPECT_FALSE(fs::exists(folder / "operator.json"));
}

TEST_F(ExerciseFolder, TheCaseThatCameWithItStaysWhenItIsSavedOnAnother) {
  exported(ofAPatient());
  const ImportedExercise there = imported();
  ASSERT_TRUE(there.check.verified());
  const fs::path folder = there.exercise.parent_path();
  Exercise exercise = *readExercise(there.exercise);
  const std::string volume = textOf(folder / "case" / "volume.mha");
  exercise.case_source = "phantom:abdomen";
  exercise.labels_file.clear();
  ASSERT_TRUE(saveExercise(exercise, folder, folder_ / "there").ok());
  EXPECT_EQ(textOf(folder / "case" / "volume.mha"), volume);
  EXPECT_TRUE(fs::exists(folder / "case" / "structures.seg.nrrd"));
  EXPECT_FALSE(fs::exists(folder / "exercise.json")) << "it is no longer what was exported";
}

TEST_F(ExerciseFolder, APersonsFileWhoseNameItNeedsNowIsKeptBesideItAsAreEmptyFolders) {
  const fs::path storage = folder_ / "storage", folder = storage / "exercises" / "mine";
  Exercise exercise = *readExercise(shipped("liver"));
  ASSERT_TRUE(saveExercise(exercise, folder, storage).ok());
  fs::create_directories(folder / "pictures");
  ASSERT_TRUE(writeTextFile(folder / "tools" / "probe.stl", "precious").ok());
  exercise.tools[0].id = "probe";
  exercise.tools[0].look.mesh = resourceFolder() / "tools" / "burr4.stl";
  for (ExerciseArm& arm : exercise.arms) arm.tool = "probe", arm.other_tools.clear();
  ASSERT_TRUE(saveExercise(exercise, folder, storage).ok());
  EXPECT_EQ(textOf(folder / "tools" / "probe-kept.stl"), "precious");
  EXPECT_GT(fs::file_size(folder / "tools" / "probe.stl"), 100u);
  EXPECT_TRUE(fs::is_directory(folder / "pictures"));
}

TEST_F(ExerciseFolder, APlaceThatCannotBeLookedAtIsAnErrorAndNoEndlessSearch) {
  fs::create_symlink("loop", folder_ / "loop");
  const fs::path storage = folder_ / "loop";
  const Exercise exercise = *readExercise(shipped("liver"));
  EXPECT_EQ(saveExercise(exercise, freshExercise(storage, "Mine"), storage).error().code.str(),
            "CANNOT_WRITE");
  exported(shipped("liver"));
  EXPECT_EQ(importExercise(folder_ / "stick", storage).error().code.str(), "CANNOT_WRITE");
}

TEST_F(ExerciseFolder, WhatIsNoCaseScriptOrMeshIsNotExported) {
  const auto refused = [&](const fs::path& exercise, const std::string& of) {
    const auto done = exportExercise(exercise, of, folder_ / "stick");
    EXPECT_FALSE(done.ok());
    EXPECT_FALSE(fs::exists(folder_ / "stick"));
    return done ? std::string() : done.error().code.str();
  };
  EXPECT_FALSE(refused(shipped("liver"), "phantom:nope").empty());
  const fs::path of = ofAPatient(), file = folder_ / "letter.txt";
  ASSERT_TRUE(writeTextFile(file, "Dear Sir").ok());
  Json exercise = *readJsonFile(of);
  exercise["operator"] = file.string();
  ASSERT_TRUE(writeTextFile(of, exercise.dump()).ok());
  EXPECT_EQ(refused(of, ""), "BAD_JSON");
  exercise.erase("operator");
  exercise["tools"][0]["mesh"] = file.string();
  ASSERT_TRUE(writeTextFile(of, exercise.dump()).ok());
  EXPECT_EQ(refused(of, ""), "NOT_STL");
}

TEST_F(ExerciseFolder, AnotherNameOfTheExerciseALinkedFolderOrAFalseSizeIsNoVerifiedImport) {
  exported(shipped("liver"));
  const fs::path stick = folder_ / "stick";
  const std::string list = textOf(stick / "exercise.json");
  Json other = Json::parse(list);
  other["scene"] = "lesson.json";
  ASSERT_TRUE(writeTextFile(stick / "exercise.json", other.dump()).ok());
  EXPECT_EQ(importExercise(stick, folder_ / "there").error().code.str(), "BAD_FIELD");
  other = Json::parse(list);
  other["parts"][0]["bytes"] = 1;
  ASSERT_TRUE(writeTextFile(stick / "exercise.json", other.dump()).ok());
  EXPECT_FALSE(imported().check.verified());
  ASSERT_TRUE(writeTextFile(stick / "exercise.json", list).ok());
  fs::rename(stick / "tools", folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", stick / "tools");
  EXPECT_FALSE(imported().check.missing.empty());
  EXPECT_TRUE(exercisesIn(folder_ / "there").empty());
}

TEST_F(ExerciseFolder, AMeshGoesWithoutWhatItsHeaderSaysOfItsMaker) {
  const std::string maker = "Exported by ann from C:/Patients/Smith_John/burr.blend";
  std::string binary = maker + std::string(80 - maker.size(), ' ');
  const std::uint32_t count = 1;
  binary.append(reinterpret_cast<const char*>(&count), 4);
  binary +=
      std::string("solid triangle, not to be read as text, of exactly fifty bytes").substr(0, 50);
  const std::string text = "solid " + maker +
                           "\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                           "vertex 0 1 0\nendloop\nendfacet\nendsolid " +
                           maker + "\n";
  for (const std::string& stl : {binary, text}) {
    const fs::path mesh = folder_ / "mesh.stl", storage = folder_ / "storage";
    ASSERT_TRUE(writeTextFile(mesh, stl).ok());
    Exercise exercise = *readExercise(shipped("burr-hole"));
    exercise.tools[0].look.mesh = mesh;
    const Result<fs::path> saved = saveExercise(exercise, storage / "exercises" / "mine", storage);
    ASSERT_TRUE(saved.ok()) << saved.error().sentence();
    const std::string copy = textOf(readExercise(*saved)->tools[0].look.mesh);
    EXPECT_EQ(copy.find("ann"), std::string::npos);
    if (stl == binary) {
      EXPECT_EQ(copy.substr(80), stl.substr(80)) << "the same triangles";
    } else {
      EXPECT_NE(copy.find("vertex 1 0 0"), std::string::npos);
      EXPECT_EQ(copy.substr(0, 6), "solid\n");
    }
  }
}

TEST_F(ExerciseFolder, WhatAKilledProgramLeftIsTakenAwayAndWhatALivingOneWritesIsNot) {
  const fs::path storage = folder_ / "storage", exercises = storage / "exercises";
  const fs::path left = exercises / ".mine.trephine-part-abcdef";
  const fs::path written = exercises / ".mine.trephine-part-ghijkl";
  const fs::path own = exercises / ".thesis.part-second";
  for (const fs::path& part : {left, written, own}) {
    fs::create_directories(part / "tools");
    ASSERT_TRUE(writeTextFile(part / "scene.json", "{").ok());
  }
  const Descriptor other_program(::open(written.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  ASSERT_EQ(::flock(other_program.get(), LOCK_EX), 0);
  ASSERT_TRUE(saveExercise(*readExercise(shipped("liver")), exercises / "mine", storage).ok());
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(written));
  EXPECT_TRUE(fs::exists(own / "scene.json")) << "a person's own folder";
}

TEST_F(ExerciseFolder, ASavedOneNamesItsCaseFromWhereItLiesAndMovesWithTheStorage) {
  const Result<Exercise> exercise = readExercise(ofAPatient());
  ASSERT_TRUE(exercise.ok()) << exercise.error().sentence();
  const fs::path storage = folder_ / "DOE^JANE";  // the case lies in it
  const Result<fs::path> saved = saveExercise(*exercise, storage / "exercises" / "mine", storage);
  ASSERT_TRUE(saved.ok()) << saved.error().sentence();
  const Json json = *readJsonFile(*saved);
  EXPECT_EQ(json.at("case"), "../../doe.mha");
  EXPECT_EQ(json.at("labels"), "../../doe.seg.nrrd");
  fs::rename(storage, folder_ / "moved");
  const Result<Exercise> moved = readExercise(folder_ / "moved" / "exercises" / "mine" / "scene.json");
  ASSERT_TRUE(moved.ok()) << moved.error().sentence();
  EXPECT_TRUE(readCase(moved->case_source).ok());
}

TEST(ExerciseFolders, AFileBelowTheStorageIsOfTheExerciseThatBroughtIt) {
  const fs::path storage = "/data/trephine", mine = storage / "exercises" / "mine";
  EXPECT_EQ(exerciseThatBrought(storage, mine / "case" / "volume.nii.gz"), mine / "scene.json");
  EXPECT_EQ(exerciseThatBrought(storage, mine / "case" / ".." / "scene.json"), mine / "scene.json");
  EXPECT_EQ(exerciseThatBrought(storage, storage / "exercises" / "loose.json"), fs::path());
  EXPECT_EQ(exerciseThatBrought(storage, storage / "cases" / "a" / "volume.nii.gz"), fs::path());
  EXPECT_EQ(exerciseThatBrought(storage, mine / ".." / ".." / "cases" / "a"), fs::path());
  EXPECT_EQ(exerciseThatBrought(storage, ""), fs::path());
}

TEST_F(ExerciseFolder, WhatCannotBeSavedLeavesTheOneThatWasThereAsItWas) {
  const fs::path storage = folder_ / "storage", folder = storage / "exercises" / "mine";
  const Exercise exercise = *readExercise(shipped("liver"));
  ASSERT_TRUE(saveExercise(exercise, folder, storage).ok());
  const std::string before = textOf(folder / "scene.json");
  Exercise wrong = exercise;
  wrong.arms[0].map.motion_scale = 1e9;
  EXPECT_EQ(saveExercise(wrong, folder, storage).error().code.str(), "BAD_FIELD");
  wrong = exercise;
  wrong.operator_file = "/nowhere/operator.json";
  EXPECT_FALSE(saveExercise(wrong, folder, storage).ok());
  Progress cancelled;
  cancelled.cancel();
  wrong = exercise;
  wrong.rate_hz = 2000;
  EXPECT_EQ(saveExercise(wrong, folder, storage, cancelled).error().code.str(), "CANCELLED");
  EXPECT_EQ(textOf(folder / "scene.json"), before);
  EXPECT_EQ(exercisesIn(storage).size(), 1u);
}

}  // namespace
}  // namespace trephine
