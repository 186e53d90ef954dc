// parseJson and readJsonFile: what is refused before any field is read.
#include "base/json.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/file.h"
#include "support.h"

namespace trephine {
namespace {

TEST(ParseJson, ReadsAndKeepsTheOrderOfFields) {
  const Result<Json> json = parseJson(R"({"b": 1, "a": [2, {"c": null}]})", "f.json");
  ASSERT_TRUE(json.ok());
  EXPECT_EQ(json->dump(), R"({"b":1,"a":[2,{"c":null}]})");
}

TEST(ParseJson, NamesTheFileAndThePlaceOfASyntaxError) {
  const Result<Json> json = parseJson("{\n  \"a\": 1,\n  \"b\" 2\n}", "f.json");
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().code.str(), "BAD_JSON");
  EXPECT_EQ(json.error().where, "f.json");
  EXPECT_NE(json.error().what.find("line 3"), std::string::npos) << json.error().what;
}

TEST(ParseJson, RefusesTextThatIsCutShort) {
  for (const char* text : {"", "{", "{\"a\": [1, 2", "\"open"}) {
    EXPECT_FALSE(parseJson(text, "f.json").ok()) << text;
  }
}

TEST(ParseJson, RefusesNaNAndInfinityWhichJsonDoesNotHave) {
  for (const char* text : {R"({"a": NaN})", R"({"a": Infinity})", R"({"a": -Infinity})"}) {
    EXPECT_FALSE(parseJson(text, "f.json").ok()) << text;
  }
}

TEST(ParseJson, NamesFieldAndValueOfANumberThatNoDoubleHolds) {
  const Result<Json> json =
      parseJson(R"({"tissues": [{"id": "a"}, {"id": "b", "opacity": 1e999}]})", "f.json");
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().where, "f.json: tissues[1].opacity");
  EXPECT_NE(json.error().what.find("1e999"), std::string::npos) << json.error().what;
}

TEST(ParseJson, NamesTheElementOfAListWhoseNumberNoDoubleHolds) {
  const Result<Json> json = parseJson(R"({"a": [[0, 1], [2, -1e400]]})", "f.json");
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().where, "f.json: a[1][1]");
}

TEST(ParseJson, RefusesAFieldGivenTwice) {
  const Result<Json> json = parseJson(R"({"a": {"k": 1}, "b": {"k": 1, "k": 2}})", "f.json");
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().where, "f.json: b.k");
}

TEST(ParseJson, RefusesNestingWithoutEnd) {
  const std::size_t depth = 1000000;
  EXPECT_FALSE(parseJson(std::string(depth, '['), "f.json").ok());
  const std::string closed = std::string(depth, '[') + std::string(depth, ']');
  EXPECT_FALSE(parseJson(closed, "f.json").ok());
  EXPECT_TRUE(parseJson(std::string(30, '[') + std::string(30, ']'), "f.json").ok());
}

// "{"f0": 0, "f1": 0, ...}"
std::string objectOf(std::size_t fields) {
  std::string text = "{";
  for (std::size_t n = 0; n < fields; ++n) {
    text += (n ? ", " : "") + ("\"f" + std::to_string(n)) + "\": 0";
  }
  return text + "}";
}

TEST(ParseJson, ReadsAnObjectOfAThousandFieldsAndRefusesOneOfMore) {
  const Result<Json> most = parseJson(objectOf(1024), "f.json");
  ASSERT_TRUE(most.ok()) << most.error().sentence();
  EXPECT_EQ(most->size(), 1024u);
  EXPECT_TRUE(most->contains("f1023"));
  const Result<Json> more = parseJson("{\"a\": [1, " + objectOf(1025) + "]}", "f.json");
  ASSERT_FALSE(more.ok());
  EXPECT_EQ(more.error().where, "f.json: a[1].f1024");
  EXPECT_NE(more.error().what.find("more than 1024 fields"), std::string::npos);
}

// A value that grows is not copied each time: a thousand objects, each within the last one's first
// field, beside a thousand others.
TEST(ParseJson, ReadsAnObjectWithinManyOthers) {
  std::string text = "0";
  for (int depth = 0; depth < 60; ++depth) {
    std::string level = "{\"a\": " + text;
    for (int n = 0; n < 1000; ++n) level += ", \"f" + std::to_string(n) + "\": 0";
    text = level + "}";
  }
  const Result<Json> json = parseJson(text, "f.json");
  ASSERT_TRUE(json.ok()) << json.error().sentence();
  const Json* at = &*json;
  int depth = 0;
  for (; at->is_object(); at = &(*at)["a"]) ++depth;
  EXPECT_EQ(depth, 60);
}

std::string listOf(std::size_t values) {
  std::string text = "[";
  for (std::size_t n = 0; n < values; ++n) text += n ? ",0" : "0";
  return text + "]";
}

TEST(ParseJson, RefusesMoreThanFourMillionValues) {
  EXPECT_TRUE(parseJson(listOf(3999999), "f.json").ok()) << "the list is a value, too";
  EXPECT_FALSE(parseJson(listOf(4000000), "f.json").ok());
}

TEST(ParseJson, IsCancelledInTheMiddleOfALongText) {
  Progress progress;
  progress.cancel();
  const Result<Json> json = parseJson(listOf(10000), "f.json", progress);
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().code.str(), "CANCELLED");
}

TEST(ReadJsonFile, ReadsAFile) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "f.json", R"({"a": 1})"));
  const Result<Json> json = readJsonFile(folder / "f.json");
  ASSERT_TRUE(json.ok());
  EXPECT_EQ((*json)["a"], 1);
}

TEST(ReadJsonFile, NamesAFileThatIsNotThere) {
  const test::TemporaryFolder folder;
  for (const auto& path : {folder / "none.json", folder.path()}) {
    const Result<Json> json = readJsonFile(path);
    ASSERT_FALSE(json.ok());
    EXPECT_EQ(json.error().code.str(), "MISSING_FILE");
    EXPECT_EQ(json.error().where, path.string());
    EXPECT_FALSE(json.error().next.empty());
  }
}

TEST(ReadJsonFile, RefusesAFileThatIsTooLargeBeforeItReadsIt) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "f.json", "{}"));
  std::filesystem::resize_file(folder / "f.json", (64 << 20) + 1);
  const Result<Json> json = readJsonFile(folder / "f.json");
  ASSERT_FALSE(json.ok());
  EXPECT_NE(json.error().what.find("64 MB"), std::string::npos) << json.error().what;
}

TEST(ReadJsonFile, DoesNotWaitForAPipeOrReadADevice) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.json").c_str(), 0600), 0);
  for (const std::filesystem::path& path :
       {folder / "pipe.json", std::filesystem::path("/dev/zero")}) {
    const Result<Json> json = readJsonFile(path);
    ASSERT_FALSE(json.ok());
    EXPECT_EQ(json.error().code.str(), "MISSING_FILE");
    EXPECT_EQ(json.error().where, path.string());
    EXPECT_NE(json.error().what.find("pipe"), std::string::npos) << json.error().what;
  }
}

}  // namespace
}  // namespace trephine
