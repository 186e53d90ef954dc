#include "lab/touch/rest_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lab/touch/placed_exercise.h"

namespace trephine {
namespace {

// 16 mm of one tissue below the plane through the origin, and air above it.
Volume block() {
  Volume volume;
  volume.geometry.size = {32, 32, 32};
  volume.geometry.origin_mm = Vec3(-15.5);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), 32 * 32 * 16, std::int16_t(700));
  return volume;
}

// A burr without its motor on bone: it is held and cuts nothing.
HapticParameters burrOnBone() {
  HapticParameters p;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.force_at = ForceAt::distributed;
  p.tissues.count = 1;
  p.tissues.classes[0] = {{12.0, 900.0, 2.0, 0.0, 0.06}, 226, 3071, 1, 0, 1, 0};
  p.arms = {{makeBurr(0.003, 32, 8, 0.03), WorkspaceMap{}, 3.3, {0.045, 0.055e-3, 3.3, 0}}};
  p.journal_voxels = 1 << 16;
  return p;
}

const HoldPath kPress{Vec3(0.0, 0.0, 0.01), Vec3(0.0, 0.0, -0.002), Vec3(0.0, 0.0, -0.004)};

TEST(AToolThatAHandHolds, RestsOnBoneAndGivesNothingOut) {
  const HoldResult held =
      hold(burrOnBone(), block(), {RigArm{}}, {kPress}, HoldKind::rest, 2.0).front();
  EXPECT_TRUE(held.touched);
  EXPECT_FALSE(held.waited);
  EXPECT_EQ(held.removed_voxels, 0u);
  EXPECT_FALSE(faultsOf(HoldKind::rest, held, 0.055e-3).any())
      << 1e6 * held.cycle_m << " um, " << 1e3 * held.energy_out_J << " mJ";
}

TEST(AToolThatAHandHolds, IsCaughtWhereItShakes) {
  // Without a controller a wall of 100 kN/m shakes the arm.
  HapticParameters shaken = burrOnBone();
  shaken.controller = ControllerKind::off;
  shaken.tissues.classes[0].stiffness_N_per_m = 1e5;
  const HoldResult held = hold(shaken, block(), {RigArm{}}, {kPress}, HoldKind::rest, 2.0).front();
  EXPECT_TRUE(faultsOf(HoldKind::rest, held, 0.055e-3).cycles) << 1e6 * held.cycle_m << " um";
  EXPECT_TRUE(isGrave(HoldKind::rest, held, 0.055e-3));
  EXPECT_GT(held.cycle_Hz, 2.0);
}

TEST(AToolThatAHandHolds, RestsOnAPerfectArmWithoutAController) {
  HapticParameters parameters = burrOnBone();
  parameters.controller = ControllerKind::seed;  // replaced
  const HoldResult ideal =
      hold(parameters, block(), {RigArm{}}, {kPress}, HoldKind::rest, 1.0, true).front();
  EXPECT_LT(ideal.cycle_m, 1e-6) << "no encoder, 5 kHz";
}

TEST(AToolThatAHandHolds, SwingsWithoutTheSwingBeingCalledACycle) {
  // In air: nothing but the swing itself, of 4 mm either way.
  HoldPath air = kPress;
  air.held_m.z = 0.008;
  const HoldResult swung =
      hold(burrOnBone(), block(), {RigArm{}}, {air}, HoldKind::swing, 2.0).front();
  EXPECT_FALSE(swung.touched);
  EXPECT_LT(swung.cycle_m, 5e-6);
  EXPECT_EQ(swung.energy_out_J, 0.0);
}

// Between rest and swing: at each count that it passes a force that follows the counts comes and
// goes, which must not be taken for a loss.
TEST(AToolThatAHandHolds, CreepsOverBoneWithItsForceAndGivesNothingOut) {
  for (const Impedance& hand : {Impedance{5.0, 300.0}, Impedance{10.0, 1000.0}}) {
    const HoldResult held = hold(burrOnBone(), block(), {RigArm{0.045, 0.05, 0.055e-3, hand}},
                                 {kPress}, HoldKind::creep, 8.0)
                                .front();
    EXPECT_TRUE(held.touched);
    EXPECT_GT(held.shown, 0.9);
    EXPECT_FALSE(faultsOf(HoldKind::creep, held, 0.055e-3).any())
        << 1e6 * held.cycle_m << " um, " << 1e3 * held.energy_out_J << " mJ";
  }
}

TEST(AToolThatAHandHolds, IsToldApartWhereItBeganInTissue) {
  HoldPath within = kPress;
  within.start_m.z = -0.004;
  EXPECT_TRUE(
      hold(burrOnBone(), block(), {RigArm{}}, {within}, HoldKind::rest, 0.5).front().waited);
}

TEST(TheBarsOfRest, AreACountOrTwentyMicrometresAndAFifthOfAMillijoule) {
  const auto faults = [](double cycle_m, double energy_J, double encoder_m) {
    HoldResult r;
    r.cycle_m = cycle_m;
    r.energy_out_J = energy_J;
    return faultsOf(HoldKind::rest, r, encoder_m);
  };
  EXPECT_FALSE(faults(19e-6, 1.9e-4, 0.0).any());
  EXPECT_TRUE(faults(21e-6, 0.0, 0.0).cycles);
  EXPECT_FALSE(faults(50e-6, 0.0, 55e-6).any());
  EXPECT_TRUE(faults(60e-6, 0.0, 55e-6).cycles);
  EXPECT_TRUE(faults(0.0, 2.1e-4, 55e-6).gives_out);
  EXPECT_TRUE(faults(std::nan(""), 0.0, 55e-6).cycles);
}

