#include <gtest/gtest.h>

#include <cstdio>

#include "imaging/steps/couch.h"
#include "painted.h"
#include "posed.h"
#include "volume/phantom.h"

namespace trephine::test {

namespace {

const GridGeometry kManGrid = centredGrid({200, 160, 100}, {2.5, 2.5, 4.0});

// He gives way to what he lies on.
Matter manOn(const Vec3& p, const Matter& couch) {
  return couch.owner == Owner::couch ? couch : man(p);
}

// What became of patient and couch.
struct Outcome {
  bool found = false;
  std::uint64_t patient_lost = 0;     // voxels of the patient that changed
  std::uint64_t preview_patient = 0;  // and that the preview shows as couch
  double couch_left_percent = 0.0;    // of the voxels that the couch's plates touch
  double said_percent = 0.0;          // the finding's voxels against what went
};

Outcome outcomeOf(const Painted& painted) {
  const CouchFinding finding = findCouch(painted.volume);
  Outcome outcome;
  outcome.found = finding.found;
  Volume after = painted.volume;
  const std::uint64_t gone = removeCouch(after, finding);
  outcome.said_percent = gone > 0 ? 100.0 * double(finding.voxels) / double(gone) : 0.0;
  std::uint64_t plates = 0, left = 0;
  for (std::size_t n = 0; n < after.hu.size(); ++n) {
    const Index3 at = after.geometry.indicesOf(n);
    // A voxel that he and the couch share belongs to neither.
    if (painted.patient[n] >= 2 && painted.couch[n] == 0) {
      outcome.patient_lost += after.hu[n] != painted.volume.hu[n];
      outcome.preview_patient += finding.isCouch(at[0], at[1], at[2]);
    }
    if (painted.couch[n] == 0 || painted.patient[n] > 0 || painted.volume.hu[n] < -850) continue;
    ++plates;
    left += after.hu[n] != kAirHu;
  }
  outcome.couch_left_percent = plates > 0 ? 100.0 * double(left) / double(plates) : 0.0;
  return outcome;
}

void expectRemoved(const Painted& painted, double left_percent, const char* what) {
  const Outcome outcome = outcomeOf(painted);
  EXPECT_TRUE(outcome.found) << what;
  EXPECT_EQ(outcome.patient_lost, 0u) << what;
  EXPECT_EQ(outcome.preview_patient, 0u) << what;
  EXPECT_LE(outcome.couch_left_percent, left_percent) << what;
  EXPECT_NEAR(outcome.said_percent, 100.0, 40.0) << what;
}

// Head, neck and shoulders on or between `thing`, into which they press.
template <class Thing>
Painted headOn(const Thing& thing) {
  GridGeometry grid = centredGrid({150, 120, 120}, {2.5, 2.5, 2.75});
  grid.origin_mm.z -= 50.0;
  return paint(grid, [&](const Vec3& p) {
    const Matter matter = thing(p);
    return matter.owner == Owner::couch ? matter : posedMan(p, {});
  });
}
// Negative inside.
double box(const Vec3& p, const Vec3& middle, const Vec3& half) {
  const Vec3 beyond = glm::abs(p - middle) - half;
  return std::max({beyond.x, beyond.y, beyond.z});
}
// `wall` mm of `hu` around a core of foam.
Matter hollow(double distance, double wall, int hu) {
  if (distance > 0.0) return {};
  return {distance > -wall ? hu : -940, Owner::couch};
}
Matter headBoard(const Vec3& p) {
  return hollow(box(p, {0, 103, 0}, {140, 7.5, 1000}), 1.5, 80);
}
// Beside the head, past its ears; two.
double headBlocks(const Vec3& p, double thick) {
  return box({std::abs(p.x), p.y, p.z}, {92 + thick / 2, 45, -10}, {thick / 2, 42, 60});
}

}  // namespace

TEST(Couch, AHeadBoardOnWhichHeadAndShouldersLieGoes) {
  expectRemoved(headOn(headBoard), 1.0, "board");
}

TEST(Couch, WhereAHeadBoardEndsTheShouldersBeyondItStay) {
  // What is in the board's columns there is the patient: skin, muscle and lung.
  for (const int hu : {80, -100}) {
    const auto board = [&](const Vec3& p) {
      return hollow(box(p, {0, 100, 60}, {90, 7.5, 190}), 2.5, hu);
    };
    const Outcome outcome = outcomeOf(headOn(board));
    std::printf("[ figures  ] board of %d HU that ends: %llu lost, %.1f %% left\n", hu,
                (unsigned long long)outcome.patient_lost, outcome.couch_left_percent);
    EXPECT_TRUE(outcome.found);
    EXPECT_EQ(outcome.patient_lost, 0u);
    EXPECT_EQ(outcome.preview_patient, 0u);
    EXPECT_LT(outcome.couch_left_percent, 5.0);
  }
}

TEST(Couch, ARestThatLeansAlongTheScanGoes) {
  for (const double rise : {0.09, 0.18}) {  // 5 and 10 degrees
    const auto rest = [&](const Vec3& p) {
      return hollow(box({p.x, p.y + rise * p.z, p.z}, {0, 104, 30}, {90, 6, 130}), 2.0, 80);
    };
    const Outcome outcome = outcomeOf(headOn(rest));
    std::printf("[ figures  ] rest of 1 in %.0f: %llu lost, %.1f %% left\n", 1.0 / rise,
                (unsigned long long)outcome.patient_lost, outcome.couch_left_percent);
    EXPECT_TRUE(outcome.found);
    EXPECT_EQ(outcome.patient_lost, 0u);
    EXPECT_LT(outcome.couch_left_percent, 6.0);
  }
}

TEST(Couch, BlocksBesideTheHeadNeverCostThePatientAnything) {
  struct Case {
    const char* name;
    bool board;
    double thick, wall;
    int hu;
    double left_percent;  // 100: nothing need go
  };
  for (const Case& one : {Case{"foam in covers", false, 56, 1.5, -200, 30.0},
                          Case{"foam in covers, on a board", true, 56, 1.5, -200, 3.0},
                          Case{"bare foam on a board", true, 56, 100, -900, 1.0},
                          Case{"plates of 5 mm on a board", true, 5, 100, 120, 1.0},
                          Case{"solid blocks of 20 mm on a board", true, 20, 100, 120, 70.0},
                          Case{"solid blocks alone", false, 20, 100, 120, 100.0}}) {
    const auto blocks = [&](const Vec3& p) {
      const Matter board = one.board ? headBoard(p) : Matter{};
      if (board.owner == Owner::couch) return board;
      return hollow(headBlocks(p, one.thick), one.wall, one.hu);
    };
    const Outcome outcome = outcomeOf(headOn(blocks));
    std::printf("[ figures  ] %s: %s, %llu lost, %.1f %% left\n", one.name,
                outcome.found ? "found" : "not found", (unsigned long long)outcome.patient_lost,
                outcome.couch_left_percent);
    EXPECT_EQ(outcome.found, one.left_percent < 100.0) << one.name;
    EXPECT_EQ(outcome.patient_lost, 0u) << one.name;
    EXPECT_EQ(outcome.preview_patient, 0u) << one.name;
    EXPECT_LE(outcome.couch_left_percent, one.left_percent) << one.name;
  }
}

TEST(Couch, AFlatCouchGoesWhollyAndThePatientStays) {
  const auto truth = [](const Vec3& p) { return manOn(p, couchPlates(p, 125.0, 0.0)); };
  expectRemoved(paint(kManGrid, truth), 0.0, "flat, on a mattress");
}

TEST(Couch, ACurvedCouchThatThePatientLiesOnGoesToo) {
  const auto truth = [](const Vec3& p) { return manOn(p, couchPlates(p, 104.0, 25.0)); };
  expectRemoved(paint(kManGrid, truth), 2.0, "curved, touching");
}

TEST(Couch, ItMayLieOnAnySideOfThePatientAndAlongAnyAxis) {
  for (const double turned : {1.0, -1.0}) {  // prone: the couch is in front
    const auto truth = [&](const Vec3& p) {
      return manOn(p, couchPlates({p.x, turned * p.y, p.z}, turned > 0 ? 125.0 : 122.0, 20.0));
    };
    const Painted axial = paint(kManGrid, truth);
    expectRemoved(axial, 0.0, turned > 0 ? "supine" : "prone");
    expectRemoved(permuted(axial, {0, 2, 1}), 0.0, "coronal");
    expectRemoved(permuted(axial, {1, 2, 0}), 0.0, "sagittal");
    Painted feet_first = axial;
    feet_first.volume.geometry.direction = Mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1);
    expectRemoved(feet_first, 0.0, "feet first");
  }
}

