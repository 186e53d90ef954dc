#include "tissue/tissue_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/file.h"
#include "base/system.h"
#include "schema_page.h"
#include "support.h"
#include "tissue/tissue_edits.h"

namespace trephine {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNaN = std::numeric_limits<double>::quiet_NaN();

Tissue plainTissue(const std::string& id, int hu_min, int hu_max) {
  Tissue t;
  t.id = id;
  t.name = "The " + id;
  t.hu_min = hu_min;
  t.hu_max = hu_max;
  t.hu_source = "an atlas";
  t.colour = Vec3(0.9, 0.8, 0.7);
  t.opacity = 0.25;
  t.damping_Ns_per_m = {12.5, "a paper"};
  t.stiffness_N_per_m = {800.0, "a table"};
  t.friction_N = {1.5, "tuned here, uncited"};
  t.cutting_J_per_mm3 = SourcedNumber{0.05, "a handbook"};
  return t;
}

TissueSet head() {
  return {"head",
          {plainTissue("skin", -200, 100), plainTissue("brain", 101, 299),
           plainTissue("bone", 300, 3071)}};
}

// The error of a valid set after `change`, which must make it invalid.
template <class Change>
Error errorAfter(Change&& change) {
  TissueSet set = head();
  change(set);
  const Status status = validate(set, "t.json");
  EXPECT_FALSE(status.ok());
  return status.ok() ? Error{} : status.error();
}

#define EXPECT_PART(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "'" << (text) << "' lacks '" << (part) << "'"

TEST(TissueSet, AcceptsASetThatKeepsEveryRule) {
  const Status status = validate(head(), "t.json");
  EXPECT_TRUE(status.ok()) << status.error().sentence();
}

TEST(TissueSet, HasAtLeastOneTissueAndAtMostSixteen) {
  const Error none = errorAfter([](TissueSet& s) { s.tissues.clear(); });
  EXPECT_EQ(none.where, "t.json: tissues");
  EXPECT_PART(none.what, "this one has 0");
  TissueSet set{"many", {}};
  for (int i = 0; i < 16; ++i) set.tissues.push_back(plainTissue("t" + std::to_string(i), i, i));
  EXPECT_TRUE(validate(set, "t.json").ok());
  set.tissues.push_back(plainTissue("t16", 16, 16));
  ASSERT_FALSE(validate(set, "t.json").ok());
  EXPECT_PART(validate(set, "t.json").error().what, "this one has 17");
}

TEST(TissueSet, HasIdsThatAreThereAndUnique) {
  EXPECT_EQ(errorAfter([](TissueSet& s) { s.tissues[1].id = ""; }).where, "t.json: tissues[1].id");
  const Error twice = errorAfter([](TissueSet& s) { s.tissues[2].id = "skin"; });
  EXPECT_EQ(twice.where, "t.json: tissues[2].id");
  EXPECT_PART(twice.what, "'skin'");
}

TEST(TissueSet, LiesInsideOfOtherTissuesInNoCircle) {
  TissueSet set = *readTissueSet(resourceFolder() / "tissues" / "cranium.json");
  const auto inside = [&](const char* id) -> std::string& {
    return std::ranges::find(set.tissues, id, &Tissue::id)->within;
  };
  inside("dura") = "bone";
  inside("brain") = "dura";
  EXPECT_TRUE(validate(set, "x.json")) << "one inside of another inside of a third";
  const auto refused = [&](const char* id, const char* by) {
    const std::string before = std::exchange(inside(id), by);
    const Status status = validate(set, "x.json");
    inside(id) = before;
    EXPECT_FALSE(status) << id << " in " << by;
    return status ? std::string() : status.error().sentence();
  };
  EXPECT_NE(refused("bone", "bone").find("within"), std::string::npos);
  EXPECT_NE(refused("bone", "nowhere").find("nowhere"), std::string::npos);
  EXPECT_NE(refused("bone", "dura").find("itself"), std::string::npos);
  EXPECT_NE(refused("bone", "brain").find("itself"), std::string::npos);
}

TEST(TissueSet, HasItsLowerHuFirst) {
  const Error error = errorAfter([](TissueSet& s) { s.tissues[2].hu_min = 4000; });
  EXPECT_EQ(error.where, "t.json: tissues[2].hu");
  EXPECT_PART(error.what, "4000..3071");
  TissueSet one_value{"x", {plainTissue("a", 7, 7)}};
  EXPECT_TRUE(validate(one_value, "t.json").ok());
}

TEST(TissueSet, KeepsItsHuWithinInt16) {
  EXPECT_PART(errorAfter([](TissueSet& s) { s.tissues[2].hu_max = 32768; }).what, "300..32768");
  EXPECT_PART(errorAfter([](TissueSet& s) { s.tissues[0].hu_min = -32769; }).what, "-32769..100");
  TissueSet whole{"x", {plainTissue("a", -32768, 32767)}};
  EXPECT_TRUE(validate(whole, "t.json").ok());
}

TEST(TissueSet, HasNoTwoRangesThatOverlap) {
  const Error error = errorAfter([](TissueSet& s) { s.tissues[1].hu_max = 300; });
  EXPECT_EQ(error.where, "t.json: tissues[2].hu");
  EXPECT_PART(error.what, "101..300 of 'brain'");
  EXPECT_PART(error.what, "300..3071 of 'bone'");
  EXPECT_PART(error.next, "labels");
  const TissueSet falling{"x", {plainTissue("bone", 300, 3071), plainTissue("brain", 0, 300)}};
  EXPECT_FALSE(validate(falling, "t.json").ok()) << "the order in the list does not matter";
}

TEST(TissueSet, MayOverlapWhereTheLabelsDifferOrOneHasNone) {
  TissueSet set{"x", {plainTissue("liver", 0, 200), plainTissue("kidney", 100, 300)}};
  EXPECT_FALSE(validate(set, "t.json").ok());
  set.tissues[0].label = 5;
  EXPECT_TRUE(validate(set, "t.json").ok()) << "the liver holds label 5, the other the rest";
  set.tissues[1].label = 5;
  EXPECT_FALSE(validate(set, "t.json").ok());
  set.tissues[1].label = 6;
  EXPECT_TRUE(validate(set, "t.json").ok());
}

TEST(TissueSet, HasLabelsFromOneTo255) {
  for (int label : {0, -1, 256}) {
    const Error error = errorAfter([&](TissueSet& s) { s.tissues[1].label = label; });
    EXPECT_EQ(error.where, "t.json: tissues[1].label");
    EXPECT_PART(error.what, std::to_string(label));
  }
  TissueSet set = head();
  set.tissues[0].label = 1;
  set.tissues[1].label = 255;
  EXPECT_TRUE(validate(set, "t.json").ok());
}

TEST(TissueSet, HasOpacityAndColourBetweenZeroAndOne) {
  for (double value : {-0.1, 1.1, kNaN, kInfinity}) {
    EXPECT_EQ(errorAfter([&](TissueSet& s) { s.tissues[0].opacity = value; }).where,
              "t.json: tissues[0].opacity");
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(errorAfter([&](TissueSet& s) { s.tissues[1].colour[c] = value; }).where,
                "t.json: tissues[1].colour");
    }
  }
  EXPECT_PART(errorAfter([](TissueSet& s) { s.tissues[0].opacity = 1.5; }).what, "1.5");
  EXPECT_PART(errorAfter([](TissueSet& s) { s.tissues[0].colour.y = -2.5; }).what, "-2.5");
}

