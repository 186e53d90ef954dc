// The workstation without a window: a case, its label map, an exercise on both.
#include "ui/work/workstation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <random>

#include "base/file.h"
#include "base/system.h"
#include "file_size_limit.h"
#include "qt_support.h"
#include "shells.h"
#include "support.h"
#include "tissue/tissue_edits.h"
#include "training/session_reader.h"
#include "ui/frame/main_window.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

using test::waitFor;

// A ball of bone: enough for the landmark of the default exercise.
Volume ball() {
  return test::shells(60, 1.5, {{40, 1200}});
}

class WorkstationTest : public ::testing::Test {
 protected:
  WorkstationTest() {
    workstation_.setStepped(true);
    QObject::connect(&workstation_, &Workstation::failed, &workstation_,
                     [this](const Error& error) { failed_ = error; });
  }
  // Runs until what was begun is over.
  bool wait() {
    return waitFor([this] { return !workstation_.isOpening(); });
  }
  // With the time of an exercise going on meanwhile.
  bool comes(const std::function<bool()>& condition) {
    return waitFor([&] {
      if (workstation_.session()) workstation_.session()->advance(0.01);
      return condition();
    });
  }
  std::filesystem::path written(const char* name, const Volume& volume) {
    EXPECT_TRUE(writeVolume(volume, folder_ / name));
    return folder_ / name;
  }
  std::filesystem::path labels(int label) {
    Volume map = ball();
    std::fill(map.hu.begin(), map.hu.end(), std::int16_t(label));
    return written("labels.nii.gz", map);
  }

  QApplication& application_ = test::application();
  test::TemporaryFolder folder_;
  Workstation workstation_;
  std::optional<Error> failed_;
};

TEST_F(WorkstationTest, ALabelMapBelongsToTheCaseThatIsOpen) {
  workstation_.useLabels(labels(7));
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NO_CASE");
  failed_.reset();

  const auto ct = std::make_shared<const Volume>(ball());
  workstation_.openImported(caseOf(ct));
  ASSERT_TRUE(wait());
  ASSERT_TRUE(workstation_.currentCase());
  EXPECT_EQ(workstation_.placed()->labels, nullptr);
  workstation_.useLabels(labels(7));
  ASSERT_TRUE(wait());
  EXPECT_FALSE(failed_) << failed_->sentence();
  ASSERT_TRUE(workstation_.placed()->labels);
  EXPECT_EQ(workstation_.placed()->labels->labels, std::vector<std::uint8_t>(ball().hu.size(), 7));

  workstation_.useLabels(labels(-7));
  ASSERT_TRUE(wait());
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NOT_LABELS");
  EXPECT_TRUE(workstation_.placed()->labels) << "the one before stays";
  workstation_.useExercise(workstation_.exerciseFile());
  ASSERT_TRUE(wait());
  EXPECT_TRUE(workstation_.placed()->labels) << "another exercise on the same case";
  workstation_.openImported(caseOf(ct));
  ASSERT_TRUE(wait());
  EXPECT_EQ(workstation_.placed()->labels, nullptr);
}

TEST_F(WorkstationTest, AnImportedCaseComesWithItsLabelMapOrWithoutOneAndASentence) {
  const auto ct = std::make_shared<const Volume>(ball());
  workstation_.openImported(caseOf(ct), labels(7));
  ASSERT_TRUE(wait());
  EXPECT_FALSE(failed_) << failed_->sentence();
  ASSERT_TRUE(workstation_.currentCase() && workstation_.placed()->labels);

  const auto another = std::make_shared<const Volume>(ball());
  workstation_.openImported(caseOf(another), labels(-7));
  ASSERT_TRUE(wait());
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NOT_LABELS");
  EXPECT_EQ(workstation_.currentCase()->volume, another) << "the case opens all the same";
  EXPECT_EQ(workstation_.placed()->labels, nullptr);
}

