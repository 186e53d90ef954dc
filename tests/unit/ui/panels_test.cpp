#include <gtest/gtest.h>

#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>
#include <algorithm>
#include <vector>

#include "haptics/bounded_controller.h"
#include "qt_support.h"
#include "tissue/tissue_edits.h"
#include "ui/cases/cases_page.h"
#include "ui/common/colours.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/tissue/limit_bar.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/train/arms_panel.h"
#include "ui/train/hand_bar.h"
#include "ui/train/result_page.h"

namespace trephine {
namespace {

TissueSet twoTissues() {
  Tissue soft;
  soft.id = "soft";
  soft.name = "Soft tissue";
  soft.hu_max = 200;
  soft.hu_source = "a book";
  soft.colour = Vec3(0.8);
  soft.opacity = 0.1;
  soft.damping_Ns_per_m = soft.stiffness_N_per_m = {1.0, "a paper"};
  soft.friction_N = soft.stiffness_N_per_m;
  soft.cutting_J_per_mm3 = soft.stiffness_N_per_m;
  Tissue bone = soft;
  bone.id = "bone";
  bone.name = "Bone";
  bone.hu_min = 201;
  bone.hu_max = 3000;
  bone.opacity = 0.4237;
  return {"two", {soft, bone}};
}

class PanelTest : public ::testing::Test {
 protected:
  template <class Widget>
  static Widget& find(QWidget& panel, const char* name) {
    auto* widget = panel.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name;
    return *widget;
  }
  QApplication& application_ = test::application();
};

class TissuePanelTest : public PanelTest {
 protected:
  TissuePanelTest() {
    panel_.setTissues(twoTissues());
    panel_.select("bone");
    QObject::connect(&panel_, &TissuePanel::tissuesChanged, &panel_, [this](const TissueSet& set) {
      changed_ = set;
      ++changes_;
    });
  }
  TissuePanel panel_;
  TissueSet changed_;
  int changes_ = 0;
};

TEST_F(TissuePanelTest, ShowsANumberAndItsSource) {
  EXPECT_EQ(find<QSpinBox>(panel_, "huLow").value(), 201);
  EXPECT_TRUE(find<QLineEdit>(panel_, "tissue:hu_source").text().contains("a book"));
  EXPECT_TRUE(find<QDoubleSpinBox>(panel_, "damping").toolTip().contains("a paper"));
  EXPECT_EQ(changes_, 0) << "showing is no change";
}

TEST_F(TissuePanelTest, AChangeIsToldAndNoLongerCitesTheOldSource) {
  find<QSpinBox>(panel_, "huLow").setValue(300);
  ASSERT_EQ(changes_, 1);
  EXPECT_EQ(changed_.tissues[1].hu_min, 300);
  EXPECT_NE(changed_.tissues[1].hu_source, "a book");
  EXPECT_EQ(changed_.tissues[0].hu_source, "a book");
  find<QDoubleSpinBox>(panel_, "stiffness").setValue(55.0);
  ASSERT_EQ(changes_, 2);
  EXPECT_EQ(changed_.tissues[1].stiffness_N_per_m.value, 55.0);
  EXPECT_NE(changed_.tissues[1].stiffness_N_per_m.source, "a paper");
  EXPECT_EQ(changed_.tissues[1].damping_Ns_per_m.source, "a paper");
}

TEST_F(TissuePanelTest, ANumberThatWasNotTouchedKeepsEveryDigit) {
  find<QSpinBox>(panel_, "huLow").setValue(300);
  EXPECT_EQ(changed_.tissues[1].opacity, 0.4237);
}

TEST_F(TissuePanelTest, AnOverlapIsSaidAndNotApplied) {
  find<QSpinBox>(panel_, "huLow").setValue(150);
  EXPECT_EQ(changes_, 0);
  EXPECT_EQ(panel_.tissues().tissues[1].hu_min, 201);
  QLabel& problem = find<QLabel>(panel_, "tissueProblem");
  EXPECT_FALSE(problem.isHidden());
  EXPECT_TRUE(problem.text().contains("overlap")) << problem.text().toStdString();
  find<QSpinBox>(panel_, "huLow").setValue(220);
  EXPECT_TRUE(problem.isHidden());
  EXPECT_EQ(changes_, 1);
}

TEST_F(TissuePanelTest, ATissueIsRestrictedToALabelOnceThereIsALabelMapAndFreedAlways) {
  QSpinBox& label = find<QSpinBox>(panel_, "label");
  EXPECT_EQ(label.text(), "label any");
  EXPECT_FALSE(label.isEnabled());
  EXPECT_TRUE(label.toolTip().contains("label map"));
  panel_.setLabelsOpen(true);
  ASSERT_TRUE(label.isEnabled());
  EXPECT_EQ(changes_, 0);
  label.setValue(5);
  ASSERT_EQ(changes_, 1);
  EXPECT_EQ(changed_.tissues[1].label, 5);
  EXPECT_FALSE(changed_.tissues[0].label);
  EXPECT_TRUE(find<QListWidget>(panel_, "tissueList").item(1)->toolTip().contains("label 5"));
  find<QSpinBox>(panel_, "huLow").setValue(150);
  EXPECT_EQ(changes_, 2) << "under a label it may overlap one that has none";

  panel_.setLabelsOpen(false);
  ASSERT_TRUE(label.isEnabled());
  find<QSpinBox>(panel_, "huLow").setValue(201);
  label.setValue(0);
  EXPECT_EQ(label.text(), "label any");
  EXPECT_FALSE(changed_.tissues[1].label);
  panel_.select("soft");
  EXPECT_FALSE(label.isEnabled());
}

TEST_F(TissuePanelTest, IsInsideOfNoTissueThatLiesInsideOfIt) {
  TissueSet set = twoTissues();
  set.tissues[0].within = "bone";  // soft
  panel_.setTissues(set);
  panel_.select("bone");
  EXPECT_EQ(find<QComboBox>(panel_, "tissue:within").findData("soft"), -1);
  panel_.select("soft");
  EXPECT_GE(find<QComboBox>(panel_, "tissue:within").findData("bone"), 0);
  EXPECT_EQ(find<QComboBox>(panel_, "tissue:within").findData("soft"), -1);
}

TEST_F(TissuePanelTest, TabGoesThroughItsFormAsItIsLaidOut) {
  std::vector<QString> order;
  const QWidget* first = &find<QWidget>(panel_, "tissue:name");
  for (const QWidget* at = first; order.size() < 200;) {
    order.push_back(at->objectName());
    at = at->nextInFocusChain();
    if (at == first) break;
  }
  std::ptrdiff_t last = -1;
  for (const char* name :
       {"tissue:name", "opacity", "colour", "huLow", "huHigh", "tissue:hu_source",
        "tissue:structure", "label", "tissue:within", "damping", "stiffness"}) {
    const std::ptrdiff_t at = std::ranges::find(order, name) - order.begin();
    EXPECT_GT(at, last) << name;
    EXPECT_LT(at, std::ptrdiff_t(order.size())) << name;
    last = at;
  }
}

TEST_F(TissuePanelTest, WhereACaseLacksItsStructureItIsTheOutsideOfAnother) {
  panel_.setStructures({"capsule", "liver"});
  panel_.select("bone");
  auto* place = &find<QComboBox>(panel_, "tissue:structure");
  auto* of = &find<QComboBox>(panel_, "shell:of");
  EXPECT_TRUE(of->parentWidget()->isHidden()) << "of a tissue that is anywhere";
  const auto choose = [](QComboBox* box, const QString& data) {
    const int index = box->findData(data);
    ASSERT_GE(index, 0) << data.toStdString();
    box->setCurrentIndex(index);
    emit box->activated(index);
  };
  choose(place, "capsule");
  EXPECT_FALSE(of->parentWidget()->isHidden());
  EXPECT_EQ(of->findData("capsule"), -1) << "not of itself";
  EXPECT_FALSE(changed_.find("bone")->shell);
  choose(of, "liver");
  ASSERT_TRUE(changed_.find("bone")->shell);
  EXPECT_EQ(changed_.find("bone")->shell->of, "liver");
  auto* thickness = &find<QDoubleSpinBox>(panel_, "shell:thickness_mm");
  thickness->setValue(2.5);
  EXPECT_EQ(changed_.find("bone")->shell->thickness_mm, 2.5);
  thickness->setValue(25.0);
  EXPECT_EQ(changed_.find("bone")->shell->thickness_mm, 2.5) << "too thick to be a layer";
  choose(of, "");
  EXPECT_FALSE(changed_.find("bone")->shell);
}

TEST_F(TissuePanelTest, ASourceThatIsBeingTypedStaysWithItsTissue) {
  QLineEdit& source = find<QLineEdit>(panel_, "tissue:hu_source");
  const std::string of_soft = twoTissues().find("soft")->hu_source;
  source.setText("an atlas");
  source.setModified(true);
  find<QToolButton>(panel_, "addTissue").click();
  EXPECT_EQ(changed_.find("bone")->hu_source, "an atlas");
  panel_.setTissues(twoTissues());
  panel_.select("bone");
  source.setText("another atlas");
  source.setModified(true);
  find<QToolButton>(panel_, "removeTissue").click();
  ASSERT_EQ(changed_.tissues.size(), 1u);
  emit source.editingFinished();
  EXPECT_EQ(panel_.tissues().find("soft")->hu_source, of_soft);
  EXPECT_EQ(source.text().toStdString(), of_soft);
}

TEST_F(TissuePanelTest, TheOpacitySliderReachesClearAndSolid) {
  QSlider& slider = find<QSlider>(panel_, "opacity");
  slider.setValue(slider.maximum());
  EXPECT_EQ(changed_.tissues[1].opacity, 1.0);
  slider.setValue(0);
  EXPECT_EQ(changed_.tissues[1].opacity, 0.0);
  for (double opacity : {0.0, 0.01, 0.3, 1.0}) {
    EXPECT_NEAR(opacityAtSlider(sliderAtOpacity(opacity)), opacity, 1e-12);
  }
}

TEST_F(TissuePanelTest, WhatIsFeltIsSaidOfTheSumOfTheLaws) {
  QLabel& felt = find<QLabel>(panel_, "tissueFelt");
  find<QDoubleSpinBox>(panel_, "stiffness").setValue(600.0);
  panel_.setRenderable(
      ArmsLimit{{10.0, 1000.0}, 3.3},
      [](const Tissue& tissue) {
        return Impedance{0.0, 2.0 * tissue.stiffness_N_per_m.value};
      },
      {LawKind::elastic}, RemovalKind::work, ControllerKind::bounded);
  EXPECT_TRUE(felt.text().contains("demand 1200 N/m")) << felt.text().toStdString();
  EXPECT_TRUE(felt.text().contains("at most 1000 N/m")) << felt.text().toStdString();
  find<QDoubleSpinBox>(panel_, "damping").setValue(50.0);
  EXPECT_FALSE(felt.text().contains("Damping")) << "no law of the exercise uses it";
  find<QDoubleSpinBox>(panel_, "stiffness").setValue(500.0);
  EXPECT_TRUE(felt.isHidden());
}

TEST_F(TissuePanelTest, UnderAControllerThatBoundsNothingItDoesNotSayThatTheMostIsFelt) {
  QLabel& felt = find<QLabel>(panel_, "tissueFelt");
  find<QDoubleSpinBox>(panel_, "stiffness").setValue(1200.0);
  for (ControllerKind kind : {ControllerKind::off, ControllerKind::seed}) {
    panel_.setRenderable(
        ArmsLimit{{10.0, 1000.0}, 3.3},
        [](const Tissue& tissue) {
          return Impedance{0.0, tissue.stiffness_N_per_m.value};
        },
        {LawKind::elastic}, RemovalKind::work, kind);
    EXPECT_FALSE(felt.isHidden());
    EXPECT_FALSE(felt.text().contains("is felt")) << felt.text().toStdString();
    EXPECT_FALSE(felt.text().contains("at most")) << felt.text().toStdString();
    EXPECT_TRUE(felt.text().contains("above 1000 N/m these arms may shake"))
        << felt.text().toStdString();
  }
}

TEST_F(TissuePanelTest, BesideANumberStandsWhetherItIsFeltAndWhatTheOthersLeave) {
  const auto words = [&](const char* bar) {
    return find<LimitBar>(panel_, bar).words().toStdString();
  };
  // All that the arms show goes to the stiffness.
  find<QDoubleSpinBox>(panel_, "stiffness").setValue(5000.0);
  const ArmsLimit arms{{10.0, 1000.0}, 3.3};
  const auto demanded = [](const Tissue& tissue) {
    return Impedance{tissue.damping_Ns_per_m.value, tissue.stiffness_N_per_m.value};
  };
  panel_.setRenderable(arms, demanded, {LawKind::viscous, LawKind::elastic}, RemovalKind::work,
                       ControllerKind::bounded);
  EXPECT_EQ(words("ruptureLimit"), "not felt");
  EXPECT_EQ(words("frictionLimit"), "not felt");
  EXPECT_EQ(words("stiffnessLimit"), "arm 1000");
  EXPECT_EQ(words("dampingLimit"), "arm 10.0") << "bounded by itself";
  panel_.setRenderable(arms, demanded, {LawKind::rupture}, RemovalKind::instant,
                       ControllerKind::bounded);
  EXPECT_EQ(words("ruptureLimit"), "arm 3.3");
  EXPECT_EQ(words("dampingLimit"), "not felt");
  EXPECT_EQ(words("cuttingLimit"), "not felt") << "all that is met goes";
  find<QDoubleSpinBox>(panel_, "rupture").setValue(2.0);
  EXPECT_EQ(words("ruptureLimit"), "felt weaker") << "a spring of 5000 N/m in an arm of 1000";
  panel_.setRenderable(arms, demanded, {}, RemovalKind::work, ControllerKind::bounded);
  for (const char* bar : {"dampingLimit", "stiffnessLimit", "frictionLimit", "ruptureLimit"}) {
    EXPECT_EQ(words(bar), "not felt") << bar;
  }
}

// Bone as it was measured, in every number that the tests of it ask for.
class KnownNumbersTest : public TissuePanelTest {
 protected:
  KnownNumbersTest() {
    TissueSet set = twoTissues();
    Tissue& bone = set.tissues[1];
    bone.friction_N = {
        2.5, "a paper", {{2.2, 3.3}}, Confidence::measured, "human cadaver, access needle"};
    bone.relaxation_share = SourcedNumber{0.5, "a book", {{0.4, 0.6}}, Confidence::derived};
    bone.relaxation_s = SourcedNumber{2.0, "a book"};
    panel_.setTissues(set);
    panel_.select("bone");
  }
  QLabel& known(const char* number) {
    return find<QLabel>(panel_, (std::string(number) + "Known").c_str());
  }
  QString tip(const char* number) { return find<QDoubleSpinBox>(panel_, number).toolTip(); }
  Tissue bone() { return panel_.tissues().tissues[1]; }
};

TEST_F(KnownNumbersTest, WhatWasPublishedStandsBelowTheNumberAndInItsTip) {
  const QString words = "published 2.2 to 3.3 N (measured; human cadaver, access needle)";
  EXPECT_EQ(known("friction").text(), words);
  EXPECT_FALSE(known("friction").isHidden());
  EXPECT_TRUE(tip("friction").contains("Source: a paper\n" + words))
      << tip("friction").toStdString();
  EXPECT_EQ(known("relaxes by").text(), "published 40 to 60 % (derived)") << "in the shown unit";
  EXPECT_TRUE(known("stiffness").isHidden()) << "nothing is known but its source";
}

TEST_F(KnownNumbersTest, ANumberOutsideOfWhatWasPublishedSaysSo) {
  TissueSet set = panel_.tissues();
  set.tissues[1].friction_N.value = 4.5;
  panel_.setTissues(set);
  panel_.select("bone");
  EXPECT_EQ(known("friction").text(),
            "outside the published 2.2 to 3.3 N, by a factor of 1.36 (measured; human cadaver, "
            "access needle)");
  EXPECT_EQ(known("friction").palette().color(QPalette::WindowText), colours::kCaution);
  EXPECT_NE(known("relaxes by").palette().color(QPalette::WindowText), colours::kCaution);
}

TEST_F(KnownNumbersTest, ANumberThatIsEditedClaimsNothingOfTheMeasurementUntilItIsBack) {
  const Tissue declared = bone();
  find<QDoubleSpinBox>(panel_, "friction").setValue(2.6);
  EXPECT_EQ(bone().friction_N, (SourcedNumber{2.6, kOwnSource}));
  EXPECT_TRUE(known("friction").isHidden());
  EXPECT_FALSE(tip("friction").contains("published"));
  find<QDoubleSpinBox>(panel_, "friction").setValue(2.5);
  EXPECT_EQ(bone(), declared);
  EXPECT_FALSE(known("friction").isHidden());
}

TEST_F(KnownNumbersTest, AnotherSourceDoesNotInheritWhatTheOldOneSaid) {
  const Tissue declared = bone();
  QLineEdit& source = find<QLineEdit>(panel_, "frictionSource");
  source.setText("another paper");
  emit source.editingFinished();
  EXPECT_EQ(bone().friction_N, (SourcedNumber{2.5, "another paper"}));
  EXPECT_TRUE(known("friction").isHidden());
  source.setText("a paper");
  emit source.editingFinished();
  EXPECT_EQ(bone(), declared);
}

TEST_F(KnownNumbersTest, ToughnessTakesThePlaceOfTheCuttingEnergyAndBack) {
  const Tissue declared = bone();
  QDoubleSpinBox& cutting = find<QDoubleSpinBox>(panel_, "cutting");
  QDoubleSpinBox& toughness = find<QDoubleSpinBox>(panel_, "toughness");
  const auto isGiven = [&](const char* number) {
    const QLineEdit& source = find<QLineEdit>(panel_, (std::string(number) + "Source").c_str());
    EXPECT_EQ(source.placeholderText() == "not given", !source.isEnabled());
    EXPECT_EQ(tip(number).contains("not given"), !source.isEnabled());
    return source.isEnabled();
  };
  EXPECT_TRUE(isGiven("cutting"));
  EXPECT_FALSE(isGiven("toughness"));
  EXPECT_EQ(cutting.value(), 1000.0);
  toughness.setValue(75.8);
  EXPECT_EQ(bone().toughness_J_per_m2, (SourcedNumber{75.8, kOwnSource}));
  EXPECT_FALSE(bone().cutting_J_per_mm3);
  EXPECT_FALSE(isGiven("cutting"));
  EXPECT_TRUE(isGiven("toughness"));
  EXPECT_EQ(cutting.value(), 0.0);
  EXPECT_EQ(toughness.value(), 75.8);
  toughness.setValue(0.0);
  EXPECT_EQ(bone(), declared) << "given up, what was declared is back";
  EXPECT_EQ(cutting.value(), 1000.0);
  EXPECT_TRUE(isGiven("cutting"));
}

TEST_F(KnownNumbersTest, AShareStaysWithinTheRangeOfItsFile) {
  QDoubleSpinBox& share = find<QDoubleSpinBox>(panel_, "relaxes by");
  share.setValue(100.0);
  EXPECT_EQ(bone().relaxation_share->value, 1.0);
  share.setValue(101.0);
  EXPECT_EQ(bone().relaxation_share->value, 1.0);
  EXPECT_FALSE(find<QLabel>(panel_, "relaxes byRefused").isHidden());
}

class LooksTest : public TissuePanelTest {
 protected:
  LooksTest() {
    QObject::connect(&panel_, &TissuePanel::looksChanged, &panel_,
                     [this](const TissueLooks& looks) {
                       looks_ = looks;
                       ++looked_;
                     });
  }
  QComboBox& box(const char* id) {
    return find<QComboBox>(panel_, ("look:" + std::string(id)).c_str());
  }
  // As a click in the opened list does.
  void choose(const char* id, TissueLook look) {
    box(id).setCurrentIndex(int(look));
    QMetaObject::invokeMethod(&box(id), "activated", Q_ARG(int, int(look)));
  }
  TissueLooks looks_;
  int looked_ = 0;
};

TEST_F(LooksTest, EveryTissueHasAChoiceWithANameThatCanBeReadOut) {
  EXPECT_EQ(box("soft").accessibleName(), "Look of Soft tissue");
  EXPECT_NE(box("bone").focusPolicy() & Qt::TabFocus, 0);
  choose("soft", TissueLook::ghosted);
  EXPECT_EQ(looks_, (TissueLooks{{"soft", TissueLook::ghosted}}));
  choose("bone", TissueLook::hidden);
  EXPECT_EQ(looks_, (TissueLooks{{"soft", TissueLook::ghosted}, {"bone", TissueLook::hidden}}));
  EXPECT_EQ(looked_, 2);
}

TEST_F(LooksTest, AreNoChangeOfATissue) {
  choose("bone", TissueLook::hidden);
  EXPECT_EQ(changes_, 0);
  EXPECT_TRUE(panel_.tissues() == twoTissues());
  EXPECT_TRUE(find<QListWidget>(panel_, "tissueList").item(1)->toolTip().contains("not drawn"));
}

TEST_F(LooksTest, OfWhatTheSetHasClearIsHiddenUntilItIsChosen) {
  TissueSet set = twoTissues();
  set.tissues[0].opacity = 0.0;
  panel_.setTissues(set);
  EXPECT_EQ(box("soft").currentIndex(), int(TissueLook::hidden));
  choose("soft", TissueLook::shown);
  EXPECT_EQ(box("soft").currentIndex(), int(TissueLook::shown));
  panel_.setLooks({});
  EXPECT_EQ(box("soft").currentIndex(), int(TissueLook::hidden));
}

TEST_F(LooksTest, FollowTheirTissuesIntoAnotherSet) {
  TissueSet set = twoTissues();
  set.tissues.erase(set.tissues.begin());
  panel_.setTissues(set);
  EXPECT_EQ(panel_.findChild<QComboBox*>("look:soft"), nullptr);
  choose("bone", TissueLook::ghosted);
  EXPECT_EQ(looks_.at("bone"), TissueLook::ghosted);
}

TEST_F(LooksTest, APresetIsAStartThatChoicesChange) {
  auto& bone = find<QToolButton>(panel_, "presetBone");
  EXPECT_FALSE(bone.isHidden());
  EXPECT_TRUE(find<QToolButton>(panel_, "presetLiver").isHidden()) << "the set has none";
  bone.click();
  EXPECT_EQ(looks_, (TissueLooks{{"soft", TissueLook::hidden}, {"bone", TissueLook::shown}}));
  EXPECT_EQ(box("soft").currentIndex(), int(TissueLook::hidden));
  choose("soft", TissueLook::ghosted);
  EXPECT_EQ(looks_.at("soft"), TissueLook::ghosted);
  EXPECT_EQ(looks_.at("bone"), TissueLook::shown);
}

TEST_F(TissuePanelTest, HuThatHaveLostTheirTissueAreMentioned) {
  QLabel& gaps = find<QLabel>(panel_, "tissueGaps");
  EXPECT_TRUE(gaps.isHidden());
  find<QSpinBox>(panel_, "huLow").setValue(3000);
  EXPECT_EQ(changes_, 1) << "air is possible";
  EXPECT_FALSE(gaps.isHidden());
  EXPECT_TRUE(gaps.text().contains("201 to 2999 HU")) << gaps.text().toStdString();
  panel_.select("soft");
  EXPECT_FALSE(gaps.isHidden()) << "whichever tissue is looked at";
  find<QSpinBox>(panel_, "huLow").setValue(50);
  EXPECT_TRUE(gaps.text().contains("0 to 49 HU, 201 to 2999 HU")) << gaps.text().toStdString();
  panel_.setTissues(twoTissues());
  EXPECT_TRUE(gaps.isHidden());
}

TEST_F(TissuePanelTest, ANumberBeyondItsLimitsIsRefusedBesideItsFieldAndOthersGoOn) {
  QLabel& reason = find<QLabel>(panel_, "dampingRefused");
  find<QDoubleSpinBox>(panel_, "damping").setValue(1000000.0);
  EXPECT_EQ(changes_, 0);
  EXPECT_FALSE(reason.isHidden());
  EXPECT_EQ(panel_.tissues().tissues[1].damping_Ns_per_m.value, 1.0);
  find<QDoubleSpinBox>(panel_, "friction").setValue(2.0);
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(changed_.tissues[1].damping_Ns_per_m.value, 1.0);
  EXPECT_FALSE(reason.isHidden());
  find<QDoubleSpinBox>(panel_, "damping").setValue(3.0);
  EXPECT_TRUE(reason.isHidden());
  EXPECT_EQ(changed_.tissues[1].damping_Ns_per_m.value, 3.0);

  find<QSpinBox>(panel_, "huHigh").setValue(40000);
  EXPECT_EQ(panel_.tissues().tissues[1].hu_max, 3000);
  EXPECT_FALSE(find<QLabel>(panel_, "huHighRefused").isHidden());
  panel_.setLabelsOpen(true);
  find<QSpinBox>(panel_, "label").setValue(300);
  EXPECT_FALSE(panel_.tissues().tissues[1].label);
  EXPECT_FALSE(find<QLabel>(panel_, "labelRefused").isHidden());
}

TEST_F(TissuePanelTest, AnotherTissueIsShownWithoutTheRefusalsOfTheFirst) {
  find<QDoubleSpinBox>(panel_, "damping").setValue(1000000.0);
  find<QSpinBox>(panel_, "huLow").setValue(150);
  panel_.select("soft");
  EXPECT_TRUE(find<QLabel>(panel_, "dampingRefused").isHidden());
  EXPECT_TRUE(find<QLabel>(panel_, "tissueProblem").isHidden());
  panel_.select("bone");
  EXPECT_EQ(find<QDoubleSpinBox>(panel_, "damping").value(), 1.0);
  EXPECT_EQ(find<QSpinBox>(panel_, "huLow").value(), 201);
  EXPECT_EQ(changes_, 0);
}

TEST_F(TissuePanelTest, ANumberPutBackCitesItsSourceAgain) {
  find<QSpinBox>(panel_, "huLow").setValue(300);
  find<QSpinBox>(panel_, "huLow").setValue(201);
  find<QDoubleSpinBox>(panel_, "damping").setValue(7.0);
  find<QDoubleSpinBox>(panel_, "damping").setValue(1.0);
  EXPECT_TRUE(panel_.tissues() == twoTissues());
}

TEST_F(PanelTest, NoCaseIsOpenedWhileAnExerciseRunsOrAnotherIsBeingOpened) {
  CasesPage panel;
  QPushButton& folder = find<QPushButton>(panel, "openFolder");
  QPushButton& another = find<QPushButton>(panel, "anotherSeries");
  EXPECT_TRUE(another.isHidden()) << "there is no folder yet";
  panel.setSeriesAtHand(true);
  EXPECT_FALSE(another.isHidden());
  EXPECT_TRUE(folder.isEnabled() && another.isEnabled());
  panel.setOpeningAllowed(false);
  EXPECT_FALSE(folder.isEnabled() || another.isEnabled());
  panel.setOpeningAllowed(true);
}

TEST_F(PanelTest, AnArmShowsItsForceItsTissueAndItsFault) {
  ArmsPanel panel;
  Exercise exercise;
  exercise.tissues = twoTissues();
  exercise.arms.resize(1);
  exercise.arms[0].name = "right";
  panel.setExercise(exercise);
  LoopState state;
  ArmRecord& arm = state.record.arms[0];
  arm.sent_N = {0.0, 3.0, 0.0};
  arm.demanded_N = {0.0, 4.0, 3.0};
  arm.energy_out_J = {0.001, 0.002, 0.0};
  arm.tissue_class = 1;
  panel.showState(state, exercise.tissues, {3.3});
  EXPECT_EQ(find<QLabel>(panel, "rightForce").text(), "3.00 N of 3.30 N");
  EXPECT_TRUE(find<QLabel>(panel, "rightDemanded").text().contains("5.00 N"));
  EXPECT_EQ(find<QLabel>(panel, "rightContact").text(), "Bone");
  EXPECT_TRUE(find<QLabel>(panel, "rightFaults").isHidden());

  arm.faults = kFaultLate;
  panel.showState(state, exercise.tissues, {3.3});
  EXPECT_TRUE(find<QLabel>(panel, "rightFaults").text().contains("late"));
  EXPECT_FALSE(find<QLabel>(panel, "rightFaults").isHidden());
}

TEST_F(PanelTest, AnArmsToolIsNamedAndChosenFromThoseThatTheExerciseGivesIt) {
  ArmsPanel panel;
  Exercise exercise;
  exercise.tissues = twoTissues();
  exercise.tools = {{"cutter", makeBurr(0.003, 16, 2, 0.03), {}},
                    {"scalpel", makeBlade(0.016, 4), {}}};
  exercise.arms.resize(2);
  exercise.arms[0].name = "left";
  exercise.arms[1].name = "right";
  exercise.arms[0].tool = exercise.arms[1].tool = "cutter";
  exercise.arms[1].other_tools = {"scalpel"};
  panel.setExercise(exercise);
  auto &left = find<QComboBox>(panel, "leftTool"), &right = find<QComboBox>(panel, "rightTool");
  EXPECT_EQ(right.currentText(), "cutter, 6 mm");
  EXPECT_FALSE(right.isEnabled()) << "nothing runs";
  LoopState state;
  panel.showState(state, exercise.tissues, {3.3, 3.3});
  EXPECT_FALSE(left.isEnabled());
  EXPECT_TRUE(left.toolTip().contains("one tool"));
  ASSERT_TRUE(right.isEnabled());
  ASSERT_EQ(right.count(), 2);
  std::vector<std::pair<std::size_t, std::size_t>> wanted;
  QObject::connect(&panel, &ArmsPanel::toolWanted,
                   [&](std::size_t arm, std::size_t tool) { wanted.emplace_back(arm, tool); });
  right.setCurrentIndex(1);
  emit right.activated(1);
  ASSERT_EQ(wanted.size(), 1u);
  EXPECT_EQ(wanted[0], (std::pair<std::size_t, std::size_t>(1, 1)));
  // It waits for the tool to be out of tissue.
  state.wanted_tools[1] = 1;
  panel.showState(state, exercise.tissues, {3.3, 3.3});
  EXPECT_EQ(right.currentText(), "cutter, 6 mm") << "as it is";
  EXPECT_FALSE(find<QLabel>(panel, "rightToolWaits").isHidden());
  EXPECT_TRUE(find<QLabel>(panel, "rightToolWaits").text().contains("out of the tissue"));
  EXPECT_TRUE(find<QLabel>(panel, "leftToolWaits").isHidden());
  state.tools[1] = 1;
  panel.showState(state, exercise.tissues, {3.3, 3.3});
  EXPECT_EQ(right.currentText(), "scalpel, 16 mm");
  EXPECT_TRUE(find<QLabel>(panel, "rightToolWaits").isHidden());
}

TEST_F(PanelTest, EnergyIsShownAsItIsAndColouredAsWrongWhereTheArmShakes) {
  ArmsPanel panel;
  Exercise exercise;
  exercise.arms.resize(1);
  exercise.arms[0].name = "right";
  panel.setExercise(exercise);
  QLabel& energy = find<QLabel>(panel, "rightEnergy");
  LoopState state;
  const auto shown = [&](double energy_J) {
    state.ticks += 66;
    state.record.arms[0].energy_out_J = {energy_J, 0.0, 0.0};
    panel.showState(state, {}, {3.3});
    return std::pair(energy.text(), energy.palette().color(QPalette::WindowText));
  };
  EXPECT_EQ(shown(-0.2), std::pair(QString("-200.0 mJ"), colours::kText));
  EXPECT_EQ(shown(-0.1999), std::pair(QString("-199.9 mJ"), colours::kText)) << "of one contact";
  EXPECT_TRUE(find<QLabel>(panel, "rightFaults").isHidden());
  EXPECT_EQ(shown(0.489), std::pair(QString("489.0 mJ"), colours::kBad));
  EXPECT_TRUE(find<QLabel>(panel, "rightFaults").text().contains("shakes"));
  EXPECT_TRUE(find<QLabel>(panel, "rightFaults")
                  .text()
                  .contains("Let it be kept steady by 'Limits (bounded)'"));
  for (int i = 0; i < 80; ++i) shown(0.489);
  EXPECT_EQ(shown(0.489), std::pair(QString("489.0 mJ"), colours::kText)) << "it has stopped";
  EXPECT_TRUE(energy.toolTip().contains("encoder"));
}

TEST_F(PanelTest, AResultSaysWhatWasAskedAndAnOrganThatIsATissueOnce) {
  QWidget over;
  over.resize(800, 600);
  ResultPage page(over);
  ExerciseResult result;
  result.exercise = "Slice";
  result.goal = "Cut a slice.";
  result.tissues = {{"Liver", Qt::red, 120.0}, {"Bone", Qt::white, 7.0}};
  result.structures = {{"liver", 1500.0, 0.12}, {"bone", 900.0, 0.004}};
  page.setResult(result);
  EXPECT_TRUE(find<QLabel>(page, "resultGoal").text().endsWith("Cut a slice."));
  const QString rows = find<QLabel>(page, "resultRows").text();
  EXPECT_EQ(rows.count("liver", Qt::CaseInsensitive), 1) << rows.toStdString();
  EXPECT_TRUE(rows.contains("120 mm\u00b3 of 1500.00 mL")) << rows.toStdString();
  // Bone outside of the structure counts to the tissue alone.
  EXPECT_EQ(rows.count("Bone&nbsp;", Qt::CaseInsensitive), 2) << rows.toStdString();
  EXPECT_FALSE(rows.contains("Not told apart"));
  result.unnamed_mm3 = 3.0;
  page.setResult(result);
  const QString with_rest = find<QLabel>(page, "resultRows").text();
  EXPECT_TRUE(with_rest.contains("Not told apart")) << with_rest.toStdString();
  EXPECT_TRUE(with_rest.contains("at the edge of two tissues"));
  result.goal.clear();
  page.setResult(result);
  EXPECT_TRUE(find<QLabel>(page, "resultGoal").isHidden());
}

TEST_F(PanelTest, ANameThatIsShownHasNoMarksOfDirectionAndCanBeBroken) {
  EXPECT_EQ(shownName("Head 2026-11-25 1").toStdString(), "Head 2026-11-25 1");
  EXPECT_EQ(shownName("a\u202eb\u200bc\td").toStdString(), "abcd");
  const QString wide = shownName(std::string(78, 'W'));
  EXPECT_EQ(wide.count('W'), 78);
  EXPECT_EQ(wide.count(QChar(0x200b)), 4);
}

TEST_F(PanelTest, ASettingThatIsNeitherYesNorNoIsAsWithoutIt) {
  QSettings settings = windowSettings();
  for (const char* word : {"banana", "2", ""}) {
    settings.setValue(settings::kLeftPanel.key, QString(word));
    settings.sync();
    EXPECT_TRUE(read(settings::kLeftPanel)) << word;
  }
  settings.setValue(settings::kLeftPanel.key, false);
  settings.sync();
  EXPECT_FALSE(read(settings::kLeftPanel));
  settings.remove(settings::kLeftPanel.key);
}

TEST_F(PanelTest, TheBarOfTheHandSaysThatAPushIsTheMostAndThatAToolInTissueRests) {
  QWidget over;
  over.resize(800, 600);
  HandBar bar(over);
  const auto words = [&](double push_N, const char* touches, bool at_edge = false) {
    bar.showHand("Left hand", Qt::white, "needle", false, push_N, 3.0, touches, at_edge);
    return find<QLabel>(bar, "pushWords").text().toStdString();
  };
  EXPECT_EQ(words(2.0, "Liver"), "presses up to 2.0 N");
  EXPECT_EQ(words(0.0, "Liver"), "rests");
  EXPECT_EQ(words(0.0, ""), "hovers");
  EXPECT_EQ(words(2.0, "", true), "the arm reaches no further");
}

TEST_F(PanelTest, InANarrowViewTheBarOfTheHandStillSaysHowHardItPresses) {
  QWidget over;
  HandBar bar(over);
  for (const int width : {500, 400, 300, 250, 220}) {
    over.resize(width, 400);
    over.show();
    bar.showHand("Right hand", Qt::white, "blade, 50 mm", false, 2.0, 3.0, "Brain and CSF", false);
    QApplication::processEvents();
    const QLabel& push = find<QLabel>(bar, "pushWords");
    EXPECT_TRUE(push.isVisible());
    EXPECT_GE(push.width(), push.sizeHint().width()) << width;
    EXPECT_LE(push.mapTo(&bar, QPoint(push.width(), 0)).x(), bar.width()) << width;
    if (width == 220) {
      EXPECT_FALSE(find<QLabel>(bar, "handTouches").isVisible());
    }
  }
}

TEST_F(PanelTest, WhatIsChangedInTheForceIsSaidByWhatItIs) {
  ArmRecord arm;
  EXPECT_EQ(forceChangeWords(arm, false), "as the tissue demands");
  arm.controller_parts = kPartLimiter;
  EXPECT_EQ(forceChangeWords(arm, false), "rising slowly");
  EXPECT_EQ(forceChangeWords(arm, true), "off: paused");
  arm.tool_state = kToolWaits;
  EXPECT_EQ(forceChangeWords(arm, false), "off until the tool is drawn out");
  arm.faults = kFaultLate;
  EXPECT_EQ(forceChangeWords(arm, false), "off until the computer keeps up");
  arm.faults = kFaultLate | kFaultStalled;
  EXPECT_EQ(forceChangeWords(arm, false), "off until asked for");
  arm.faults = kFaultLate | kFaultDevice;
  EXPECT_EQ(forceChangeWords(arm, false), "off until the arm's error has passed");
  arm.faults = 0;
  arm.tool_state = kToolArmWarm;
  EXPECT_EQ(forceChangeWords(arm, false), "rising slowly, less, as the motors are warm");
}

TEST_F(PanelTest, EachOfTheseWordsIsExplainedBesideIt) {
  ArmsPanel panel;
  Exercise exercise;
  exercise.arms.resize(1);
  exercise.arms[0].name = "right";
  panel.setExercise(exercise);
  const QString help = find<QLabel>(panel, "rightParts").toolTip();
  for (std::uint32_t bit = kPartArmBound; bit <= kPartLimiter; bit <<= 1) {
    ArmRecord arm;
    arm.controller_parts = bit;
    const QString words = forceChangeWords(arm, false);
    EXPECT_NE(words, "as the tissue demands") << bit;
    EXPECT_TRUE(help.simplified().contains(words + ": ")) << words.toStdString();
  }
}

TEST_F(PanelTest, ControllersAreCalledAsTheirPageCallsThemAndNoneIsShownBeforeAExercise) {
  ArmsPanel panel;
  auto& list = find<QComboBox>(panel, "controller");
  EXPECT_EQ(list.currentIndex(), -1) << "nothing is open";
  ASSERT_EQ(list.count(), int(kControllerNames.size()));
  for (const auto& [name, kind] : kControllerNames) {
    const int item = list.findData(int(kind));
    EXPECT_TRUE(list.itemText(item).contains('(' + QString::fromStdString(std::string(name)) + ')'))
        << list.itemText(item).toStdString();
    EXPECT_FALSE(list.itemData(item, Qt::ToolTipRole).toString().isEmpty());
  }
}

}  // namespace
}  // namespace trephine