// Each number of a tissue, given in head() or not.
SourcedNumber given(const TissueNumber& number, const Tissue& tissue) {
  const SourcedNumber* found = number.of(tissue);
  return found ? *found : SourcedNumber{1.0, "a paper"};
}

void setValue(const TissueNumber& number, Tissue& tissue, double value) {
  number.set(tissue, {value, given(number, tissue).source});
}

// A file of head() in which the second tissue has every number; of the two that say what cutting
// costs, the one that is asked for.
Json wholeFile(const TissueNumber& asked = kTissueNumbers[0]) {
  TissueSet set = head();
  for (const TissueNumber& m : kTissueNumbers) m.set(set.tissues[1], given(m, set.tissues[1]));
  asked.set(set.tissues[1], given(asked, set.tissues[1]));
  return toJson(set);
}

TEST(TissueSet, HasNoNegativeMechanics) {
  for (const TissueNumber& m : kTissueNumbers) {
    const Error error = errorAfter([&](TissueSet& s) { setValue(m, s.tissues[1], -0.5); });
    EXPECT_EQ(error.where, std::string("t.json: tissues[1].mechanics.") + m.key);
    EXPECT_PART(error.what, "-0.5");
    TissueSet zero = head();
    setValue(m, zero.tissues[1], 0.0);
    EXPECT_TRUE(validate(zero, "t.json").ok()) << m.key;
  }
}