TEST_F(WorkstationTest, ThatACaseIsBeingOpenedIsToldFromItsBeginningToItsEnd) {
  std::vector<bool> opening;
  QObject::connect(&workstation_, &Workstation::phaseChanged, &workstation_,
                   [&] { opening.push_back(workstation_.isOpening()); });
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  EXPECT_EQ(opening, std::vector<bool>{true});
  ASSERT_TRUE(wait());
  EXPECT_FALSE(opening.back());
  workstation_.openPhantom("cranium");
  EXPECT_TRUE(opening.back()) << "a case is open, and another is being opened";
  workstation_.cancelOpening();
  ASSERT_TRUE(wait());
  EXPECT_FALSE(opening.back()) << "cancelled";
}

TEST_F(WorkstationTest, ARawFilesSidecarIsImportedLikeTheRawFile) {
  std::ofstream(folder_ / "ct.raw") << std::string(16, 'x');
  std::ofstream(folder_ / "ct.json")
      << R"({"size": [2, 2, 2], "spacing_mm": [1, 1, 1], "type": "int16", "byte_order": "little"})";
  workstation_.openPath(folder_ / "ct.json");
  ASSERT_TRUE(waitFor([&] { return workstation_.import().hasFolder() || failed_; }));
  EXPECT_FALSE(failed_);
  ASSERT_EQ(workstation_.import().report().series.size(), 1u);
  EXPECT_EQ(workstation_.import().report().series.front().source, "raw");
}

TEST_F(WorkstationTest, AnExerciseTakesTheLabelMapAndWithoutItIsRefused) {
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  TissueSet tissues = workstation_.exercise()->tissues;
  tissues.tissues.back().label = 7;
  workstation_.setTissues(tissues);
  const auto started = [&] {
    workstation_.start(folder_.path(), {}, 1e9);
    (void)waitFor([&] { return workstation_.phase() != Workstation::Phase::starting; });
    return workstation_.session() != nullptr;
  };
  EXPECT_FALSE(started());
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NO_LABELS");
  failed_.reset();

  workstation_.useLabels(labels(7));
  ASSERT_TRUE(wait());
  ASSERT_TRUE(started()) << (failed_ ? failed_->sentence() : "");
  EXPECT_EQ(workstation_.session()->grid().labels(), workstation_.placed()->labels);
  workstation_.stop();
  EXPECT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));
}

TEST_F(WorkstationTest, ARecordingThatFailsIsSaidOnceAtOnceAndTheExerciseGoesOn) {
  std::vector<Error> said;
  QObject::connect(&workstation_, &Workstation::recordingFailed, &workstation_,
                   [&](const Error& error) { said.push_back(error); });
  workstation_.setStepped(false);  // it is written by a thread of its own
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  workstation_.start(folder_.path(), {}, 1e9);
  ASSERT_TRUE(waitFor([&] { return workstation_.session() != nullptr; }));

  // As a disk that is full from here on: no file grows.
  std::optional<test::FileSizeLimit> full(4096);
  const bool heard = waitFor([&] {
    workstation_.checkRecording();
    return !said.empty();
  });
  full.reset();
  ASSERT_TRUE(heard);
  EXPECT_EQ(said.front().code.str(), "CANNOT_WRITE");
  ASSERT_TRUE(workstation_.session());
  const std::uint64_t then = workstation_.session()->state().ticks;
  EXPECT_TRUE(waitFor([&] { return workstation_.session()->state().ticks > then + 100; }));
  workstation_.checkRecording();
  workstation_.stop();
  EXPECT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));
  EXPECT_EQ(said.size(), 1u);
  EXPECT_FALSE(failed_) << "said a second time: " << failed_->sentence();
}

