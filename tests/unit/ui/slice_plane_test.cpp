// Where slices lie in the patient, which voxels they show and what is measured on them.
#include "ui/views/slice_plane.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "ui/views/slice_image.h"
#include "ui/views/slice_measure.h"

using namespace trephine;

namespace {

Mat3 turned(double radians, const Vec3& about) {
  return Mat3(glm::rotate(Mat4(1.0), radians, glm::normalize(about)));
}

GridGeometry grid(const Mat3& direction, const Vec3& spacing_mm = {0.5, 0.8, 2.0},
                  const Index3& size = {40, 30, 12}) {
  GridGeometry g;
  g.size = size;
  g.spacing_mm = spacing_mm;
  g.origin_mm = {-31.0, 12.5, 140.0};
  g.direction = direction;
  return g;
}

const Mat3 kFlipped(-1, 0, 0, 0, -1, 0, 0, 0, 1);
const Mat3 kMirrored(1, 0, 0, 0, 1, 0, 0, 0, -1);
const Mat3 kCoronal(1, 0, 0, 0, 0, -1, 0, 1, 0);  // scanned as coronal slices
const Mat3 kOblique = turned(0.7, {1, 2, -0.5});
const Mat3 kTilted = turned(0.3, {1, 0, 0});  // a head turned under a gantry

std::string edges(const GridGeometry& stack) {
  return {patientLetter(-stack.direction[0]), patientLetter(stack.direction[0]),
          patientLetter(-stack.direction[1]), patientLetter(stack.direction[1])};
}

// Each voxel a HU of its own.
Volume numbered(const GridGeometry& geometry) {
  Volume volume{geometry, Voxels(geometry.voxelCount())};
  for (std::size_t i = 0; i < volume.hu.size(); ++i) volume.hu[i] = std::int16_t(i % 30011);
  return volume;
}

TEST(SlicePlane, IsSeenFromTheFeetFromTheFrontAndFromTheLeftHoweverItWasScanned) {
  for (const Mat3& direction : {Mat3(1.0), kFlipped, kMirrored, kCoronal, kOblique, kTilted}) {
    const GridGeometry g = grid(direction);
    EXPECT_EQ(edges(sliceStack(g, SliceAxis::axial)), "RLAP");
    EXPECT_EQ(edges(sliceStack(g, SliceAxis::coronal)), "RLSI");
    EXPECT_EQ(edges(sliceStack(g, SliceAxis::sagittal)), "APSI");
    EXPECT_EQ(patientLetter(sliceStack(g, SliceAxis::axial).direction[2]), 'S');
    EXPECT_EQ(patientLetter(sliceStack(g, SliceAxis::coronal).direction[2]), 'P');
    EXPECT_EQ(patientLetter(sliceStack(g, SliceAxis::sagittal).direction[2]), 'R');
  }
}

TEST(SlicePlane, OfAGridAlongThePatientHasItsVoxelsForPixels) {
  for (const Mat3& direction : {Mat3(1.0), kFlipped, kMirrored, kCoronal}) {
    const GridGeometry g = grid(direction);
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      EXPECT_EQ(stack.voxelCount(), g.voxelCount());
      std::vector<bool> met(g.voxelCount());
      for (int k = 0; k < stack.size[2]; ++k) {
        for (int y = 0; y < stack.size[1]; ++y) {
          for (int x = 0; x < stack.size[0]; ++x) {
            const Vec3 place = stack.toPatient_mm(Vec3(x, y, k));
            const Vec3 exact = toVoxel(g, place);
            ASSERT_LT(glm::distance(exact, glm::round(exact)), 1e-9);
            const auto voxel = voxelAt(g, place);
            ASSERT_TRUE(voxel);
            const std::size_t index = g.indexOf((*voxel)[0], (*voxel)[1], (*voxel)[2]);
            ASSERT_FALSE(met[index]);
            met[index] = true;
          }
        }
      }
    }
  }
  const GridGeometry coronal = sliceStack(grid(Mat3(1.0)), SliceAxis::coronal);
  EXPECT_EQ(coronal.spacing_mm, Vec3(0.5, 2.0, 0.8)) << "proportions are the patient's";
}