TEST(TissueSet, HasNoMechanicsThatAreNotFinite) {
  for (const TissueNumber& m : kTissueNumbers) {
    for (double value : {kNaN, kInfinity, -kInfinity}) {
      const Error error = errorAfter([&](TissueSet& s) { setValue(m, s.tissues[1], value); });
      EXPECT_EQ(error.where, std::string("t.json: tissues[1].mechanics.") + m.key);
      EXPECT_PART(error.what, std::isnan(value) ? "nan" : "inf");
    }
  }
}

TEST(TissueSet, CitesTheSourceOfEachNumber) {
  for (const TissueNumber& m : kTissueNumbers) {
    const Error error = errorAfter([&](TissueSet& s) { m.set(s.tissues[0], {1.0, ""}); });
    EXPECT_EQ(error.where, std::string("t.json: tissues[0].mechanics.") + m.key);
    EXPECT_PART(error.next, "uncited");
  }
  EXPECT_EQ(errorAfter([](TissueSet& s) { s.tissues[0].hu_source = ""; }).where,
            "t.json: tissues[0].hu_source");
}

TEST(TissueSet, FindsATissueByItsId) {
  const TissueSet set = head();
  ASSERT_NE(set.find("bone"), nullptr);
  EXPECT_EQ(set.find("bone")->hu_max, 3071);
  EXPECT_EQ(set.find("Bone"), nullptr);
}

TEST(TissueSet, AFileThatSaysBothCostsOfCuttingIsRefusedByNameAndValue) {
  test::TemporaryFolder folder;
  Json json = toJson(head());
  json["tissues"][1]["mechanics"]["toughness_J_per_m2"] = {{"value", 75.8}, {"source", "a paper"}};
  ASSERT_TRUE(writeTextFile(folder / "t.json", json.dump()).ok());
  const auto read = readTissueSet(folder / "t.json");
  ASSERT_FALSE(read.ok());
  EXPECT_PART(read.error().where, "tissues[1].mechanics.toughness_J_per_m2");
  EXPECT_PART(read.error().what, "75.8 J/m\u00b2");
}

TEST(TissueSet, SaysWhatCuttingCostsByVolumeOrByAreaAndNotByBoth) {
  const Error both = errorAfter([](TissueSet& s) {
    s.tissues[1].toughness_J_per_m2 = SourcedNumber{75.8, "a paper"};
  });
  EXPECT_EQ(both.where, "t.json: tissues[1].mechanics.toughness_J_per_m2");
  EXPECT_PART(both.what, "75.8 J/m\u00b2");
  EXPECT_PART(both.what, "0.05 J/mm\u00b3");
  const Error none = errorAfter([](TissueSet& s) { s.tissues[1].cutting_J_per_mm3.reset(); });
  EXPECT_EQ(none.where, "t.json: tissues[1].mechanics.cutting_J_per_mm3");
  EXPECT_PART(none.what, "'brain'");
}

// As a file.

// The error of head()'s file after `change`, which must make it invalid.
template <class Change>
Error parseErrorAfter(Change&& change, const TissueNumber& asked = kTissueNumbers[0]) {
  Json json = wholeFile(asked);
  change(json);
  const Result<TissueSet> set = parseTissueSet(json, "t.json");
  EXPECT_FALSE(set.ok());
  return set.ok() ? Error{} : set.error();
}