TEST_F(WorkstationTest, WhatIsEditedWhileAnExerciseStartsIsFeltInIt) {
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  workstation_.start(folder_.path(), {}, 1e9);
  ASSERT_EQ(workstation_.phase(), Workstation::Phase::starting);
  TissueSet tissues = workstation_.exercise()->tissues;
  tissues.tissues.back().damping_Ns_per_m.value = 20.0;
  workstation_.setTissues(tissues);
  workstation_.setController(ControllerKind::off);
  ASSERT_TRUE(waitFor([&] { return workstation_.session() != nullptr; }));
  EXPECT_FALSE(failed_) << failed_->sentence();
  EXPECT_EQ(workstation_.session()->exercise().tissues.tissues.back().damping_Ns_per_m.value, 20.0);
  EXPECT_TRUE(comes([&] {
    const LoopState& state = workstation_.session()->state();
    return state.ticks > 0 && state.controller == ControllerKind::off;
  }));
  workstation_.stop();
  ASSERT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));

  // The tick was told before it felt anything.
  const auto recording = SessionReader::open(*std::filesystem::directory_iterator(folder_.path()));
  ASSERT_TRUE(recording) << recording.error().sentence();
  const Result<std::vector<Event>> events = (*recording)->events();
  ASSERT_TRUE(events);
  const auto told = std::ranges::find(*events, CommandKind::tissues,
                                      [](const Event& event) { return event.command.kind; });
  ASSERT_NE(told, events->end());
  EXPECT_EQ(told->tick, 0u);
  EXPECT_EQ(told->command.tissues->classes[tissues.tissues.size() - 1].damping_Ns_per_m, 20.0);
}

class PlacedTest : public WorkstationTest {
 protected:
  double vault_mm() { return workstation_.placed()->landmarks.at(0).frame.position_mm.z; }
  void startAndStop() {
    workstation_.start(folder_.path(), {}, 1e9);
    ASSERT_TRUE(waitFor([&] { return workstation_.session() != nullptr; }));
    started_mm_ = workstation_.session()->landmarks().at(0).frame.position_mm.z;
    workstation_.stop();
    ASSERT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));
  }
  double started_mm_ = 0.0;
};

// Bone of 1200 HU around a kernel of 2000.
TEST_F(PlacedTest, ALandmarkLiesWhereTheTissueIsThatAnEditMadeOfIt) {
  workstation_.openImported(
      caseOf(std::make_shared<const Volume>(test::shells(60, 1.5, {{40, 1200}, {20, 2000}}))));
  ASSERT_TRUE(wait());
  const double before_mm = vault_mm();
  startAndStop();
  EXPECT_EQ(started_mm_, before_mm);
  TissueSet tissues = workstation_.exercise()->tissues;
  for (Tissue& tissue : tissues.tissues) {
    if (tissue.id == "bone") tissue.hu_min = 1500;
  }
  workstation_.setTissues(tissues);
  startAndStop();
  EXPECT_NEAR(before_mm - started_mm_, 20.0, 3.0);
  EXPECT_EQ(vault_mm(), started_mm_) << "where the view looks, too";
  workstation_.setTissues(workstation_.declaredTissues());
  startAndStop();
  EXPECT_EQ(started_mm_, before_mm) << "and where it lay before, once the edit is taken back";
}

TEST_F(PlacedTest, AExerciseThatNamesNoCaseIsPlacedInTheOneThatIsOpen) {
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  const double top_mm = vault_mm();
  Json exercise = *readJsonFile(resourceFolder() / "scenes" / "cranium.json");
  exercise.erase("case");
  exercise["landmarks"][0]["from"] = {0.5, 0.5, -0.2};  // from below
  std::vector<Json*> names{&exercise["tissues"], &exercise["operator"]};
  for (Json& tool : exercise["tools"]) names.push_back(&tool["file"]);
  for (Json* name : names) {
    *name = (resourceFolder() / "scenes" / name->get<std::string>()).lexically_normal().string();
  }
  ASSERT_TRUE(writeTextFile(folder_ / "below.json", exercise.dump()));
  workstation_.openPath(folder_ / "below.json");
  ASSERT_TRUE(wait());
  EXPECT_FALSE(failed_) << failed_->sentence();
  EXPECT_LT(vault_mm(), top_mm - 50.0);
  startAndStop();
  EXPECT_LT(started_mm_, top_mm - 50.0);
}