TEST(SlicePlane, ThroughAnObliqueGridIsThePatientsOwnAndReachesAllOfIt) {
  for (const Mat3& direction : {kOblique, kTilted}) {
    const GridGeometry g = grid(direction);
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      for (int n = 0; n < 3; ++n) {
        const Vec3 d = stack.direction[n];
        EXPECT_EQ(std::abs(d[mainAxis(d)]), 1.0);
        EXPECT_GE(stack.spacing_mm[n], 0.5 - 1e-9);
        EXPECT_LE(stack.spacing_mm[n], 2.0 + 1e-9);
      }
      for (int corner = 0; corner < 8; ++corner) {
        Vec3 voxel;
        for (int a = 0; a < 3; ++a) voxel[a] = corner >> a & 1 ? g.size[std::size_t(a)] - 1 : 0;
        const Vec3 at = toVoxel(stack, g.toPatient_mm(voxel));
        for (int a = 0; a < 3; ++a) {
          EXPECT_GT(at[a], -0.5);
          EXPECT_LT(at[a], stack.size[std::size_t(a)] - 0.5);
        }
      }
    }
  }
}

TEST(SlicePlane, OfAGridAlongThePatientShowsInEachPixelTheVoxelThatItsCentreLiesIn) {
  for (const Mat3& direction : {Mat3(1.0), kFlipped, kMirrored, kCoronal}) {
    const GridGeometry g = grid(direction);
    const Volume volume = numbered(g);
    SliceColours colours;
    colours.setWindow({15000.0, 30000.0});
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      const int k = stack.size[2] / 2;
      const QRect part(1, 2, stack.size[0] - 2, stack.size[1] - 3);
      QImage image;
      drawSlice(volume, nullptr, stack, k, part, colours, image);
      ASSERT_EQ(image.size(), part.size());
      int inside = 0, apart = 0;
      for (int y = 0; y < part.height(); ++y) {
        for (int x = 0; x < part.width(); ++x) {
          const Vec3 place = stack.toPatient_mm(Vec3(x + part.left(), y + part.top(), k));
          const Vec3 exact = toVoxel(g, place) + 0.5;
          const Vec3 to_border = glm::abs(exact - glm::round(exact));
          // On the border of two voxels either is right.
          if (std::min({to_border.x, to_border.y, to_border.z}) < 1e-6) continue;
          const auto voxel = voxelAt(g, place);
          const int hu = voxel ? volume.at((*voxel)[0], (*voxel)[1], (*voxel)[2]) : -1;
          inside += bool(voxel);
          apart += qRed(image.pixel(x, y)) != (voxel ? colours.greyOf(std::int16_t(hu)) : 0);
        }
      }
      EXPECT_GT(inside, 100);
      EXPECT_EQ(apart, 0);
    }
  }
}

TEST(SlicePlane, OfAnObliqueGridShowsWhatLiesBetweenItsVoxelsInTheColoursOfTheNearest) {
  Tissue tissue;
  tissue.id = "upper";
  tissue.hu_min = 128;
  tissue.hu_max = 255;
  tissue.opacity = 1.0;
  tissue.colour = {1, 0, 0};
  for (const Mat3& direction : {kOblique, kTilted}) {
    Volume volume = numbered(grid(direction));
    const GridGeometry& g = volume.geometry;
    std::mt19937 random(11);
    for (std::int16_t& hu : volume.hu) hu = std::int16_t(random() % 256);
    const auto stored = [&](const Vec3& voxel) {
      std::array<int, 3> v;
      for (int a = 0; a < 3; ++a)
        v[std::size_t(a)] = std::clamp(int(voxel[a]), 0, g.size[std::size_t(a)] - 1);
      return double(volume.at(v[0], v[1], v[2]));
    };
    SliceColours colours;
    colours.setWindow({127.5, 255.0});
    colours.setTissues({"set", {tissue}});
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      const int k = stack.size[2] / 2;
      const QRect all(0, 0, stack.size[0], stack.size[1]);
      QImage plain, coloured;
      colours.setOverlay(Overlay::none, 1.0);
      drawSlice(volume, nullptr, stack, k, all, colours, plain);
      colours.setOverlay(Overlay::tissues, 1.0);
      drawSlice(volume, nullptr, stack, k, all, colours, coloured);
      int inside = 0, apart = 0, wrong = 0;
      for (int y = 0; y < all.height(); ++y) {
        for (int x = 0; x < all.width(); ++x) {
          const Vec3 place = stack.toPatient_mm(Vec3(x, y, k));
          const auto voxel = voxelAt(g, place);
          const Vec3 exact = toVoxel(g, place), low = glm::floor(exact), share = exact - low;
          double hu = 0.0;
          for (int corner = 0; corner < 8; ++corner) {
            const Vec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
            const Vec3 part = glm::mix(1.0 - share, share, step);
            hu += part.x * part.y * part.z * stored(low + step);
          }
          inside += bool(voxel);
          apart += std::abs(qRed(plain.pixel(x, y)) - (voxel ? hu : 0.0)) > 2.0;
          const Vec3 to_border = glm::abs(exact + 0.5 - glm::round(exact + 0.5));
          if (!voxel || std::min({to_border.x, to_border.y, to_border.z}) < 1e-6) continue;
          const bool upper = volume.at((*voxel)[0], (*voxel)[1], (*voxel)[2]) >= 128;
          wrong += (coloured.pixel(x, y) == qRgb(255, 0, 0)) != upper;
        }
      }
      EXPECT_GT(inside, 100);
      EXPECT_EQ(apart, 0);
      EXPECT_EQ(wrong, 0);
    }
  }
}

