#include <gtest/gtest.h>

#include "imaging/codes.h"
#include "imaging/segmentation/overlap_order.h"
#include "imaging/segmentation/structure_fit.h"
#include "structure_fit_support.h"

namespace trephine {
namespace {

// A row of eight voxels: the liver in all, a vessel in four of them, a tumour in two of those.
Segmentation threeThatOverlap() {
  Segmentation of;
  of.format = "NRRD";
  of.geometry.size = {8, 1, 1};
  of.layers = {std::vector<std::uint8_t>(8, 1), {1, 1, 1, 1, 0, 0, 0, 0}, {0, 0, 1, 1, 0, 0, 0, 0}};
  of.segments = {{"Liver", Vec3(1.0), "", 0, 1},
                 {"vessel, portal", Vec3(1.0), "", 1, 1},
                 {"tumour", Vec3(1.0), "", 2, 1}};
  return of;
}

std::vector<std::size_t> orderIs(const std::string& answer) {
  const auto order = orderFrom(answer, threeThatOverlap());
  EXPECT_TRUE(order) << order.error().sentence();
  return order ? *order : std::vector<std::size_t>();
}

using Places = std::vector<std::size_t>;

TEST(OverlapOrder, IsThatOfTheNamesAndThenTheSmallerFirst) {
  EXPECT_EQ(orderIs("order:liver,tumour,vessel, portal"), (Places{0, 2, 1}));
  EXPECT_EQ(orderIs("order:liver"), (Places{0, 2, 1}));
  EXPECT_EQ(orderIs("order:vessel, portal"), (Places{1, 2, 0})) << "a name may hold a comma";
}

TEST(OverlapOrder, OfTwoStructuresOfOneNameHasThemInTheFilesOrder) {
  Segmentation of = threeThatOverlap();
  of.segments[1].name = "tumour";
  EXPECT_EQ(*orderFrom("order:tumour,tumour,liver", of), (Places{1, 2, 0}));
}

TEST(OverlapOrder, ANameThatIsNoneOfThemIsNamed) {
  for (const char* answer : {"order:liver,spleen", "order:spleen", "order:", "order:liver,liver"}) {
    const auto order = orderFrom(answer, threeThatOverlap());
    ASSERT_FALSE(order) << answer;
    EXPECT_EQ(order.error().code.str(), "BAD_CHOICE");
    EXPECT_NE(order.error().next.find("'vessel, portal'"), std::string::npos);
  }
}

TEST(OverlapOrder, AsAnAnswerToTheQuestionGivesTheFirstTheVoxels) {
  Volume ct;
  ct.geometry = threeThatOverlap().geometry;
  ct.hu.assign(8, 50);
  const auto first = test::fitted(threeThatOverlap(), ct);
  ASSERT_TRUE(first) << first.error().sentence();
  EXPECT_EQ(first->overlapping, (std::vector<std::string>{"tumour", "vessel, portal", "Liver"}));
  const auto fit =
      test::fitted(threeThatOverlap(), ct,
                   {{code::kOverlap, orderAnswer({"vessel, portal", "tumour", "Liver"})}});
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->structures[1].voxels, 4u);
  EXPECT_EQ(fit->structures[2].voxels, 0u);
  EXPECT_EQ(fit->structures[0].voxels, 4u);
  EXPECT_EQ(fit->overlapping, (std::vector<std::string>{"vessel, portal", "tumour", "Liver"}));
  EXPECT_EQ(
      test::fitted(threeThatOverlap(), ct, {{code::kOverlap, "order:foot"}}).error().code.str(),
      "BAD_CHOICE");
}

}  // namespace
}  // namespace trephine
