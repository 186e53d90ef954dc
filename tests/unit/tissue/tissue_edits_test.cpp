#include "tissue/tissue_edits.h"

#include <gtest/gtest.h>

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

TEST(SameSet, SeesNumbersSourcesLabelsAndColours) {
  const TissueSet set{"", {tissue("soft", 0, 200)}};
  EXPECT_TRUE(sameSet(set, set));
  for (const auto& change : std::vector<void (*)(Tissue&)>{
           [](Tissue& t) { t.hu_min = 1; }, [](Tissue& t) { t.label = 3; },
           [](Tissue& t) { t.colour.x = 0.25; }, [](Tissue& t) { t.damping_Ns_per_m.value = 3.0; },
           [](Tissue& t) { t.friction_N.source = "a book"; },
           [](Tissue& t) {
             t.rupture_N = SourcedNumber{0.5, "a book"};
           }}) {
    TissueSet other = set;
    change(other.tissues[0]);
    EXPECT_FALSE(sameSet(set, other));
  }
}

}  // namespace
}  // namespace trephine
