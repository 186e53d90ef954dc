// How structures look in 3-D, as the panel lists and asks for it.
#include <gtest/gtest.h>

#include <QDialog>
#include <QSignalSpy>
#include <QTreeWidget>
#include <QtTest>

#include "qt_support.h"
#include "ui/structures/structure_panel.h"

namespace trephine {
namespace {

class StructureLooksTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { test::application(); }

  // Structures of one voxel each.
  void show(int count) {
    auto volume = std::make_shared<Volume>();
    volume->geometry.size = {10, 10, 10};
    volume->hu.assign(1000, 50);
    auto map = std::make_shared<LabelMap>(
        LabelMap{volume->geometry, std::vector<std::uint8_t>(volume->hu.size())});
    for (int n = 1; n <= count; ++n) {
      map->labels[std::size_t(n)] = std::uint8_t(n);
      map->structures.push_back({n, "number " + std::to_string(n), labelColour(n)});
    }
    editor_.setCase(volume, map);
    showLooks();
  }
  void showLooks() {
    panel_.list().showLooks(withStructures({}, {}, editor_.map()->structures, chosen_).structures);
  }
  QTreeWidget* list() { return panel_.findChild<QTreeWidget*>("structureList"); }
  QString look(int row) { return list()->topLevelItem(row)->text(2); }
  QLabel* noRoom() { return panel_.findChild<QLabel*>("structureNoRoom"); }

  StructureEditor editor_;
  StructurePanel panel_{editor_};
  StructureLooks chosen_;
};

TEST_F(StructureLooksTest, EachIsListedWithItsLook) {
  chosen_[2].look = TissueLook::ghosted;
  chosen_[3].look = TissueLook::hidden;
  show(3);
  EXPECT_EQ(look(0), "shown");
  EXPECT_EQ(look(1), "ghost");
  EXPECT_EQ(look(2), "hidden");
  EXPECT_TRUE(noRoom()->isHidden());
}

TEST_F(StructureLooksTest, WhatHasNoRoomIsSaidInWordsUntilOthersAreHidden) {
  show(kMaxTissues + 1);
  EXPECT_EQ(look(kMaxTissues), "no room");
  EXPECT_FALSE(noRoom()->isHidden());
  EXPECT_TRUE(noRoom()->text().contains("number 17")) << noRoom()->text().toStdString();
  chosen_[4].look = TissueLook::hidden;
  showLooks();
  EXPECT_EQ(look(kMaxTissues), "shown");
  EXPECT_EQ(look(3), "hidden") << "which is no matter of room, and can be taken back";
  EXPECT_TRUE(noRoom()->isHidden());
}

TEST_F(StructureLooksTest, AClickOnTheColourOfOneAsksForAnother) {
  show(2);
  auto* list = panel_.findChild<QTreeWidget*>("structureList");
  const QRect row = list->visualItemRect(list->topLevelItem(1));
  const auto click = [&](int x) {
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {},
                      QPoint(row.left() + x, row.center().y()));
    auto* dialog = panel_.findChild<QDialog*>("structureColour");
    const bool asked = dialog != nullptr;
    delete dialog;
    return asked;
  };
  EXPECT_FALSE(click(60)) << "on its name";
  EXPECT_TRUE(click(8));
}

TEST_F(StructureLooksTest, AClickUnderIn3dAndTheChoiceBelowAskForAnotherLook) {
  show(2);
  QSignalSpy wanted(&panel_.list(), &StructureList::lookWanted);
  emit list()->itemClicked(list()->topLevelItem(1), 2);
  ASSERT_EQ(wanted.count(), 1);
  EXPECT_EQ(wanted[0][0].toInt(), 2);
  EXPECT_EQ(wanted[0][1].value<TissueLook>(), TissueLook::ghosted);
  panel_.list().nextLook();  // the first is the chosen one
  EXPECT_EQ(wanted[1][0].toInt(), 1);
  QSignalSpy opacity(&panel_.list(), &StructureList::opacityWanted);
  panel_.findChild<QSlider*>("structureOpacity")->setValue(50);
  ASSERT_EQ(opacity.count(), 1);
  EXPECT_NEAR(opacity[0][1].toDouble(), 0.25, 1e-9);
}

TEST_F(StructureLooksTest, ANewStructureTakesTheColourOfTheTissueOfItsName) {
  show(1);
  TissueSet set;
  set.tissues.emplace_back();
  set.tissues[0].id = "liver";
  set.tissues[0].colour = Vec3(0.55, 0.2, 0.16);
  editor_.setTissues(set);
  editor_.setCurrent(0);
  const Vec3 at = editor_.map()->geometry.centre_mm();
  editor_.beginStroke(at, Brush(), "liver");
  editor_.endStroke();
  ASSERT_TRUE(editor_.map()->find("liver"));
  EXPECT_EQ(editor_.map()->find("liver")->colour, set.tissues[0].colour);
  editor_.setCurrent(0);
  editor_.beginStroke(at, Brush(), "another");
  editor_.endStroke();
  const Structure* another = editor_.map()->find("another");
  ASSERT_TRUE(another);
  EXPECT_EQ(another->colour, labelColour(another->label));
}

}  // namespace
}  // namespace trephine
