#include "lab/stability/stability_cell.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "unit/lab/independent_plant.h"

namespace trephine {
namespace {

using test::IndependentPlant;

// Cells such as a grid that nobody has tuned on would hold; the same on every machine.
std::vector<StabilityCell> randomCells(std::size_t count) {
  std::mt19937 random(20261);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (double(random()) / 4294967296.0);
  };
  const auto decades = [&](double low, double high) {
    return low * std::pow(high / low, between(0.0, 1.0));
  };
  constexpr std::array<double, 4> kPeriods_s{0.25e-3, 0.5e-3, 1e-3, 2e-3};
  std::vector<StabilityCell> cells(count);
  for (StabilityCell& cell : cells) {
    cell.mass_kg = decades(0.020, 0.200);
    cell.period_s = kPeriods_s[std::size_t(between(0.0, 4.0))];
    cell.delay_samples = 0.25 * int(between(0.0, 16.0));
    if (between(0.0, 1.0) < 0.6) cell.encoder_m = between(0.02e-3, 0.2e-3);
    if (between(0.0, 1.0) < 0.6) {
      cell.hand.stiffness = between(300.0, 1000.0);
      cell.hand.damping = between(2.0, 10.0);
    }
    if (between(0.0, 1.0) < 0.5) {
      cell.tissue.damping = decades(1.0, 1e4);
    } else {
      cell.tissue.damping = between(0.0, 10.0);
      cell.tissue.stiffness = decades(300.0, 1e6);
    }
  }
  return cells;
}

bool nearAThreshold(const StabilityCell& cell, const CellResult& r) {
  const auto near = [](double value, double threshold) {
    return std::abs(value - threshold) <= 0.02 * threshold;
  };
  return near(r.oscillation_m, std::max(0.02e-3, 2.0 * cell.encoder_m)) || near(r.step_N, 0.1) ||
         near(r.energy_out_J, std::max(0.05e-3, 1.0 * cell.encoder_m));
}

// Whether two runs of a cell are one motion: what is left is rounding, and energy looked at 4 or 20
// times a period.
bool same(const CellResult& a, const CellResult& b) {
  const auto close = [](double x, double y, double relative, double absolute) {
    return std::abs(x - y) <= relative * std::max(std::abs(x), std::abs(y)) + absolute;
  };
  return close(a.oscillation_m, b.oscillation_m, 1e-3, 1e-9) &&
         close(a.step_N, b.step_N, 1e-3, 1e-6) &&
         close(a.energy_out_J, b.energy_out_J, 1e-2, 1e-9) &&
         close(a.contact_rms_N, b.contact_rms_N, 1e-7, 1e-9) &&
         // The ideal force jumps where the tip crosses the surface, and the two sums meet that jump
         // up to an eighth of a period apart.
         close(a.fidelity_error, b.fidelity_error, 0.01, 0.005);
}

TEST(StabilityCell, AgreesWithAPlantThatIsWrittenAndIntegratedOtherwise) {
  std::size_t stable = 0, unstable = 0, on_the_edge = 0, apart = 0;
  for (const StabilityCell& cell : randomCells(50)) {
    const std::pair<CellDriver, IndependentPlant::Answer> drivers[] = {
        {CellDriver::off, IndependentPlant::off(cell)},
        {CellDriver::seed, IndependentPlant::controlled(cell, ControllerKind::seed)},
        {CellDriver::bounded, IndependentPlant::controlled(cell, ControllerKind::bounded)}};
    for (const auto& [driver, answer] : drivers) {
      const CellResult found = runCell(cell, driver);
      const CellResult expected = IndependentPlant::run(cell, answer);
      SCOPED_TRACE(testing::Message()
                   << "driver " << int(driver) << ", " << cell.mass_kg << " kg, " << cell.period_s
                   << " s, delay " << cell.delay_samples << ", encoder " << cell.encoder_m
                   << " m, hand " << cell.hand.stiffness << ", b " << cell.tissue.damping << ", k "
                   << cell.tissue.stiffness);
      if (nearAThreshold(cell, expected)) {
        ++on_the_edge;
      } else {
        EXPECT_EQ(found.stable, expected.stable);
      }
      if (!expected.stable || !found.stable) {
        ++unstable;
        continue;
      }
      ++stable;
      if (same(found, expected)) continue;
      // A rounding error can decide which count a sample falls on. Where that grows into another
      // motion of the same kind, only its size can be compared.
      ++apart;
      EXPECT_GT(cell.encoder_m, 0.0) << "without counts nothing may part the two";
      EXPECT_NEAR(found.oscillation_m, expected.oscillation_m, cell.encoder_m);
      EXPECT_NEAR(found.step_N, expected.step_N, 0.03);
      EXPECT_NEAR(found.energy_out_J, expected.energy_out_J, cell.encoder_m);
      EXPECT_NEAR(found.contact_rms_N, expected.contact_rms_N, 0.1 * expected.contact_rms_N);
      EXPECT_NEAR(found.fidelity_error, expected.fidelity_error, 0.1 * expected.fidelity_error);
    }
  }
  EXPECT_GE(stable, 75u) << "half of all must have something to compare";
  EXPECT_GE(unstable, 20u);
  EXPECT_LE(on_the_edge, 5u);
  EXPECT_LE(20 * apart, stable) << "at most one in twenty";
}

TEST(StabilityCell, IsStableUpToEachThresholdAndNotBeyond) {
  for (double encoder : {0.0, 0.005e-3, 0.2e-3}) {
    StabilityCell cell;
    cell.encoder_m = encoder;
    const double shaking_m = encoder == 0.2e-3 ? 0.4e-3 : 0.02e-3;  // 2 counts, or 0.02 mm
    const double given_J = encoder == 0.2e-3 ? 0.2e-3 : 0.05e-3;    // 1 N times a count, or 0.05 mJ
    constexpr double kInside = 1.0 - 1e-9, kBeyond = 1.0 + 1e-9;
    EXPECT_DOUBLE_EQ(unseenEnergy_J(cell), given_J);

    CellResult result;
    EXPECT_TRUE(isStable(cell, result));
    result.oscillation_m = kInside * shaking_m;
    result.step_N = kInside * 0.1;
    result.energy_out_J = kInside * given_J;
    EXPECT_TRUE(isStable(cell, result)) << "just below all three";

    CellResult shaking = result, jumping = result, giving = result;
    shaking.oscillation_m = kBeyond * shaking_m;
    jumping.step_N = kBeyond * 0.1;
    giving.energy_out_J = kBeyond * given_J;
    EXPECT_FALSE(isStable(cell, shaking));
    EXPECT_FALSE(isStable(cell, jumping));
    EXPECT_FALSE(isStable(cell, giving));
    shaking.oscillation_m = std::nan("");
    EXPECT_FALSE(isStable(cell, shaking)) << "not a number is not stable";
  }
  StabilityCell cell;
  CellResult on_the_line;
  on_the_line.step_N = 0.1;
  EXPECT_TRUE(isStable(cell, on_the_line)) << "more than 0.1 N is unstable, not 0.1 N";
}

TEST(StabilityCell, JudgesNeitherFidelityNorAuthorityAsStability) {
  CellResult result;
  result.fidelity_error = 1e6;
  result.contact_rms_N = 1e6;
  EXPECT_TRUE(isStable({}, result));
}

TEST(IdealDriver, IsADamperInClosedForm) {
  for (double b : {2.0, 5.0, 20.0}) {
    StabilityCell cell;
    cell.tissue = {b, 0.0};
    // Four millimetres of air slow the arm by c x / m; then v = v0 exp(-(b + c) t / m) inside.
    const double m = cell.mass_kg, c = cell.plant_damping;
    const double v0 = 0.05 - c * 0.004 / m;
    const double inside_s = 2.0 + m / c * std::log(v0 / 0.05);
    const double decay = 2.0 * (b + c) / m;
    const double expected_N =
        b * v0 * std::sqrt((1.0 - std::exp(-decay * inside_s)) / decay / inside_s);
    EXPECT_NEAR(runCell(cell, CellDriver::ideal).contact_rms_N, expected_N, 1e-3 * expected_N)
        << "b " << b;
  }
}

TEST(IdealDriver, IsASpringInClosedForm) {
  StabilityCell cell;
  cell.plant_damping = 0.0;
  cell.tissue = {0.0, 1000.0};
  // Half a sine of amplitude v sqrt(k m).
  const double expected_N = 0.05 * std::sqrt(1000.0 * cell.mass_kg / 2.0);
  EXPECT_NEAR(runCell(cell, CellDriver::ideal).contact_rms_N, expected_N, 1e-3 * expected_N);
}

TEST(IdealDriver, HoldsAgainstTheHandAtRest) {
  StabilityCell cell;
  cell.plant_damping = 5.0;
  cell.hand = {20.0, 300.0};
  cell.tissue = {20.0, 700.0};
  // Two springs in series across 6 mm; the approach takes less than a fifth of the two seconds.
  const double at_rest_N = 0.006 * (300.0 * 700.0) / 1000.0;
  const double found_N = runCell(cell, CellDriver::ideal).contact_rms_N;
  EXPECT_NEAR(found_N, at_rest_N, 0.1 * at_rest_N);
  EXPECT_NEAR(runCell(cell, CellDriver::off).contact_rms_N, found_N, 0.01 * found_N)
      << "and a slow tissue on an arm this damped is sampled well";
}

TEST(IdealDriver, NeverPushesMoreThanTheArmCan) {
  StabilityCell cell;
  cell.hand = {10.0, 1000.0};
  cell.tissue = {0.0, 1e6};
  const double found_N = runCell(cell, CellDriver::ideal).contact_rms_N;
  EXPECT_LE(found_N, kCellForce_N);
  EXPECT_GT(found_N, 0.9 * kCellForce_N);
}

TEST(ZeroForceDriver, SendsNothingAndIsStable) {
  StabilityCell cell;
  cell.hand = {2.0, 300.0};
  cell.tissue = {10.0, 1e6};
  const CellResult result = runCell(cell, CellDriver::zero_force);
  EXPECT_TRUE(result.stable);
  EXPECT_EQ(result.contact_rms_N, 0.0);
  EXPECT_EQ(result.step_N, 0.0);
  EXPECT_EQ(result.energy_out_J, 0.0);
  EXPECT_DOUBLE_EQ(result.fidelity_error, 1.0);
}

TEST(CellReference, OfASoftTissueIsStableWithMargin) {
  StabilityCell cell;
  cell.tissue = {2.0, 0.0};
  const CellReference reference = referenceOf(cell);
  EXPECT_TRUE(reference.off.stable);
  EXPECT_TRUE(reference.margin);
  EXPECT_FALSE(reference.scale);
  EXPECT_FALSE(reference.contact_rms_N);
}

TEST(CellReference, OfAnUnstableTissueIsTheFirmestThatIsStable) {
  StabilityCell damper, wall;
  damper.tissue = {1000.0, 0.0};
  wall.tissue = {0.0, 1e5};
  wall.hand = {10.0, 1000.0};
  for (const StabilityCell& cell : {damper, wall}) {
    SCOPED_TRACE(testing::Message() << "k " << cell.tissue.stiffness);
    const CellReference reference = referenceOf(cell);
    EXPECT_FALSE(reference.off.stable);
    EXPECT_FALSE(reference.margin);
    ASSERT_TRUE(reference.scale);
    EXPECT_GT(*reference.scale, 0.01);
    EXPECT_LT(*reference.scale, 0.5);
    const CellResult there = runCell(cell, CellDriver::off, *reference.scale);
    EXPECT_TRUE(there.stable);
    EXPECT_FALSE(runCell(cell, CellDriver::off, 1.01 * *reference.scale).stable);
    ASSERT_TRUE(reference.contact_rms_N);
    EXPECT_EQ(*reference.contact_rms_N, there.contact_rms_N);
  }
}

TEST(CellReference, OfATissueThatIsStableButNotTwiceIsTheTissueItself) {
  StabilityCell cell;
  cell.tissue = {1000.0, 0.0};
  const CellReference of_firm = referenceOf(cell);
  ASSERT_TRUE(of_firm.scale);
  cell.tissue.damping *= 0.7 * *of_firm.scale;
  const CellReference reference = referenceOf(cell);
  EXPECT_TRUE(reference.off.stable);
  EXPECT_FALSE(reference.margin);
  ASSERT_TRUE(reference.scale);
  EXPECT_EQ(*reference.scale, 1.0);
  ASSERT_TRUE(reference.contact_rms_N);
  EXPECT_EQ(*reference.contact_rms_N, reference.off.contact_rms_N);
}

TEST(CellReference, OfACellThatNoTissueForceReachesIsNone) {
  StabilityCell cell;
  cell.hand = {2.0, 300.0};
  const CellReference of_air = referenceOf(cell);
  EXPECT_TRUE(of_air.off.stable);
  EXPECT_EQ(of_air.off.fidelity_error, 0.0) << "there is no ideal force to miss";
  EXPECT_FALSE(of_air.scale);
  EXPECT_FALSE(of_air.contact_rms_N);

  cell.tissue = {0.0, 1e9};  // a hundredth of it is still a rock
  const CellReference of_rock = referenceOf(cell);
  EXPECT_FALSE(of_rock.margin);
  EXPECT_FALSE(of_rock.scale);
  EXPECT_FALSE(of_rock.contact_rms_N);
}

TEST(StabilityGrid, IsTheWholeProductOnce) {
  const std::vector<StabilityCell> grid = fullGrid();
  EXPECT_EQ(grid.size(), 3645u);
  std::set<std::tuple<double, double, int, double, double, double, double, double>> different;
  std::set<double> masses, periods, encoders, hands;
  std::set<double> delays;
  std::set<std::pair<double, double>> tissues;
  for (const StabilityCell& c : grid) {
    different.emplace(c.mass_kg, c.period_s, c.delay_samples, c.encoder_m, c.hand.damping,
                      c.hand.stiffness, c.tissue.damping, c.tissue.stiffness);
    masses.insert(c.mass_kg);
    periods.insert(c.period_s);
    delays.insert(c.delay_samples);
    encoders.insert(c.encoder_m);
    hands.insert(c.hand.stiffness);
    tissues.emplace(c.tissue.stiffness, c.tissue.damping);
    EXPECT_EQ(c.plant_damping, 0.05);
    const double with_it = c.hand.stiffness == 300.0 ? 2.0 : 10.0;
    EXPECT_EQ(c.hand.damping, c.hand.stiffness == 0.0 ? 0.0 : with_it);
  }
  EXPECT_EQ(different.size(), grid.size());
  EXPECT_EQ(masses, (std::set<double>{0.020, 0.045, 0.200}));
  EXPECT_EQ(periods, (std::set<double>{0.25e-3, 1e-3, 2e-3}));
  EXPECT_EQ(delays, (std::set<double>{0.0, 1.0, 3.0}));
  EXPECT_EQ(encoders, (std::set<double>{0.0, 0.055e-3, 0.2e-3}));
  EXPECT_EQ(hands, (std::set<double>{0.0, 300.0, 1000.0}));
  EXPECT_EQ(tissues, (std::set<std::pair<double, double>>{
                         {0.0, 1.0}, {0.0, 5.0}, {0.0, 20.0}, {0.0, 50.0}, {0.0, 100.0},
                         {0.0, 1e3}, {0.0, 1e4}, {300.0, 0.0}, {300.0, 10.0}, {1e3, 0.0},
                         {1e3, 10.0}, {1e4, 0.0}, {1e4, 10.0}, {1e6, 0.0}, {1e6, 10.0}}));
}

}  // namespace
}  // namespace trephine