TEST(Couch, OnItsSideThePatientKeepsTheArmHeLiesOn) {
  const auto truth = [](const Vec3& p) {
    return manOn(p, couchPlates({p.y, p.x, p.z}, 258.0, 10.0));
  };
  expectRemoved(paint(centredGrid({240, 160, 100}, {2.75, 2.75, 4.0}), truth), 0.0, "on his side");
}

TEST(Couch, HandsThatLieOnItStay) {
  const auto truth = [](const Vec3& p) {
    // A board under each arm: the wrist presses on it, the fingertips touch it.
    const bool board = std::abs(p.x) > 175 && std::abs(p.x) < 240 && p.y > 78 && p.y < 82;
    return manOn(p, board ? Matter{80, Owner::couch} : couchPlates(p, 125.0, 0.0));
  };
  expectRemoved(paint(kManGrid, truth), 3.0, "arm boards");
}

TEST(Couch, AChildsFingerThatLiesOnItStays) {
  const auto truth = [](const Vec3& p) {
    const Matter couch = couchPlates(p, 80.0, 0.0);
    if (couch.owner == Owner::couch) return couch;
    const bool body = ellipse(p.x, p.y, 60, 55) < 0.0;
    const bool wrist = rod(p, {95, 30, 90}, {95, 66, 0}, 12.0) < 0.0;
    const bool finger = rod(p, {95, 76.9, 5}, {95, 76.9, -35}, 2.6) < 0.0;
    return body || wrist || finger ? Matter{40, Owner::patient} : Matter{};
  };
  expectRemoved(paint(centredGrid({200, 140, 90}, {1.5, 1.5, 2.0}), truth), 4.0, "finger");
}