class SavedVolumeTest : public WorkstationTest {
 protected:
  void start() {
    workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
    ASSERT_TRUE(wait());
    const Exercise& exercise = *workstation_.exercise();
    workstation_.start(folder_.path(), *readOperatorScript(exercise.operator_file, exercise), 1e9);
    ASSERT_TRUE(waitFor([&] { return workstation_.session() != nullptr; }));
    ASSERT_TRUE(comes([&] { return workstation_.session()->state().can_undo; }));
  }
  void stop() {
    workstation_.stop();
    ASSERT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));
  }
  bool isWhole(const char* name) { return readVolume(folder_ / name)->hu == ball().hu; }
};

TEST_F(SavedVolumeTest, WhileAnExerciseEndsIsThatOfTheExercise) {
  start();
  workstation_.stop();
  ASSERT_EQ(workstation_.phase(), Workstation::Phase::ending);
  bool saved = false;
  workstation_.saveVolume(folder_ / "carved.mha", [&] { saved = true; });
  ASSERT_TRUE(waitFor([&] { return saved; }));
  EXPECT_FALSE(isWhole("carved.mha"));
}

TEST_F(SavedVolumeTest, WhileAnExerciseStartsIsRefusedAndOneThatDoesNotStartIsSaid) {
  start();
  stop();
  int told = 0;
  QObject::connect(&workstation_, &Workstation::startFailed, &workstation_, [&] { ++told; });
  ASSERT_TRUE(writeTextFile(folder_ / "file", "no folder"));
  workstation_.start(folder_ / "file" / "nowhere", {}, 1e9);
  workstation_.saveVolume(folder_ / "carved.mha");
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "BUSY");
  failed_.reset();
  ASSERT_TRUE(waitFor([&] { return workstation_.phase() == Workstation::Phase::ready; }));
  ASSERT_TRUE(failed_) << "there is no such folder";
  EXPECT_EQ(told, 1) << "the view shows cuts that are gone";
}

TEST_F(SavedVolumeTest, AskedForTwiceIsWrittenOnceAndTheExerciseStandsStillMeanwhile) {
  start();
  std::vector<std::string> saved;
  workstation_.saveVolume(folder_ / "a.mha", [&] { saved.push_back("a"); });
  workstation_.saveVolume(folder_ / "b.mha", [&] { saved.push_back("b"); });
  ASSERT_TRUE(failed_) << "the second while the first waits";
  EXPECT_EQ(failed_->code.str(), "BUSY");
  ASSERT_TRUE(comes([&] { return saved == std::vector<std::string>{"a"}; }));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.mha"));
  EXPECT_TRUE(comes([&] { return !workstation_.session()->state().paused; }));
  stop();
}

// What the exercise finds is deep in soft tissue, and so is where it puts the tools.
TEST_F(WorkstationTest, HandsThatTheMouseWillMoveBeginOutsideOfTissue) {
  const Volume deep = test::shells(60, 1.5, {{42, -20}, {15, 1200}});
  workstation_.openImported(caseOf(std::make_shared<const Volume>(deep)));
  ASSERT_TRUE(wait());
  workstation_.start(folder_.path(), {}, 1e9);
  ASSERT_TRUE(waitFor([this] { return workstation_.session() != nullptr; }));
  ASSERT_TRUE(comes([this] { return workstation_.session()->state().ticks > 10; }));
  for (int arm : {0, 1}) {
    const ArmRecord record = workstation_.session()->state().record.arms[arm];
    EXPECT_EQ(record.tissue_class, -1) << arm;
    EXPECT_EQ(record.tool_state & kToolWaits, 0u) << arm;
  }
}

class EditedTissuesTest : public WorkstationTest {
 protected:
  EditedTissuesTest() {
    workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
    EXPECT_TRUE(wait());
    TissueSet tissues = workstation_.exercise()->tissues;
    tissues.tissues.back().hu_min = 900;
    workstation_.setTissues(tissues);
  }
  int boneFrom() { return workstation_.exercise()->tissues.tissues.back().hu_min; }
};

