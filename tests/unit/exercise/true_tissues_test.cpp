#include "exercise/true_tissues.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "base/system.h"
#include "exercise/cut_tally.h"
#include "support.h"
#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

enum { kScalp, kBrain, kDura, kBone };

TissueSet cranium() {
  return *readTissueSet(resourceFolder() / "tissues" / "cranium.json");
}

// HU by the distance from the middle of a head of 80 mm, as a scanner with a spread of 0.6 mm and
// 8 HU of noise sees it: brain to 30 mm, bone to 35, fat to 40, muscle on one side up to there.
constexpr double kBrainTo_mm = 30.0, kBoneTo_mm = 35.0, kFatTo_mm = 40.0;
bool isMuscle(const Vec3& mm) {
  return mm.x > 0.8 * glm::length(mm) && glm::length(mm) > kBoneTo_mm + 0.5;
}
double huAt(const Vec3& mm) {
  const double r = glm::length(mm);
  const auto over = [&](double border) { return 0.5 * std::erfc((border - r) / (0.6 * M_SQRT2)); };
  return 35.0 + (1200.0 - 35.0) * over(kBrainTo_mm) +
         ((mm.x > 0.8 * r ? 50.0 : -80.0) - 1200.0) * over(kBoneTo_mm) +
         (-1000.0 - (mm.x > 0.8 * r ? 50.0 : -80.0)) * over(kFatTo_mm);
}
Volume head() {
  GridGeometry g;
  g.size = {108, 108, 88};
  g.spacing_mm = {0.8, 0.8, 1.0};
  g.origin_mm = -0.5 * g.spacing_mm * Vec3(107, 107, 87);
  Volume head{g, Voxels(g.voxelCount())};
  for (std::size_t v = 0; v < head.hu.size(); ++v) {
    const Index3 at = g.indicesOf(v);
    const double noise = double((v * 2654435761u >> 9) % 29) - 14.0;
    head.hu[v] = std::int16_t(huAt(g.toPatient_mm(Vec3(at[0], at[1], at[2]))) + noise);
  }
  return head;
}
Vec3 place(const Volume& of, std::size_t voxel) {
  const Index3 at = of.geometry.indicesOf(voxel);
  return of.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
}

TEST(TrueTissues, OutsideASkullNothingIsBrainOrDura) {
  const Volume ct = head();
  const TissueSet set = cranium();
  const TrueTissues tissues(set, ct, nullptr, "");
  const TissueTable table = tissueTable(set);
  int by_hu = 0, said = 0, muscle = 0;
  for (std::size_t v = 0; v < ct.hu.size(); ++v) {
    const Vec3 mm = place(ct, v);
    if (glm::length(mm) < kBoneTo_mm + 0.2) continue;
    const int plain = classify(table, ct.hu[v]), of = tissues.at(v);
    by_hu += plain == kBrain || plain == kDura;
    muscle += isMuscle(mm);
    said += of == kBrain || of == kDura;
  }
  EXPECT_GT(by_hu, 5000) << "the edge of bone and fat, and muscle, have such HU";
  EXPECT_GT(muscle, 1000);
  EXPECT_EQ(said, 0);
}

TEST(TrueTissues, InsideEachLayerIsWhatItIs) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  std::map<int, std::pair<int, int>> right;  // by tissue: of all
  for (std::size_t v = 0; v < ct.hu.size(); ++v) {
    const Vec3 mm = place(ct, v);
    const double r = glm::length(mm);
    const int is = r < kBrainTo_mm - 1.5                                           ? kBrain
                   : r > kBrainTo_mm + 1.0 && r < kBoneTo_mm - 1.0                 ? kBone
                   : r > kBoneTo_mm + 1.0 && r < kFatTo_mm - 1.0 && mm.x < 0.6 * r ? kScalp
                                                                                   : -1;
    if (is < 0) continue;
    right[is].first += tissues.at(v) == is;
    ++right[is].second;
  }
  for (const auto& [tissue, of] : right) {
    EXPECT_GT(of.second, 5000) << tissue;
    EXPECT_GE(of.first, 0.98 * of.second) << tissue;
  }
}

TEST(TrueTissues, AnEdgeIsOfTheSideThatItIsMostlyOfOrOfNone) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  int bone = 0, none = 0, other = 0;
  for (std::size_t v = 0; v < ct.hu.size(); ++v) {
    const double r = glm::length(place(ct, v));
    if (std::abs(r - kBoneTo_mm) > 0.3 || place(ct, v).x > 0.6 * r) continue;
    const int of = tissues.at(v);
    ++(of == kBone ? bone : of == TrueTissues::kUnnamed || of == kScalp ? none : other);
  }
  EXPECT_GT(bone, 1000);
  EXPECT_GT(none, 1000);
  EXPECT_EQ(other, 0);
}

// Layers along x, from a voxel on: sharp, without noise.
Volume layers(const std::vector<std::pair<int, int>>& from_hu) {
  GridGeometry g;
  g.size = {40, 12, 12};
  Volume volume{g, Voxels(g.voxelCount())};
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    for (const auto& [from, hu] : from_hu) {
      if (g.indicesOf(v)[0] >= from) volume.hu[v] = std::int16_t(hu);
    }
  }
  return volume;
}

