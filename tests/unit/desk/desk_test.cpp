// The desk without a window and without an event loop.
#include "desk/desk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "base/file.h"
#include "session/operator_script.h"
#include "shells.h"
#include "support.h"
#include "training/session_reader.h"
#include "volume/segmentation.h"

namespace {
int made_json = 0;
}

// The linker leads the desk's calls of checkEdited() through here: by that alone an edit becomes
// JSON.
namespace trephine {
Status realCheckEdited(const Exercise&) asm("__real__ZN8trephine11checkEditedERKNS_8ExerciseE");
Status wrappedCheckEdited(const Exercise& exercise) asm(
    "__wrap__ZN8trephine11checkEditedERKNS_8ExerciseE");
Status wrappedCheckEdited(const Exercise& exercise) {
  ++made_json;
  return realCheckEdited(exercise);
}

namespace {

class DeskTest : public ::testing::Test, private DeskEvents {
 protected:
  // Takes what comes until that is so. False: it did not come.
  bool until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < end) {
      {
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, std::chrono::milliseconds(10), [this] { return wake_; });
        wake_ = false;
      }
      desk_.take();
    }
    return condition();
  }
  bool untilOpened() {
    return until([this] { return !desk_.isOpening(); });
  }
  void openBone() {
    desk_.openImported(caseOf(std::make_shared<const Volume>(bone_)));
    ASSERT_TRUE(untilOpened());
  }
  // Until something is asked about a file in which the bone is a liver.
  void openABonyLiver() {
    ASSERT_NO_FATAL_FAILURE(openBone());
    ASSERT_TRUE(writeSegmentation(*structure("liver"), liver_).ok());
    desk_.useLabels(liver_);
    ASSERT_TRUE(untilOpened());
    EXPECT_FALSE(failed_) << failed_->sentence();
    ASSERT_EQ(questions_.size(), 1u);
  }
  std::shared_ptr<const LabelMap> structure(const std::string& name) const {
    LabelMap map{bone_.geometry, std::vector<std::uint8_t>(bone_.hu.size()), {}};
    for (std::size_t v = 0; v < map.labels.size(); ++v) map.labels[v] = bone_.hu[v] > 1000;
    map.structures = {{1, name, Vec3(0.5, 0.25, 0.25)}};
    return std::make_shared<const LabelMap>(std::move(map));
  }
  bool has(DeskChange change) const { return std::ranges::count(changes_, change) > 0; }

  test::TemporaryFolder folder_;
  const Volume bone_ = test::shells(60, 1.5, {{40, 1200}});
  const std::filesystem::path liver_ = folder_ / "liver.seg.nrrd";
  std::vector<DeskChange> changes_;
  std::vector<StructureQuestion> questions_;
  std::optional<RunReport> report_;
  std::optional<Error> failed_;

 private:
  void onChange(DeskChange change) override { changes_.push_back(change); }
  void onOpeningProgress(double, const std::string&) override {}
  void onSavingProgress(double, const std::string&) override {}
  void onExerciseOpening(const Exercise&, const std::filesystem::path&) override {}
  void onQuestion(const StructureQuestion& question) override { questions_.push_back(question); }
  void onRecordingFailed(const Error& error) override { failed_ = error; }
  void onSessionEnded(Session&) override {}
  void onReport(const RunReport& report) override { report_ = report; }
  void onSaved(const std::string&) override {}
  void onFailure(const Error& error) override { failed_ = error; }

  std::mutex mutex_;
  std::condition_variable woken_;
  bool wake_ = false;

 protected:
  Desk desk_{{},
             *this,
             [] { return ArmSettings(); },
             [this] {
               const std::lock_guard lock(mutex_);
               wake_ = true;
               woken_.notify_one();
             }};
};

