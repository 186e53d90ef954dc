// Structures while they are made, without a window: the editor alone.
#include "ui/structures/structure_editor.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QSignalSpy>

#include "qt_support.h"
#include "ui/common/words.h"
#include "ui/structures/structure_shaping.h"

namespace trephine {
namespace {

// Liver of 50 HU, a ball of 25 mm in fat.
std::shared_ptr<const Volume> ballOfLiver() {
  auto volume = std::make_shared<Volume>();
  volume->geometry.size = {60, 60, 60};
  volume->geometry.spacing_mm = Vec3(1.5);
  volume->hu.assign(volume->geometry.voxelCount(), -100);
  for (std::size_t v = 0; v < volume->hu.size(); ++v) {
    const Index3 at = volume->geometry.indicesOf(v);
    const Vec3 mm = volume->geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
    if (glm::length(mm - volume->geometry.centre_mm()) < 25.0) volume->hu[v] = 50;
  }
  return volume;
}

class Editor : public testing::Test {
 protected:
  static void SetUpTestSuite() { test::application(); }
  Editor() : volume_(ballOfLiver()), middle_(volume_->geometry.centre_mm()) {
    editor_.setCase(volume_, nullptr);
    QObject::connect(&editor_, &StructureEditor::said, [this](const QString& w) { said_ = w; });
    QObject::connect(&editor_, &StructureEditor::failed,
                     [this](const Error& e) { failed_ = e.code.str(); });
  }
  void wait() {
    EXPECT_TRUE(test::waitFor([this] { return !editor_.busy(); }));
  }
  double ml(const char* name) {
    const Structure* of = editor_.map()->find(name);
    return of ? editor_.millilitres(of->label) : -1.0;
  }
  void stroke(const Vec3& from, const Vec3& to, bool erase = false) {
    Brush brush;
    brush.radius_mm = 5.0;
    brush.erase = erase;
    editor_.beginStroke(from, brush, "made");
    editor_.moveStroke(to);
    editor_.endStroke();
  }

  std::shared_ptr<const Volume> volume_;
  Vec3 middle_;
  StructureEditor editor_;
  QString said_;
  std::string failed_;
};

constexpr double kBall_ml = 65.4;

TEST_F(Editor, WhatWasGrownCountsOnceItIsTaken) {
  editor_.growAt(middle_, "liver");
  EXPECT_TRUE(editor_.busy());
  wait();
  ASSERT_TRUE(editor_.preview()) << failed_;
  EXPECT_NEAR(ml("liver"), kBall_ml, 2.0);
  EXPECT_FALSE(editor_.edited());
  EXPECT_EQ(editor_.takeEdited(), nullptr);
  editor_.leavePreview();
  EXPECT_EQ(ml("liver"), -1.0);
  EXPECT_TRUE(editor_.map()->structures.empty());
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  EXPECT_TRUE(editor_.edited());
  const auto made = editor_.takeEdited();
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->find("liver"));
  EXPECT_EQ(editor_.takeEdited(), nullptr) << "it was taken";
  EXPECT_TRUE(editor_.edited()) << "but not saved";
}

TEST_F(Editor, EveryStepIsUndoneAndDoneAgain) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  const auto grown = editor_.map()->labels;
  stroke(middle_, middle_ + Vec3(10, 0, 0), true);
  const auto erased = editor_.map()->labels;
  EXPECT_NE(grown, erased);
  fillHoles(editor_);
  wait();
  const auto filled = editor_.map()->labels;
  EXPECT_EQ(filled, grown);
  editor_.undo();
  EXPECT_EQ(editor_.map()->labels, erased);
  editor_.undo();
  EXPECT_EQ(editor_.map()->labels, grown);
  editor_.undo();
  EXPECT_EQ(ml("liver"), 0.0);
  EXPECT_FALSE(editor_.undoText());
  for (int n = 0; n < 3; ++n) editor_.redo();
  EXPECT_EQ(editor_.map()->labels, filled);
  EXPECT_NEAR(ml("liver"), kBall_ml, 2.0);
  EXPECT_FALSE(editor_.redoText());
}

TEST_F(Editor, AStrokeIsOneStepHoweverManyPieces) {
  Brush brush;
  editor_.beginStroke(middle_, brush, "made");
  for (int n = 0; n < 20; ++n) editor_.moveStroke(middle_ + Vec3(n, 0, 0));
  editor_.endStroke();
  EXPECT_GT(ml("made"), 1.0);
  editor_.undo();
  EXPECT_EQ(ml("made"), 0.0);
}