TEST(TrueTissues, ThinBoneIsBoneWhateverLiesBehindIt) {
  TissueSet set = cranium();
  for (Tissue& tissue : set.tissues) tissue.within.clear();
  for (const int before : {-1000, -80, 60}) {
    for (const int behind : {35, -80, 60}) {
      for (const int thick : {1, 2, 3, 4}) {
        const Volume ct = layers({{0, before}, {20, 900}, {20 + thick, behind}});
        const TrueTissues tissues(set, ct, nullptr, "");
        for (int i = 20; i < 20 + thick; ++i) {
          EXPECT_EQ(tissues.at(ct.geometry.indexOf(i, 6, 6)), kBone)
              << thick << " voxels between " << before << " and " << behind << " HU, the " << i - 19
              << "th";
        }
      }
    }
  }
}

// A scan of half a head, from its middle on.
TEST(TrueTissues, BrainIsBrainInAScanThatHoldsAPartOfTheSkull) {
  const Volume whole = head();
  Volume half;
  half.geometry = whole.geometry;
  half.geometry.size[2] /= 2;
  half.hu.assign(whole.hu.begin() + std::ptrdiff_t(half.geometry.voxelCount()), whole.hu.end());
  half.geometry.origin_mm.z += half.geometry.size[2] * half.geometry.spacing_mm.z;
  const TrueTissues tissues(cranium(), half, nullptr, "");
  int brain = 0, named = 0, outside = 0;
  for (std::size_t v = 0; v < half.hu.size(); ++v) {
    const double r = glm::length(place(half, v));
    const int of = tissues.at(v);
    if (r < kBrainTo_mm - 2.0) ++brain, named += of == kBrain;
    if (r > kBoneTo_mm + 0.2) outside += of == kBrain || of == kDura;
  }
  EXPECT_GT(brain, 20000);
  EXPECT_GE(named, 0.95 * brain);
  EXPECT_EQ(outside, 0);
}

TEST(TrueTissues, WhatEnclosesInABuiltInAbdomenIsNoSkull) {
  const GridGeometry g = *phantomGeometry("abdomen");
  const PhantomTruth truth = *phantomTruth("abdomen");
  Volume ct{g, Voxels(g.voxelCount(), 0)};
  std::size_t kidney = 0;
  for (std::size_t v = 0; v < ct.hu.size(); ++v) {
    const bool is = truth(place(ct, v)) == PhantomTissue::kidney;
    ct.hu[v] = is ? 120 : 40;
    if (is && kidney == 0) kidney = v;
  }
  TissueSet set = startingSet("two");
  set.tissues[0].hu_min = 100;
  set.tissues[0].hu_max = 200;
  set.tissues[1].hu_min = 0;
  set.tissues[1].hu_max = 90;
  set.tissues[0].within = set.tissues[1].id;
  EXPECT_EQ(TrueTissues(set, ct, nullptr, "phantom:abdomen").at(kidney), 0);
}

TEST(TrueTissues, ALabelSaysExactlyWhateverTheHu) {
  Volume ct = head();
  LabelMap labels{ct.geometry, std::vector<std::uint8_t>(ct.hu.size()), {{4, "brain", Vec3(1.0)}}};
  TissueSet set = cranium();
  set.tissues[kBrain].label = 4;
  const std::size_t scalp = ct.geometry.indexOf(54, 8, 44), air = ct.geometry.indexOf(0, 0, 0);
  labels.labels[scalp] = labels.labels[air] = 4;
  const TrueTissues tissues(set, ct, &labels, "");
  EXPECT_EQ(tissues.at(scalp), kBrain) << "at " << ct.hu[scalp] << " HU";
  EXPECT_EQ(tissues.at(air), kBrain);
  EXPECT_NE(tissues.at(scalp + 1), kBrain);
  LabelMap other = labels;
  other.labels.pop_back();
  EXPECT_NE(TrueTissues(set, ct, &other, "").at(scalp), kBrain) << "labels of another grid";
}

TEST(TrueTissues, OfABuiltInCaseItsFormulaSays) {
  const GridGeometry g = *phantomGeometry("cranium");
  const Volume ct{g, Voxels(g.voxelCount(), 40)};  // whatever its HU
  const TissueSet set = cranium();
  const TrueTissues tissues(set, ct, nullptr, "phantom:cranium");
  const PhantomTruth truth = *phantomTruth("cranium");
  std::map<PhantomTissue, int> met;
  for (std::size_t v = 0; v < ct.hu.size(); v += 997) {
    const PhantomTissue is = truth(place(ct, v));
    ++met[is];
    int expected = TrueTissues::kUnnamed;  // eye and muscle have HU of brain and dura
    switch (is) {
      case PhantomTissue::scalp:
      case PhantomTissue::fat:
        expected = kScalp;
        break;
      case PhantomTissue::outerTable:
      case PhantomTissue::diploe:
      case PhantomTissue::innerTable:
      case PhantomTissue::bone:
      case PhantomTissue::marrow:
      case PhantomTissue::facialBone:
        expected = kBone;
        break;
      case PhantomTissue::dura:
        expected = kDura;
        break;
      case PhantomTissue::csf:
      case PhantomTissue::greyMatter:
      case PhantomTissue::whiteMatter:
      case PhantomTissue::ventricle:
        expected = kBrain;
        break;
      default:
        break;
    }
    EXPECT_EQ(tissues.at(v), expected) << phantomTissueName(is);
  }
  for (const PhantomTissue is : {PhantomTissue::eye, PhantomTissue::muscle, PhantomTissue::dura,
                                 PhantomTissue::scalp, PhantomTissue::csf}) {
    EXPECT_GT(met[is], 0) << phantomTissueName(is);
  }
}