TEST(SlicePlane, IsDrawnAnewWhereABoxOfVoxelsTouchesItAndOnlyThere) {
  for (const Mat3& direction : {Mat3(1.0), kFlipped, kCoronal}) {
    const GridGeometry g = grid(direction);
    const VoxelBox box{{16, 0, 4}, {32, 16, 8}};
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      for (int k = 0; k < stack.size[2]; ++k) {
        bool shows = false;
        for (int corner = 0; corner < stack.size[0] * stack.size[1]; ++corner) {
          const Vec3 at(corner % stack.size[0], corner / stack.size[0], k);
          const Index3 v = *voxelAt(g, stack.toPatient_mm(at));
          bool in = true;
          for (std::size_t a = 0; a < 3; ++a) in = in && v[a] >= box.low[a] && v[a] < box.high[a];
          shows = shows || in;
        }
        EXPECT_EQ(touches(stack, k, g, box), shows) << k;
      }
    }
  }
  // Of an oblique grid: none too few.
  const GridGeometry g = grid(kOblique);
  const GridGeometry stack = sliceStack(g, SliceAxis::axial);
  EXPECT_FALSE(touches(stack, 0, g, {{16, 16, 4}, {20, 20, 6}}));
  const double middle = toVoxel(stack, g.toPatient_mm(Vec3(17, 17, 5))).z;
  EXPECT_TRUE(touches(stack, int(std::lround(middle)), g, {{16, 16, 4}, {20, 20, 6}}));
  // A cut of one voxel changes no slice that is not drawn anew.
  Volume volume = numbered(g);
  volume.hu.assign(volume.hu.size(), 1000);
  SliceColours colours;
  for (int k = 0; k < stack.size[2]; ++k) {
    const QRect all(0, 0, stack.size[0], stack.size[1]);
    QImage before, after;
    drawSlice(volume, nullptr, stack, k, all, colours, before);
    volume.hu[g.indexOf(17, 15, 5)] = kAirHu;
    drawSlice(volume, nullptr, stack, k, all, colours, after);
    volume.hu[g.indexOf(17, 15, 5)] = 1000;
    if (before != after) {
      EXPECT_TRUE(touches(stack, k, g, {{17, 15, 5}, {18, 16, 6}})) << k;
    }
  }
}

TEST(SlicePlane, OfOneSliceOrOfTwentyToOneHasItsTrueProportions) {
  const GridGeometry one = sliceStack(grid(Mat3(1.0), {1, 1, 5}, {64, 48, 1}), SliceAxis::coronal);
  EXPECT_EQ(one.size, (Index3{64, 1, 48}));
  EXPECT_EQ(one.spacing_mm.y, 5.0);
  const GridGeometry flat = grid(kOblique, {0.5, 0.5, 10.0}, {64, 64, 9});
  for (SliceAxis axis : kSliceAxes) {
    const GridGeometry stack = sliceStack(flat, axis);
    EXPECT_LE(stack.size[0] * stack.spacing_mm.x, flat.diagonal_mm() + stack.spacing_mm.x);
    EXPECT_LT(stack.voxelCount(), 100u * flat.voxelCount());
  }
}

