#include <gtest/gtest.h>

#include "machine/drawing/drawing_parts.h"

namespace trephine {
namespace {

TEST(DrawingSubjects, WithoutLabelsATissueKeepsWhatItIsByHuAlone) {
  Tissue liver, bone;
  liver.id = "liver";
  liver.label = 5;
  liver.hu_min = -1000;
  liver.hu_max = 1000;
  bone.id = "bone";
  bone.hu_min = 300;
  bone.hu_max = 3000;
  const TissueSet set = byHuAlone({"", {liver, bone}});
  EXPECT_FALSE(set.tissues[0].label);
  EXPECT_EQ(set.tissues[0].hu_min, 26);
  EXPECT_EQ(set.tissues[0].hu_max, 62);
  EXPECT_EQ(set.tissues[1].hu_min, 300);
}

}  // namespace
}  // namespace trephine