TEST(TrueTissues, AFormulaIsNotAskedOnAnotherGridThanItsCases) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "phantom:cranium");
  EXPECT_EQ(tissues.at(ct.geometry.indexOf(54, 54, 44)), kBrain) << "by HU";
}

// Bone in specks among brain, and a sharp wall of it: no mean of two makes it the dura between.
TEST(TrueTissues, AMeanOfTwoTissuesIsNoThird) {
  Volume ct;
  ct.geometry.size = {48, 48, 48};
  ct.geometry.spacing_mm = Vec3(0.5);
  ct.hu.assign(ct.geometry.voxelCount(), -1000);
  for (std::size_t v = 0; v < ct.hu.size(); ++v) {
    const double r = glm::length(place(ct, v) - Vec3(11.75));
    const bool speck = (v * 2654435761u >> 9) % 50 == 0;
    if (r < 11.0) ct.hu[v] = r > 9.0 || speck ? 900 : 30;
  }
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  std::map<int, int> named;
  for (std::size_t v = 0; v < ct.hu.size(); ++v) ++named[tissues.at(v)];
  EXPECT_GT(named[kBrain], 15000);
  EXPECT_GT(named[kBone], 5000);
  EXPECT_EQ(named[kDura], 0);
}

TEST(TrueTissues, WhatIsKnownOfPlacesChangesNoName) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  TrueTissues::Enclosed known;
  for (std::size_t v = 0; v < ct.hu.size(); v += 17) {
    ASSERT_EQ(tissues.at(v, &known), tissues.at(v)) << v;
  }
  EXPECT_GT(known.size(), 100u);
}

// ---- What was cut.

void cutBall(Volume& of, double radius_mm, const Vec3& at_mm) {
  for (std::size_t v = 0; v < of.hu.size(); ++v) {
    if (glm::distance(place(of, v), at_mm) < radius_mm) of.hu[v] = kRemovedHu;
  }
}
CutVoxels wholeTally(CutTally& tally, const Volume& now, const VoxelBox& box,
                     const CutTally::Step& step, int& steps) {
  for (steps = 1; !tally.look(now, box, step) && steps < 100000;) ++steps;
  return tally.counts();
}

TEST(CutTally, FindsInStepsWhatALookAtAllVoxelsFinds) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  LabelMap structures{ct.geometry, std::vector<std::uint8_t>(ct.hu.size(), 3), {}};
  Volume now = ct;
  cutBall(now, 4.0, Vec3(0.0, -34.0, 0.0));
  const VoxelBox all{{0, 0, 0}, ct.geometry.size};
  CutVoxels expected = cutVoxels(tissues, ct, Grid(Volume(now)));
  EXPECT_GT(expected.of_tissue[kBone], 100u);
  EXPECT_GT(expected.of_tissue[kScalp], 50u);
  EXPECT_GT(expected.unnamed, 20u);
  std::uint64_t sum = expected.unnamed;
  for (const std::uint64_t one : expected.of_tissue) sum += one;
  expected.of_label[3] = sum;
  for (const CutTally::Step& step : {CutTally::Step{}, {5000, 7}, {1, 1'000'000}}) {
    CutTally tally(tissues, ct, &structures);
    int steps = 0;
    EXPECT_EQ(wholeTally(tally, now, all, step, steps), expected);
    EXPECT_EQ(steps > 1, step.voxels < 1000u * 1000u || step.names < 100) << steps;
  }
}

TEST(CutTally, FollowsWhatIsCutAndWhatIsPutBack) {
  const Volume ct = head();
  const TrueTissues tissues(cranium(), ct, nullptr, "");
  CutTally tally(tissues, ct, nullptr);
  const VoxelBox all{{0, 0, 0}, ct.geometry.size};
  Volume first = ct, second = ct;
  cutBall(first, 3.0, Vec3(0.0, -32.0, 0.0));
  cutBall(second, 5.0, Vec3(0.0, -32.0, 0.0));
  int steps = 0;
  for (const Volume* now : std::initializer_list<const Volume*>{&first, &second, &first, &ct}) {
    EXPECT_EQ(wholeTally(tally, *now, all, {}, steps), cutVoxels(tissues, ct, Grid(Volume(*now))));
  }
  EXPECT_EQ(tally.counts(), CutVoxels{});
  EXPECT_TRUE(tally.look(ct, VoxelBox{}, {})) << "nothing was touched";
}

}  // namespace
}  // namespace trephine
