#include "ui/common/field_editor.h"

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>

#include "qt_support.h"
#include "ui/common/field_rows.h"

namespace trephine {
namespace {

enum class Shape { ball, rod };
constexpr std::array<std::pair<std::string_view, Shape>, 2> kShapes{
    {{"ball", Shape::ball}, {"rod", Shape::rod}}};

struct Thing {
  std::string id = "one";
  double length_mm = 2.5;
  Vec3 towards{0, 0, 1};
  bool closed = true;
  std::vector<std::string> steps{"first", "then"};
  std::string landmark = "vault";
  std::vector<std::string> tools{"burr"};
  Shape shape = Shape::rod;
  std::vector<Shape> shapes{Shape::rod};
  double rod_mm = 7.0;
};
constexpr FieldOf<Thing> kFields[] = {
    {{"id", {1, 20}, Given::always, "shown"}, &Thing::id},
    {{"length_mm", {0, 10, "mm"}, Given::may_be, "how long"}, &Thing::length_mm},
    {{"towards", {-1, 1}, Given::may_be, "which way"}, DirectionIn<Thing>{&Thing::towards}},
    {{"closed", {}, Given::may_be, "whether"}, &Thing::closed},
    {{"steps", {1, 9}, Given::may_be, "in order"}, &Thing::steps},
    {{"landmark", {}, Given::may_be, "of it"}, ReferenceIn<Thing>{&Thing::landmark}},
    {{"tools", {}, Given::may_be, "with it"}, ReferencesIn<Thing>{&Thing::tools}},
    {{"shape", {}, Given::may_be, "of it"}, oneOf<&Thing::shape, kShapes>()},
    {{"shapes", {}, Given::may_be, "also"}, someOf<&Thing::shapes, kShapes>()},
    {{"rod_mm", {0, 10, "mm"}, Given::always, "of a rod"},
     &Thing::rod_mm,
     {"rod", [](const Thing& of) { return of.shape == Shape::rod; }}},
};

// A form of a thing, which takes what a person wants unless it refuses.
class FieldRowsTest : public ::testing::Test {
 protected:
  FieldRowsTest() : form_(&panel_), rows_(kFields, form_, &panel_, "thing:") {
    rows_["landmark"].offer({{"Vault", "vault"}, {"Ear", "ear"}});
    rows_["tools"].offer({{"Burr", "burr"}, {"Blade", "blade"}});
    rows_.entered = [this](const Thing& wanted, const char* key) {
      key_ = key;
      ++entered_;
      if (refuses_) return;
      thing_ = wanted;
      rows_.show(thing_);
    };
    rows_.show(thing_);
    panel_.show();
  }
  template <class Editor>
  Editor& find(const char* name) {
    auto* found = panel_.findChild<Editor*>(name);
    EXPECT_TRUE(found) << name;
    return *found;
  }

