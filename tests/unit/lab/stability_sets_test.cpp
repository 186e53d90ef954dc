#include "lab/stability/stability_sets.h"

#include <gtest/gtest.h>

#include <map>

namespace trephine {
namespace {

// An arm of 45 g at 1 kHz with the encoder of an Omni on a wall of 1000 N/m.
StabilityCell wall() {
  StabilityCell cell;
  cell.encoder_m = 0.055e-3;
  cell.hand = {2.0, 300.0};
  cell.tissue = {0.0, 1000.0};
  return cell;
}

TEST(StabilitySets, AreReadByName) {
  const auto sets = readStabilitySets("claims,long,claims");
  ASSERT_TRUE(sets);
  EXPECT_EQ(*sets, (std::vector{StabilitySet::claims, StabilitySet::lasting}));
  for (const char* wrong : {"", "grid,", "grids", "grid long"}) {
    const auto refused = readStabilitySets(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().code.str(), "BAD_ARGUMENT");
    EXPECT_NE(refused.error().sentence().find("--sets"), std::string::npos);
  }
}

TEST(RepresentativeCells, HoldEveryValueOfEveryAxisAboutEquallyOften) {
  const std::vector<StabilityCell> cells = representativeCells();
  ASSERT_EQ(cells.size(), 304u);
  std::map<double, int> masses, periods, encoders, hands, delays;
  std::map<std::pair<double, double>, int> tissues, pairs;
  for (const StabilityCell& c : cells) {
    ++masses[c.mass_kg];
    ++periods[c.period_s];
    ++encoders[c.encoder_m];
    ++hands[c.hand.stiffness];
    ++delays[c.delay_samples];
    ++tissues[{c.tissue.damping, c.tissue.stiffness}];
    ++pairs[{c.period_s, double(c.delay_samples)}];
  }
  for (const auto& axis : {masses, periods, encoders, hands, delays}) {
    ASSERT_EQ(axis.size(), 3u);
    for (const auto& [value, count] : axis) EXPECT_NEAR(count, 304 / 3.0, 4.0) << value;
  }
  ASSERT_EQ(tissues.size(), 15u);
  for (const auto& [tissue, count] : tissues) EXPECT_NEAR(count, 304 / 15.0, 4.0);
  ASSERT_EQ(pairs.size(), 9u);
  for (const auto& [pair, count] : pairs) EXPECT_NEAR(count, 304 / 9.0, 4.0);
}

TEST(StabilitySets, CountEachVariationInARowAndNoUndampedHandInTheTotal) {
  const auto hands = measureStabilitySet(StabilitySet::hands, {wall()}, 0.5, Progress());
  ASSERT_TRUE(hands);
  EXPECT_EQ(hands->rows.size(), 30u);
  EXPECT_EQ(hands->total.cells, 24u);
  const auto claims = measureStabilitySet(StabilitySet::claims, {wall()}, 0.5, Progress());
  ASSERT_TRUE(claims);
  EXPECT_EQ(claims->rows.size(), 7u);
  EXPECT_EQ(claims->total.cells, 7u);
  StabilityCell free = wall();
  free.hand = {};
  const auto moving = measureStabilitySet(StabilitySet::moving, {wall(), free}, 2.0, Progress());
  ASSERT_TRUE(moving);
  EXPECT_EQ(moving->total.cells, 1u) << "nobody moves an arm that nobody holds";

  const Json json = toJson(*hands);
  for (const char* key :
       {"cells", "unstable", "also_ideal", "energy_out_mJ_max", "cycle_um_max", "cycle_Hz", "rows"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["rows"][0]["name"], "k 50 b 1");
  EXPECT_NE(toText("hands", *hands).find("k 50 b 1"), std::string::npos);
}

TEST(StabilitySets, CountWhatThePerfectArmDoesAsWellApart) {
  // An undamped hand on a wall without damping swings for ever, whoever answers it.
  StabilityCell cell = wall();
  cell.plant_damping = 0.0;
  cell.hand = {0.0, 2000.0};
  const CellResult ideal = runCell(cell, CellDriver::ideal);
  EXPECT_TRUE(faultsOf(cell, ideal).oscillates);
  EXPECT_NEAR(ideal.cycle_Hz, 38.0, 6.0) << "between hand alone and hand and wall";
  CellFaults oscillates{true, false, false}, gives_out{false, false, true};
  EXPECT_TRUE(oscillates.allIn({true, false, true}));
  EXPECT_FALSE(gives_out.allIn(oscillates));
}

TEST(StabilitySets, LetAHandSwingWithoutCallingTheSwingAnOscillation) {
  StabilityCell soft = wall();
  soft.encoder_m = 0.0;
  soft.tissue = {5.0, 0.0};
  CellConditions moving;
  moving.moving = true;
  moving.seconds = 5.0;
  const CellResult swung = runCell(soft, CellDriver::ideal, 1.0, moving);
  EXPECT_LT(swung.oscillation_m, 1e-5);
  EXPECT_GT(swung.contact_rms_N, 0.02) << "the hand drags it to and fro";
}

TEST(StabilitySets, TellTheControllerWhatIsClaimedAndNotWhatIs) {
  StabilityCell cell = wall();
  cell.mass_kg = 0.2;
  cell.encoder_m = 0.0;
  cell.tissue = {0.0, 1e6};
  CellConditions heavier, later;
  heavier.mass_claimed = 2.0;
  later.delay_claimed_more = 1;
  EXPECT_TRUE(runCell(cell, CellDriver::bounded, 1.0, heavier).not_as_stated);
  EXPECT_TRUE(runCell(cell, CellDriver::bounded, 1.0, later).not_as_stated);
  EXPECT_FALSE(runCell(cell, CellDriver::bounded).not_as_stated);
}

TEST(StabilitySets, AreCancelledWithTheMeasurement) {
  Progress progress;
  progress.cancel();
  const auto measured =
      measureStabilitySet(StabilitySet::lasting, representativeCells(), {}, progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANCELLED");
}

}  // namespace
}  // namespace trephine
