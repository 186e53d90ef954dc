// JsonReader: every field is there, known and of its type, or the error names it.
#include <gtest/gtest.h>

#include <limits>

#include "base/json.h"

namespace trephine {
namespace {

constexpr Range kAny{-1e19, 1e19};

Json json(const char* text) {
  Result<Json> parsed = parseJson(text, "test");
  EXPECT_TRUE(parsed.ok()) << text;
  return parsed.ok() ? *parsed : Json();
}

// The error of reading `text` with `read`, which must fail.
template <class Read>
Error errorOf(const char* text, Read&& read) {
  const Json object = json(text);
  JsonReader reader(object, "f.json");
  read(reader);
  const Status status = reader.finish();
  EXPECT_FALSE(status.ok()) << text;
  return status.ok() ? Error{} : status.error();
}

bool says(const Error& error, const std::string& part) {
  return error.what.find(part) != std::string::npos;
}

TEST(JsonReader, ReadsEveryTypeOfField) {
  const Json object = json(R"({"n": 1.5, "i": -3, "b": true, "t": "x", "v": [1, 2, 3],
                               "l": ["p", "q"], "h": [-5, 9], "o": {"k": 4}, "a": [{"k": 5}]})");
  JsonReader reader(object, "f.json");
  EXPECT_EQ(reader.number("n", kAny), 1.5);
  EXPECT_EQ(reader.integer("i", kAny), -3);
  EXPECT_TRUE(reader.boolean("b", false));
  EXPECT_EQ(reader.text("t"), "x");
  EXPECT_EQ(reader.vec3("v", kAny), Vec3(1, 2, 3));
  EXPECT_EQ(reader.texts("l", 9), (std::vector<std::string>{"p", "q"}));
  EXPECT_EQ(reader.integers("h", 2, kAny), (std::vector<std::int64_t>{-5, 9}));
  EXPECT_EQ(reader.object("o").number("k", kAny), 4.0);
  std::vector<JsonReader> items = reader.objects("a", 9);
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].number("k", kAny), 5.0);
  const Status status = reader.finish();
  EXPECT_TRUE(status.ok()) << status.error().sentence();
}

TEST(JsonReader, TakesTheFallbackOfAFieldThatIsAbsent) {
  const Json object = json("{}");
  JsonReader reader(object, "f.json");
  EXPECT_EQ(reader.number("n", kAny, 2.5), 2.5);
  EXPECT_EQ(reader.integer("i", kAny, 7), 7);
  EXPECT_TRUE(reader.boolean("b", true));
  EXPECT_EQ(reader.text("t", "d"), "d");
  EXPECT_EQ(reader.vec3("v", kAny, Vec3(1, 0, 0)), Vec3(1, 0, 0));
  EXPECT_TRUE(reader.raw("r").is_null());
  EXPECT_TRUE(reader.finish().ok());
}

TEST(JsonReader, DoesNotLetAFallbackHideAWrongType) {
  EXPECT_EQ(errorOf(R"({"n": "1"})", [](JsonReader& r) { r.number("n", kAny, 1.0); }).where,
            "f.json: n");
  EXPECT_EQ(errorOf(R"({"i": 1.5})", [](JsonReader& r) { r.integer("i", kAny, 1); }).where,
            "f.json: i");
  EXPECT_EQ(errorOf(R"({"b": 1})", [](JsonReader& r) { r.boolean("b", true); }).where, "f.json: b");
  EXPECT_EQ(errorOf(R"({"t": null})", [](JsonReader& r) { r.text("t", ""); }).where, "f.json: t");
  EXPECT_EQ(errorOf(R"({"v": []})", [](JsonReader& r) { r.vec3("v", kAny, Vec3(0)); }).where,
            "f.json: v");
}

TEST(JsonReader, NamesAFieldThatIsMissing) {
  const auto where = [](auto read) { return errorOf("{}", read).where; };
  EXPECT_EQ(where([](JsonReader& r) { r.number("k", kAny); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.integer("k", kAny); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.text("k"); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.vec3("k", kAny); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.texts("k", 9); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.integers("k", 2, kAny); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.object("k"); }), "f.json: k");
  EXPECT_EQ(where([](JsonReader& r) { r.objects("k", 9); }), "f.json: k");
}