  QApplication& application_ = test::application();
  QWidget panel_;
  QFormLayout form_;
  FieldRows<Thing> rows_;
  Thing thing_;
  std::string key_;
  int entered_ = 0;
  bool refuses_ = false;
};

TEST_F(FieldRowsTest, ShowingAThingIsNoEntry) {
  thing_ = {"two", 4.0, {1, 0, 0}, false, {"only"}, "ear", {"blade"}, Shape::ball, {}, 1.0};
  rows_.show(thing_);
  EXPECT_EQ(entered_, 0);
  EXPECT_EQ(find<QLineEdit>("thing:id").text(), "two");
  EXPECT_EQ(find<QDoubleSpinBox>("thing:length_mm").value(), 4.0);
  EXPECT_EQ(find<QDoubleSpinBox>("thing:towardsX").value(), 1.0);
  EXPECT_FALSE(find<QCheckBox>("thing:closed").isChecked());
  EXPECT_EQ(find<QPlainTextEdit>("thing:steps").toPlainText(), "only");
  EXPECT_EQ(find<QComboBox>("thing:landmark").currentText(), "Ear");
  EXPECT_EQ(find<QListWidget>("thing:tools").item(1)->checkState(), Qt::Checked);
  EXPECT_EQ(find<QComboBox>("thing:shape").currentText(), "Ball");
  EXPECT_FALSE(find<QCheckBox>("thing:shapes:rod").isChecked());
}

TEST_F(FieldRowsTest, WhatAPersonEntersIsToldWithItsKey) {
  find<QDoubleSpinBox>("thing:length_mm").setValue(3.0);
  EXPECT_EQ(key_, "length_mm");
  EXPECT_EQ(thing_.length_mm, 3.0);
  find<QDoubleSpinBox>("thing:towardsX").setValue(1.0);
  EXPECT_NEAR(glm::length(thing_.towards), 1.0, 1e-12) << "a direction is a unit vector";
  find<QCheckBox>("thing:closed").click();
  EXPECT_FALSE(thing_.closed);
  QListWidget& tools = find<QListWidget>("thing:tools");
  tools.item(1)->setCheckState(Qt::Checked);
  EXPECT_EQ(thing_.tools, (std::vector<std::string>{"burr", "blade"}));
  find<QCheckBox>("thing:shapes:ball").click();
  EXPECT_EQ(thing_.shapes, (std::vector<Shape>{Shape::ball, Shape::rod}));
  QLineEdit& id = find<QLineEdit>("thing:id");
  id.setText("another");
  emit id.editingFinished();
  EXPECT_EQ(thing_.id, "another");
}

TEST_F(FieldRowsTest, AnEmptyNameIsGivenUp) {
  QLineEdit& id = find<QLineEdit>("thing:id");
  id.setText("  ");
  emit id.editingFinished();
  EXPECT_EQ(entered_, 0);
  EXPECT_EQ(id.text(), "one");
}

TEST_F(FieldRowsTest, WhatIsRefusedIsShownAsItIsAgain) {
  refuses_ = true;
  find<QCheckBox>("thing:closed").click();
  EXPECT_TRUE(find<QCheckBox>("thing:closed").isChecked());
  find<QDoubleSpinBox>("thing:length_mm").setValue(3.0);
  EXPECT_EQ(find<QDoubleSpinBox>("thing:length_mm").value(), 2.5);
  QLineEdit& id = find<QLineEdit>("thing:id");
  id.setText("taken");
  emit id.editingFinished();
  EXPECT_EQ(id.text(), "taken") << "a text stays, to be mended";
  EXPECT_EQ(entered_, 3);
}

TEST_F(FieldRowsTest, AFieldThatTheThingDoesNotHaveIsNotShown) {
  QWidget& rod = find<QDoubleSpinBox>("thing:rod_mm");
  EXPECT_TRUE(rod.isVisible());
  QComboBox& shape = find<QComboBox>("thing:shape");
  shape.setCurrentIndex(0);
  emit shape.activated(0);
  EXPECT_EQ(thing_.shape, Shape::ball);
  EXPECT_FALSE(rod.isVisible());
  rows_.setVisible(false);
  EXPECT_FALSE(find<QLineEdit>("thing:id").isVisible());
  rows_.setVisible(true);
  EXPECT_TRUE(find<QLineEdit>("thing:id").isVisible());
  EXPECT_FALSE(rod.isVisible());
}

TEST_F(FieldRowsTest, ANameThatIsNotOfferedStaysToBeSeen) {
  thing_.landmark = "gone";
  thing_.tools = {"lost", "burr"};
  rows_.show(thing_);
  EXPECT_EQ(find<QComboBox>("thing:landmark").currentText(), "gone");
  QListWidget& tools = find<QListWidget>("thing:tools");
  ASSERT_EQ(tools.count(), 3);
  EXPECT_EQ(tools.item(0)->text(), "lost");
  EXPECT_EQ(tools.item(0)->checkState(), Qt::Checked);
}

TEST_F(FieldRowsTest, WhatIsBeingTypedStaysUnlessTheThingIsAnother) {
  QLineEdit& id = find<QLineEdit>("thing:id");
  id.setText("half typed");
  id.setModified(true);
  rows_.takeTyped();
  EXPECT_EQ(thing_.id, "half typed");
  id.setText("more");
  id.setModified(true);
  Thing other;
  other.id = "other";
  rows_.show(other, false);
  EXPECT_EQ(id.text(), "other");
}

TEST_F(FieldRowsTest, ChoicesAreDescribedInWords) {
  rows_["shape"].describe([](const std::string& shape) {
    return FieldEditor::ChoiceText{"A " + QString::fromStdString(shape), "It turns.", "2 us"};
  });
  EXPECT_EQ(find<QComboBox>("thing:shape").currentText(), "A rod");
  EXPECT_EQ(find<QLabel>("thing:shape:note").text(), "2 us");
  rows_["shapes"].describe([](const std::string& shape) {
    return FieldEditor::ChoiceText{"A " + QString::fromStdString(shape), {}, "3 us"};
  });
  EXPECT_EQ(find<QCheckBox>("thing:shapes:ball").text(), "A ball");
  EXPECT_EQ(find<QLabel>("thing:shapes:ball:note").text(), "3 us");
}

}  // namespace
}  // namespace trephine
