#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "imaging/series/detail/series_geometry.h"

namespace trephine {

namespace {

StackInput axialStack(std::initializer_list<double> places) {
  StackInput input{512, 256, {0.7, 0.4}, {1, 0, 0, 0, 1, 0}, {}, {}, ""};
  for (const double z : places) input.positions_mm.push_back({-100.0, -50.0, z});
  return input;
}

std::string codesOf(const Stack& stack) {
  std::string codes;
  for (const Finding& finding : stack.findings)
    codes += (codes.empty() ? "" : " ") + finding.code.str();
  return codes;
}

}  // namespace

TEST(SeriesGeometry, EvenSlicesInAnyOrderGiveOneStack) {
  StackInput input = axialStack({4, 1, 3, 2, 0});
  const Stack stack = stackSlices(input);
  EXPECT_EQ(codesOf(stack), "");
  EXPECT_EQ(stack.order, (std::vector<std::size_t>{4, 1, 3, 2, 0}));
  EXPECT_EQ(stack.geometry.size, (Index3{256, 512, 5}));
  EXPECT_EQ(stack.geometry.spacing_mm, Vec3(0.4, 0.7, 1.0));  // x is the second PixelSpacing
  EXPECT_EQ(stack.geometry.origin_mm, Vec3(-100, -50, 0));
  EXPECT_EQ(stack.geometry.direction, Mat3(1.0));
  EXPECT_EQ(stack.tilt_deg, 0.0);
}

TEST(SeriesGeometry, TheNormalIsRowCrossColumnSoTheStackIsRightHanded) {
  StackInput coronal = axialStack({});
  coronal.orientation = {1, 0, 0, 0, 0, -1};
  for (const double y : {3.0, 1.0, 2.0}) coronal.positions_mm.push_back({0, y, 0});
  const Stack stack = stackSlices(coronal);
  EXPECT_EQ(codesOf(stack), "");
  EXPECT_EQ(stack.geometry.direction[2], Vec3(0, 1, 0));
  EXPECT_NEAR(glm::determinant(stack.geometry.direction), 1.0, 1e-12);
  EXPECT_EQ(stack.geometry.origin_mm, Vec3(0, 1, 0));

  StackInput prone = axialStack({});
  prone.orientation = {-1, 0, 0, 0, 1, 0};  // normal points to the feet
  for (const double z : {1.0, 2.0, 3.0}) prone.positions_mm.push_back({0, 0, z});
  EXPECT_EQ(stackSlices(prone).geometry.origin_mm, Vec3(0, 0, 3));
}

TEST(SeriesGeometry, AnObliqueStackHasNoTilt) {
  StackInput input = axialStack({});
  const double c = std::cos(0.3), s = std::sin(0.3);
  input.orientation = {1, 0, 0, 0, c, s};
  for (int k = 0; k < 5; ++k)
    input.positions_mm.push_back(Vec3(5, 6, 7) + Vec3(0, -s, c) * (2.0 * k));
  const Stack stack = stackSlices(input);
  EXPECT_EQ(codesOf(stack), "");
  EXPECT_NEAR(stack.geometry.spacing_mm.z, 2.0, 1e-12);
  EXPECT_NEAR(stack.tilt_deg, 0.0, 1e-6);
}

TEST(SeriesGeometry, StepsWithinAPercentOrAHundredthOfAMillimetreAreEven) {
  EXPECT_EQ(codesOf(stackSlices(axialStack({0, 5.0, 10.04, 15.04}))), "");
  EXPECT_EQ(codesOf(stackSlices(axialStack({0, 0.3, 0.609, 0.909}))), "");
  EXPECT_EQ(codesOf(stackSlices(axialStack({0, 5.0, 10.2, 15.2, 20.2}))), "RESAMPLED_SPACING");
}

TEST(SeriesGeometry, SpacingComesFromTheWholeExtent) {
  EXPECT_NEAR(stackSlices(axialStack({0, 1.0, 2.0, 3.005, 4.006})).geometry.spacing_mm.z, 1.0015,
              1e-12);
}

TEST(SeriesGeometry, MissingSlicesAreNamedInMillimetres) {
  const Stack stack = stackSlices(axialStack({10, 11.5, 14.5, 16, 17.5, 23.5}));
  ASSERT_EQ(codesOf(stack), "MISSING_SLICES");
  EXPECT_EQ(stack.findings.front().slices,
            (std::vector<std::string>{"13.00 mm", "19.00 mm to 22.00 mm (3 slices)"}));
  EXPECT_EQ(stack.geometry.spacing_mm.z, 1.5);
}

TEST(SeriesGeometry, OfTwoStepsTheLargerIsTheGap) {
  EXPECT_EQ(codesOf(stackSlices(axialStack({0, 1, 3}))), "MISSING_SLICES");
  EXPECT_EQ(codesOf(stackSlices(axialStack({0, 2, 3}))), "MISSING_SLICES");
}

TEST(SeriesGeometry, StepsThatAreNoMultiplesAreUneven) {
  const Stack stack = stackSlices(axialStack({0, 1, 2, 3.5, 4.5}));
  ASSERT_EQ(codesOf(stack), "UNEVEN_SPACING");
  EXPECT_NE(stack.findings.front().text.find("1.500"), std::string::npos);
}

TEST(SeriesGeometry, OfSeveralSlicesAtOnePlaceTheFirstCounts) {
  const Stack stack = stackSlices(axialStack({0, 1, 1, 2}));
  EXPECT_EQ(codesOf(stack), "");
  EXPECT_EQ(stack.order, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(stack.geometry.size[2], 3);
}

TEST(SeriesGeometry, OneLocationIsNotAVolume) {
  EXPECT_EQ(codesOf(stackSlices(axialStack({7}))), "ONE_LOCATION");
  EXPECT_EQ(codesOf(stackSlices(axialStack({7, 7, 7}))), "ONE_LOCATION");
}

TEST(SeriesGeometry, TiltIsMeasuredFromThePositions) {
  StackInput input = axialStack({});
  const double angle = 18.5 * 3.14159265358979 / 180.0;
  input.orientation = {1, 0, 0, 0, std::cos(angle), -std::sin(angle)};
  for (int k = 0; k < 27; ++k) input.positions_mm.push_back({-123.5, -15.6, 742.3 + 2.5 * k});
  const Stack stack = stackSlices(input);
  EXPECT_EQ(codesOf(stack), "GANTRY_TILT");
  EXPECT_NEAR(stack.tilt_deg, 18.5, 1e-9);
  EXPECT_NEAR(stack.geometry.spacing_mm.z, 2.5 * std::cos(angle), 1e-9);
}

TEST(SeriesGeometry, SlicesAsideOfTheLineAreNoTilt) {
  StackInput input = axialStack({0, 1, 2, 3});
  input.positions_mm[2].x += 2.0;
  EXPECT_EQ(codesOf(stackSlices(input)), "SHIFTED_SLICES");
  input.positions_mm[2].x -= 1.99;  // as positions are rounded in headers
  EXPECT_EQ(codesOf(stackSlices(input)), "");
}

TEST(SeriesGeometry, AnOrientationThatIsNotOrthonormalIsRefused) {
  for (const std::array<double, 6>& orientation :
       {std::array<double, 6>{1, 0, 0, 0.1, 0.995, 0}, {1, 0, 0, 0, 1.1, 0}, {0, 0, 0, 0, 1, 0}}) {
    StackInput input = axialStack({0, 1, 2});
    input.orientation = orientation;
    EXPECT_EQ(codesOf(stackSlices(input)), "NOT_ORTHONORMAL");
  }
}

TEST(SeriesGeometry, RoundedCosinesAreMadeOrthonormal) {
  StackInput input = axialStack({0, 1, 2});
  input.orientation = {0.9999, 0.0001, 0, 0, 1, 0};
  const Mat3 d = stackSlices(input).geometry.direction;
  EXPECT_NEAR(glm::length(d[0]), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(d[0], d[1]), 0.0, 1e-12);
}

TEST(SeriesGeometry, ShufflingNeverChangesTheGeometry) {
  StackInput input = axialStack({});
  for (int k = 0; k < 40; ++k) input.positions_mm.push_back({0.0, 0.0, -20.0 + 0.6 * k});
  const GridGeometry expected = stackSlices(input).geometry;
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::ranges::shuffle(input.positions_mm, random);
    EXPECT_EQ(stackSlices(input).geometry, expected);
  }
}

}  // namespace trephine
