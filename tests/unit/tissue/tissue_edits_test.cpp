#include "tissue/tissue_edits.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace trephine {
namespace {

Tissue tissue(const char* id, int low, int high, std::optional<int> label = {}) {
  Tissue t;
  t.id = id;
  t.hu_min = low;
  t.hu_max = high;
  t.label = label;
  return t;
}

using Ranges = std::vector<HuRange>;

TEST(FreeHu, IsWhatNoTissueHoldsWithinTheSpan) {
  const TissueSet set{"", {tissue("bone", 3000, 3071), tissue("dura", 56, 225)}};
  EXPECT_EQ(freeHu(set, {56, 3071}), (Ranges{{226, 2999}}));
  EXPECT_EQ(freeHu(set, {-200, 4000}), (Ranges{{-200, 55}, {226, 2999}, {3072, 4000}}));
  EXPECT_EQ(freeHu(set, {300, 400}), (Ranges{{300, 400}}));
  EXPECT_EQ(freeHu(set, {100, 200}), Ranges{});
}

TEST(FreeHu, RangesThatTouchLeaveNothingBetweenThem) {
  const TissueSet set{"", {tissue("soft", 0, 200), tissue("bone", 201, 3000)}};
  EXPECT_EQ(freeHu(set, {0, 3000}), Ranges{});
}

TEST(FreeHu, ATissueOfALabelHoldsNothingWhereTheLabelIsNot) {
  const TissueSet set{"", {tissue("soft", 0, 200), tissue("liver", 100, 400, 5)}};
  EXPECT_EQ(freeHu(set, {0, 400}), (Ranges{{201, 400}}));
}

TEST(LostHu, LiesBetweenTheEndsThatTissuesHaveOrHad) {
  const TissueSet declared{"", {tissue("soft", -200, 225), tissue("bone", 226, 3071)}};
  const TissueSet set{"", {tissue("soft", -100, 225), tissue("bone", 300, 3071)}};
  EXPECT_EQ(lostHu(set, declared), (Ranges{{-200, -101}, {226, 299}}));
  EXPECT_EQ(lostHu(set, set), (Ranges{{226, 299}}));
  const TissueSet labelled{"", {tissue("liver", 0, 100, 5)}};
  EXPECT_EQ(lostHu(labelled, labelled), Ranges{}) << "nothing is of any place";
}

TEST(RangesOf, AnotherSetAreTakenAndNothingElse) {
  TissueSet set{"", {tissue("soft", 0, 200)}}, other = set;
  set.tissues[0].opacity = 0.7;
  other.tissues[0].hu_max = 100;
  other.tissues[0].hu_source = "a book";
  const TissueSet out = withRangesOf(set, other);
  EXPECT_EQ(out.tissues[0].hu_max, 100);
  EXPECT_EQ(out.tissues[0].hu_source, "a book");
  EXPECT_EQ(out.tissues[0].opacity, 0.7);
}

TEST(InStructure, ATissueThatIsAloneThereIsAllOfIt) {
  TissueSet set{"", {tissue("liver", 0, 200, 5), tissue("vessel", 100, 300)}};
  const Tissue alone = inStructure(set, set.tissues[0], "liver", {});
  EXPECT_EQ(alone.structure, "liver");
  EXPECT_FALSE(alone.label);
  EXPECT_LT(alone.hu_min, -900);
  EXPECT_EQ(alone.hu_max, kCtHu.high);
  set.tissues[1].structure = "liver";
  EXPECT_EQ(inStructure(set, set.tissues[0], "liver", {}).hu_max, 200);
}

TEST(InStructure, WhatStandsInGoesWithTheStructureAndComesBackWithIt) {
  TissueSet declared{"", {tissue("capsule", 0, 200)}};
  declared.tissues[0].structure = "capsule";
  declared.tissues[0].shell = Tissue::Shell{"liver", 2.0};
  const Tissue anywhere = inStructure(declared, declared.tissues[0], "", declared);
  EXPECT_FALSE(anywhere.shell);
  EXPECT_EQ(anywhere.hu_max, 200);
  EXPECT_TRUE(inStructure(declared, anywhere, "capsule", declared).shell);
}

TEST(SameSet, SeesNumbersSourcesLabelsAndColours) {
  const TissueSet set{"", {tissue("soft", 0, 200)}};
  EXPECT_TRUE(TissueSet(set) == set);
  for (const auto& change : std::vector<void (*)(Tissue&)>{
           [](Tissue& t) { t.hu_min = 1; }, [](Tissue& t) { t.label = 3; },
           [](Tissue& t) { t.colour.x = 0.25; }, [](Tissue& t) { t.damping_Ns_per_m.value = 3.0; },
           [](Tissue& t) { t.friction_N.source = "a book"; },
           [](Tissue& t) {
             t.rupture_N = SourcedNumber{0.5, "a book"};
           }}) {
    TissueSet other = set;
    change(other.tissues[0]);
    EXPECT_FALSE(set == other);
  }
}

// Three that touch or leave a gap, and one known by a label of its own.
TissueSet neighbours() {
  TissueSet set{"", {tissue("soft", 0, 99), tissue("dura", 100, 225), tissue("bone", 300, 3071),
                     tissue("liver", 50, 400, 5)}};
  for (Tissue& t : set.tissues) t.hu_source = "a book";
  return set;
}
HuRange rangeOf(const TissueSet& set, std::size_t i) {
  return {set.tissues[i].hu_min, set.tissues[i].hu_max};
}

TEST(WithThreshold, TakesWithItTheNeighbourThatTouchesAndLeavesItOneHu) {
  const TissueSet set = neighbours();
  const TissueSet moved = withThreshold(set, 1, RangeEnd::low, 60, true, set);
  EXPECT_EQ(rangeOf(moved, 1), (HuRange{60, 225}));
  EXPECT_EQ(rangeOf(moved, 0), (HuRange{0, 59}));
  const TissueSet far = withThreshold(set, 1, RangeEnd::low, -5000, true, set);
  EXPECT_EQ(rangeOf(far, 1), (HuRange{1, 225}));
  EXPECT_EQ(rangeOf(far, 0), (HuRange{0, 0}));
  const TissueSet up = withThreshold(set, 0, RangeEnd::high, 500, true, set);
  EXPECT_EQ(rangeOf(up, 0), (HuRange{0, 224}));
  EXPECT_EQ(rangeOf(up, 1), (HuRange{225, 225}));
}

TEST(WithThreshold, AloneItStopsAtTheNeighbourAndLeavesAGapBehind) {
  const TissueSet set = neighbours();
  EXPECT_EQ(rangeOf(withThreshold(set, 1, RangeEnd::low, 60, false, set), 1), (HuRange{100, 225}));
  const TissueSet gap = withThreshold(set, 1, RangeEnd::low, 150, false, set);
  EXPECT_EQ(rangeOf(gap, 1), (HuRange{150, 225}));
  EXPECT_EQ(rangeOf(gap, 0), (HuRange{0, 99}));
  // Across a gap nobody is taken along.
  EXPECT_EQ(rangeOf(withThreshold(set, 2, RangeEnd::low, 10, true, set), 2),
            (HuRange{226, 3071}));
}

TEST(WithThreshold, ItsOwnRangeKeepsOneHuAndOtherPlacesDoNotCount) {
  const TissueSet set = neighbours();
  EXPECT_EQ(rangeOf(withThreshold(set, 2, RangeEnd::low, 9000, true, set), 2),
            (HuRange{3071, 3071}));
  EXPECT_EQ(rangeOf(withThreshold(set, 3, RangeEnd::high, 99999, true, set), 3),
            (HuRange{50, 32767}));
}

TEST(WithThreshold, WhatMovesIsTunedHereAndCitesItsSourceAgainWhereItIsAsDeclared) {
  const TissueSet set = neighbours();
  const TissueSet moved = withThreshold(set, 1, RangeEnd::low, 60, true, set);
  EXPECT_EQ(moved.tissues[0].hu_source, kOwnSource);
  EXPECT_EQ(moved.tissues[1].hu_source, kOwnSource);
  EXPECT_EQ(moved.tissues[2].hu_source, "a book");
  const TissueSet back = withThreshold(moved, 1, RangeEnd::low, 100, true, set);
  EXPECT_TRUE(back == set);
}

TEST(OverlapsOf, AreTheSharedHuOfTheSamePlace) {
  const TissueSet set = neighbours();
  Tissue wanted = set.tissues[2];
  wanted.hu_min = 90;
  EXPECT_EQ(overlapsOf(set, 2, wanted),
            (std::vector<HuOverlap>{{0, {90, 99}}, {1, {100, 225}}}));
  wanted.label = 5;
  EXPECT_EQ(overlapsOf(set, 2, wanted), (std::vector<HuOverlap>{{3, {90, 400}}}));
  EXPECT_TRUE(overlapsOf(set, 2, set.tissues[2]).empty());
}

// What is known of a tissue's numbers: one of each kind.
Tissue known() {
  Tissue t = tissue("capsule", 0, 200);
  t.friction_N = {0.3, "a paper", {{0.2, 0.4}}, Confidence::measured, "pig, 37 degrees"};
  t.rupture_N = SourcedNumber{2.5, "a thesis", {{2.2, 3.3}}, Confidence::second_hand};
  t.toughness_J_per_m2 = SourcedNumber{75.8, "a book", {}, Confidence::derived};
  return t;
}
const TissueNumber& number(const std::string& key) {
  return *std::ranges::find(kTissueNumbers, key, &TissueNumber::key);
}

TEST(WithNumber, AnEditedNumberIsTunedHereAndClaimsNothingOfTheOldMeasurement) {
  const Tissue declared = known();
  const Tissue other = withNumber(declared, number("friction_N"), 0.5, 0.005, declared);
  EXPECT_EQ(other.friction_N.value, 0.5);
  EXPECT_EQ(other.friction_N.source, kOwnSource);
  EXPECT_EQ(other.friction_N.confidence(), Confidence::tuned);
  EXPECT_FALSE(other.friction_N.range);
  EXPECT_EQ(other.friction_N.condition, "");
  EXPECT_EQ(other.rupture_N, declared.rupture_N) << "the others stay";
}

TEST(WithNumber, TheDeclaredNumberIsBackWholeWhereItsValueIs) {
  const Tissue declared = known();
  const Tissue other = withNumber(declared, number("friction_N"), 0.5, 0.005, declared);
  EXPECT_EQ(withNumber(other, number("friction_N"), 0.3, 0.005, declared), declared);
  EXPECT_EQ(withNumber(other, number("friction_N"), 0.303, 0.005, declared), declared)
      << "as it is shown";
}

TEST(WithNumber, WhatIsShownRoundedIsNoOtherNumber) {
  const Tissue declared = known();
  Tissue other = declared;
  other.friction_N = {0.5, "another paper"};
  EXPECT_EQ(withNumber(other, number("friction_N"), 0.504, 0.005, declared), other);
}

TEST(WithNumber, ZeroGivesUpWhatTheDeclaredTissueLacksToo) {
  const Tissue declared = known();
  const Tissue given = withNumber(declared, number("rupture_mm"), 3.0, 0.005, declared);
  ASSERT_TRUE(given.rupture_mm);
  EXPECT_EQ(withNumber(given, number("rupture_mm"), 0.0, 0.005, declared), declared);
  EXPECT_EQ(withNumber(declared, number("rupture_N"), 0.0, 0.005, declared).rupture_N,
            (SourcedNumber{0.0, kOwnSource}));
}

TEST(WithNumber, WhatCuttingCostsByVolumeTakesThePlaceOfWhatItCostsByArea) {
  const Tissue declared = known();
  const Tissue by_volume = withNumber(declared, number("cutting_J_per_mm3"), 0.002, 1e-6, declared);
  EXPECT_EQ(by_volume.cutting_J_per_mm3, (SourcedNumber{0.002, kOwnSource}));
  EXPECT_FALSE(by_volume.toughness_J_per_m2);
  EXPECT_EQ(withNumber(by_volume, number("cutting_J_per_mm3"), 0.0, 1e-6, declared), declared)
      << "given up, the declared one is back";
  EXPECT_EQ(withNumber(by_volume, number("toughness_J_per_m2"), 75.8, 0.05, declared), declared);
  const Tissue free = withNumber(by_volume, number("cutting_J_per_mm3"), 0.0, 1e-6, {});
  EXPECT_EQ(free.cutting_J_per_mm3, (SourcedNumber{0.0, kOwnSource})) << "one of the two is given";
}

TEST(WithSource, AnotherSourceDoesNotInheritWhatTheOldOneSaid) {
  const Tissue declared = known();
  const Tissue other = withSource(declared, number("friction_N"), "another paper", declared);
  EXPECT_EQ(other.friction_N, (SourcedNumber{0.3, "another paper"}));
  EXPECT_EQ(other.friction_N.confidence(), Confidence::unstated);
  EXPECT_EQ(withSource(other, number("friction_N"), "a paper", declared), declared);
  const Tissue moved = withNumber(declared, number("friction_N"), 0.5, 0.005, declared);
  EXPECT_EQ(withSource(moved, number("friction_N"), "a paper", declared).friction_N,
            (SourcedNumber{0.5, "a paper"}))
      << "its value is another";
}

TEST(NewTissue, TakesTheWidestFreeRangeUnderANameOfItsOwnAndTheSetStaysPossible) {
  const TissueSet set = startingSet("Mine");
  ASSERT_TRUE(validate(set, "").ok());
  const Result<TissueSet> more = withNewTissue(set);
  ASSERT_TRUE(more.ok());
  EXPECT_EQ(more->tissues[0].id, "tissue-1");
  EXPECT_EQ(rangeOf(*more, 0), (HuRange{-300, -201})) << "not the air of the whole room";
  EXPECT_TRUE(validate(*more, "").ok());
  TissueSet gap = set;
  gap.tissues[0].hu_min = 300;
  EXPECT_EQ(rangeOf(*withNewTissue(gap), 0), (HuRange{226, 299}));
  TissueSet whole = set;
  whole.tissues[1].hu_min = -1024;
  const Result<TissueSet> full = withNewTissue(whole);
  ASSERT_FALSE(full.ok());
  EXPECT_EQ(full.error().code.str(), "NO_ROOM");
  EXPECT_NE(full.error().next, "");
}

TEST(NewTissue, OneIsTakenAwayButNotTheLast) {
  TissueSet set = startingSet("Mine");
  const Result<TissueSet> one = withoutTissue(set, 0);
  ASSERT_TRUE(one.ok());
  ASSERT_EQ(one->tissues.size(), 1u);
  EXPECT_EQ(one->tissues[0].id, "soft");
  EXPECT_EQ(withoutTissue(*one, 0).error().code.str(), "LAST_TISSUE");
}

}  // namespace
}  // namespace trephine