TEST(JsonReader, NamesFieldAndValueOfAWrongType) {
  const Error number = errorOf(R"({"k": "seven"})", [](JsonReader& r) { r.number("k", kAny); });
  EXPECT_EQ(number.code.str(), "BAD_FIELD");
  EXPECT_EQ(number.where, "f.json: k");
  EXPECT_TRUE(says(number, R"("seven")")) << number.what;
  EXPECT_FALSE(number.next.empty());
  EXPECT_TRUE(says(errorOf(R"({"k": 1.5})", [](JsonReader& r) { r.integer("k", kAny); }), "1.5"));
  EXPECT_TRUE(says(errorOf(R"({"k": 12})", [](JsonReader& r) { r.text("k"); }), "12"));
  EXPECT_TRUE(says(errorOf(R"({"k": 3})", [](JsonReader& r) { r.boolean("k", false); }), "3"));
  EXPECT_TRUE(says(errorOf(R"({"k": [1, 2]})", [](JsonReader& r) { r.vec3("k", kAny); }), "[1,2]"));
  EXPECT_TRUE(
      says(errorOf(R"({"k": [1, "b", 3]})", [](JsonReader& r) { r.vec3("k", kAny); }), R"("b")"));
  EXPECT_TRUE(says(errorOf(R"({"k": ["a", 2]})", [](JsonReader& r) { r.texts("k", 9); }), "2"));
  EXPECT_TRUE(says(errorOf(R"({"k": [1, 2, 3]})", [](JsonReader& r) { r.integers("k", 2, kAny); }),
                   "[1,2,3]"));
  EXPECT_TRUE(
      says(errorOf(R"({"k": [1, 2.5]})", [](JsonReader& r) { r.integers("k", 2, kAny); }), "2.5"));
  EXPECT_TRUE(says(errorOf(R"({"k": 9})", [](JsonReader& r) { r.object("k"); }), "9"));
  EXPECT_TRUE(says(errorOf(R"({"k": {}})", [](JsonReader& r) { r.objects("k", 9); }), "{}"));
}

TEST(JsonReader, RefusesAWholeNumberThatWouldWrapRound) {
  const Json object = json(R"({"k": 9223372036854775807})");
  JsonReader reader(object, "f.json");
  EXPECT_EQ(reader.integer("k", kAny), std::numeric_limits<std::int64_t>::max());
  EXPECT_TRUE(reader.finish().ok());
  const Error error =
      errorOf(R"({"k": 18446744073709551615})", [](JsonReader& r) { r.integer("k", kAny); });
  EXPECT_TRUE(says(error, "18446744073709551615")) << error.what;
}

TEST(JsonReader, RefusesANumberThatIsNotFinite) {
  const Json object = {{"k", std::numeric_limits<double>::quiet_NaN()}};
  JsonReader reader(object, "f.json");
  EXPECT_EQ(reader.number("k", kAny), 0.0);
  const Status status = reader.finish();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().where, "f.json: k");
}