TEST(TissueFile, ComesBackAsItWasWritten) {
  TissueSet set = head();
  set.tissues[1].label = 5;
  set.tissues[2].cuttable = false;
  set.tissues[0].damping_Ns_per_m.value = 0.1;  // no double holds it exactly
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "t.json", toJson(set).dump(2)));
  const Result<TissueSet> read = readTissueSet(folder / "t.json");
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  EXPECT_EQ(toJson(*read), toJson(set));
  EXPECT_EQ(read->name, "head");
  ASSERT_EQ(read->tissues.size(), 3u);
  const Tissue& skin = read->tissues[0];
  EXPECT_EQ(skin.name, "The skin");
  EXPECT_EQ(skin.hu_min, -200);
  EXPECT_EQ(skin.hu_max, 100);
  EXPECT_EQ(skin.hu_source, "an atlas");
  EXPECT_FALSE(skin.label.has_value());
  EXPECT_EQ(skin.colour, Vec3(0.9, 0.8, 0.7));
  EXPECT_EQ(skin.opacity, 0.25);
  EXPECT_EQ(skin.damping_Ns_per_m.value, 0.1);
  EXPECT_EQ(skin.damping_Ns_per_m.source, "a paper");
  EXPECT_EQ(skin.stiffness_N_per_m.value, 800.0);
  EXPECT_EQ(skin.friction_N.source, "tuned here, uncited");
  EXPECT_TRUE(skin.cuttable);
  EXPECT_EQ(read->tissues[1].label, 5);
  EXPECT_FALSE(read->tissues[2].cuttable);
}

TEST(TissueFile, EveryShippedSetIsSavedReadAndSavedAgainInTheSameBytes) {
  int sets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "tissues")) {
    SCOPED_TRACE(entry.path());
    const Result<TissueSet> shipped = readTissueSet(entry.path());
    ASSERT_TRUE(shipped.ok()) << shipped.error().sentence();
    const Json saved = toJson(*shipped);
    const Result<TissueSet> again = parseTissueSet(saved, "again.json");
    ASSERT_TRUE(again.ok()) << again.error().sentence();
    EXPECT_TRUE(*again == *shipped);
    EXPECT_EQ(toJson(*again).dump(1), saved.dump(1));
    ++sets;
  }
  EXPECT_GE(sets, 3);
}

TEST(TissueFile, ComesBackWithEveryNumberAndLacksNoneThatMustBeThere) {
  // Alone it would lack another number.
  const auto hasOther = [](const TissueNumber& m) {
    const std::string key = m.key;
    return m.isCutting() || key == "rupture_N" || key.starts_with("relaxation");
  };
  for (const TissueNumber& m : kTissueNumbers) {
    const Json json = wholeFile(m);
    const Result<TissueSet> set = parseTissueSet(json, "t.json");
    ASSERT_TRUE(set.ok()) << set.error().sentence();
    EXPECT_EQ(toJson(*set), json);
    EXPECT_TRUE(json["tissues"][1]["mechanics"].contains(m.key)) << m.key;
    Json without = json;
    without["tissues"][1]["mechanics"].erase(m.key);
    const Result<TissueSet> read = parseTissueSet(without, "t.json");
    ASSERT_EQ(read.ok(), m.row().given == Given::may_be && !hasOther(m)) << m.key;
    if (hasOther(m)) {
      EXPECT_PART(read.error().where, "t.json: tissues[1].mechanics.");
    } else if (read) {
      EXPECT_EQ(tissueTable(*read).classes[1].*m.in_tick, 0.0) << m.key;
    } else {
      EXPECT_EQ(read.error().where, std::string("t.json: tissues[1].mechanics.") + m.key);
    }
  }
}

TEST(TissueFile, ThePageIsAsTheRowsAre) {
  test::expectNumbers(resourceFolder() / "schemas" / "tissues.md", "tissue", tissueFieldsPage());
}