TEST_F(Editor, AShellOfTheChosenOneIsAStructureOfItsOwn) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  const double before = ml("liver");
  makeShell(editor_, 1.0, "capsule");
  wait();
  EXPECT_GT(ml("capsule"), 3.0);
  EXPECT_NEAR(ml("capsule") + ml("liver"), before, 1e-6);
}

TEST_F(Editor, ALayerThatIsDeletedGoesBackToWhatItWasOf) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  const double before = ml("liver");
  makeShell(editor_, 2.0, "capsule");
  wait();
  EXPECT_LT(ml("liver"), before - 3.0);
  EXPECT_TRUE(said_.contains("keeps")) << said_.toStdString();
  editor_.remove(editor_.map()->find("capsule")->label);
  EXPECT_NEAR(ml("liver"), before, 1e-6);
  EXPECT_EQ(ml("capsule"), 0.0);
  editor_.undo();
  EXPECT_NEAR(ml("liver") + ml("capsule"), before, 1e-6);
  EXPECT_GT(ml("capsule"), 3.0);
}

TEST_F(Editor, ANameAndAColourAreStepsThatAreUndone) {
  stroke(middle_, middle_);
  const int label = editor_.current();
  const Vec3 colour = editor_.map()->find(label)->colour;
  ASSERT_TRUE(editor_.rename(label, "liver").ok());
  ASSERT_TRUE(editor_.setColour(label, Vec3(0.0, 1.0, 0.0)));
  EXPECT_EQ(editor_.undoText(), QString("Colour"));
  editor_.undo();
  EXPECT_EQ(editor_.map()->find(label)->colour, colour);
  editor_.undo();
  EXPECT_EQ(editor_.map()->find(label)->name, "made");
  EXPECT_GT(ml("made"), 0.0) << "what was painted is a step of its own";
  editor_.redo();
  EXPECT_EQ(editor_.map()->find(label)->name, "liver");
}

TEST_F(Editor, APreviewCannotBeTakenOnceAnExerciseRuns) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.setLocked("An exercise runs.");
  editor_.takePreview();
  EXPECT_TRUE(editor_.preview());
  EXPECT_EQ(said_, "An exercise runs.");
  editor_.setLocked({});
  editor_.leavePreview();
  editor_.growAt(middle_, "liver");  // and what is on its way when it begins is dropped
  editor_.setLocked("An exercise runs.");
  wait();
  EXPECT_FALSE(editor_.preview());
}

TEST_F(Editor, AStrokeThatChangesNothingSaysWhy) {
  stroke(middle_, middle_);
  EXPECT_EQ(said_, "");
  stroke(middle_, middle_);
  EXPECT_TRUE(said_.contains("Nothing changed there")) << said_.toStdString();
}

TEST_F(Editor, AStrokeOfAStructureThatIsDeletedMeanwhileEnds) {
  stroke(middle_, middle_);
  Brush brush;
  brush.radius_mm = 3.0;
  const int made = editor_.current();
  editor_.beginStroke(middle_, brush, "liver");
  editor_.remove(made);
  editor_.endStroke();
  EXPECT_NE(editor_.current(), made);
  EXPECT_EQ(editor_.millilitres(made), 0.0);
}

TEST_F(Editor, AWallOverWhatCountsAlreadySaysWhatToDo) {
  stroke(middle_, middle_);
  Brush brush;
  brush.radius_mm = 5.0;
  editor_.beginWall(middle_, brush);
  editor_.endStroke();
  EXPECT_TRUE(said_.contains("made")) << said_.toStdString();
}

TEST_F(Editor, WhileItIsLockedNothingChangesAndItSaysWhy) {
  stroke(middle_, middle_);
  const auto before = editor_.map()->labels;
  editor_.setLocked("An exercise runs.");
  stroke(middle_ + Vec3(10, 0, 0), middle_ + Vec3(20, 0, 0));
  editor_.undo();
  editor_.remove(editor_.current());
  editor_.growAt(middle_, "liver");
  EXPECT_FALSE(editor_.busy());
  EXPECT_EQ(editor_.map()->labels, before);
  EXPECT_EQ(said_, "An exercise runs.");
}

