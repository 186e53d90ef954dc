#include "lab/stability/stability_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <thread>

#include "support.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> keysOf(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}
using Keys = std::vector<std::string>;

// A grid file with one cell, after an edit of its JSON.
class GridFile {
 public:
  Json json = Json::parse(R"({"cells": [{
    "mass_kg": 0.03, "period_s": 0.0005, "delay_samples": 2, "encoder_mm": 0.1,
    "plant_damping": 0.2, "hand": {"k": 450.0, "b": 3.0}, "tissue": {"b": 7.0, "k": 900.0}}]})");
  Json& cell() { return json["cells"][0]; }

  Result<std::vector<StabilityCell>> read() { return readText(json.dump()); }
  Result<std::vector<StabilityCell>> readText(const std::string& text) {
    std::ofstream(file()) << text;
    return readGrid(file());
  }
  std::filesystem::path file() const { return folder_ / "grid.json"; }

 private:
  test::TemporaryFolder folder_;
};

void expectRefused(const Result<std::vector<StabilityCell>>& read, const std::string& code,
                   const std::string& field) {
  ASSERT_FALSE(read) << field;
  EXPECT_EQ(read.error().code.str(), code) << field;
  EXPECT_NE(read.error().where.find("grid.json"), std::string::npos) << read.error().sentence();
  const std::string& where = read.error().where;
  EXPECT_TRUE(where.size() >= field.size() &&
              where.compare(where.size() - field.size(), field.size(), field) == 0)
      << read.error().sentence() << " does not name " << field;
}

// A reference with and without margin, and columns that were never simulated.
JudgedCell judgedByHand(bool margin, double off_error, double bounded_error, double authority) {
  JudgedCell cell;
  cell.reference.margin = margin;
  cell.off.fidelity_error = cell.seed.fidelity_error = off_error;
  cell.bounded.fidelity_error = bounded_error;
  if (!margin) {
    cell.reference.scale = 0.5;
    cell.reference.contact_rms_N = 2.0;
    cell.off.contact_rms_N = 2.0;
    cell.bounded.contact_rms_N = authority * 2.0;
    if (authority < 0.7) cell.ideal_authority = 1.0;
  }
  return cell;
}

TEST(StabilityGridFile, IsReadWithEveryValue) {
  GridFile file;
  file.json["cells"].push_back(Json::parse(R"({
    "mass_kg": 0.2, "period_s": 0.002, "delay_samples": 0, "encoder_mm": 0, "hand": null,
    "tissue": {"b": 1e4, "k": 0}})"));
  const auto cells = file.read();
  ASSERT_TRUE(cells) << cells.error().sentence();
  ASSERT_EQ(cells->size(), 2u);
  const StabilityCell& held = (*cells)[0];
  EXPECT_EQ(held.mass_kg, 0.03);
  EXPECT_EQ(held.period_s, 0.0005);
  EXPECT_EQ(held.delay_samples, 2);
  EXPECT_DOUBLE_EQ(held.encoder_m, 0.1e-3);
  EXPECT_EQ(held.plant_damping, 0.2);
  EXPECT_EQ(held.hand.stiffness, 450.0);
  EXPECT_EQ(held.hand.damping, 3.0);
  EXPECT_EQ(held.tissue.damping, 7.0);
  EXPECT_EQ(held.tissue.stiffness, 900.0);
  const StabilityCell& free = (*cells)[1];
  EXPECT_EQ(free.plant_damping, 0.05) << "unless it is given";
  EXPECT_EQ(free.hand.stiffness, 0.0);
  EXPECT_EQ(free.hand.damping, 0.0);
  EXPECT_EQ(free.tissue.damping, 1e4);
  EXPECT_EQ(free.encoder_m, 0.0);
}

