#include <gtest/gtest.h>

#include <cmath>

#include "render/transfer_function.h"
#include "scenes.h"

using namespace trephine;
using test::tissue;

namespace {

const Vec3 kRed(1, 0, 0), kBlue(0, 0, 1);

}  // namespace

TEST(TransferFunction, InsideARangeATissueHasItsOwnLook) {
  const auto f = transferFunction({"",
                                   {tissue("a", 0, 499, kRed, 0.3),  //
                                    tissue("b", 500, 3000, kBlue, 0.8)}});
  EXPECT_EQ(evaluate(f, 250).colour, kRed);
  EXPECT_DOUBLE_EQ(evaluate(f, 250).opacity, 0.3);
  EXPECT_EQ(evaluate(f, 1500).colour, kBlue);
  EXPECT_DOUBLE_EQ(evaluate(f, 1500).opacity, 0.8);
}

TEST(TransferFunction, HuOfNoTissueAreTransparent) {
  const auto f = transferFunction({"",
                                   {tissue("a", 0, 100, kRed, 0.3),  //
                                    tissue("b", 500, 900, kBlue, 0.8)}});
  for (double hu : {-3000.0, -1000.0, -50.0, 300.0, 1000.0, 30000.0}) {
    EXPECT_EQ(evaluate(f, hu).opacity, 0.0) << hu;
  }
}

TEST(TransferFunction, TheRampIsNarrowAndHalfWayAtTheRangesEdge) {
  const auto f = transferFunction({"", {tissue("a", 300, 3000, kRed, 0.8)}});
  EXPECT_NEAR(evaluate(f, 299.5).opacity, 0.4, 1e-12);
  EXPECT_EQ(evaluate(f, 299.5 - kRampHalfWidth_HU).opacity, 0.0);
  EXPECT_DOUBLE_EQ(evaluate(f, 299.5 + kRampHalfWidth_HU).opacity, 0.8);
  EXPECT_NEAR(evaluate(f, 3000.5).opacity, 0.4, 1e-12);
}

TEST(TransferFunction, TheEdgeOfAVisibleTissueKeepsItsColourBesideAHiddenOne) {
  const auto f = transferFunction(
      {"", {tissue("hidden", 0, 299, kBlue, 0.0), tissue("bone", 300, 3000, kRed, 0.8)}});
  EXPECT_EQ(evaluate(f, 296.0).colour, kRed);
  EXPECT_GT(evaluate(f, 296.0).opacity, 0.0);
  EXPECT_EQ(evaluate(f, 150.0).opacity, 0.0);
}

TEST(TransferFunction, ARangeOfOneValueIsStillSeenAndPointsStayInOrder) {
  const auto f = transferFunction({"",
                                   {tissue("thin", 40, 40, kRed, 0.5),  //
                                    tissue("next", 41, 42, kBlue, 0.9)}});
  EXPECT_DOUBLE_EQ(evaluate(f, 40).opacity, 0.5);
  EXPECT_EQ(evaluate(f, 40).colour, kRed);
  for (std::size_t i = 1; i < f.size(); ++i) EXPECT_LT(f[i - 1].hu, f[i].hu);
}

TEST(TransferFunction, ATissueOfALabelIsSeenThereBeforeOneOfAnyVoxelAndNowhereElse) {
  Tissue any = tissue("any", 0, 200, kRed, 0.5), bound = tissue("bound", 100, 300, kBlue, 0.9);
  bound.label = 2;
  const TissueSet set{"", {any, bound}};
  EXPECT_EQ(evaluate(transferFunction(set), 150).colour, kRed);
  EXPECT_EQ(evaluate(transferFunction(set), 250).opacity, 0.0);
  EXPECT_EQ(evaluate(transferFunction(set, 2), 50).colour, kRed);
  EXPECT_EQ(evaluate(transferFunction(set, 2), 150).colour, kBlue);
  EXPECT_EQ(evaluate(transferFunction(set, 2), 250).colour, kBlue);
}

TEST(TransferFunction, WhatRemovalLeavesIsClearInATissueThatHoldsItsHu) {
  const auto f = transferFunction({"", {tissue("all", -2000, 3000, kRed, 0.8)}});
  EXPECT_EQ(evaluate(f, kRemovedHu).opacity, 0.0);
  EXPECT_DOUBLE_EQ(evaluate(f, kRemovedHu + 30).opacity, 0.8);
  EXPECT_DOUBLE_EQ(evaluate(f, kRemovedHu - 30).opacity, 0.8);
  const auto near = transferFunction({"", {tissue("near", -999, -990, kRed, 0.8)}});
  EXPECT_GT(evaluate(near, -995).opacity, 0.0);
}

TEST(TransferFunction, SideBySideEachIsItselfInItsShare) {
  const auto one = transferFunction({"", {tissue("a", 0, 200, kRed, 0.5)}});
  const auto two = transferFunction({"", {tissue("b", 100, 4000, kBlue, 0.9)}});
  const auto all = sideBySide({one, {}, two}, -1024, 3071);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LT(all[i - 1].hu, all[i].hu);
  for (double hu = -1024; hu <= 3071; hu += 1.0) {
    const auto at = [&](std::size_t n) {
      return evaluate(all, sideBySide_HU(hu, n, 3, -1024, 3071));
    };
    ASSERT_NEAR(at(0).opacity, evaluate(one, hu).opacity, 1e-9) << hu;
    ASSERT_EQ(at(1).opacity, 0.0) << hu;
    ASSERT_NEAR(at(2).opacity, evaluate(two, hu).opacity, 1e-9) << hu;
    ASSERT_NEAR(glm::distance(at(2).colour, evaluate(two, hu).colour), 0.0, 1e-9) << hu;
  }
}

TEST(TransferFunction, FullOpacityStaysBelowOne) {
  const auto f = transferFunction({"", {tissue("a", 0, 1000, kRed, 1.0)}});
  EXPECT_DOUBLE_EQ(evaluate(f, 500).opacity, kMaxOpacity);
}

TEST(TransferFunction, AnEmptySetShowsNothing) {
  const auto f = transferFunction({});
  EXPECT_EQ(evaluate(f, 500).opacity, 0.0);
  EXPECT_TRUE(visibleIntervals(f).empty());
}

TEST(VisibleIntervals, HoldExactlyTheHuWithOpacity) {
  const auto f = transferFunction(
      {"",
       {tissue("skin", -200, 99, kRed, 0.1), tissue("hidden", 100, 299, kBlue, 0.0),
        tissue("bone", 300, 699, kRed, 0.6), tissue("hard", 700, 3071, kBlue, 0.9)}});
  const auto visible = visibleIntervals(f);
  ASSERT_EQ(visible.size(), 2u);
  for (double hu = -1100.5; hu < 3300; hu += 1.0) {
    const bool inside = (hu > visible[0].low && hu < visible[0].high) ||
                        (hu > visible[1].low && hu < visible[1].high);
    EXPECT_EQ(inside, evaluate(f, hu).opacity > 0.0) << hu;
  }
}

TEST(TransferFunction, ATissueFromRightAboveRemovedVoxelsHasARampThatATableCanHold) {
  const auto f = transferFunction({"", {tissue("organ", -999, 3000, kRed, 0.8)}});
  EXPECT_EQ(evaluate(f, kRemovedHu).opacity, 0.0);
  EXPECT_GT(evaluate(f, -995.0).opacity, 0.0);
  EXPECT_DOUBLE_EQ(evaluate(f, -970.0).opacity, 0.8);
  ASSERT_GE(f.size(), 2u);
  EXPECT_GE(f[1].hu - f[0].hu, kRampHalfWidth_HU);
}