TEST_F(Editor, NamesAreItsOwnAndWhatIsDeletedComesBack) {
  stroke(middle_, middle_);
  const int first = editor_.current();
  EXPECT_TRUE(editor_.rename(first, " Leber \u809d ").ok());
  EXPECT_EQ(editor_.map()->find(first)->name, "Leber \xe8\x82\x9d");
  editor_.setCurrent(0);
  stroke(middle_ + Vec3(20, 0, 0), middle_ + Vec3(20, 0, 0));
  EXPECT_EQ(
      editor_.rename(editor_.current(), QString::fromUtf8("leber \xe8\x82\x9d")).error().code.str(),
      "BAD_NAME");
  EXPECT_EQ(editor_.rename(editor_.current(), "  ").error().code.str(), "BAD_NAME");
  const double before = editor_.millilitres(first);
  editor_.remove(first);
  EXPECT_EQ(editor_.millilitres(first), 0.0);
  editor_.undo();
  EXPECT_NEAR(editor_.millilitres(first), before, 1e-9);
}

TEST_F(Editor, AnInterruptedGrowLosesNothing) {
  stroke(middle_, middle_);
  const auto before = editor_.map()->labels;
  editor_.growAt(middle_, "liver");
  editor_.cancel();
  wait();
  EXPECT_EQ(editor_.map()->labels, before);
  EXPECT_FALSE(editor_.preview());
  EXPECT_TRUE(failed_.empty());
  editor_.growAt(middle_ + Vec3(1000, 0, 0), "liver");
  EXPECT_NE(said_.indexOf("inside the scan"), -1);
  EXPECT_EQ(editor_.map()->labels, before);
}

TEST_F(Editor, AWallHoldsGrowingBackAndIsInNoExerciseAndNoFile) {
  Brush brush;
  brush.radius_mm = 30.0;
  brush.shape = Brush::Shape::disc;
  brush.across = 0;
  editor_.beginWall(middle_, brush);
  editor_.endStroke();
  ASSERT_GT(ml("wall"), 0.0);
  EXPECT_EQ(editor_.current(), 0);  // a help, not what one works on
  editor_.growAt(middle_ + Vec3(10, 0, 0), "liver");
  wait();
  ASSERT_TRUE(editor_.preview()) << failed_ << said_.toStdString();
  EXPECT_NEAR(ml("liver"), kBall_ml / 2.0, 0.1 * kBall_ml);
  editor_.takePreview();
  const auto made = editor_.takeEdited();
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->find("liver"));
  EXPECT_FALSE(made->find("wall"));
  const int wall = editor_.map()->find("wall")->label;
  EXPECT_EQ(std::count(made->labels.begin(), made->labels.end(), wall), 0);
  EXPECT_FALSE(editor_.finished()->find("wall"));
  // Its voxels can be taken back as any stroke.
  editor_.undo();
  editor_.undo();
  EXPECT_EQ(ml("wall"), 0.0);
}

TEST_F(Editor, AWallThroughAPreviewGrowsItAnew) {
  editor_.growAt(middle_ + Vec3(10, 0, 0), "liver");
  wait();
  ASSERT_NEAR(ml("liver"), kBall_ml, 2.0);
  Brush brush;
  brush.radius_mm = 30.0;
  brush.shape = Brush::Shape::disc;
  brush.across = 0;
  editor_.beginWall(middle_, brush);
  EXPECT_FALSE(editor_.preview());
  editor_.endStroke();
  wait();
  ASSERT_TRUE(editor_.preview());
  EXPECT_NEAR(ml("liver"), kBall_ml / 2.0, 0.1 * kBall_ml);
}

TEST_F(Editor, GrowsInsideOfABoxThatIsDrawnAndAnewWhereItChanges) {
  editor_.limitTo(middle_ + Vec3(-60, -60, 0), middle_ + Vec3(0.7, 60, 0), 2);
  ASSERT_TRUE(editor_.box());
  EXPECT_NEAR(editor_.boxSize_mm()->z, 90.0, 1e-9);
  editor_.growAt(middle_ + Vec3(20, 0, 0), "liver");
  EXPECT_FALSE(editor_.busy());
  EXPECT_NE(said_.indexOf("inside the box"), -1);
  editor_.growAt(middle_ - Vec3(10, 0, 0), "liver");
  wait();
  ASSERT_TRUE(editor_.preview()) << failed_;
  EXPECT_NEAR(ml("liver"), kBall_ml / 2.0, 0.1 * kBall_ml);
  editor_.leaveBox();  // the preview is grown anew
  EXPECT_TRUE(editor_.busy());
  wait();
  ASSERT_TRUE(editor_.preview());
  EXPECT_NEAR(ml("liver"), kBall_ml, 2.0);
  EXPECT_EQ(editor_.map()->structures.size(), 1u);
}