TEST(StabilityGridFile, ThatIsMissingOrNoJsonIsRefusedByName) {
  GridFile file;
  expectRefused(readGrid(file.file()), "MISSING_FILE", "grid.json");
  expectRefused(file.readText("cells: none"), "BAD_JSON", "grid.json");
  expectRefused(file.readText(""), "BAD_JSON", "grid.json");
  expectRefused(file.readText("[1, 2]"), "BAD_FIELD", "top level");
  expectRefused(file.readText("{}"), "BAD_FIELD", "cells");
}

TEST(StabilityGridFile, IsRefusedByTheFieldThatIsWrong) {
  const auto refused = [](const char* key, const Json& value, const std::string& field) {
    GridFile file;
    file.cell()[key] = value;
    expectRefused(file.read(), "BAD_FIELD", field);
  };
  refused("mass_kg", -0.045, "cells[0].mass_kg");
  refused("mass_kg", 0.0, "cells[0].mass_kg");
  refused("mass_kg", "nan", "cells[0].mass_kg");
  refused("mass_kg", nullptr, "cells[0].mass_kg");
  refused("period_s", 0.0, "cells[0].period_s");
  refused("period_s", -0.001, "cells[0].period_s");
  refused("period_s", 1.0, "cells[0].period_s");
  refused("delay_samples", 17, "cells[0].delay_samples");
  refused("delay_samples", -1, "cells[0].delay_samples");
  refused("delay_samples", 16.5, "cells[0].delay_samples");
  refused("delay_samples", 1e18, "cells[0].delay_samples");
  refused("encoder_mm", -0.055, "cells[0].encoder_mm");
  refused("plant_damping", -0.05, "cells[0].plant_damping");
  refused("hand", 3.0, "cells[0].hand");
  refused("hand", {{"k", -1.0}, {"b", 2.0}}, "cells[0].hand.k");
  refused("hand", {{"k", 300.0}}, "cells[0].hand.b");
  refused("tissue", {{"b", -1.0}, {"k", 0.0}}, "cells[0].tissue.b");
  refused("tissue", {{"b", 1.0}}, "cells[0].tissue.k");
  refused("tissue", nullptr, "cells[0].tissue");
  refused("colour", "red", "cells[0].colour");
  refused("tissue", {{"b", 1.0}, {"k", 0.0}, {"yield", 2.0}}, "cells[0].tissue.yield");
}

TEST(StabilityGridFile, IsRefusedForANumberThatIsNone) {
  GridFile file;
  const std::string good = file.json.dump();
  const auto with = [&](const std::string& number) {
    std::string text = good;
    return text.replace(text.find("0.03"), 4, number);
  };
  ASSERT_TRUE(file.readText(with("0.04")));
  expectRefused(file.readText(with("NaN")), "BAD_JSON", "grid.json");
  expectRefused(file.readText(with("Infinity")), "BAD_JSON", "grid.json");
  expectRefused(file.readText(with("1e999")), "BAD_JSON", "cells[0].mass_kg");
}

TEST(StabilityGridFile, IsRefusedWhereAFieldIsMissingAndNamesTheCell) {
  for (const char* key : {"mass_kg", "period_s", "delay_samples", "encoder_mm", "tissue"}) {
    GridFile file;
    file.json["cells"].push_back(file.cell());
    file.json["cells"][1].erase(key);
    expectRefused(file.read(), "BAD_FIELD", std::string("cells[1].") + key);
  }
}

TEST(StabilityGridFile, NeedsACellAndNothingBesideThem) {
  GridFile file;
  file.json["cells"] = Json::array();
  expectRefused(file.read(), "BAD_FIELD", "cells");
  GridFile with_more;
  with_more.json["name"] = "mine";
  expectRefused(with_more.read(), "BAD_FIELD", "name");
}

TEST(StabilityBars, AreThoseOfTheDesign) {
  BarFigures f;
  f.cells = 1000;
  f.cells_with_margin = 500;
  f.authority_cells = 400;
  EXPECT_TRUE(f.accepted());
  f.unstable = 10;
  f.unfaithful = 50;
  f.below_0_5 = 80;
  EXPECT_TRUE(f.accepted()) << "at most 1 % unstable, 10 % unfaithful, 20 % below 0.5";
  BarFigures unstable = f, unfaithful = f, weak = f;
  ++unstable.unstable;
  ++unfaithful.unfaithful;
  ++weak.below_0_5;
  EXPECT_FALSE(unstable.accepted());
  EXPECT_FALSE(unfaithful.accepted());
  EXPECT_FALSE(weak.accepted());
}

