// Segmentations in their place, out of it and mirrored, on real and built-in CTs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "imaging/importer.h"
#include "imaging/segmentation/structure_fit.h"
#include "structure_fit_support.h"
#include "thorough.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

// TotalSegmentator's names of what the real CTs have.
const std::map<int, std::string> kNames = {{1, "spleen"},
                                           {2, "kidney_right"},
                                           {3, "kidney_left"},
                                           {4, "gallbladder"},
                                           {5, "liver"},
                                           {6, "stomach"},
                                           {7, "pancreas"},
                                           {8, "adrenal_gland_right"},
                                           {9, "adrenal_gland_left"},
                                           {10, "lung_upper_lobe_left"},
                                           {11, "lung_lower_lobe_left"},
                                           {13, "lung_middle_lobe_right"},
                                           {14, "lung_lower_lobe_right"},
                                           {18, "small_bowel"},
                                           {19, "duodenum"},
                                           {20, "colon"},
                                           {30, "vertebrae_L2"},
                                           {31, "vertebrae_L1"},
                                           {32, "vertebrae_T12"},
                                           {33, "vertebrae_T11"},
                                           {52, "aorta"},
                                           {63, "inferior_vena_cava"},
                                           {64, "portal_vein_and_splenic_vein"},
                                           {69, "humerus_left"},
                                           {70, "humerus_right"},
                                           {79, "spinal_cord"},
                                           {86, "autochthon_left"},
                                           {87, "autochthon_right"},
                                           {88, "iliopsoas_left"},
                                           {89, "iliopsoas_right"},
                                           {97, "rib_left_6"},
                                           {98, "rib_left_7"},
                                           {99, "rib_left_8"},
                                           {100, "rib_left_9"},
                                           {101, "rib_left_10"},
                                           {102, "rib_left_11"},
                                           {103, "rib_left_12"},
                                           {109, "rib_right_6"},
                                           {110, "rib_right_7"},
                                           {111, "rib_right_8"},
                                           {112, "rib_right_9"},
                                           {113, "rib_right_10"},
                                           {114, "rib_right_11"},
                                           {115, "rib_right_12"},
                                           {117, "costal_cartilages"}};

struct Case {
  Volume ct;
  LabelMap truth;
};

// A file's labels, by the names above.
std::optional<LabelMap> labelsOf(const std::string& file) {
  auto of = readLabelMap(file);
  if (!of) return {};
  for (Structure& s : of->structures) s.name = kNames.at(s.label);
  return *std::move(of);
}

std::string realData() {
  const char* folder = std::getenv("TREPHINE_TEST_DATA");
  return folder ? std::string(folder) + "/abdomen-ct-totalsegmentator/" : "";
}

// 122 x 101 x 112 voxels of 3 mm; labels of 30 slices, put where they belong by hand.
constexpr int kFirstSlice = 82;
const Case* abdomenCt() {
  static const std::optional<Case> read = []() -> std::optional<Case> {
    auto ct = readVolume(realData() + "example_ct.nii.gz");
    auto labels = labelsOf(realData() + "example_seg.nii.gz");
    if (!ct || !labels) return {};
    labels->geometry.origin_mm = ct->geometry.toPatient_mm(Vec3(0, 0, kFirstSlice));
    return Case{*std::move(ct), *std::move(labels)};
  }();
  return read ? &*read : nullptr;
}

// 512 x 512 x 20 voxels of 1 x 1 x 2 mm, and labels of all of it.
const Case* abdomenDicom() {
  static const std::optional<Case> read = []() -> std::optional<Case> {
    auto folder = CtFolder::scan(realData() + "example_ct_dicom", Progress());
    if (!folder || !folder->bestSeries()) return {};
    auto ct = folder->read(*folder->bestSeries(), {}, Progress());
    auto labels = labelsOf(realData() + "example_seg_dicom.nii.gz");
    if (!ct || !labels) return {};
    labels = fitTo(*labels, ct->geometry).value();
    return Case{*std::move(ct), *std::move(labels)};
  }();
  return read ? &*read : nullptr;
}

#define REAL_OR_SKIP(name, function)                                       \
  if (realData().empty()) GTEST_SKIP() << "TREPHINE_TEST_DATA is not set"; \
  const Case* const name = function();                                     \
  ASSERT_NE(name, nullptr)

const std::set<int> kAll;

