#include "tissue/sourced_number.h"

#include <gtest/gtest.h>

#include <limits>

#include "tissue/tissue_set.h"

namespace trephine {
namespace {

using Limits = std::numeric_limits<double>;
constexpr Range kNewtons{0, 1e9, "N"};

// A published measurement, with all that can be known of it.
SourcedNumber measured() {
  return {2.5, "a paper", {{2.2, 3.3}}, Confidence::measured, "human cadaver, access needle"};
}

Json measuredFile() {
  return Json::parse(R"({"value": 2.5, "source": "a paper", "range": [2.2, 3.3],
                         "confidence": "measured", "condition": "human cadaver, access needle"})");
}

// As a tissue set's file has it.
Result<SourcedNumber> read(const Json& json) {
  const Json file{{"rupture_N", json}};
  JsonReader reader(file, "t.json");
  const SourcedNumber number = readSourced(reader.object("rupture_N"), kNewtons);
  if (Status status = reader.finish(); !status) return status.error();
  if (Status status = checkSourced("t.json", "rupture_N", kNewtons, number); !status) {
    return status.error();
  }
  return number;
}

Error errorOf(const Json& json) {
  const Result<SourcedNumber> number = read(json);
  EXPECT_FALSE(number.ok()) << json;
  return number ? Error{} : number.error();
}

// The error of measuredFile() with another value of one field.
Error errorWith(const char* key, const Json& value) {
  Json json = measuredFile();
  json[key] = value;
  return errorOf(json);
}

#define EXPECT_PART(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "'" << (text) << "' lacks '" << (part) << "'"

TEST(SourcedNumber, ComesBackWithAllThatIsKnownOfIt) {
  const Result<SourcedNumber> number = read(measuredFile());
  ASSERT_TRUE(number.ok()) << number.error().sentence();
  EXPECT_EQ(*number, measured());
  EXPECT_EQ(toJson(*number), measuredFile());
  for (const auto& [name, confidence] : kConfidenceNames) {
    Json json = measuredFile();
    json["confidence"] = std::string(name);
    ASSERT_TRUE(read(json)) << name;
    EXPECT_EQ(read(json)->stated, confidence);
    EXPECT_EQ(toJson(*read(json)), json);
  }
}

TEST(SourcedNumber, IsWrittenWithoutWhatIsNotKnown) {
  const Json bare{{"value", 2.5}, {"source", "a paper"}};
  ASSERT_TRUE(read(bare));
  EXPECT_EQ(toJson(*read(bare)), bare);
  const Json own{{"value", 2.5}, {"source", kOwnSource}};
  EXPECT_EQ(toJson(*read(own)), own) << "tuned, without a word of it";
}

TEST(SourcedNumber, OfItsOwnSourceIsTunedAndOfAnotherNotStated) {
  EXPECT_EQ((SourcedNumber{1.0, kOwnSource}.confidence()), Confidence::tuned);
  EXPECT_EQ((SourcedNumber{1.0, "a paper"}.confidence()), Confidence::unstated);
  EXPECT_EQ((SourcedNumber{1.0, kOwnSource}),
            (SourcedNumber{1.0, kOwnSource, {}, Confidence::tuned}));
  EXPECT_FALSE((SourcedNumber{1.0, "a paper"}) ==
               (SourcedNumber{1.0, "a paper", {}, Confidence::tuned}));
}

TEST(SourcedNumber, DiffersInWhateverIsKnownOfIt) {
  for (const auto& change : std::vector<void (*)(SourcedNumber&)>{
           [](SourcedNumber& n) { n.value = 2.6; }, [](SourcedNumber& n) { n.source = "a book"; },
           [](SourcedNumber& n) { n.range->low = 2.1; },
           [](SourcedNumber& n) { n.range->high = 3.4; }, [](SourcedNumber& n) { n.range.reset(); },
           [](SourcedNumber& n) { n.stated = Confidence::derived; },
           [](SourcedNumber& n) { n.condition.clear(); }}) {
    SourcedNumber other = measured();
    change(other);
    EXPECT_FALSE(other == measured());
  }
}

TEST(SourcedNumber, ItsRangeIsTwoFiniteNumbersInOrderAndNoneNegative) {
  for (const char* range :
       {"[1]", "[1, 2, 3]", "7", "null", R"(["a", 2])", "[-1, 2]", "[1, 1e10]"}) {
    EXPECT_EQ(errorWith("range", Json::parse(range)).where, "t.json: rupture_N.range") << range;
  }
  const Error falling = errorWith("range", {3.3, 2.2});
  EXPECT_EQ(falling.where, "t.json: rupture_N.range");
  EXPECT_PART(falling.what, "3.3 to 2.2");
  EXPECT_NE(falling.next, "");
  for (const double end : {Limits::quiet_NaN(), Limits::infinity(), -1.0}) {
    for (const bool low : {true, false}) {
      SourcedNumber number = measured();
      (low ? number.range->low : number.range->high) = end;
      const Status status = checkSourced("t.json", "rupture_N", kNewtons, number);
      ASSERT_FALSE(status) << end;
      EXPECT_EQ(status.error().where, "t.json: rupture_N.range");
    }
  }
}

TEST(SourcedNumber, ItsRangeNeedNotHoldItsValueAndMayBeOneNumber) {
  for (const Json& range : {Json{3.0, 4.0}, Json{0.0, 1.0}, Json{2.5, 2.5}}) {
    Json json = measuredFile();
    json["range"] = range;
    EXPECT_TRUE(read(json)) << range;
  }
}

TEST(SourcedNumber, ItsConfidenceIsOneOfTheNamesAndNotWhatIsMeantByNone) {
  for (const char* name : {"sure", "unstated", "", "Measured"}) {
    const Error error = errorWith("confidence", name);
    EXPECT_EQ(error.where, "t.json: rupture_N.confidence");
    EXPECT_PART(error.what, std::string("'") + name + "'");
    EXPECT_PART(error.next, "second-hand");
  }
  EXPECT_EQ(errorWith("confidence", 3).where, "t.json: rupture_N.confidence");
}

TEST(SourcedNumber, ThatIsMeasuredHasASourceOfTheMeasurement) {
  const Error error = errorWith("source", kOwnSource);
  EXPECT_EQ(error.code.str(), "BAD_TISSUE");
  EXPECT_EQ(error.where, "t.json: rupture_N.confidence");
  EXPECT_PART(error.what, "2.5");
  EXPECT_PART(error.what, kOwnSource);
  EXPECT_PART(error.next, "tuned");
  Json json = measuredFile();
  json["confidence"] = "tuned";
  EXPECT_TRUE(read(json)) << "tuned after a paper";
  json["source"] = kOwnSource;
  EXPECT_TRUE(read(json));
}

TEST(SourcedNumber, ItsConditionIsOneCleanLineAndNoneWhereItIsEmpty) {
  Json json = measuredFile();
  json["condition"] = " bovine liver\nex vivo ";
  ASSERT_TRUE(read(json));
  EXPECT_EQ(read(json)->condition, "bovine liver ex vivo");
  json["condition"] = "";
  EXPECT_FALSE(toJson(*read(json)).contains("condition"));
  EXPECT_EQ(errorWith("condition", 5).where, "t.json: rupture_N.condition");
  EXPECT_EQ(errorWith("condition", std::string(5000, 'x')).where, "t.json: rupture_N.condition");
}

TEST(Provenance, SaysWhatWasPublishedHowItIsKnownAndUnderWhichCondition) {
  EXPECT_EQ(provenanceWords(measured(), "N", 1.0),
            "published 2.2 to 3.3 N (measured; human cadaver, access needle)");
  SourcedNumber number = measured();
  number.condition.clear();
  EXPECT_EQ(provenanceWords(number, "", 100.0), "published 220 to 330 (measured)")
      << "in the unit that is shown";
  number.range = {2.5, 2.5};
  EXPECT_EQ(provenanceWords(number, "N", 1.0), "published 2.5 N (measured)");
  number.range.reset();
  EXPECT_EQ(provenanceWords(number, "N", 1.0), "measured");
  EXPECT_EQ(provenanceWords({1.0, "a paper"}, "N", 1.0), "");
}

TEST(Provenance, SaysThatAValueLiesOutsideOfWhatWasPublished) {
  SourcedNumber number = measured();
  for (const auto& [value, factor] : {std::pair(1.1, "0.5"), {3.4, "1.03"}}) {
    number.value = value;
    EXPECT_EQ(provenanceWords(number, "N", 1.0),
              std::string("outside the published 2.2 to 3.3 N, by a factor of ") + factor +
                  " (measured; human cadaver, access needle)");
  }
  // No factor leads to nothing, or from it.
  number.value = 0.0;
  EXPECT_EQ(provenanceWords(number, "N", 1.0).find("factor"), std::string::npos);
  for (const double end : {2.2, 3.3}) {
    number.value = end;
    EXPECT_EQ(provenanceWords(number, "N", 1.0), provenanceWords(measured(), "N", 1.0));
  }
}

TEST(Provenance, SaysTunedWhereTheSourceDoesNot) {
  EXPECT_EQ(provenanceWords({1.0, kOwnSource}, "N", 1.0), "");
  EXPECT_EQ(provenanceWords({1.0, "after a paper", {}, Confidence::tuned}, "N", 1.0), "tuned here");
}

TEST(Provenance, HasAWordForEachConfidence) {
  for (const auto& [name, confidence] : kConfidenceNames) {
    EXPECT_NE(confidenceWord(confidence), "") << name;
  }
  EXPECT_EQ(confidenceWord(Confidence::unstated), "");
}

}  // namespace
}  // namespace trephine