TEST(StabilityBars, CountEachCellWhereItIsAsked) {
  StabilityMeasurement m;
  m.judged.push_back(judgedByHand(true, 0.10, 0.109, 0.0));   // faithful, by less than a point
  m.judged.push_back(judgedByHand(true, 0.10, 0.111, 0.0));   // unfaithful
  m.judged.push_back(judgedByHand(true, 0.50, 0.100, 0.0));   // better than `off`
  m.judged.push_back(judgedByHand(false, 0.0, 9.0, 0.8));     // fidelity is not asked here
  m.judged.push_back(judgedByHand(false, 0.0, 0.0, 0.6));
  m.judged.push_back(judgedByHand(false, 0.0, 0.0, 0.4));
  m.judged.back().ideal_authority = 0.45;
  m.judged.push_back(judgedByHand(false, 0.0, 0.0, 0.0));
  m.judged.back().reference.contact_rms_N.reset();
  m.judged[3].bounded.stable = false;
  m.judged[4].bounded.energy_out_J = 2e-3;
  m.cells.resize(m.judged.size());

  const BarFigures f = figuresOf(m, &JudgedCell::bounded);
  EXPECT_EQ(f.cells, 7u);
  EXPECT_EQ(f.unstable, 1u);
  EXPECT_EQ(f.energy_out_J_max, 2e-3);
  EXPECT_EQ(f.cells_with_margin, 3u);
  EXPECT_EQ(f.unfaithful, 1u);
  EXPECT_NEAR(f.worst_points, 1.1, 1e-9);
  EXPECT_EQ(f.authority_cells, 3u);
  EXPECT_EQ(f.no_reference, 1u);
  EXPECT_EQ(f.below_0_7, 2u);
  EXPECT_EQ(f.below_0_5, 1u);
  ASSERT_TRUE(f.lowest_authority);
  EXPECT_DOUBLE_EQ(*f.lowest_authority, 0.4);
  EXPECT_EQ(f.ideal_below_0_7, 1u);
  EXPECT_EQ(f.ideal_below_0_5, 1u);
  EXPECT_EQ(figuresOf(m, &JudgedCell::off).unstable, 0u);
  EXPECT_EQ(figuresOf(m, &JudgedCell::zero_force).below_0_5, 3u);

  std::vector<std::pair<std::size_t, std::string>> missed;
  for (const MissedBar& bar : missedBars(m)) {
    missed.emplace_back(bar.cell, bar.bar);
    EXPECT_EQ(bar.cause.empty(), bar.bar == "stable") << "its figures, made up here, show no cause";
  }
  const std::vector<std::pair<std::size_t, std::string>> expected{
      {1, "faithful"}, {3, "stable"}, {4, "authority"}, {5, "authority"}};
  EXPECT_EQ(missed, expected);
}

// Every 8th cell of the grid: 8 shares no factor with the grid's threes and fives, so all values of
// every axis are met.
class ThinnedGrid : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::vector<StabilityCell> cells;
    const std::vector<StabilityCell> grid = fullGrid();
    for (std::size_t i = 0; i < grid.size(); i += 8) cells.push_back(grid[i]);
    const std::thread::id caller = std::this_thread::get_id();
    const Progress progress([caller](double fraction, const std::string& step) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_FALSE(step.empty());
      fractions.push_back(fraction);
    });
    auto measured = measureStability(std::move(cells), progress);
    ASSERT_TRUE(measured) << measured.error().sentence();
    measurement = std::move(*measured);
  }
  static void TearDownTestSuite() { measurement = {}; }
  static inline StabilityMeasurement measurement;
  static inline std::vector<double> fractions;
};