TEST(TissueFile, NeedsEveryFieldButLabelAndCuttable) {
  for (const char* key : {"format", "version", "name", "tissues"}) {
    EXPECT_EQ(parseErrorAfter([&](Json& j) { j.erase(key); }).where, std::string("t.json: ") + key);
  }
  for (const char* key : {"id", "name", "hu", "hu_source", "colour", "opacity", "mechanics"}) {
    EXPECT_EQ(parseErrorAfter([&](Json& j) { j["tissues"][1].erase(key); }).where,
              std::string("t.json: tissues[1].") + key);
  }
  for (const TissueNumber& m : kTissueNumbers) {
    for (const char* key : {"value", "source"}) {
      EXPECT_EQ(parseErrorAfter([&](Json& j) { j["tissues"][1]["mechanics"][m.key].erase(key); }, m)
                    .where,
                std::string("t.json: tissues[1].mechanics.") + m.key + "." + key);
    }
  }
  Json json = toJson(head());
  json["tissues"][0]["mechanics"].erase("cuttable");
  const Result<TissueSet> set = parseTissueSet(json, "t.json");
  ASSERT_TRUE(set.ok()) << set.error().sentence();
  EXPECT_TRUE(set->tissues[0].cuttable);
}

TEST(TissueFile, RefusesAnUnknownFieldByNameAndValue) {
  const Error top = parseErrorAfter([](Json& j) { j["author"] = "me"; });
  EXPECT_EQ(top.where, "t.json: author");
  EXPECT_PART(top.what, "\"me\"");
  EXPECT_EQ(parseErrorAfter([](Json& j) { j["tissues"][2]["opactiy"] = 0.5; }).where,
            "t.json: tissues[2].opactiy");
  EXPECT_EQ(parseErrorAfter([](Json& j) { j["tissues"][0]["mechanics"]["friction"] = 1; }).where,
            "t.json: tissues[0].mechanics.friction");
  EXPECT_EQ(
      parseErrorAfter([](Json& j) { j["tissues"][0]["mechanics"]["friction_N"]["unit"] = "N"; }).where,
      "t.json: tissues[0].mechanics.friction_N.unit");
}

TEST(TissueFile, RefusesANewerVersionByName) {
  const Error error = parseErrorAfter([](Json& j) { j["version"] = 2; });
  EXPECT_EQ(error.where, "t.json: version");
  EXPECT_PART(error.what, "version 2 of trephine.tissues");
  EXPECT_PART(parseErrorAfter([](Json& j) { j["format"] = "trephine.scene"; }).what,
              "trephine.scene");
}

TEST(TissueFile, RefusesAnHuRangeThatIsNotTwoWholeNumbers) {
  for (const char* hu : {"[1]", "[1, 2, 3]", "[1.5, 2]", "[\"a\", 2]", "7", "null"}) {
    const Error error = parseErrorAfter([&](Json& j) { j["tissues"][0]["hu"] = Json::parse(hu); });
    EXPECT_EQ(error.where, "t.json: tissues[0].hu") << hu;
  }
}

TEST(TissueFile, RefusesWholeNumbersThatWouldWrapRoundIntoValidOnes) {
  const Error hu = parseErrorAfter([](Json& j) {
    j["tissues"][0]["hu"] = {4294967296, 4294967300};
  });
  EXPECT_EQ(hu.where, "t.json: tissues[0].hu");
  EXPECT_PART(hu.what, "4294967296");
  const Error label = parseErrorAfter([](Json& j) { j["tissues"][0]["label"] = 4294967301; });
  EXPECT_EQ(label.where, "t.json: tissues[0].label");
  EXPECT_PART(label.what, "4294967301");
}

TEST(TissueFile, IsHeldToTheRulesOfTheSet) {
  const Error error = parseErrorAfter([](Json& j) { j["tissues"][1]["hu"] = {0, 299}; });
  EXPECT_EQ(error.code.str(), "BAD_TISSUE");
  EXPECT_EQ(error.where, "t.json: tissues[1].hu");
  EXPECT_PART(error.what, "overlap");
}