TEST_F(EditedTissuesTest, StayWithTheirExerciseWhateverTheCaseAndAreKnownToBeEdited) {
  EXPECT_TRUE(workstation_.tissuesEdited());
  EXPECT_EQ(workstation_.declaredTissues().tissues.back().hu_min, 226);
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  EXPECT_EQ(boneFrom(), 900);
  workstation_.useLabels(labels(7));
  TissueSet tissues = workstation_.exercise()->tissues;
  tissues.tissues.back().hu_min = 950;  // while the label map is read
  workstation_.setTissues(tissues);
  ASSERT_TRUE(wait());
  ASSERT_TRUE(workstation_.placed()->labels);
  EXPECT_EQ(boneFrom(), 950);
  EXPECT_TRUE(workstation_.tissuesEdited());
  EXPECT_EQ(workstation_.declaredTissues().tissues.back().hu_min, 226);

  workstation_.useExercise(workstation_.exerciseFile());
  ASSERT_TRUE(wait());
  EXPECT_EQ(boneFrom(), 226) << "an exercise that is chosen brings its own";
  EXPECT_FALSE(workstation_.tissuesEdited());
}

TEST_F(WorkstationTest, TissuesThatWereEditedComeBackWithTheStructuresThatTheyAreOf) {
  workstation_.openPhantom("abdomen");
  ASSERT_TRUE(wait()) << failed_->sentence();
  const auto structures = workstation_.currentCase()->structures;
  TissueSet tissues = workstation_.tissues();
  tissues.tissues.front().opacity = 0.123;
  workstation_.setTissues(tissues);
  ASSERT_TRUE(workstation_.useStructures(nullptr));
  ASSERT_TRUE(wait());
  EXPECT_TRUE(workstation_.isElsewhere()) << "those by HU are in force";
  EXPECT_EQ(workstation_.tissues(), *workstation_.exercise()->tissues_elsewhere);
  EXPECT_TRUE(workstation_.exerciseEdited()) << "the set that waits is not saved";
  EXPECT_FALSE(workstation_.tissuesEdited());
  // What is saved now is the exercise, not what this case leaves of it.
  TissueSet by_hu = workstation_.tissues();
  by_hu.tissues.front().opacity = 0.456;
  workstation_.setTissues(by_hu);
  EXPECT_TRUE(workstation_.isElsewhere());
  const std::optional<Exercise> made = workstation_.exercise();
  EXPECT_EQ(made->tissues.tissues.front().opacity, 0.123);
  EXPECT_FALSE(made->tissues.find("liver")->structure.empty());
  ASSERT_TRUE(made->tissues_elsewhere);
  EXPECT_EQ(made->tissues_elsewhere->tissues.front().opacity, 0.456);
  workstation_.undoEdit();
  ASSERT_TRUE(workstation_.useStructures(structures));
  ASSERT_TRUE(wait());
  EXPECT_TRUE(workstation_.tissuesEdited());
  EXPECT_EQ(workstation_.exercise()->tissues.tissues.front().opacity, 0.123);
  EXPECT_EQ(workstation_.placedTissues().find("liver")->label, structures->find("liver")->label);
}

TEST_F(EditedTissuesTest, AreSavedAsASetThatExercisesCanName) {
  bool then = false;
  workstation_.saveTissues(folder_ / "mine.json", [&] { then = true; });
  ASSERT_TRUE(waitFor([&] { return then; }));
  EXPECT_FALSE(failed_);
  const Result<TissueSet> saved = readTissueSet(folder_ / "mine.json");
  ASSERT_TRUE(saved) << saved.error().sentence();
  EXPECT_TRUE(*saved == workstation_.exercise()->tissues);
  EXPECT_FALSE(workstation_.tissuesEdited());
}

TEST_F(EditedTissuesTest, ThatCannotBeSavedAreStillEdited) {
  bool then = false;
  workstation_.saveTissues(folder_ / "no folder" / "mine.json", [&] { then = true; });
  ASSERT_TRUE(waitFor([&] { return failed_.has_value(); }));
  EXPECT_FALSE(then);
  EXPECT_TRUE(workstation_.tissuesEdited());
}

TEST_F(WorkstationTest, NothingIsStartedFromAWindowThatCannotDraw) {
  MainWindow window(folder_.path());
  std::optional<Error> said;
  QObject::connect(&window, &MainWindow::failed, &window,
                   [&](const Error& error) { said = error; });
  Workstation& shown = window.workstation();
  shown.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(waitFor([&] { return shown.phase() == Workstation::Phase::ready; }));
  window.startExercise();
  EXPECT_EQ(shown.phase(), Workstation::Phase::ready);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->code.str(), "NO_OPENGL");
}