TEST(TheBarsOfRest, HoldAtAnEdgeToo) {
  HoldResult r;
  r.cycle_m = 60e-6;
  EXPECT_TRUE(faultsOf(HoldKind::edge, r, 55e-6).cycles);
  r = {};
  r.energy_out_J = 2.1e-4;
  EXPECT_TRUE(faultsOf(HoldKind::edge, r, 55e-6).gives_out);
  r.energy_out_J = 6e-4;
  EXPECT_TRUE(isGrave(HoldKind::edge, r, 55e-6));
}

// The bone's edge at x = 0, by a hand that hardly damps: friction, proxy and controller.
TEST(AToolThatALightHandHolds, RestsOnAnEdgeOnceItHasSlidThere) {
  Volume edge = block();
  const GridGeometry& g = edge.geometry;
  for (std::size_t n = 0; n < edge.hu.size(); ++n) {
    const Index3 v = g.indicesOf(n);
    if (g.toPatient_mm(Vec3(v[0], v[1], v[2])).x > 0.0) edge.hu[n] = kAirHu;
  }
  RigArm arm;
  arm.hand = {1.0, 50.0};
  for (const double beside_m : {-0.3e-3, 0.0, 0.3e-3}) {
    const HoldPath path{Vec3(beside_m, 0.0, 0.01), Vec3(beside_m, 0.0, -0.006),
                        Vec3(0.0, 0.0, -0.004)};
    const HoldResult held = hold(burrOnBone(), edge, {arm}, {path}, HoldKind::edge, 2.0).front();
    EXPECT_FALSE(faultsOf(HoldKind::edge, held, 0.055e-3).any())
        << beside_m << ": " << 1e6 * held.cycle_m << " um, " << 1e3 * held.energy_out_J << " mJ";
    EXPECT_GE(held.shown, 0.5) << beside_m;
  }
}

// A map that scales the force makes a tissue firmer at the arm than it shows.
TEST(AToolThatAHandHolds, RestsWhateverTheMapScalesTheForceBy) {
  for (const double scale : {10.0, 30.0, 100.0}) {
    HapticParameters scaled = burrOnBone();
    scaled.arms[0].map.force_scale = scale;
    const HoldResult held =
        hold(scaled, block(), {RigArm{}}, {kPress}, HoldKind::edge, 2.0).front();
    EXPECT_FALSE(faultsOf(HoldKind::edge, held, 0.055e-3).any())
        << scale << ": " << 1e6 * held.cycle_m << " um, " << 1e3 * held.energy_out_J << " mJ";
    EXPECT_TRUE(held.touched);
  }
}

TEST(TheRowsOfRest, AreCountedByKindAndTheIdealLawsApart) {
  RestFigures figures;
  figures.seconds = 60.0;
  RestRow still{"liver", "left", "needle", "skin", HoldKind::rest, {}, 55e-6};
  still.result.touched = true;
  RestRow bad = still, ideal = still, block = still;
  bad.unstable = true;
  bad.result.cycle_m = 1e-4;
  bad.result.cycle_Hz = 66.7;
  bad.result.energy_out_J = 0.031;
  ideal.also_ideal = true;
  ideal.result.cycle_m = 1.0;
  block.exercise = "block of bone";
  block.kind = HoldKind::swing;
  figures.rows = {still, bad, ideal, block};
  const Json json = toJson(figures);
  EXPECT_EQ(json["cells"], 4);
  EXPECT_EQ(json["unstable"], 1);
  EXPECT_EQ(json["also_ideal"], 1);
  EXPECT_EQ(json["beyond_accepted"], 1);
  EXPECT_DOUBLE_EQ(json["energy_out_mJ_max"], 31.0);
  EXPECT_DOUBLE_EQ(json["cycle_um_max"], 100.0) << "the ideal law's are not counted";
  EXPECT_EQ(json["kinds"][0]["cells"], 3);
  EXPECT_EQ(json["kinds"][4]["cells"], 1);
  EXPECT_EQ(json["rows"][1]["scene"], "liver");
  EXPECT_EQ(json["rows"][1]["kind"], "rest");
  EXPECT_NE(toText(figures).find("liver: left arm, needle, skin, rest: 100 um at 67 Hz"),
            std::string::npos);
}

TEST(ATissue, IsFoundAlongARayBeforeTheFirstSolidOne) {
  Volume volume = block();
  HapticParameters p = burrOnBone();
  p.tissues.count = 2;
  p.tissues.classes[1] = {{1.0, 40.0, 0.1, 0.0, 0.0}, 0, 100, 1, 0, 0, 0};
  const Vec3 from_mm(0.0, 0.0, 12.0), down(0.0, 0.0, -1.0);
  EXPECT_NEAR(depthOf(volume, p.tissues, 0, from_mm, down, 40.0).value_or(0.0), 12.0, 0.11);
  EXPECT_FALSE(depthOf(volume, p.tissues, 0, from_mm, down, 10.0));
  // Soft tissue behind the bone is not to be reached.
  std::fill_n(volume.hu.begin(), 32 * 32 * 8, std::int16_t(50));
  EXPECT_FALSE(depthOf(volume, p.tissues, 1, from_mm, down, 40.0));
  std::fill_n(volume.hu.begin() + 32 * 32 * 16, 32 * 32 * 4, std::int16_t(50));
  EXPECT_NEAR(depthOf(volume, p.tissues, 1, from_mm, down, 40.0).value_or(0.0), 8.0, 0.11);
}

}  // namespace
}  // namespace trephine