TEST(TissueFile, RefusesNumbersOutOfTheirRangeByFieldAndValue) {
  const auto expectRefused = [](auto change, const char* field, const char* value,
                                const TissueNumber& asked = kTissueNumbers[0]) {
    const Error error = parseErrorAfter(change, asked);
    EXPECT_EQ(error.where, std::string("t.json: tissues[1].") + field);
    EXPECT_PART(error.what, value);
  };
  for (const TissueNumber& m : kTissueNumbers) {
    const std::string field = std::string("mechanics.") + m.key + ".value";
    expectRefused([&](Json& j) { j["tissues"][1]["mechanics"][m.key]["value"] = -3.0; },
                  field.c_str(), "-3.0", m);
    expectRefused([&](Json& j) { j["tissues"][1]["mechanics"][m.key]["value"] = 1e12; },
                  field.c_str(), "1000000000000.0", m);
  }
  expectRefused([](Json& j) { j["tissues"][1]["opacity"] = 1.5; }, "opacity", "1.5");
  expectRefused([](Json& j) { j["tissues"][1]["colour"][2] = -0.5; }, "colour", "-0.5");
  expectRefused([](Json& j) { j["tissues"][1]["hu"][1] = 40000; }, "hu", "40000");
  expectRefused([](Json& j) { j["tissues"][1]["label"] = 0; }, "label", "0");
}

TEST(TissueFile, NamesANumberThatNoDoubleHoldsByFileFieldAndValue) {
  std::string text = toJson(head()).dump();
  const std::string value = "12.5";
  text.replace(text.rfind(value), value.size(), "1e999");
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "t.json", text));
  const Result<TissueSet> set = readTissueSet(folder / "t.json");
  ASSERT_FALSE(set.ok());
  EXPECT_EQ(set.error().where,
            (folder / "t.json").string() + ": tissues[2].mechanics.damping_Ns_per_m.value");
  EXPECT_PART(set.error().what, "1e999");
}

TEST(TissueFile, NamesAFileThatIsNotThere) {
  const Result<TissueSet> set = readTissueSet("none/such.json");
  ASSERT_FALSE(set.ok());
  EXPECT_EQ(set.error().code.str(), "MISSING_FILE");
  EXPECT_EQ(set.error().where, "none/such.json");
}

TEST(TissueFile, IsValidAndComesBackForEverySetThatIsShipped) {
  int sets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "tissues")) {
    const Result<TissueSet> set = readTissueSet(entry.path());
    ASSERT_TRUE(set.ok()) << set.error().sentence();
    const Result<TissueSet> again = parseTissueSet(toJson(*set), "again");
    ASSERT_TRUE(again.ok()) << again.error().sentence();
    EXPECT_EQ(toJson(*again), toJson(*set));
    ++sets;
  }
  EXPECT_GE(sets, 2);
}

// In the tick.

TEST(TissueTable, HasEveryNumberOfTheSet) {
  TissueSet set = head();
  double value = 0.5;
  for (const TissueNumber& m : kTissueNumbers) {
    setValue(m, set.tissues[2], value += 1.0);
    EXPECT_EQ(tissueTable(set).classes[2].*m.in_tick, value) << m.key;
  }
  const TissueClass whole = tissueTable(set).classes[2];
  EXPECT_EQ(whole.rupture_N, 4.5);
  EXPECT_EQ(whole.toughness_J_per_m2, 6.5);
  EXPECT_EQ(whole.cutting_J_per_mm3, 0.0) << "the toughness says what cutting costs";
}

TEST(TissueTable, KeepsTheOrderAndTheNumbersOfTheSet) {
  TissueSet set = head();
  set.tissues[1].cuttable = false;
  const TissueTable table = tissueTable(set);
  ASSERT_EQ(table.count, 3);
  EXPECT_EQ(table.classes[2].hu_min, 300);
  EXPECT_EQ(table.classes[2].hu_max, 3071);
  EXPECT_EQ(table.classes[2].damping_Ns_per_m, 12.5);
  EXPECT_EQ(table.classes[2].stiffness_N_per_m, 800.0);
  EXPECT_EQ(table.classes[2].friction_N, 1.5);
  EXPECT_EQ(table.classes[0].cuttable, 1);
  EXPECT_EQ(table.classes[1].cuttable, 0);
  EXPECT_EQ(table.classes[1].label, 0);
  set.tissues[1].label = 7;
  EXPECT_EQ(tissueTable(set).classes[1].label, 7);
}