TEST(Couch, AMattressGoesWithItUpToTheSkin) {
  const auto truth = [](const Vec3& p) {
    Matter couch = couchPlates(p, 125.0, 0.0);
    // Cloth of 600 HU less than water, in which he lies 8 mm deep.
    if (couch.owner == Owner::air && p.y > 95.0 && p.y < 126.0 && std::abs(p.x) < 190.0 &&
        man(p).owner == Owner::air) {
      couch = {-600, Owner::couch};
    }
    return manOn(p, couch);
  };
  const Painted painted = paint(kManGrid, truth);
  const CouchFinding finding = findCouch(painted.volume);
  ASSERT_TRUE(finding.found);
  Volume after = painted.volume;
  removeCouch(after, finding);
  std::uint64_t cloth = 0, cloth_left = 0;
  for (std::size_t n = 0; n < after.hu.size(); ++n) {
    // Skin's own edge is kept, too, where it is as light as cloth.
    if (painted.patient[n] >= 2) {
      ASSERT_EQ(after.hu[n], painted.volume.hu[n]);
    }
    const bool is_cloth = painted.couch[n] == 4 && painted.volume.hu[n] > -700;
    cloth += is_cloth;
    cloth_left += is_cloth && after.hu[n] != kAirHu;
  }
  // A layer of a voxel or two stays on the skin.
  EXPECT_LT(double(cloth_left), 0.25 * double(cloth));
}

TEST(Couch, APatientWithoutOneIsLeftAlone) {
  const Painted painted = paint(kManGrid, man);
  const CouchFinding finding = findCouch(painted.volume);
  EXPECT_FALSE(finding.found);
  EXPECT_EQ(finding.voxels, 0u);
  EXPECT_FALSE(finding.isCouch(10, 10, 10));
  Volume after = painted.volume;
  EXPECT_EQ(removeCouch(after, finding), 0u);
  EXPECT_EQ(after.hu, painted.volume.hu);
}

TEST(Couch, TheBuiltInCasesHaveNone) {
  for (const char* name : {"cranium", "abdomen"}) {
    GridGeometry geometry = phantomGeometry(name).value();
    for (int axis = 0; axis < 3; ++axis) {
      geometry.size[axis] /= 3;
      geometry.spacing_mm[axis] *= 3.0;
    }
    const Volume volume = makePhantomOn(phantomTruth(name).value(), geometry, kPhantomNoiseHu);
    EXPECT_FALSE(findCouch(volume).found) << name;
  }
}

TEST(Couch, AHeadHolderThatTheScalpTouchesGoesAndTheEarsStay) {
  const PhantomTruth head = phantomTruth("cranium").value();
  const auto truth = [&](const Vec3& p) -> Matter {
    // Half a ring, open in front: 4 mm thick, pressed 2 mm into the back of the scalp.
    const double radius = std::sqrt(p.x * p.x + (p.y + 5.0) * (p.y + 5.0));
    if (p.y > 0.0 && radius > 99.0 && radius < 103.0) return {150, Owner::couch};
    const PhantomTissue tissue = head(p);
    const bool inside = tissue != PhantomTissue::air || ellipse(p.x, p.y, 60, 70) < 0.0;
    return inside ? Matter{phantomHu(tissue), Owner::patient} : Matter{};
  };
  const Painted painted = paint(centredGrid({220, 220, 90}, {1.0, 1.0, 2.0}), truth);
  expectRemoved(painted, 1.0, "head holder");
}

