#include <gtest/gtest.h>

#include "imaging/codes.h"
#include "imaging/segmentation/structure_fit.h"
#include "structure_fit_support.h"
#include "volume/phantom.h"

namespace trephine {
namespace {

// The built-in abdomen at 6 mm, with the truth of its organs.
struct Abdomen {
  Volume ct;
  LabelMap truth;
};

const Abdomen& abdomen() {
  static const Abdomen made = [] {
    GridGeometry g = *phantomGeometry("abdomen");
    for (std::size_t a = 0; a < 3; ++a) {
      g.size[a] = int(g.size[a] * g.spacing_mm[int(a)] / 6.0);
      g.spacing_mm[int(a)] = 6.0;
    }
    Abdomen of{makePhantomOn(*phantomTruth("abdomen"), g, kPhantomNoiseHu),
               phantomLabelsOn(*phantomTruth("abdomen"), g)};
    of.truth.structures = {
        {1, "liver"}, {2, "capsule"}, {3, "vessel"}, {4, "kidney"}, {5, "spleen"}};
    return of;
  }();
  return made;
}

Segmentation liverOf(const LabelMap& truth) {
  Segmentation of;
  of.format = "NIfTI";
  of.geometry = truth.geometry;
  of.layers.assign(1, std::vector<std::uint8_t>(truth.labels.size()));
  for (std::size_t v = 0; v < truth.labels.size(); ++v) of.layers[0][v] = truth.labels[v] == 1;
  of.segments = {{"liver", Vec3(0.5, 0.2, 0.2), "", 0, 1}};
  return of;
}

bool found(const std::vector<Finding>& findings, const std::string& code) {
  return std::ranges::any_of(findings, [&](const Finding& f) { return f.code.str() == code; });
}

std::string codeOf(const Segmentation& of, const Answers& answers = {}, bool ask_all = true) {
  const auto fit = test::fitted(of, abdomen().ct, answers, ask_all);
  return fit ? "fits" : fit.error().code.str();
}

TEST(StructureFit, AFittingLiverIsTakenAsItIs) {
  const Segmentation of = liverOf(abdomen().truth);
  const auto fit = test::fitted(of, abdomen().ct);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->map.labels, of.layers[0]);
  ASSERT_EQ(fit->structures.size(), 1u);
  const StructureCard& liver = fit->structures[0];
  EXPECT_EQ(liver.name, "liver");
  EXPECT_DOUBLE_EQ(liver.ml, liver.ml_in_file);
  EXPECT_NEAR((*liver.hu)[1], 50.0, 5.0);
  EXPECT_DOUBLE_EQ(fit->covers_percent, 100.0);
  EXPECT_FALSE(fit->resampled);
  EXPECT_TRUE(fit->findings.empty());
  EXPECT_TRUE(fit->choices.empty());
}

// The same structure in slices [low, high) alone, its grid moved by so much.
Segmentation part(int low, int high, const Vec3& moved_mm = Vec3(0.0)) {
  const Segmentation whole = liverOf(abdomen().truth);
  Segmentation of = whole;
  const GridGeometry& g = whole.geometry;
  of.geometry.size[2] = high - low;
  of.geometry.origin_mm = g.toPatient_mm(Vec3(0, 0, low)) + moved_mm;
  const std::size_t slice = std::size_t(g.size[0]) * std::size_t(g.size[1]);
  of.layers[0].assign(whole.layers[0].begin() + std::ptrdiff_t(slice * std::size_t(low)),
                      whole.layers[0].begin() + std::ptrdiff_t(slice * std::size_t(high)));
  return of;
}

TEST(StructureFit, WhatCoversAPartOfTheCtSaysWhich) {
  const int slices = abdomen().ct.geometry.size[2];
  const auto fit = test::fitted(part(slices / 2, slices / 2 + 5), abdomen().ct);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_NEAR(fit->covers_percent, 500.0 / slices, 1e-9);
  EXPECT_EQ(fit->covers.low[2], slices / 2);
  EXPECT_EQ(fit->covers.high[2], slices / 2 + 5);
  ASSERT_EQ(fit->findings.size(), 1u);
  const Finding& finding = fit->findings[0];
  EXPECT_EQ(finding.code.str(), "PART_OF_CT");
  const std::string words = "slices " + std::to_string(slices / 2 + 1) + " to " +
                            std::to_string(slices / 2 + 5) + " of " + std::to_string(slices) +
                            " (30 of";
  EXPECT_NE(finding.text.find(words), std::string::npos) << finding.text;
}

TEST(StructureFit, WhatLiesElsewhereOrHalfOutsideIsRefusedByName) {
  const int slices = abdomen().ct.geometry.size[2];
  EXPECT_EQ(codeOf(part(0, slices, Vec3(0, 0, 3000))), "LABELS_ELSEWHERE");
  const double far_mm = 6.0 * slices * 0.6;
  const auto fit = test::fitted(part(0, slices, Vec3(0, 0, far_mm)), abdomen().ct);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code.str(), "HALF_OUTSIDE");
  EXPECT_NE(fit.error().what.find("'liver'"), std::string::npos);
}