// Those alone; without names each is "label 7".
Segmentation segmentationOf(const LabelMap& truth, const std::set<int>& labels = kAll,
                            bool named = true) {
  Segmentation of{"NIfTI", truth.geometry, {truth.labels}, {}};
  of.named = named;
  for (const Structure& s : truth.structures) {
    if (!labels.empty() && !labels.contains(s.label)) continue;
    of.segments.push_back({named ? s.name : "label " + std::to_string(s.label), s.colour,
                           named ? s.tissue : "", 0, std::uint8_t(s.label)});
  }
  for (std::uint8_t& label : of.layers[0]) {
    if (!labels.empty() && !labels.contains(label)) label = 0;
  }
  return of;
}

// Every second voxel along each axis.
LabelMap halfOf(const LabelMap& map) {
  LabelMap half{map.geometry, {}, map.structures};
  for (std::size_t a = 0; a < 3; ++a) {
    half.geometry.size[a] = (map.geometry.size[a] + 1) / 2;
    half.geometry.spacing_mm[int(a)] *= 2.0;
  }
  const Index3& size = half.geometry.size;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        half.labels.push_back(map.labels[map.geometry.indexOf(2 * i, 2 * j, 2 * k)]);
      }
    }
  }
  return half;
}

Segmentation moved(Segmentation of, const Vec3& by_mm) {
  of.geometry.origin_mm += by_mm;
  return of;
}

// Turned about along an axis of its grid, which stays where it is.
LabelMap mirroredAlong(LabelMap map, std::size_t axis) {
  const std::vector<std::uint8_t> straight = map.labels;
  for (std::size_t v = 0; v < straight.size(); ++v) {
    Index3 at = map.geometry.indicesOf(v);
    at[axis] = map.geometry.size[axis] - 1 - at[axis];
    map.labels[map.geometry.indexOf(at[0], at[1], at[2])] = straight[v];
  }
  return map;
}

// "fits", or the code and what is said.
std::string answerTo(const Segmentation& of, const Volume& ct) {
  const auto fit = test::fitted(of, ct);
  return fit ? "fits" : fit.error().code.str() + ": " + fit.error().what;
}

bool asks(const Segmentation& of, const Volume& ct, const std::string& code) {
  const std::string answer = answerTo(of, ct);
  EXPECT_TRUE(answer.starts_with(code)) << answer;
  return answer.starts_with(code);
}

// Each structure alone and all together, with names and without, at full and half resolution, and
// off by a voxel of the CT along each axis.
// Thoroughly: from either resolution, all and each alone, named or not, in their place and a voxel
// off in six ways; else one of these changes at a time.
void expectTaken(const Case& of) {
  std::vector<std::set<int>> picks{kAll};
  for (const Structure& s : of.truth.structures) picks.push_back({s.label});
  for (const LabelMap& map : {of.truth, halfOf(of.truth)}) {
    for (const std::set<int>& labels : picks) {
      for (const bool named : {true, false}) {
        const Segmentation straight = segmentationOf(map, labels, named);
        if (std::ranges::count(straight.layers[0], 0) == std::ptrdiff_t(map.labels.size()))
          continue;
        const int changed = (map.geometry == of.truth.geometry ? 0 : 1) + (labels.empty() ? 0 : 1) +
                            (named ? 0 : 1);
        for (int way = 0; way < 7; ++way) {
          if (changed + (way > 0 ? 1 : 0) > test::thoroughly(4, 1)) continue;
          // Of one alone, in its place and along one axis: all would take a minute.
          if (way > 0 && labels.size() == 1 && way != 1 + *labels.begin() % 6) continue;
          Vec3 by(0.0);
          if (way > 0) by[(way - 1) / 2] = way % 2 ? 1.0 : -1.0;
          const Vec3 by_mm = of.ct.geometry.direction * (by * of.ct.geometry.spacing_mm);
          const std::string answer = answerTo(moved(straight, by_mm), of.ct);
          // A voxel of the last slice that is moved out of the CT.
          if (answer.starts_with("LABELS_ELSEWHERE")) continue;
          EXPECT_EQ(answer, "fits")
              << straight.segments.size() << " structures from " << straight.segments[0].name
              << ", voxels of " << map.geometry.spacing_mm.x << " mm, way " << way;
        }
      }
    }
  }
}

TEST(StructurePlace, RealStructuresInTheirPlaceAreTaken) {
  REAL_OR_SKIP(abdomen, abdomenCt);
  expectTaken(*abdomen);
}

TEST(StructurePlace, RealStructuresOfAFewThickSlicesAreTaken) {
  REAL_OR_SKIP(abdomen, abdomenDicom);
  expectTaken(*abdomen);
}