// A file of the trainee's own may change while it is open.
TEST_F(WorkstationTest, AExerciseThatIsEditedUnderneathBringsNothingThatIsLocked) {
  Policy policy;
  policy.locks = {Lock::controller};
  policy.controller = ControllerKind::bounded;
  Workstation locked(policy);
  std::optional<Error> said;
  QObject::connect(&locked, &Workstation::failed, &locked, [&](const Error& e) { said = e; });
  const std::filesystem::path exercises = resourceFolder() / "scenes", file = folder_ / "own.json";
  Json exercise = *readJsonFile(exercises / "cranium.json");
  for (const char* key : {"tissues", "operator"})
    exercise[key] = exercises / exercise[key].get<std::string>();
  for (Json& tool : exercise["tools"]) tool["file"] = exercises / tool["file"].get<std::string>();
  exercise["case"] = "";
  ASSERT_TRUE(writeTextFile(file, exercise.dump()));
  locked.openPath(file);
  locked.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(waitFor([&] { return locked.phase() == Workstation::Phase::ready; }));
  ASSERT_EQ(locked.exerciseFile(), file);
  said.reset();
  exercise["controller"] = "off";
  ASSERT_TRUE(writeTextFile(file, exercise.dump()));
  EXPECT_TRUE(locked.placeEntry(std::nullopt));
  ASSERT_TRUE(waitFor([&] { return !locked.isOpening(); }));
  EXPECT_FALSE(said) << said->sentence();
  EXPECT_EQ(locked.exercise()->controller, ControllerKind::bounded);
  locked.useExercise(file);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->code.str(), "LOCKED");
  EXPECT_EQ(locked.exercise()->controller, ControllerKind::bounded);
}

// ---- Edits of the exercise

class EditsTest : public WorkstationTest {
 protected:
  EditsTest() {
    workstation_.openPhantom("cranium");
    EXPECT_TRUE(waitFor([this] { return workstation_.phase() == Workstation::Phase::ready; }));
  }
  const Exercise& exercise() { return *workstation_.exercise(); }
};

// Tissues, tools and arms, at random but possible.
Exercise randomlyEdited(Exercise exercise, std::mt19937& random) {
  const auto pick = [&](std::size_t count) { return std::size_t(random()) % count; };
  const auto share = [&] { return double(random() % 1000) / 1000.0; };
  Tissue& tissue = exercise.tissues.tissues[pick(exercise.tissues.tissues.size())];
  ExerciseTool& tool = exercise.tools[pick(exercise.tools.size())];
  ExerciseArm& arm = exercise.arms[pick(exercise.arms.size())];
  switch (random() % 12) {
    case 0:
      tissue.damping_Ns_per_m = {20.0 * share(), "asked"};
      break;
    case 1:
      tissue.rupture_N = SourcedNumber{share(), "asked"};
      break;
    case 2:
      tissue.colour = Vec3(share(), share(), share());
      break;
    case 3:
      exercise.tissues = withThreshold(exercise.tissues, pick(exercise.tissues.tissues.size()),
                                       random() % 2 ? RangeEnd::low : RangeEnd::high,
                                       int(random() % 4000) - 1000, random() % 2, exercise.tissues);
      break;
    case 4:
      if (const auto more = withNewTissue(exercise.tissues))
        exercise = withTissues(exercise, *more).exercise;
      break;
    case 5:
      if (const auto less =
              withoutTissue(exercise.tissues, pick(exercise.tissues.tissues.size()))) {
        exercise = withTissues(exercise, *less).exercise;
      }
      break;
    case 6:
      tool.tool.made_from.points = 1 + int(random() % 64);
      break;
    case 7:
      tool.tool.made_from.length_mm = 10.0 + 30.0 * share();
      break;
    case 8:
      arm.map.offset_mm = Vec3(20.0 * share(), 20.0 * share(), 20.0 * share());
      break;
    case 9:
      arm.map.motion_scale = 0.5 + share();
      break;
    case 10:
      arm.max_force_N = 0.5 + 2.0 * share();
      break;
    case 11:
      arm.tool = exercise.tools[pick(exercise.tools.size())].id;
      arm.other_tools.clear();
      break;
  }
  return exercise;
}