TEST(JsonReader, RefusesANumberOutOfItsRangeWithItsValueAndTheRange) {
  constexpr Range kLength{0, 1000, "mm"};
  const auto what = [](const char* text, auto read) { return errorOf(text, read).what; };
  const std::string expected = "must lie between 0 and 1000 mm";
  for (const char* text : {R"({"k": 1e300})", R"({"k": -1})", R"({"k": 1000.1})"}) {
    const std::string found = what(text, [&](JsonReader& r) { r.number("k", kLength); });
    EXPECT_NE(found.find(expected), std::string::npos) << found;
    EXPECT_EQ(found, what(text, [&](JsonReader& r) { r.number("k", kLength, 5.0); }));
  }
  EXPECT_EQ(what(R"({"k": -3})", [&](JsonReader& r) { r.integer("k", kLength); }),
            "The value -3 " + expected);
  EXPECT_EQ(what(R"({"k": [1, 2, 1e9]})", [&](JsonReader& r) { r.vec3("k", kLength); }),
            "The value 1000000000.0 " + expected);
  EXPECT_EQ(what(R"({"k": [1, 1001]})", [&](JsonReader& r) { r.integers("k", 2, kLength); }),
            "The value 1001 " + expected);
  EXPECT_EQ(what(R"({"k": [-0.5, 1]})", [&](JsonReader& r) { r.numbers("k", 2, kLength); }),
            "The value -0.5 " + expected);
  const Json ends = json(R"({"low": 0, "high": 1000})");
  JsonReader reader(ends, "f.json");
  EXPECT_EQ(reader.number("low", kLength), 0.0);
  EXPECT_EQ(reader.number("high", kLength), 1000.0);
  EXPECT_TRUE(reader.finish().ok()) << "both ends are allowed";
}

TEST(JsonReader, MakesADirectionAUnitVectorAndRefusesOneThatPointsNowhere) {
  const Json object = json(R"({"k": [0, -3, 4]})");
  JsonReader reader(object, "f.json");
  EXPECT_NEAR(glm::length(reader.direction("k") - Vec3(0.0, -0.6, 0.8)), 0.0, 1e-15);
  EXPECT_EQ(reader.direction("absent", Vec3(1, 0, 0)), Vec3(1, 0, 0));
  EXPECT_TRUE(reader.finish().ok());
  for (const char* text : {R"({"k": [0, 0, 0]})", R"({"k": [1e-9, 0, 0]})", R"({"k": [0, 1e9, 0]})",
                           R"({"k": [1000, 1000, 0]})"}) {
    EXPECT_EQ(errorOf(text, [](JsonReader& r) { r.direction("k"); }).where, "f.json: k") << text;
  }
}

TEST(JsonReader, RefusesAListThatIsTooLongAndATextThatIsTooLong) {
  EXPECT_TRUE(says(errorOf(R"({"a": [{}, {}, {}]})", [](JsonReader& r) { r.objects("a", 2); }),
                   "at most 2 objects, found 3"));
  EXPECT_TRUE(says(errorOf(R"({"a": ["x", "y"]})", [](JsonReader& r) { r.texts("a", 1); }),
                   "at most 1 texts, found 2"));
  const Json object = {{"k", std::string(5000, 'z')}};
  JsonReader reader(object, "f.json");
  EXPECT_EQ(reader.text("k"), "");
  EXPECT_FALSE(reader.finish().ok());
}

TEST(JsonReader, RefusesATextThatIsNoPlainLine) {
  for (const char* text : {"a\nOK: verified", "a\u2028b", "\x1b[2J", "a\u202E"}) {
    SCOPED_TRACE(text);
    const Json json = {{"name", text}, {"names", {"good", text}}};
    JsonReader one(json, "f");
    (void)one.text("name");
    EXPECT_EQ(one.finish().error().where, "f: name");
    JsonReader list(json, "f");
    (void)list.texts("names", 2);
    EXPECT_EQ(list.finish().error().where, "f: names");
  }
}

TEST(JsonReader, NamesFieldAndValueThatNobodyReads) {
  const Error error =
      errorOf(R"({"damping": 1, "dampnig": 2})", [](JsonReader& r) { r.number("damping", kAny); });
  EXPECT_EQ(error.where, "f.json: dampnig");
  EXPECT_TRUE(says(error, "2")) << error.what;
}

TEST(JsonReader, NamesAnUnknownFieldInsideObjectsAndLists) {
  EXPECT_EQ(
      errorOf(R"({"o": {"k": 1, "x": 2}})", [](JsonReader& r) { r.object("o").number("k", kAny); })
          .where,
      "f.json: o.x");
  EXPECT_EQ(errorOf(R"({"a": [{"k": 1}, {"k": 1, "x": 2}]})",
                    [](JsonReader& r) {
                      for (JsonReader& item : r.objects("a", 9)) item.number("k", kAny);
                    })
                .where,
            "f.json: a[1].x");
}