TEST_F(DeskTest, OpensACaseEditsItsExercisePractisesItAndTellsWhatWasDone) {
  EXPECT_EQ(desk_.phase(), Desk::Phase::empty);
  desk_.openPhantom("cranium");
  EXPECT_TRUE(desk_.isOpening());
  ASSERT_TRUE(untilOpened());
  ASSERT_FALSE(failed_) << failed_->sentence();
  EXPECT_EQ(desk_.phase(), Desk::Phase::ready);
  EXPECT_TRUE(has(DeskChange::case_opened));
  EXPECT_FALSE(desk_.takeMirror().hu.empty()) << "for the view";
  EXPECT_FALSE(desk_.exerciseEdited());

  const double rate_hz = desk_.exercise()->rate_hz;
  ASSERT_TRUE(desk_.edit("rate", [&](Exercise& exercise) { exercise.rate_hz = 2.0 * rate_hz; }));
  EXPECT_TRUE(desk_.exerciseEdited());
  EXPECT_EQ(desk_.placed()->exercise.rate_hz, 2.0 * rate_hz) << "on the case at once";
  desk_.undoEdit();
  EXPECT_EQ(desk_.exercise()->rate_hz, rate_hz);
  EXPECT_FALSE(desk_.exerciseEdited());

  const auto script = readOperatorScript(desk_.exercise()->operator_file, *desk_.exercise());
  ASSERT_TRUE(script.ok()) << script.error().sentence();
  desk_.setStepped(true);
  desk_.start(folder_.path(), *script, 1e9);
  EXPECT_EQ(desk_.phase(), Desk::Phase::starting);
  ASSERT_TRUE(until([&] { return desk_.session() || failed_; }));
  ASSERT_FALSE(failed_) << failed_->sentence();
  EXPECT_FALSE(desk_.edit("rate", [](Exercise& exercise) { exercise.rate_hz = 500.0; }))
      << "not while it runs";
  desk_.session()->advance(1.5);
  desk_.stop();
  EXPECT_EQ(desk_.session(), nullptr) << "its end has begun";
  ASSERT_TRUE(until([&] { return desk_.phase() == Desk::Phase::ready; }));
  EXPECT_FALSE(failed_) << failed_->sentence();
  ASSERT_TRUE(report_);
  EXPECT_EQ(report_->done.ticks, std::uint64_t(1.5 * rate_hz));
  const auto recording = SessionReader::open(report_->recording);
  ASSERT_TRUE(recording.ok()) << recording.error().sentence();
  EXPECT_EQ((*recording)->tickCount(), report_->done.ticks);
}

TEST_F(DeskTest, WhatIsAskedAboutAFileIsAnsweredWithoutReadingItAgain) {
  ASSERT_NO_FATAL_FAILURE(openABonyLiver());
  EXPECT_EQ(questions_[0].asked.choice.code.str(), "HU_NOT_TISSUE");
  EXPECT_EQ(questions_[0].asked.choice.options, std::vector<std::string>{"keep"});
  EXPECT_EQ(desk_.placed()->labels, nullptr) << "not used yet";

  ASSERT_TRUE(std::filesystem::remove(liver_));
  desk_.answer("keep");
  ASSERT_TRUE(untilOpened());
  EXPECT_FALSE(failed_) << failed_->sentence();
  ASSERT_TRUE(desk_.placed()->labels);
  EXPECT_TRUE(desk_.placed()->labels->find("liver"));
  desk_.answer("keep");
  EXPECT_FALSE(desk_.isOpening()) << "nothing is asked any more";
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NOT_ASKED");
}

TEST_F(DeskTest, StructuresThatWereMadeMeanwhileLeaveTheQuestionAsItIs) {
  ASSERT_NO_FATAL_FAILURE(openABonyLiver());
  ASSERT_TRUE(desk_.useStructures(structure("skull")));
  ASSERT_TRUE(untilOpened());
  ASSERT_TRUE(desk_.placed()->labels);
  desk_.answer("keep");
  ASSERT_TRUE(untilOpened());
  EXPECT_FALSE(failed_) << failed_->sentence();
  EXPECT_TRUE(desk_.placed()->labels->find("liver"));
}

TEST_F(DeskTest, AnAnswerAboutAnotherCaseIsRefusedInWords) {
  ASSERT_NO_FATAL_FAILURE(openABonyLiver());
  ASSERT_NO_FATAL_FAILURE(openBone());
  desk_.answer("keep");
  EXPECT_FALSE(desk_.isOpening());
  EXPECT_EQ(desk_.placed()->labels, nullptr);
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "NOT_ASKED");
}

TEST_F(DeskTest, TwoThingsAreNotOpenedAtOnce) {
  desk_.openPhantom("cranium");
  desk_.openPhantom("abdomen");
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "BUSY");
  failed_.reset();
  desk_.cancelOpening();
  ASSERT_TRUE(untilOpened());
  EXPECT_FALSE(failed_) << "who cancels is not told of it";
  EXPECT_EQ(desk_.phase(), Desk::Phase::empty);
}

TEST_F(DeskTest, ADraggedThresholdMakesNoJson) {
  ASSERT_NO_FATAL_FAILURE(openBone());
  made_json = 0;
  for (int step = 1; step <= 60; ++step) {
    TissueSet moved = desk_.tissues();
    moved.tissues.back().hu_min += 1.0;
    desk_.setTissues(moved, "threshold:bone");
  }
  EXPECT_FALSE(failed_) << failed_->sentence();
  EXPECT_EQ(made_json, 0);
  ASSERT_TRUE(desk_.edit("name", [](Exercise& exercise) { exercise.name = "another"; }));
  EXPECT_EQ(made_json, 1) << "what is typed is checked as a file is";
}