TEST(SlicePlane, APlaceOutsideOrNowhereHasNoVoxel) {
  const GridGeometry g = grid(kTilted);
  EXPECT_FALSE(voxelAt(g, g.toPatient_mm(Vec3(-0.6, 3, 3))));
  EXPECT_FALSE(voxelAt(g, g.toPatient_mm(Vec3(3, 29.6, 3))));
  EXPECT_FALSE(voxelAt(g, Vec3(NAN, 0, 0)));
  EXPECT_EQ(voxelAt(g, g.toPatient_mm(Vec3(39.4, 0.4, 2.6))), (Index3{39, 0, 3}));
}

// The ends of a known length, as a hand that hits the nearest pixel marks them on a slice.
TEST(SliceMeasure, ARulerIsTrueToHalfAVoxelAndAnAngleToHalfADegreeInAnyGrid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.25, 0.75);
  for (const Mat3& direction : {Mat3(1.0), kOblique, kTilted}) {
    const GridGeometry g = grid(direction, {0.6, 0.6, 1.5}, {160, 160, 64});
    for (SliceAxis axis : kSliceAxes) {
      const GridGeometry stack = sliceStack(g, axis);
      const double pixel_mm = 0.25;  // of a screen that shows the slice at that scale
      for (int n = 0; n < 200; ++n) {
        std::array<Vec3, 3> truth, marked;
        const double k = std::round(share(random) * stack.size[2]);
        for (std::size_t p = 0; p < 3; ++p) {
          const Vec3 at = Vec3(share(random) * stack.size[0], share(random) * stack.size[1], k);
          truth[p] = stack.toPatient_mm(at);
          Vec3 hit = at * stack.spacing_mm / pixel_mm;
          hit = glm::round(hit) * pixel_mm / stack.spacing_mm;
          marked[p] = stack.toPatient_mm(Vec3(hit.x, hit.y, k));
        }
        const Measure ruler{Measure::Kind::ruler, {marked[0], marked[1]}};
        EXPECT_NEAR(length_mm(ruler), glm::distance(truth[0], truth[1]), 0.3);
        const Vec3 a = truth[0] - truth[1], b = truth[2] - truth[1];
        if (std::min(glm::length(a), glm::length(b)) < 45.0)
          continue;  // shorter than a person would
        const double angle = std::acos(glm::dot(a, b) / glm::length(a) / glm::length(b));
        const Measure corner{Measure::Kind::angle, {marked[0], marked[1], marked[2]}};
        EXPECT_NEAR(angle_deg(corner), angle * 180.0 / M_PI, 0.5);
      }
    }
  }
  EXPECT_EQ(angle_deg({Measure::Kind::angle, {Vec3(0.0), Vec3(0.0), Vec3(1.0)}}), 0.0);
  EXPECT_NEAR(angle_deg({Measure::Kind::angle, {{1, 0, 0}, {0, 0, 0}, {0, 2, 0}}}), 90.0, 1e-9);
}

namespace {

// Red by its HU, and blue by its label, with the same HU.
Tissue softTissue() {
  Tissue soft;
  soft.id = "soft";
  soft.hu_min = 0;
  soft.hu_max = 100;
  soft.colour = {1, 0, 0};
  soft.opacity = 1.0;
  return soft;
}
Tissue organTissue() {
  Tissue organ = softTissue();
  organ.id = "organ";
  organ.label = 3;
  organ.colour = {0, 0, 1};
  return organ;
}

}  // namespace