// The built-in abdomen at 3 mm, with its organs.
const Case& builtInAbdomen() {
  static const Case made = [] {
    GridGeometry g = *phantomGeometry("abdomen");
    for (std::size_t a = 0; a < 3; ++a) {
      g.size[a] = int(g.size[a] * g.spacing_mm[int(a)] / 3.0);
      g.spacing_mm[int(a)] = 3.0;
    }
    LabelMap truth = phantomLabelsOn(*phantomTruth("abdomen"), g);
    truth.structures = {{1, "liver"}, {2, "capsule"}, {3, "vessel"}, {4, "kidney"}, {5, "spleen"}};
    return Case{makePhantomOn(*phantomTruth("abdomen"), g, kPhantomNoiseHu), std::move(truth)};
  }();
  return made;
}

TEST(StructurePlace, BuiltInOrgansInTheirPlaceAreTaken) {
  expectTaken(builtInAbdomen());
}

// What is bone; the outermost 4 mm of all that is no air.
TEST(StructurePlace, TheBuiltInSkullAndSkinInTheirPlaceAreTaken) {
  GridGeometry g = *phantomGeometry("cranium");
  for (std::size_t a = 0; a < 3; ++a) {
    g.size[a] = int(g.size[a] * g.spacing_mm[int(a)] / 2.0);
    g.spacing_mm[int(a)] = 2.0;
  }
  Case head{makePhantomOn(*phantomTruth("cranium"), g, kPhantomNoiseHu), {g, {}, {}}};
  for (const std::int16_t hu : head.ct.hu) head.truth.labels.push_back(hu > -300);
  head.truth.labels = shellOf(head.truth, 1, 4.0);
  for (std::size_t v = 0; v < head.ct.hu.size(); ++v) {
    if (head.ct.hu[v] > 300) head.truth.labels[v] = 2;
  }
  head.truth.structures = {{1, "skin"}, {2, "skull"}};
  expectTaken(head);
}

TEST(StructurePlace, AHeaderThatPutsRealStructuresElsewhereIsAskedAbout) {
  REAL_OR_SKIP(abdomen, abdomenCt);
  for (const bool named : {true, false}) {
    const Segmentation of = segmentationOf(abdomen->truth, kAll, named);
    const std::string answer = answerTo(moved(of, Vec3(0, 0, -3.0 * kFirstSlice)), abdomen->ct);
    EXPECT_TRUE(answer.starts_with("HU_NOT_TISSUE")) << answer;
    EXPECT_NE(answer.find("about 82 slices (246 mm) nearer to the head"), std::string::npos)
        << answer;
  }
}

TEST(StructurePlace, RealStructuresThatAreAFewMillimetresOffAreAskedAbout) {
  REAL_OR_SKIP(abdomen, abdomenCt);
  for (const bool named : {true, false}) {
    const Segmentation of = segmentationOf(abdomen->truth, kAll, named);
    for (const double mm : {-60.0, -18.0, -12.0, -6.0, 6.0, 12.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        // What is moved up leaves the CT, and sideways by 60 mm some does.
        if ((axis == 2 && mm > 0.0) || (axis < 2 && mm < -20.0)) continue;
        Vec3 by(0.0);
        by[axis] = mm;
        EXPECT_TRUE(asks(moved(of, by), abdomen->ct, "HU_NOT_TISSUE"))
            << mm << " mm along " << axis << (named ? ", named" : "");
      }
    }
  }
}

TEST(StructurePlace, MirroredRealStructuresAreAskedAboutWithTheSidesNamed) {
  REAL_OR_SKIP(abdomen, abdomenDicom);
  for (const std::set<int>& labels : {kAll, {1, 5, 6, 52, 63}, {5}}) {
    for (const bool named : {true, false}) {
      const Segmentation of = segmentationOf(mirroredAlong(abdomen->truth, 0), labels, named);
      const std::string answer = answerTo(of, abdomen->ct);
      EXPECT_TRUE(answer.starts_with("MIRRORED")) << labels.size() << " labels: " << answer;
      EXPECT_NE(answer.find("left and right"), std::string::npos) << answer;
    }
  }
}

TEST(StructurePlace, RealStructuresMirroredAlongAnyAxisAreAskedAbout) {
  REAL_OR_SKIP(abdomen, abdomenCt);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool named : {true, false}) {
      EXPECT_TRUE(asks(segmentationOf(mirroredAlong(abdomen->truth, axis), kAll, named),
                       abdomen->ct, "MIRRORED"))
          << "axis " << axis << (named ? ", named" : "");
    }
  }
}

}  // namespace
}  // namespace trephine