TEST(StructureFit, APartThatIsOutsideIsLeftOutAndSaid) {
  const int slices = abdomen().ct.geometry.size[2];
  // Up until a quarter of it or so is beyond the scan.
  for (double by_mm = 0.0; by_mm < 6.0 * slices; by_mm += 6.0) {
    const auto fit = test::fitted(part(0, slices, Vec3(0, 0, by_mm)), abdomen().ct,
                                  {{code::kHuNotTissue, "keep"}});
    if (!fit || fit->structures[0].outside_percent < 10.0) continue;
    EXPECT_TRUE(found(fit->structures[0].findings, "OUTSIDE"));
    EXPECT_NEAR(fit->structures[0].ml,
                fit->structures[0].ml_in_file * (1.0 - fit->structures[0].outside_percent / 100.0),
                1e-6);
    return;
  }
  FAIL() << "it never reached the border";
}

// Left and right have changed places.
Segmentation mirroredLiver() {
  Segmentation of = liverOf(abdomen().truth);
  const GridGeometry& g = of.geometry;
  const auto straight = of.layers[0];
  for (std::size_t v = 0; v < straight.size(); ++v) {
    const Index3 at = g.indicesOf(v);
    of.layers[0][g.indexOf(g.size[0] - 1 - at[0], at[1], at[2])] = straight[v];
  }
  return of;
}

TEST(StructureFit, AMirroredLiverIsRefusedWithTheSidesNamed) {
  const Segmentation of = mirroredLiver();
  const auto fit = test::fitted(of, abdomen().ct);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code.str(), "MIRRORED");
  EXPECT_NE(fit.error().what.find("left and right"), std::string::npos) << fit.error().what;
}

TEST(StructureFit, AMirroredOneIsTakenWhereAPersonSaysSoAndNotElse) {
  const Segmentation of = mirroredLiver();
  EXPECT_EQ(codeOf(of, {}, false), "MIRRORED") << "nor where nobody is asked";
  EXPECT_EQ(codeOf(of, {{code::kMirrored, "keep"}, {code::kHuNotTissue, "keep"}}), "fits");
}

// Each structure alone, in its place: whatever would have closer HU elsewhere.
TEST(StructureFit, NothingThatLiesInItsPlaceIsTakenForMirrored) {
  const LabelMap& truth = abdomen().truth;
  for (const Structure& s : truth.structures) {
    for (const std::string& name : {s.name, std::string("target"), std::string("vertebra")}) {
      Segmentation of = liverOf(truth);
      for (std::size_t v = 0; v < truth.labels.size(); ++v) {
        of.layers[0][v] = truth.labels[v] == s.label;
      }
      of.segments[0].name = name;
      EXPECT_NE(codeOf(of, {}, false), "MIRRORED") << s.name << " as " << name;
    }
  }
}

// Organs in their places, in a CT of which the file has a part: 82 slices too low they lie on
// something else, and so they do turned about.
TEST(StructureFit, WhatLiesTooLowIsAskedAboutByItsHuAndNotCalledMirrored) {
  const int slices = abdomen().ct.geometry.size[2];
  Segmentation of = part(slices / 2, slices * 3 / 4);
  of.geometry.origin_mm = abdomen().ct.geometry.origin_mm;
  const std::string code = codeOf(of);
  EXPECT_TRUE(code == "HU_NOT_TISSUE" || code == "fits") << code;
}

TEST(StructureFit, WhatAnObliqueFileCoversIsCounted) {
  Segmentation of = liverOf(abdomen().truth);
  const Vec3 middle = of.geometry.centre_mm();
  of.geometry.direction =
      glm::mat3_cast(glm::angleAxis(glm::radians(45.0), Vec3(0, 0, 1))) * of.geometry.direction;
  of.geometry.origin_mm += middle - of.geometry.centre_mm();
  const auto fit = test::fitted(of, abdomen().ct, {{code::kHuNotTissue, "keep"}}, false);
  ASSERT_TRUE(fit) << fit.error().sentence();
  const GridGeometry& g = abdomen().ct.geometry;
  const Mat4 to_file = of.geometry.patientToVoxel() * g.voxelToPatient();
  std::size_t inside = 0;
  for (std::size_t v = 0; v < g.voxelCount(); ++v) {
    const Index3 at = g.indicesOf(v);
    const Vec3 there(to_file * glm::dvec4(at[0], at[1], at[2], 1.0));
    bool in = true;
    for (int a = 0; a < 3; ++a) {
      in = in && there[a] > -0.5 && there[a] < of.geometry.size[std::size_t(a)] - 0.5;
    }
    inside += in;
  }
  EXPECT_NEAR(fit->covers_percent, 100.0 * double(inside) / double(g.voxelCount()), 0.1);
  EXPECT_LT(fit->covers_percent, 95.0);
  EXPECT_TRUE(found(fit->findings, "RESAMPLED"));
}