TEST(JsonReader, NamesTheElementOfAListThatIsNoObject) {
  EXPECT_EQ(errorOf(R"({"a": [{}, 7]})", [](JsonReader& r) { r.objects("a", 9); }).where,
            "f.json: a[1]");
}

TEST(JsonReader, ReportsTheFirstProblemOfSeveral) {
  const Error error = errorOf(R"({"a": "x", "b": "y"})", [](JsonReader& r) {
    r.number("a", kAny);
    r.number("b", kAny);
    r.number("c", kAny);
  });
  EXPECT_EQ(error.where, "f.json: a");
}

TEST(JsonReader, KeepsAProblemThatItsCallerFound) {
  const Error error = errorOf(R"({"a": 3})", [](JsonReader& r) {
    r.number("a", kAny);
    r.fail("a", "The value 3 is odd", "Use an even one");
  });
  EXPECT_EQ(error.sentence(), "The value 3 is odd (f.json: a). Use an even one.");
}

TEST(JsonReader, RefusesAFileWhoseTopLevelIsNoObject) {
  for (const char* text : {"[]", "3", "null", "\"text\""}) {
    const Error error = errorOf(text, [](JsonReader& r) { r.has("k"); });
    EXPECT_TRUE(says(error, "Expected an object")) << error.what;
  }
}

TEST(JsonReader, ShortensAHugeValueInItsError) {
  const std::string text = R"({"k": ")" + std::string(100000, 'z') + R"("})";
  EXPECT_LT(errorOf(text.c_str(), [](JsonReader& r) { r.number("k", kAny); }).what.size(), 200u);
}

TEST(JsonReader, ShortensBetweenCharactersNotInsideOne) {
  for (std::size_t lead = 0; lead < 3; ++lead) {
    std::string value(lead, 'a');
    for (int i = 0; i < 40; ++i) value += "\u9ab8";
    const Json object = {{"k", value}};
    JsonReader reader(object, "f.json");
    reader.number("k", kAny);
    const Status status = reader.finish();
    ASSERT_FALSE(status.ok());
    EXPECT_NO_THROW(Json(status.error().what).dump()) << lead;
  }
}

TEST(JsonReaderFormat, AcceptsItsOwnFormatUpToItsVersion) {
  for (const char* text :
       {R"({"format": "t.x", "version": 1})", R"({"format": "t.x", "version": 2})"}) {
    const Json object = json(text);
    JsonReader reader(object, "f.json");
    reader.format("t.x", 2);
    EXPECT_TRUE(reader.finish().ok()) << text;
  }
}

TEST(JsonReaderFormat, RefusesANewerVersionByName) {
  const Error error =
      errorOf(R"({"format": "t.x", "version": 3})", [](JsonReader& r) { r.format("t.x", 2); });
  EXPECT_EQ(error.where, "f.json: version");
  EXPECT_TRUE(says(error, "version 3 of t.x")) << error.what;
  EXPECT_TRUE(error.next.find("newer Trephine") != std::string::npos) << error.next;
}

TEST(JsonReaderFormat, SaysThatTheVersionIsNewerBeforeItSaysThatAFieldIsUnknown) {
  const Error error = errorOf(R"({"format": "t.x", "version": 3, "new_field": 1})",
                              [](JsonReader& r) { r.format("t.x", 2); });
  EXPECT_EQ(error.where, "f.json: version");
}

TEST(JsonReaderFormat, RefusesAnotherFormatAndAVersionThatCannotBe) {
  const auto read = [](JsonReader& r) { r.format("t.x", 2); };
  EXPECT_TRUE(says(errorOf(R"({"format": "t.y", "version": 1})", read), "'t.y'"));
  EXPECT_EQ(errorOf(R"({"format": "t.x", "version": 0})", read).where, "f.json: version");
  EXPECT_EQ(errorOf(R"({"format": "t.x"})", read).where, "f.json: version");
  EXPECT_EQ(errorOf(R"({"version": 1})", read).where, "f.json: format");
}

}  // namespace
}  // namespace trephine