TEST_F(EditsTest, TwoHundredAtRandomAreTakenBackAndDoneAgain) {
  const Exercise before = exercise();
  std::mt19937 random(20);
  int done = 0;
  for (int n = 0; n < 200; ++n) {
    const Status edited = workstation_.edit(randomlyEdited(exercise(), random), "edit");
    workstation_.closeEdit();
    done += edited.ok();
  }
  EXPECT_GT(done, 150);
  EXPECT_FALSE(failed_) << failed_->sentence();
  const Exercise after = exercise();
  EXPECT_FALSE(before == after);
  int back = 0;
  for (; workstation_.edits().canUndo(); ++back) workstation_.undoEdit();
  EXPECT_TRUE(exercise() == before);
  EXPECT_GT(back, 140);
  for (; workstation_.edits().canRedo(); --back) workstation_.redoEdit();
  EXPECT_EQ(back, 0);
  EXPECT_TRUE(exercise() == after);
  EXPECT_TRUE(waitFor([this] { return !workstation_.isOpening(); }));
  EXPECT_TRUE(exercise() == after) << "placed in the case";
}

TEST_F(EditsTest, WhatIsNotPossibleIsRefusedInWordsAndChangesNothing) {
  const Exercise before = exercise();
  Exercise wrong = before;
  wrong.arms[0].map.force_scale = 1000.0;
  const Status refused = workstation_.edit(wrong, "arm");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().where.find("force_scale"), std::string::npos)
      << refused.error().sentence();
  EXPECT_TRUE(exercise() == before);
  EXPECT_FALSE(workstation_.edits().canUndo());
}

TEST_F(EditsTest, StayOnAnotherCaseAndOnOtherStructuresAndAreToldFromWhatWasOpened) {
  EXPECT_FALSE(workstation_.exerciseEdited());
  Exercise edited = exercise();
  edited.arms[0].map.motion_scale = 0.75;
  ASSERT_TRUE(workstation_.edit(edited, "arm").ok());
  EXPECT_TRUE(workstation_.exerciseEdited());
  ASSERT_TRUE(workstation_.useStructures(nullptr));
  ASSERT_TRUE(wait());
  EXPECT_EQ(exercise().arms[0].map.motion_scale, 0.75);
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  EXPECT_EQ(exercise().arms[0].map.motion_scale, 0.75);
  EXPECT_TRUE(workstation_.exerciseEdited());
  workstation_.undoEdit();
  EXPECT_NE(exercise().arms[0].map.motion_scale, 0.75);
  EXPECT_FALSE(workstation_.exerciseEdited());
}

TEST_F(EditsTest, AnEntryPointIsOneStepAndGoesWithAnotherCase) {
  const Landmark* own = &exercise().landmarks[0];
  Landmark place = *own;
  place.is_place = true;
  place.at_mm = workstation_.placed()->landmarks[0].frame.position_mm + Vec3(0.0, 5.0, 0.0);
  ASSERT_TRUE(workstation_.placeEntry(place));
  EXPECT_TRUE(workstation_.exerciseEdited()) << "it would be lost with the case, unsaid";
  ASSERT_TRUE(wait());
  ASSERT_TRUE(workstation_.entry());
  EXPECT_EQ(workstation_.edits().undoWhat(), "entry");
  workstation_.undoEdit();
  ASSERT_TRUE(wait());
  EXPECT_FALSE(workstation_.entry());
  workstation_.redoEdit();
  ASSERT_TRUE(wait());
  EXPECT_TRUE(workstation_.entry());
  workstation_.openImported(caseOf(std::make_shared<const Volume>(ball())));
  ASSERT_TRUE(wait());
  EXPECT_FALSE(workstation_.entry());
}

}  // namespace
}  // namespace trephine