TEST(Couch, SliversOfABodyThatTheFieldOfViewCutsAreNotTakenForOne) {
  // Of his arms no more than 5 mm are in the field: as thin, wide and long as a plate.
  const auto round = [](const Vec3& p) -> Matter {
    if (std::sqrt(p.x * p.x + p.y * p.y) > 150.0) return {kPadding, Owner::air};
    if (ellipse(p.x, p.y, 60, 60) < 0.0) return {45, Owner::patient};
    return p.x + p.y > 205.5 ? Matter{-95, Owner::patient} : Matter{};
  };
  const GridGeometry grid = centredGrid({120, 120, 80}, {2.5, 2.5, 3.0});
  EXPECT_FALSE(findCouch(paint(grid, round).volume).found);
  const auto square = [](const Vec3& p) -> Matter {
    if (ellipse(p.x, p.y, 60, 60) < 0.0) return {45, Owner::patient};
    return p.x > 144.5 ? Matter{-95, Owner::patient} : Matter{};
  };
  EXPECT_FALSE(findCouch(paint(grid, square).volume).found);
}

TEST(Couch, AThinWallWithinTheBodyIsNotTakenForOne) {
  const auto hollow = [](const Vec3& p) -> Matter {
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    if (r > 150.0) return {};
    if (r > 120.0) return {45, Owner::patient};
    return std::abs(p.y) < 2.5 && std::abs(p.x) < 60.0 ? Matter{40, Owner::patient}
                                                       : Matter{-900, Owner::patient};
  };
  EXPECT_FALSE(findCouch(paint(centredGrid({130, 130, 60}, {2.5, 2.5, 3.0}), hollow).volume).found);
}

TEST(Couch, ANoisyLungThatTheFieldOfViewCutsOpenIsNotTakenForOne) {
  Painted chest =
      paint(centredGrid({240, 240, 60}, {0.75, 0.75, 2.5}), [](const Vec3& p) -> Matter {
        if (p.y > 50.0) return {45, Owner::patient};  // the wall of the chest, on one side only
        return {-760, Owner::patient};
      });
  // 160 HU of noise: most cells have one voxel that could be a plate's.
  std::uint32_t state = 1;
  for (auto& hu : chest.volume.hu) {
    int sum = 0;
    for (int n = 0; n < 4; ++n) {
      state = state * 1664525u + 1013904223u;
      sum += int(state >> 24);
    }
    hu = std::int16_t(hu + (sum - 510) * 160 / 148);
  }
  EXPECT_FALSE(findCouch(chest.volume).found);
}

TEST(Couch, ThinBoneIsNotTakenForOne) {
  const auto dry_skull = [](const Vec3& p) -> Matter {
    const double r = glm::length(p / Vec3(70, 85, 75));
    if (p.z < -40 && ellipse(p.x, p.y, 40, 40) < 0.0) return {700, Owner::patient};
    return r < 1.0 && r > 0.94 ? Matter{900, Owner::patient} : Matter{};
  };
  EXPECT_FALSE(findCouch(paint(centredGrid({100, 100, 80}, {2, 2, 2}), dry_skull).volume).found);
}

TEST(Couch, WhatIsThinButNotWideOrNotLongStays) {
  // Tubes along the patient, and a plate of 60 mm across his chest.
  const auto truth = [](const Vec3& p) {
    const bool tube = ellipse(p.x - 90, p.y + 150, 5, 5) < 0.0;
    const bool plate = std::abs(p.z) < 30 && std::abs(p.x) < 100 && std::abs(p.y + 160) < 3;
    return manOn(p, tube || plate ? Matter{100, Owner::couch} : Matter{});
  };
  EXPECT_FALSE(findCouch(paint(kManGrid, truth).volume).found);
}

TEST(Couch, AShortScanShowsOneOnlyWhenItIsVeryWide) {
  const auto truth = [](const Vec3& p) { return manOn(p, couchPlates(p, 125.0, 30.0)); };
  expectRemoved(paint(centredGrid({200, 160, 16}, {2.5, 2.5, 4.0}), truth), 0.0, "64 mm");
  EXPECT_FALSE(findCouch(paint(centredGrid({200, 160, 5}, {2.5, 2.5, 4.0}), truth).volume).found);
}

TEST(Couch, VoxelsTooCoarseToTellAHandFromAPlateShowNone) {
  const auto truth = [](const Vec3& p) { return manOn(p, couchPlates(p, 125.0, 0.0)); };
  EXPECT_FALSE(findCouch(paint(centredGrid({100, 80, 80}, {5, 5, 5}), truth).volume).found);
}

TEST(Couch, EmptyAndTinyVolumesHaveNone) {
  EXPECT_FALSE(findCouch(Volume()).found);
  Volume air;
  air.geometry.size = {64, 64, 64};
  air.hu.assign(air.geometry.voxelCount(), kAirHu);
  EXPECT_FALSE(findCouch(air).found);
  Volume one;
  one.geometry.size = {1, 1, 1};
  one.hu = {40};
  EXPECT_FALSE(findCouch(one).found);
}

}  // namespace trephine::test
