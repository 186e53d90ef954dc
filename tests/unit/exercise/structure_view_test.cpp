#include "exercise/structure_view.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

Tissue tissue(const char* id, const char* structure = "") {
  Tissue t;
  t.id = t.name = id;
  t.hu_min = -100;
  t.hu_max = 100;
  t.structure = structure;
  t.colour = Vec3(0.5, 0.2, 0.1);
  t.opacity = 0.8;
  return t;
}

TissueSet liverAndBone() {
  return {"set", {tissue("liver", "liver"), tissue("bone")}};
}

std::vector<Structure> structures(int count, const char* first = "liver") {
  std::vector<Structure> made{{1, first, Vec3(0, 0, 1)}};
  for (int label = 2; label <= count; ++label) {
    made.push_back({label, "structure " + std::to_string(label), labelColour(label)});
  }
  return made;
}

TEST(SeenTissues, AStructureThatNoTissueIsOfHasOneOfItsOwnInItsColour) {
  const TissueSet exercise = liverAndBone();
  const SeenTissues seen = withStructures(exercise, {}, structures(2), {});
  ASSERT_EQ(seen.tissues.tissues.size(), 3u);
  const Tissue& own = seen.tissues.tissues.back();
  EXPECT_EQ(own.label, 2);
  EXPECT_EQ(own.colour, labelColour(2));
  EXPECT_EQ(own.opacity, kSeenOpacity);
  EXPECT_EQ(lookOf(own, seen.looks), TissueLook::shown);
  // Whatever HU it has, as removal and all.
  EXPECT_LE(own.hu_min, -3024);
  EXPECT_GE(own.hu_max, 3071);
  // The exercise's keep what is theirs.
  EXPECT_EQ(seen.tissues.tissues[0].colour, exercise.tissues[0].colour);
  EXPECT_FALSE(seen.tissues.tissues[1].label);
}

TEST(SeenTissues, AStructureOfATissueLooksAsThatDoes) {
  const SeenTissues seen =
      withStructures(liverAndBone(), {{"liver", TissueLook::ghosted}}, structures(1, "Liver"), {});
  ASSERT_EQ(seen.tissues.tissues.size(), 2u);
  EXPECT_EQ(seen.tissues.tissues[0].label, 1);
  ASSERT_EQ(seen.structures.size(), 1u);
  EXPECT_EQ(seen.structures[0].look, TissueLook::ghosted);
  EXPECT_EQ(seen.structures[0].opacity, 0.8);
}

TEST(SeenTissues, ATissueWhoseStructureIsNotThereIsNowhere) {
  const SeenTissues seen = withStructures(liverAndBone(), {}, structures(3, "spleen"), {});
  ASSERT_TRUE(seen.tissues.tissues[0].label);
  EXPECT_GT(*seen.tissues.tissues[0].label, 3);
}

TEST(SeenTissues, WhatWasChosenIsSeen) {
  const SeenTissues seen = withStructures(liverAndBone(), {}, structures(2),
                                          {{1, {{}, 0.3}}, {2, {TissueLook::ghosted, 0.2}}});
  EXPECT_EQ(seen.tissues.tissues[0].opacity, 0.3);
  EXPECT_EQ(seen.tissues.tissues[2].opacity, 0.2);
  EXPECT_EQ(lookOf(seen.tissues.tissues[2], seen.looks), TissueLook::ghosted);
}

TEST(SeenTissues, BeyondWhatAPictureHoldsTheHiddenOnesHaveNoRoomFirst) {
  const int most = kMaxTissues - 2;  // beside liver and bone; the first structure is the liver's
  const auto made = structures(1 + most + 2);
  StructureLooks chosen{{2, {TissueLook::hidden, {}}}};
  const SeenTissues seen = withStructures(liverAndBone(), {}, made, chosen);
  EXPECT_EQ(int(seen.tissues.tissues.size()), kMaxTissues);
  std::vector<int> without;
  for (const SeenStructure& s : seen.structures) {
    if (!s.has_room) without.push_back(s.label);
  }
  EXPECT_EQ(without, (std::vector<int>{2, 1 + most + 2}));
  // The one that is looked at goes before all, but where it is hidden itself.
  const int last = 1 + most + 2;
  const auto hasRoom = [&](int label, int first) {
    const SeenTissues now = withStructures(liverAndBone(), {}, made, chosen, first);
    return now.structures[std::size_t(label - 1)].has_room;
  };
  EXPECT_TRUE(hasRoom(last, last));
  EXPECT_FALSE(hasRoom(last - 1, last));
  EXPECT_FALSE(hasRoom(2, 2));
}

TEST(SeenTissues, WhatWasChosenBeforeATissueWasOfItIsThatTissuesThen) {
  StructureLooks chosen{{1, {TissueLook::ghosted, 0.4}}, {2, {TissueLook::hidden, {}}}};
  TissueLooks looks;
  handToTissues(chosen, looks, liverAndBone(), structures(2));
  EXPECT_EQ(looks, (TissueLooks{{"liver", TissueLook::ghosted}}));
  EXPECT_FALSE(chosen[1].look);
  EXPECT_EQ(chosen[1].opacity, 0.4);
  EXPECT_EQ(chosen[2].look, TissueLook::hidden);
}

TEST(SeenTissues, ANewStructureHasTheColourOfTheTissueOfItsName) {
  const TissueSet set = liverAndBone();
  EXPECT_EQ(colourOfNew(set, "Liver", 4), set.tissues[0].colour);
  EXPECT_EQ(colourOfNew(set, "bone", 4), set.tissues[1].colour);
  EXPECT_EQ(colourOfNew(set, "spleen", 4), labelColour(4));
}

}  // namespace
}  // namespace trephine