TEST(SliceColours, ShowTissuesAsTouchClassifiesThemAndLabelsAsTheyAre) {
  const Tissue soft = softTissue(), organ = organTissue();
  SliceColours colours;
  colours.setTissues({"set", {soft, organ}});
  colours.setWindow({50.0, 400.0});
  const QRgb plain = colours.of(50, 0);
  EXPECT_EQ(qRed(plain), 128);
  EXPECT_EQ(qRed(plain), qBlue(plain));

  colours.setOverlay(Overlay::tissues, 1.0);
  EXPECT_EQ(colours.of(50, 0), qRgb(255, 0, 0));
  EXPECT_EQ(colours.of(50, 3), qRgb(0, 0, 255)) << "a tissue of the label goes first";
  EXPECT_EQ(colours.of(200, 0), 0xff000000u | colours.greyOf(200) * 0x010101u) << "no tissue";
  EXPECT_EQ(qRed(colours.of(kAirHu, 3)), 0) << "what was cut has no tissue";
  colours.setOverlay(Overlay::tissues, 0.5);
  EXPECT_NEAR(qRed(colours.of(50, 0)), 191, 2);
  EXPECT_NEAR(qBlue(colours.of(50, 0)), 64, 2);

  colours.setOverlay(Overlay::labels, 1.0);
  EXPECT_EQ(colours.of(50, 3), qRgb(0, 0, 255)) << "in the colour of its tissue";
  EXPECT_EQ(colours.of(50, 0), plain);
  EXPECT_NE(colours.of(50, 9), plain);
  EXPECT_NE(colours.of(50, 9), colours.of(50, 10));
}

TEST(SliceColours, FollowTheLooksOfTheTissues) {
  Tissue soft = softTissue(), organ = organTissue(), vessel = organ;
  vessel.id = "vessel";
  vessel.hu_min = 101;
  vessel.hu_max = 200;
  vessel.colour = {0, 1, 0};
  const TissueSet set{"set", {soft, organ, vessel}};
  SliceColours colours;
  colours.setWindow({50.0, 400.0});
  colours.setTissues(set);
  const QRgb plain = colours.of(50, 0);
  colours.setOverlay(Overlay::tissues, 1.0);
  EXPECT_EQ(colours.of(50, 0), qRgb(255, 0, 0));
  colours.setTissues(set, {{"soft", TissueLook::hidden}});
  EXPECT_EQ(colours.of(50, 0), plain);
  EXPECT_EQ(colours.of(50, 3), qRgb(0, 0, 255)) << "no other";
  colours.setTissues(set, {{"soft", TissueLook::ghosted}});
  EXPECT_NEAR(qRed(colours.of(50, 0)), 191, 2);
  EXPECT_NEAR(qBlue(colours.of(50, 0)), 64, 2);

  // A label looks as the tissue that is seen best of those it names.
  colours.setOverlay(Overlay::labels, 1.0);
  colours.setTissues(set);
  EXPECT_EQ(colours.of(50, 3), qRgb(0, 0, 255));
  colours.setTissues(set, {{"organ", TissueLook::ghosted}});
  EXPECT_EQ(colours.of(50, 3), qRgb(0, 255, 0));
  colours.setTissues(set, {{"organ", TissueLook::hidden}, {"vessel", TissueLook::ghosted}});
  EXPECT_NEAR(qGreen(colours.of(50, 3)), 191, 2);
  colours.setTissues(set, {{"organ", TissueLook::hidden}, {"vessel", TissueLook::hidden}});
  EXPECT_EQ(colours.of(50, 3), plain);
  EXPECT_NE(colours.of(50, 9), plain) << "no tissue hides what none names";
  EXPECT_EQ(qRed(colours.of(kAirHu, 9)), 0) << "what was cut has no label";

  // What the set itself makes invisible is not coloured, unless it is asked for.
  soft.opacity = 0.0;
  colours.setOverlay(Overlay::tissues, 1.0);
  colours.setTissues({"set", {soft}});
  EXPECT_EQ(colours.of(50, 0), plain);
  colours.setTissues({"set", {soft}}, {{"soft", TissueLook::shown}});
  EXPECT_EQ(colours.of(50, 0), qRgb(255, 0, 0));
}

TEST(SliceColours, HaveOneWidthAtLeast) {
  SliceColours colours;
  colours.setWindow({100.0, 0.0});
  EXPECT_EQ(colours.greyOf(90), 0);
  EXPECT_EQ(colours.greyOf(110), 255);
}

TEST(SliceColours, KnowTheFivePresetsOfTheKeys) {
  const std::array<const char*, 5> names{"Brain", "Bone", "Soft", "Lung", "Liver"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_STREQ(kWindowPresets[i].name, names[i]);
}

}  // namespace