TEST(Classify, HoldsBothEndsOfARange) {
  const TissueTable table = tissueTable(head());
  EXPECT_EQ(classify(table, -200), 0);
  EXPECT_EQ(classify(table, 100), 0);
  EXPECT_EQ(classify(table, 101), 1);
  EXPECT_EQ(classify(table, 299), 1);
  EXPECT_EQ(classify(table, 300), 2);
  EXPECT_EQ(classify(table, 3071), 2);
}

TEST(Classify, TakesWhatNoRangeHoldsForFreeSpace) {
  const TissueTable table = tissueTable(head());
  for (int hu : {-32768, -1024, -201, 3072, 32767}) {
    EXPECT_EQ(classify(table, std::int16_t(hu)), -1) << hu;
  }
  EXPECT_EQ(classify(TissueTable{}, 0), -1);
}

TEST(Classify, FindsNoTissueThatIsBoundToALabel) {
  TissueSet set = head();
  set.tissues[1].label = 5;
  const TissueTable table = tissueTable(set);
  EXPECT_EQ(table.count, 3);
  EXPECT_EQ(classify(table, 200), -1);
  EXPECT_EQ(classify(table, 500), 2) << "the others keep their place";
}

TEST(Classify, PutsATissueOfTheLabelBeforeOneOfAnyVoxelInWhateverOrder) {
  for (bool labelled_first : {true, false}) {
    TissueSet set{"x", {plainTissue("soft", -100, 300), plainTissue("liver", -1000, 1000)}};
    set.tissues[1].label = 5;
    if (labelled_first) std::swap(set.tissues[0], set.tissues[1]);
    const int liver = labelled_first ? 0 : 1, soft = 1 - liver;
    const TissueTable table = tissueTable(set);
    EXPECT_EQ(classify(table, 50, 5), liver);
    EXPECT_EQ(classify(table, 50, 6), soft);
    EXPECT_EQ(classify(table, 50), soft);
    EXPECT_EQ(classify(table, 900, 5), liver);
    EXPECT_EQ(classify(table, 900, 6), -1);
  }
}

TEST(Classify, HoldsWhatRemovalLeavesToBeFreeSpace) {
  TissueSet set{"x", {plainTissue("all", -2000, 3000)}};
  EXPECT_EQ(classify(tissueTable(set), kRemovedHu), -1);
  EXPECT_EQ(classify(tissueTable(set), kRemovedHu + 1), 0);
  EXPECT_EQ(classify(tissueTable(set), kRemovedHu - 1), 0);
}

TEST(LabelRows, GivesEachLabelThatIsNamedARowAndAllOthersTheFirst) {
  TissueSet set = head();
  EXPECT_EQ(LabelRows(tissueTable(set)).count, 1);
  set.tissues[0].label = 5;
  set.tissues[1].label = 200;
  set.tissues[2].label = 5;
  const LabelRows rows(tissueTable(set));
  EXPECT_EQ(rows.count, 3);
  EXPECT_EQ(rows.row[5], 1);
  EXPECT_EQ(rows.row[200], 2);
  EXPECT_EQ(rows.label[1], 5);
  EXPECT_EQ(rows.label[2], 200);
  EXPECT_EQ(rows.row[0] + rows.row[6] + rows.row[255], 0);
}

TEST(TissueTable, TakesNoMoreThanItHoldsOfASetThatIsTooLong) {
  TissueSet set{"many", {}};
  for (int i = 0; i < kMaxTissues + 4; ++i) {
    set.tissues.push_back(plainTissue("t" + std::to_string(i), i, i));
  }
  EXPECT_EQ(tissueTable(set).count, kMaxTissues);
}

}  // namespace
}  // namespace trephine