// An exercise that keeps its tissues, on the bone.
class KeptDeskTest : public DeskTest {
 protected:
  void open() {
    Exercise kept = readExercise(defaultExercise("cranium")).value();
    kept.case_source.clear();
    kept.locks = {Lock::tissues};
    ASSERT_TRUE(writeTextFile(file_, toJson(kept).dump()).ok());
    ASSERT_NO_FATAL_FAILURE(openBone());
    desk_.useExercise(file_);
    ASSERT_TRUE(untilOpened());
    ASSERT_FALSE(failed_) << failed_->sentence();
    ASSERT_EQ(desk_.exercise()->locks, (Locks{Lock::tissues}));
  }
  Status soften() {
    return desk_.edit("tissues",
                      [](Exercise& exercise) { exercise.tissues.tissues.back().hu_max -= 7; });
  }
  const std::filesystem::path file_ = folder_ / "kept.json";
};

TEST_F(KeptDeskTest, WhatIsPractisedStaysKeptWhereverOneLooksUntilItHasEnded) {
  ASSERT_NO_FATAL_FAILURE(open());
  desk_.setStepped(true);
  desk_.start(folder_.path(), {}, 1e9);
  ASSERT_TRUE(until([&] { return desk_.session() || failed_; }));
  ASSERT_FALSE(failed_) << failed_->sentence();
  desk_.setPractising(false);
  EXPECT_EQ(soften().error().code.str(), "LOCKED");
  EXPECT_TRUE(desk_.isLocked(Lock::tissues));
  changes_.clear();
  desk_.stop();
  ASSERT_TRUE(until([&] { return desk_.phase() == Desk::Phase::ready; }));
  EXPECT_TRUE(has(DeskChange::locks)) << "what shows them has to know";
  EXPECT_TRUE(soften().ok());
}

TEST_F(KeptDeskTest, ACopyOfItsTissuesInAFileMakesThemNoneOfItsOwn) {
  ASSERT_NO_FATAL_FAILURE(open());
  desk_.setPractising(false);
  ASSERT_TRUE(soften().ok());
  bool saved = false;
  desk_.saveTissues(folder_ / "copy.json", "saved", [&] { saved = true; });
  ASSERT_TRUE(until([&] { return saved || failed_; }));
  ASSERT_FALSE(failed_) << failed_->sentence();
  EXPECT_FALSE(desk_.tissuesEdited()) << "a file has them";
  EXPECT_TRUE(desk_.tissuesUnlikeExercise());
  desk_.setPractising(true);
  desk_.start(folder_.path(), {}, 1e9);
  ASSERT_TRUE(failed_);
  EXPECT_EQ(failed_->code.str(), "LOCKED");
  EXPECT_EQ(desk_.phase(), Desk::Phase::ready);
}

TEST_F(DeskTest, TissuesThatACaseBringsMakeItsExerciseNoOtherAndEditsOfThemDo) {
  ASSERT_NO_FATAL_FAILURE(openBone());
  ASSERT_FALSE(desk_.tissuesUnlikeExercise());
  TissueSet own = desk_.tissues();
  own.tissues.back().damping_Ns_per_m.value += 3.0;
  desk_.openStored([&](const Progress&) {
    return Result<StoredCase>(StoredCase{caseOf(std::make_shared<const Volume>(bone_)), own});
  });
  ASSERT_TRUE(untilOpened());
  ASSERT_FALSE(failed_) << failed_->sentence();
  EXPECT_EQ(desk_.tissues(), own);
  EXPECT_FALSE(desk_.tissuesUnlikeExercise());
  EXPECT_FALSE(desk_.tissuesEdited());
  ASSERT_TRUE(desk_
                  .edit("tissues",
                        [](Exercise& exercise) {
                          exercise.tissues.tissues.back().damping_Ns_per_m.value += 1.0;
                        })
                  .ok());
  EXPECT_TRUE(desk_.tissuesUnlikeExercise());
}

TEST_F(DeskTest, StructuresAreOpenedWithoutAnotherCase) {
  ASSERT_NO_FATAL_FAILURE(openBone());
  desk_.openImported(caseOf(std::make_shared<const Volume>(bone_)));
  EXPECT_TRUE(desk_.opensAnotherCase());
  ASSERT_TRUE(untilOpened());
  ASSERT_TRUE(writeSegmentation(*structure("bone"), liver_).ok());
  desk_.useLabels(liver_);
  EXPECT_TRUE(desk_.isOpening());
  EXPECT_FALSE(desk_.opensAnotherCase());
  ASSERT_TRUE(untilOpened());
}

}  // namespace
}  // namespace trephine