TEST(StructureFit, AStructureWhoseHuCannotBeItsTissueIsAskedAbout) {
  Segmentation of = liverOf(abdomen().truth);
  of.segments[0].name = "Left_lung";
  EXPECT_EQ(codeOf(of), "HU_NOT_TISSUE");
  const auto kept = test::fitted(of, abdomen().ct, {{code::kHuNotTissue, "keep"}});
  ASSERT_TRUE(kept) << kept.error().sentence();
  ASSERT_EQ(kept->choices.size(), 1u);
  EXPECT_EQ(kept->choices[0].code.str(), "HU_NOT_TISSUE");
  EXPECT_TRUE(found(kept->findings, "HU_NOT_TISSUE"));
  EXPECT_EQ(codeOf(of, {}, false), "fits") << "where nobody is asked it is said";
  EXPECT_EQ(codeOf(of, {{code::kHuNotTissue, "perhaps"}}), "BAD_CHOICE");
}

TEST(StructureFit, WhatNobodyHasAnsweredIsAChoiceAndWhatWasRefusedAnError) {
  Segmentation of = liverOf(abdomen().truth);
  of.segments[0].name = "Left_lung";
  const auto open = fitStructures(of, abdomen().ct);
  ASSERT_TRUE(open) << open.error().sentence();
  const auto* choice = std::get_if<Choice>(&*open);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->code, code::kHuNotTissue);
  EXPECT_EQ(choice->options, (std::vector<std::string>{"refuse", "keep"}));
  const auto refused = fitStructures(of, abdomen().ct, {{code::kHuNotTissue, "refuse"}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, code::kHuNotTissue);
  EXPECT_NE(refused.error().next.find("HU_NOT_TISSUE=keep"), std::string::npos);
}

TEST(StructureFit, OverlapsAreAskedAboutOnce) {
  Segmentation of = liverOf(abdomen().truth);
  of.layers.push_back(std::vector<std::uint8_t>(of.layers[0].size()));
  std::size_t taken = 0;
  for (std::size_t v = 0; v < of.layers[0].size() && taken < 20; ++v) {
    if (of.layers[0][v]) of.layers[1][v] = 1, ++taken;
  }
  of.segments.push_back({"tumour", Vec3(1.0), "", 1, 1});
  const auto count = [&](const Answers& answers) {
    const auto fit = test::fitted(of, abdomen().ct, answers);
    EXPECT_TRUE(fit);
    EXPECT_TRUE(found(fit->findings, "OVERLAP"));
    EXPECT_EQ(fit->choices.size(), 1u);
    return fit->structures[1].voxels;
  };
  EXPECT_EQ(count({}), taken) << "the smaller one";
  EXPECT_EQ(count({{code::kOverlap, "last"}}), taken);
  EXPECT_EQ(count({{code::kOverlap, "first"}}), 0u);
}

TEST(StructureFit, NothingAtAllAndAnEmptyStructureAreSaid) {
  Segmentation of = liverOf(abdomen().truth);
  of.segments.push_back({"spleen", Vec3(1.0), "", 0, 2});
  const auto fit = test::fitted(of, abdomen().ct);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(found(fit->structures[1].findings, "EMPTY_STRUCTURE"));
  std::ranges::fill(of.layers[0], std::uint8_t(0));
  EXPECT_EQ(codeOf(of), "EMPTY_SEGMENTATION");
}

TEST(StructureFit, AFinerGridIsSaidToBeResampled) {
  GridGeometry fine = abdomen().ct.geometry;
  for (std::size_t a = 0; a < 3; ++a) {
    fine.size[a] *= 2;
    fine.spacing_mm[int(a)] /= 2.0;
  }
  fine.origin_mm -= Vec3(1.5);
  const auto fit =
      test::fitted(liverOf(phantomLabelsOn(*phantomTruth("abdomen"), fine)), abdomen().ct);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_TRUE(fit->resampled);
  EXPECT_NEAR(fit->structures[0].ml / fit->structures[0].ml_in_file, 1.0, 0.02);
}

TEST(StructureFit, NamesTellWhatHuCanBe) {
  EXPECT_STREQ(huOfKind("Left_Lung")->kind, "lung or airway");
  EXPECT_STREQ(huOfKind("rib_left_4")->kind, "bone");
  EXPECT_STREQ(huOfKind("x", "liver")->kind, "a solid organ");
  EXPECT_FALSE(huOfKind("label 5"));
  EXPECT_FALSE(huOfKind("\xe8\x82\x9d"));
  EXPECT_FALSE(huOfKind("deliverable")) << "a word of its own";
}

}  // namespace
}  // namespace trephine