TEST_F(ThinnedGrid, ReportsItsProgressWhileItIsMeasured) {
  ASSERT_FALSE(fractions.empty());
  EXPECT_GE(fractions.front(), 0.0);
  EXPECT_LE(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST_F(ThinnedGrid, HasEveryCellJudged) {
  ASSERT_EQ(measurement.judged.size(), measurement.cells.size());
  ASSERT_EQ(measurement.cells.size(), 456u);
  // A few by hand: the judgement is that of the cell, whichever thread it fell to.
  for (std::size_t i : {0u, 101u, 202u, 455u}) {
    const StabilityCell& cell = measurement.cells[i];
    const CellResult bounded = runCell(cell, CellDriver::bounded);
    EXPECT_EQ(measurement.judged[i].bounded.contact_rms_N, bounded.contact_rms_N);
    EXPECT_EQ(measurement.judged[i].bounded.stable, bounded.stable);
    EXPECT_EQ(measurement.judged[i].reference.margin, referenceOf(cell).margin);
    EXPECT_EQ(measurement.judged[i].seed.step_N, runCell(cell, CellDriver::seed).step_N);
  }
}

TEST_F(ThinnedGrid, IsNotPassedByAControllerThatSendsNoForce) {
  const BarFigures zero = figuresOf(measurement, &JudgedCell::zero_force);
  EXPECT_EQ(zero.unstable, 0u) << "it is as stable as can be";
  EXPECT_FALSE(zero.accepted());
  EXPECT_EQ(zero.below_0_5, zero.authority_cells);
  EXPECT_GT(zero.authority_cells, 50u);
  EXPECT_GT(2 * zero.unfaithful, zero.cells_with_margin);
}

TEST_F(ThinnedGrid, IsStableUnderBoundedWhereItIsNotWithoutIt) {
  const BarFigures off = figuresOf(measurement, &JudgedCell::off);
  const BarFigures bounded = figuresOf(measurement, &JudgedCell::bounded);
  EXPECT_GT(4 * off.unstable, off.cells) << "or the grid asks nothing";
  EXPECT_LE(100 * bounded.unstable, bounded.cells) << "the bar: one in a hundred";
  EXPECT_LT(20 * bounded.unstable, off.unstable);
  EXPECT_LT(bounded.energy_out_J_max, 0.1 * off.energy_out_J_max);
}

TEST_F(ThinnedGrid, IsAnsweredWithExactlyItsKeys) {
  const Json json = toJson(measurement);
  EXPECT_EQ(keysOf(json["controllers"]), (Keys{"off", "seed", "bounded"}));
  for (const auto& item : json["controllers"].items()) {
    EXPECT_EQ(keysOf(item.value()), (Keys{"cells", "unstable", "energy_out_mJ_max"}));
    EXPECT_EQ(item.value()["cells"], measurement.cells.size());
  }
  EXPECT_EQ(keysOf(json["faithful"]),
            (Keys{"cells_with_margin", "unfaithful", "worst_percent_points"}));
  for (const char* key : {"cells", "no_reference", "below_0_7", "below_0_5", "lowest"}) {
    EXPECT_TRUE(json["authority"].contains(key)) << key;
  }
  const BarFigures bounded = figuresOf(measurement, &JudgedCell::bounded);
  EXPECT_EQ(json["faithful"]["cells_with_margin"].get<std::size_t>() +
                json["authority"]["cells"].get<std::size_t>() +
                json["authority"]["no_reference"].get<std::size_t>(),
            measurement.cells.size())
      << "every cell is asked one of the two, or counted apart";
  EXPECT_EQ(json["authority"]["below_0_5"], bounded.below_0_5);
  EXPECT_EQ(json["controllers"]["bounded"]["energy_out_mJ_max"], 1e3 * bounded.energy_out_J_max);

  ASSERT_EQ(json["per_cell"].size(), 3 * measurement.cells.size());
  const Keys promised{"cell",           "controller", "oscillation_mm", "step_N", "energy_out_mJ",
                      "fidelity_error", "authority",  "stable",         "margin"};
  std::size_t unstable = 0;
  for (std::size_t i = 0; i < json["per_cell"].size(); ++i) {
    const Json& row = json["per_cell"][i];
    ASSERT_EQ(keysOf(row), promised);
    ASSERT_EQ(row["cell"], i / 3);
    ASSERT_EQ(row["authority"].is_null(), row["margin"].get<bool>() ||
                                              !measurement.judged[i / 3].reference.contact_rms_N);
    unstable += row["controller"] == "off" && !row["stable"].get<bool>();
  }
  EXPECT_EQ(json["controllers"]["off"]["unstable"], unstable);
  EXPECT_TRUE(parseJson(json.dump(), "answer")) << "no value is lost in writing";
}

TEST_F(ThinnedGrid, SaysWhatHeldBackEachCellThatMissesABar) {
  const BarFigures bounded = figuresOf(measurement, &JudgedCell::bounded);
  std::size_t unstable = 0, unfaithful = 0, weak = 0;
  for (const MissedBar& bar : missedBars(measurement)) {
    EXPECT_FALSE(bar.cause.empty()) << "cell " << bar.cell << ", " << bar.bar;
    unstable += bar.bar == "stable";
    unfaithful += bar.bar == "faithful";
    weak += bar.bar == "authority";
  }
  EXPECT_EQ(unstable, bounded.unstable);
  EXPECT_EQ(unfaithful, bounded.unfaithful);
  EXPECT_EQ(weak, bounded.below_0_7);
}

TEST_F(ThinnedGrid, IsWrittenAsATableOfThreeLinesACell) {
  const test::TemporaryFolder folder;
  const Status written = writeStabilityTable(measurement, folder / "a" / "b");
  ASSERT_TRUE(written) << written.error().sentence();
  std::ifstream in(folder / "a" / "b" / "stability.csv");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 1 + 3 * measurement.cells.size());
  const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
  EXPECT_EQ(lines[0].rfind("cell,mass_kg,period_s,", 0), 0u) << lines[0];
  for (const char* column :
       {",controller,", ",oscillation_mm,", ",energy_out_mJ,", ",authority,"}) {
    EXPECT_NE(lines[0].find(column), std::string::npos) << column;
  }
  const char* controllers[] = {",off,", ",seed,", ",bounded,"};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    ASSERT_EQ(std::count(lines[i].begin(), lines[i].end(), ','), commas) << lines[i];
    ASSERT_EQ(lines[i].rfind(std::to_string((i - 1) / 3) + ",", 0), 0u) << lines[i];
    ASSERT_NE(lines[i].find(controllers[(i - 1) % 3]), std::string::npos) << lines[i];
  }
}

TEST_F(ThinnedGrid, ReadsAsTextThatSaysWhetherTheControlFails) {
  const std::string text = toText(measurement);
  EXPECT_NE(text.find("456 cells"), std::string::npos) << text;
  EXPECT_NE(text.find("fails, as it must"), std::string::npos) << text;
}

TEST(StabilityTable, IsNotWrittenWhereItsFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const Status written = writeStabilityTable({}, folder / "file");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
}

TEST(StabilityMeasurement, ThatIsCancelledBeforeItBeginsIsCancelled) {
  Progress progress;
  progress.cancel();
  const auto measured = measureStability(fullGrid(), progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANCELLED");
}

TEST(StabilityMeasurement, StopsSoonAfterItIsCancelled) {
  Progress* to_cancel = nullptr;
  double furthest = 0.0;
  Progress progress([&](double fraction, const std::string&) {
    furthest = std::max(furthest, fraction);
    to_cancel->cancel();
  });
  to_cancel = &progress;
  const auto start = std::chrono::steady_clock::now();
  const auto measured = measureStability(fullGrid(), progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANCELLED");
  EXPECT_LT(furthest, 1.0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s) << "0.2 s, and room for a busy machine";
}

}  // namespace
}  // namespace trephine