TEST_F(Editor, AClickIntoWhatIsThereSaysSo) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  editor_.growAt(middle_, "second");
  EXPECT_FALSE(editor_.busy());
  EXPECT_NE(said_.indexOf("liver"), -1);
  EXPECT_EQ(ml("second"), -1.0);
}

TEST_F(Editor, WhatIsDeletedGivesItsNameAwayAndIsChosenNoMore) {
  stroke(middle_, middle_);
  const int first = editor_.current();
  editor_.setCurrent(0);
  stroke(middle_ + Vec3(20, 0, 0), middle_ + Vec3(20, 0, 0));
  const int second = editor_.current();
  editor_.remove(second);
  EXPECT_EQ(editor_.current(), first);
  EXPECT_TRUE(editor_.rename(first, toQt(editor_.map()->find(second)->name)).ok());
  editor_.undo();  // the name
  editor_.undo();  // what was deleted
  EXPECT_GT(editor_.millilitres(second), 0.0);
  EXPECT_NE(editor_.map()->find(first)->name, editor_.map()->find(second)->name);
}

TEST_F(Editor, ShapingAPreviewAloneSaysThatItIsGone) {
  editor_.growAt(middle_, "liver");
  wait();
  ASSERT_TRUE(editor_.preview());
  fillHoles(editor_);
  wait();
  EXPECT_FALSE(editor_.preview());
  EXPECT_NE(said_.indexOf("was not taken"), -1) << said_.toStdString();
  EXPECT_EQ(failed_, "");
}

TEST_F(Editor, WhatWasSaidOfOneStepGoesWithTheNext) {
  fillHoles(editor_);
  stroke(middle_, middle_);
  fillHoles(editor_);
  wait();
  EXPECT_NE(said_.indexOf("Nothing was changed"), -1);
  stroke(middle_ + Vec3(10, 0, 0), middle_ + Vec3(10, 0, 0));
  EXPECT_EQ(said_, "");
  makeShell(editor_, 0.5, "shell");
  wait();
  EXPECT_NE(said_.indexOf("one voxel thick"), -1) << said_.toStdString();
}

TEST_F(Editor, WhatRedoBringsBackHasItsNameAlthoughAPreviewOfThatNameWasLeft) {
  editor_.growAt(middle_, "liver");
  wait();
  editor_.takePreview();
  editor_.undo();
  editor_.growAt(middle_, "liver");
  wait();
  editor_.leavePreview();
  editor_.redo();
  EXPECT_NEAR(ml("liver"), kBall_ml, 2.0);
}

TEST_F(Editor, AStructureFromElsewhereThatIsCalledWallIsNoWall) {
  LabelMap given{volume_->geometry, std::vector<std::uint8_t>(volume_->geometry.voxelCount())};
  given.labels[0] = 3;
  given.structures = {{3, "wall", Vec3(1.0)}};
  editor_.setCase(volume_, std::make_shared<const LabelMap>(given));
  Brush brush;
  editor_.beginWall(middle_, brush);
  editor_.endStroke();
  EXPECT_EQ(editor_.map()->structures.size(), 2u);
  const auto finished = editor_.finished();
  ASSERT_TRUE(finished);
  ASSERT_EQ(finished->structures.size(), 1u);
  EXPECT_EQ(finished->structures[0].label, 3);
}

TEST_F(Editor, WhatChangedAfterItWasHandedOutIsStillUnsaved) {
  stroke(middle_, middle_);
  const std::uint64_t saved = editor_.version();
  stroke(middle_ + Vec3(20, 0, 0), middle_ + Vec3(20, 0, 0));
  editor_.markSaved(saved);
  EXPECT_TRUE(editor_.edited());
  editor_.markSaved(editor_.version());
  EXPECT_FALSE(editor_.edited());
  EXPECT_TRUE(editor_.takeEdited());
  editor_.giveBack();
  EXPECT_TRUE(editor_.takeEdited()) << "it could not be used, saved or not";
  stroke(middle_ + Vec3(-20, 0, 0), middle_ + Vec3(-20, 0, 0));
  EXPECT_TRUE(editor_.edited());
  editor_.undo();
  EXPECT_FALSE(editor_.edited()) << "they are again what was saved";
}

}  // namespace
}  // namespace trephine
