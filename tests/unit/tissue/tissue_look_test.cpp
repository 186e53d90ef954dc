#include "tissue/tissue_look.h"

#include <gtest/gtest.h>

#include "base/system.h"

namespace trephine {
namespace {

Tissue clearTissue(const char* id, double opacity) {
  Tissue t;
  t.id = id;
  t.opacity = opacity;
  return t;
}

double opacityOf(const TissueSet& set, const char* id) {
  return set.find(id)->opacity;
}

const TissueSet kSet{
    "", {clearTissue("fat", 0.0), clearTissue("liver", 0.25), clearTissue("bone", 0.9)}};

TEST(TissueLook, OfATissueThatIsNotNamedIsThatOfItsSet) {
  EXPECT_EQ(lookOf(kSet.tissues[0], {}), TissueLook::hidden);
  EXPECT_EQ(lookOf(kSet.tissues[1], {}), TissueLook::shown);
  const TissueSet seen = asSeen(kSet, {});
  for (const Tissue& t : kSet.tissues) EXPECT_EQ(opacityOf(seen, t.id.c_str()), t.opacity) << t.id;
}

TEST(TissueLook, WhatIsNamedAsShownOrGhostedIsSeenThoughTheSetHasItClear) {
  EXPECT_EQ(opacityOf(asSeen(kSet, {{"fat", TissueLook::shown}}), "fat"), kSeenOpacity);
  EXPECT_EQ(opacityOf(asSeen(kSet, {{"fat", TissueLook::ghosted}}), "fat"), kSeenOpacity);
  EXPECT_EQ(opacityOf(asSeen(kSet, {{"liver", TissueLook::shown}}), "liver"), 0.25);
}

TEST(TissueLook, WhatIsHiddenIsNotSeenAndNothingElseOfItChanges) {
  const TissueSet seen = asSeen(kSet, {{"bone", TissueLook::hidden}});
  EXPECT_EQ(opacityOf(seen, "bone"), 0.0);
  EXPECT_EQ(opacityOf(seen, "liver"), 0.25);
  EXPECT_EQ(tissueTable(seen), tissueTable(kSet)) << "what is felt";
}

TEST(TissueLook, SeenTwiceIsAsSeenOnce) {
  const TissueLooks looks{{"fat", TissueLook::shown}, {"bone", TissueLook::ghosted}};
  const TissueSet once = asSeen(kSet, looks), twice = asSeen(once, looks);
  for (const Tissue& t : once.tissues) EXPECT_EQ(opacityOf(twice, t.id.c_str()), t.opacity) << t.id;
}

using Offered = std::vector<ViewPreset>;
Offered offered(const TissueSet& set) {
  Offered presets;
  for (const ViewPreset preset : kViewPresets) {
    if (presetLooks(set, preset)) presets.push_back(preset);
  }
  return presets;
}

TEST(ViewPresets, AreOfferedWhereTheShippedSetsHaveTheirTissue) {
  const auto folder = resourceFolder() / "tissues";
  EXPECT_EQ(offered(*readTissueSet(folder / "cranium.json")),
            (Offered{ViewPreset::bone, ViewPreset::skin, ViewPreset::soft_tissue}));
  EXPECT_EQ(
      offered(*readTissueSet(folder / "abdomen.json")),
      (Offered{ViewPreset::bone, ViewPreset::skin, ViewPreset::soft_tissue, ViewPreset::liver}));
  EXPECT_EQ(offered({"", {clearTissue("steel", 1.0)}}), Offered{ViewPreset::soft_tissue});
  EXPECT_EQ(offered({"", {clearTissue("steel", 0.0)}}), Offered{});
}

TEST(ViewPresets, NameEveryTissueSoThatNoneIsLeftAsTheLastPresetHadIt) {
  for (const char* name : {"cranium.json", "abdomen.json"}) {
    const TissueSet set = *readTissueSet(resourceFolder() / "tissues" / name);
    for (const ViewPreset preset : offered(set)) {
      EXPECT_EQ(presetLooks(set, preset)->size(), set.tissues.size()) << name;
    }
  }
}

TEST(ViewPresets, BoneIsAloneSkinIsSolidAndTheLiverIsSeenThroughGhostsOfBone) {
  const TissueSet set = *readTissueSet(resourceFolder() / "tissues" / "abdomen.json");
  const TissueLooks bone = *presetLooks(set, ViewPreset::bone);
  for (const auto& [id, look] : bone) {
    EXPECT_EQ(look, id == "bone" ? TissueLook::shown : TissueLook::hidden) << id;
  }
  const TissueSet skin = asSeen(set, *presetLooks(set, ViewPreset::skin));
  EXPECT_EQ(opacityOf(skin, "skin"),
            set.find("skin")->opacity > 0 ? set.find("skin")->opacity : kSeenOpacity);
  const TissueLooks liver = *presetLooks(set, ViewPreset::liver);
  EXPECT_EQ(liver.at("liver"), TissueLook::shown);
  EXPECT_EQ(liver.at("vessel"), TissueLook::shown);
  EXPECT_EQ(liver.at("bone"), TissueLook::ghosted);
  EXPECT_EQ(liver.at("muscle"), TissueLook::hidden);
  EXPECT_EQ(presetLooks(set, ViewPreset::soft_tissue)->at("bone"), TissueLook::ghosted);
}

TEST(ViewPresets, TheLiverHasItsCapsuleWhereALabelTellsItFromWhatHasTheSameHu) {
  const auto capsule = [](const char* file) {
    const TissueSet set = *readTissueSet(resourceFolder() / "tissues" / file);
    return presetLooks(set, ViewPreset::liver)->at("capsule");
  };
  EXPECT_EQ(capsule("abdomen.json"), TissueLook::hidden);
  EXPECT_EQ(capsule("abdomen-labels.json"), TissueLook::shown);
}

}  // namespace
}  // namespace trephine
